"""Materials of shapes: which one holds, whether it is masked or shines, each made once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Mapping, Sequence

from importer.materials import models, roughness
from importer.materials import parameters as arithmetic
from importer.pbrt.parameters import Parameters
from importer.pbrt.spectra import Spectra
from importer.pbrt.state import Definition, State
from importer.pbrt.textures import Textures
from importer.problems import ImportProblem, Notes
from importer.scene import BLACK, Colour, Material, Number, Rgb, Texture

_DEEPEST_MIX = 32
_ROUGHNESSES = ("roughness", "uroughness", "vroughness")
_INVISIBLE = ("", "none", "interface")


@dataclass
class Reader:
    """The parameters of one material, as the functions that make materials of them ask for them."""

    name: str
    parameters: Parameters
    state: State
    textures: Textures
    spectra: Spectra
    notes: Notes
    version: int
    other: Callable[[str, str], Material]  # a named material, for mixtures

    @property
    def where(self) -> str:
        return str(self.parameters.place)

    def colour(self, name: str, default: float) -> Colour:
        colour = self.textures.colour(self.parameters, name, default, self.state)
        assert colour is not None
        return colour

    def number(self, name: str, default: float) -> Number:
        number = self.textures.number(self.parameters, name, default, self.state)
        assert number is not None
        return number

    def one_number(self, name: str, default: float) -> float:
        """Where ours does not vary over a surface."""
        number = self.number(name, default)
        if isinstance(number, Texture):
            self.notes.approximated(f'"{name}" of a material, which varies, as its mean', self.where)
        return arithmetic.mean_number(number)

    def index(self, *names: str, default: float = 1.5) -> float:
        for name in names:
            if self.parameters.texture(name) is not None:
                return self.one_number(name, default)
            if self.parameters.has(name):
                return self.spectra.index(self.parameters, name, default)
        return default

    def metal(self, eta: str, k: str) -> tuple[Rgb, Rgb]:
        for name in (eta, k):
            if self.parameters.texture(name) is not None:
                raise ImportProblem(f'{self.where}: "{name}" of {self.parameters.what} is a texture; it must be a spectrum')
        return self.spectra.metal(self.parameters, eta, k, self.state.colour_space)

    def alpha(self, default: float, prefix: str = "", names: Sequence[str] = _ROUGHNESSES,
              is_smooth_at_0: bool = False) -> Number:
        """Of "roughness", or of "uroughness" and "vroughness", which win; of those that the material knows. Remapped unless
        the file says not to, or unless both are 0 and the material smooth then."""
        both: Number = default if names[0] != _ROUGHNESSES[0] else self.number(prefix + names[0], default)
        along = [self.textures.number(self.parameters, prefix + name, None, self.state) if name in names else None
                 for name in _ROUGHNESSES[1:]]
        remap = self.parameters.flag("remaproughness", True)
        values = [both if value is None else value for value in along]
        if is_smooth_at_0 and all(arithmetic.is_constant(value, 0.0) for value in values):
            return 0.0
        u, v = (roughness.pbrt_alpha(value, remap, self.version) for value in values)
        return roughness.isotropic_alpha(u, v, self.notes, self.where)


Maker = Callable[[Reader], Material]


class Materials:
    """Makes materials of one scene's definitions."""

    def __init__(self, makers: Mapping[str, Maker], refused: Mapping[str, str], textures: Textures, spectra: Spectra,
                 notes: Notes, version: int) -> None:
        self._makers = makers
        self._refused = refused
        self._textures = textures
        self._spectra = spectra
        self._notes = notes
        self._version = version
        self._made: dict[Definition, Material | None] = {}
        self._variants: dict[tuple[object, ...], Material] = {}
        self._being_made = 0
        self._default = models.diffuse("default", (0.5, 0.5, 0.5), notes, "")

    def of(self, definition: Definition | None) -> Material | None:
        """None for an interface that nothing sees. Without a definition pbrt has a diffuse surface of 0.5 (v4: diffuse,
        v3: matte)."""
        if definition is None:
            return self._default
        if definition not in self._made:
            if self._being_made > _DEEPEST_MIX:
                raise ImportProblem(f"{definition.statement.place}: materials are mixed of themselves, or of more than"
                                    f" {_DEEPEST_MIX} within each other; a mixture must end in others")
            self._being_made += 1
            self._made[definition] = self._make(definition)
            self._being_made -= 1
        return self._made[definition]

    def overridden(self, definition: Definition, parameters: Parameters, names: set[str]) -> Material | None:
        """As pbrt-v3 has it where a shape sets parameters of its material (GraphicsState::GetMaterialForShape)."""
        own = [*(parameter for parameter in parameters.own if parameter.name in names), *definition.parameters.own]
        return self._make(replace(definition, parameters=replace(definition.parameters, own=own)))

    def masked(self, material: Material, parameters: Parameters, state: State) -> Material | None:
        """With the shape's "alpha"; None where that is 0 all over. pbrt-v3 cuts away where it is 0 and nothing else."""
        alpha = self._textures.number(parameters, "alpha", 1.0, state)
        if parameters.has("shadowalpha"):
            self._notes.left_out('"shadowalpha", by which shadows have other holes than the surface', str(parameters.place))
            parameters.without_effect("shadowalpha")
        assert alpha is not None
        if isinstance(alpha, float) and (alpha <= 0 or alpha >= 1 or self._version == 3):
            return None if alpha <= 0 else material
        key = ("masked", material, alpha)
        if key not in self._variants:
            opacity = arithmetic.map_number(alpha, lambda a: (a > 0) * 1.0, "not 0") if self._version == 3 else alpha
            self._variants[key] = models.masked(material, opacity, self._notes, str(parameters.place))
        return self._variants[key]

    def lamp(self, material: Material | None, radiance: Colour, both_sides: bool, where: str) -> Material:
        """The material with emission; without a material (v3) a black surface stands for one that only shines."""
        key = ("lamp", material, radiance, both_sides)
        if key not in self._variants:
            if material is None:
                self._notes.approximated("a lamp that light passes through as a black one", where)
                material = models.diffuse("lamp", BLACK, self._notes, where)
            self._variants[key] = models.lamp(material, radiance, both_sides, self._notes, where)
        return self._variants[key]

    def _make(self, definition: Definition) -> Material | None:
        parameters = definition.parameters
        is_named = definition.statement.directive == "MakeNamedMaterial"
        if is_named and not parameters.has("type"):
            raise ImportProblem(f'{parameters.place}: {parameters.what} has no "string type"; it must say which it is')
        kind = parameters.string("type", "") if is_named else definition.statement.strings[0]
        if kind in _INVISIBLE:
            parameters.finish(self._notes)
            return None
        name = definition.statement.strings[0] if is_named else f"{kind} of line {parameters.place.line}"
        if kind in self._refused:
            self._notes.refuse(f'the material "{kind}", {self._refused[kind]}', str(parameters.place))
            return models.diffuse(name, (0.5, 0.5, 0.5), self._notes, str(parameters.place))
        if kind not in self._makers:
            raise ImportProblem(f'{parameters.place}: there is no material "{kind}" in pbrt-v{self._version};'
                                f' it must be one of {", ".join(self._makers)}')
        state = definition.state
        reader = Reader(name, parameters, state, self._textures, self._spectra, self._notes, self._version,
                        lambda other, role: self._named(other, role, definition))
        material = self._makers[kind](reader)
        material = self._with_normal_map(material, parameters)
        for relief in ("displacement", "bumpmap"):
            if parameters.has(relief):
                self._notes.left_out(f"a bump map ({relief})", str(parameters.place))
        parameters.without_effect("displacement", "bumpmap", "type")
        parameters.finish(self._notes)
        return material

    def _with_normal_map(self, material: Material, parameters: Parameters) -> Material:
        name = parameters.string("normalmap", "") if self._version == 4 else ""
        return replace(material, normal_map=self._textures.normal_map(name, str(parameters.place))) if name else material

    def _named(self, name: str, role: str, definition: Definition) -> Material:
        if name not in definition.state.materials:
            raise ImportProblem(f'{definition.statement.place}: "{role}" names the material "{name}"; no material of that'
                                " name has been defined")
        made = self.of(definition.state.materials[name])
        return models.null(name) if made is None else made
