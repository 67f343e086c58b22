"""pbrt's graphics state: what holds for the shapes and lights that follow (pbrt-v4: BasicSceneBuilder; pbrt-v3: api.cpp)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Sequence

import numpy as np

from importer import moves
from importer.pbrt import transforms
from importer.pbrt.parameters import Parameter, Parameters
from importer.pbrt.source import Place
from importer.pbrt.statements import Statement
from importer.problems import ImportProblem, Notes

ATTRIBUTE_TARGETS = ("shape", "light", "material", "medium", "texture")
COLOUR_SPACES = ("srgb", "dci-p3", "rec2020", "aces2065-1")
DEEPEST_STATE = 10_000


@dataclass(eq=False)
class Definition:
    """A material or texture with the state in which it was made; it becomes ours when a shape asks for it."""

    statement: Statement
    parameters: Parameters
    state: "State"


@dataclass
class State:
    to_world: np.ndarray = field(default_factory=lambda: np.eye(4))  # pbrt's CTM
    is_reversed: bool = False
    material: Definition | None = None  # None: the default one
    area_light: Definition | None = None
    medium: str = ""  # within the shapes that follow
    colour_space: str = "srgb"
    attributes: dict[str, tuple[Parameter, ...]] = field(default_factory=dict)
    materials: dict[str, Definition] = field(default_factory=dict)
    colour_textures: dict[str, Definition] = field(default_factory=dict)
    number_textures: dict[str, Definition] = field(default_factory=dict)


class States:
    """The state now and those that AttributeBegin and its like have put aside."""

    def __init__(self, notes: Notes, version: int) -> None:
        self.now = State()
        self._notes = notes
        self._version = version
        self._saved: list[tuple[str, Place, State]] = []
        self._coordinate_systems: dict[str, np.ndarray] = {}

    def parameters(self, statement: Statement, what: str, target: str = "") -> Parameters:
        return Parameters(statement.parameters, statement.place, what, self.now.attributes.get(target, ()))

    def definition(self, statement: Statement, what: str, target: str) -> Definition:
        return Definition(statement, self.parameters(statement, what, target), self.now)

    def define(self, statement: Statement) -> None:
        """Gives a name to a material or a texture. In pbrt-v3 it is forgotten at AttributeEnd; in pbrt-v4 it is the scene's,
        and can be given once (BasicSceneBuilder::MakeNamedMaterial, ::Texture)."""
        name = statement.strings[0]
        table = "materials" if statement.directive == "MakeNamedMaterial" else _texture_table(statement)
        names: dict[str, Definition] = getattr(self.now, table)
        if self._version == 4 and name in names:
            if names[name].statement is statement:  # as `collected` has found it
                return
            raise ImportProblem(f'{statement.place}: "{name}" has been defined at {names[name].statement.place};'
                                " in pbrt-v4 a name is given once")
        kind = "material" if table == "materials" else "texture"
        definition = self.definition(statement, f'the {kind} "{name}"', kind)
        if self._version == 4:
            names[name] = definition
        else:
            self.now = replace(self.now, **{table: {**names, name: definition}})

    def bracket(self, statement: Statement) -> None:
        """WorldBegin, AttributeBegin, AttributeEnd and their like."""
        directive, place = statement.directive, statement.place
        kind = directive.removesuffix("Begin").removesuffix("End")
        if directive == "WorldBegin":
            self.now = replace(self.now, to_world=np.eye(4))
            self._coordinate_systems["world"] = np.eye(4)
        elif kind != "World" and directive.endswith("Begin"):
            self._push(kind, place)
        elif kind != "World":
            self._pop(kind, place)

    def _push(self, kind: str, place: Place) -> None:
        if len(self._saved) >= DEEPEST_STATE:
            raise ImportProblem(f"{place}: more than {DEEPEST_STATE} states within each other; each needs its end")
        self._saved.append((kind, place, self.now))

    def _pop(self, kind: str, place: Place) -> None:
        if not self._saved or self._saved[-1][0] != kind:
            open_one = f"{self._saved[-1][0]}Begin of {self._saved[-1][1]}" if self._saved else "nothing"
            raise ImportProblem(f"{place}: {kind}End closes {open_one}; it must close its own {kind}Begin")
        saved = self._saved.pop()[2]
        self.now = replace(self.now, to_world=saved.to_world) if kind == "Transform" else saved

    def check_closed(self) -> None:
        if self._saved:
            kind, place, _ = self._saved[-1]
            raise ImportProblem(f"{place}: {kind}Begin has no {kind}End; each needs its end")

    def apply(self, statement: Statement) -> bool:
        """Whether the statement was one that changes nothing but the state, and has been carried out."""
        if statement.directive in _TRANSFORMS:
            with np.errstate(over="ignore", invalid="ignore"):  # what overflows is told of there
                matrix = _TRANSFORMS[statement.directive](self.now.to_world, statement.numbers, statement.place)
            self._set_matrix(matrix, statement.place)
        elif statement.directive == "CoordinateSystem":
            self._coordinate_systems[statement.strings[0]] = self.now.to_world
        elif statement.directive == "CoordSysTransform":
            self._recall(statement)
        elif statement.directive == "ReverseOrientation":
            self.now = replace(self.now, is_reversed=not self.now.is_reversed)
        elif statement.directive == "ColorSpace":
            self._set_colour_space(statement)
        elif statement.directive == "Attribute":
            self._set_attribute(statement)
        elif statement.directive == "ActiveTransform":
            self._activate(statement)
        else:
            if statement.directive == "Camera":
                transforms.check_usable(self.now.to_world, statement.place)
                self._coordinate_systems["camera"] = np.linalg.inv(self.now.to_world)
            return False
        return True

    def _set_matrix(self, matrix: np.ndarray, place: Place) -> None:
        transforms.check_finite(matrix, place)
        self.now = replace(self.now, to_world=matrix)

    def _recall(self, statement: Statement) -> None:
        name = statement.strings[0]
        if name not in self._coordinate_systems:
            raise ImportProblem(f'{statement.place}: there is no coordinate system "{name}"; CoordinateSystem must name it'
                                " before")
        self.now = replace(self.now, to_world=self._coordinate_systems[name])

    def _set_colour_space(self, statement: Statement) -> None:
        name = statement.strings[0]
        if name not in COLOUR_SPACES:
            raise ImportProblem(f'{statement.place}: "{name}" is no colour space; it must be {", ".join(COLOUR_SPACES)}')
        self.now = replace(self.now, colour_space=name)

    def _set_attribute(self, statement: Statement) -> None:
        target = statement.strings[0]
        if target not in ATTRIBUTE_TARGETS:
            raise ImportProblem(f'{statement.place}: Attribute is about "{target}"; it must be one of'
                                f' {", ".join(ATTRIBUTE_TARGETS)}')
        newest_first = (*statement.parameters, *self.now.attributes.get(target, ()))
        self.now = replace(self.now, attributes={**self.now.attributes, target: newest_first})

    def _activate(self, statement: Statement) -> None:
        if statement.strings[0] not in ("All", "StartTime", "EndTime"):
            raise ImportProblem(f"{statement.place}: ActiveTransform must be All, StartTime or EndTime")
        if statement.strings[0] != "All":
            self._notes.refuse("the scene moves while the shutter is open (ActiveTransform)", str(statement.place))


def collected(statements: Sequence[Statement], notes: Notes) -> States:
    """The state at the beginning of a scene of pbrt-v4, in which all names are known: pbrt makes materials and textures
    when it has read the whole file, so that shapes may name what is defined after them."""
    before = States(Notes(is_lenient=True), 4)
    for statement in statements:
        if statement.directive.endswith(("Begin", "End")):
            before.bracket(statement)
        elif statement.directive in ("MakeNamedMaterial", "Texture"):
            before.define(statement)
        elif statement.directive in ("ColorSpace", "Attribute"):  # on which definitions depend, and on no matrix
            before.apply(statement)
    states = States(notes, 4)
    known = before.now
    states.now = State(materials=known.materials, colour_textures=known.colour_textures,
                       number_textures=known.number_textures)
    return states


def _texture_table(statement: Statement) -> str:
    name, kind, _ = statement.strings
    tables = {"float": "number_textures", "spectrum": "colour_textures", "color": "colour_textures"}
    if kind not in tables:
        raise ImportProblem(f'{statement.place}: the texture "{name}" is of the type "{kind}"; it must be float or spectrum')
    return tables[kind]


_TRANSFORMS = {
    "Identity": lambda old, numbers, place: np.eye(4),
    "Translate": lambda old, numbers, place: old @ moves.translation(numbers),
    "Scale": lambda old, numbers, place: old @ transforms.scaling(numbers, place),
    "Rotate": lambda old, numbers, place: old @ moves.rotation(numbers[1:], numbers[0], str(place)),
    "LookAt": lambda old, numbers, place: old @ transforms.look_at(numbers, place),
    "Transform": lambda old, numbers, place: transforms.from_file(numbers, place),
    "ConcatTransform": lambda old, numbers, place: old @ transforms.from_file(numbers, place),
}
