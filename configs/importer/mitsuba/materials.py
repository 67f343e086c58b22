"""<bsdf>: which of Mitsuba's scattering models becomes which of importer.materials.models, with Mitsuba's defaults."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Callable

from importer.materials import metals, models, roughness
from importer.materials.indices import named_index
from importer.mitsuba.colours import Use
from importer.mitsuba.plugin import Plugin
from importer.mitsuba.textures import TextureReader
from importer.mitsuba.values import numbers
from importer.problems import ImportProblem, Notes
from importer.scene import Material, Number, Rgb

NO_COUNTERPART = {"ward", "hk", "irawan", "rmbrdf", "measured", "measured_polarized", "hair", "circular", "polarizer",
                  "retarder", "pplastic", "dipolebrdf", "sssbrdf"}
# Of these Mitsuba lights the front alone where no twosided is around them.
_ONE_SIDED = {"diffuse", "roughdiffuse", "conductor", "roughconductor", "plastic", "roughplastic", "phong"}
_PLAIN = ("sample_visible", "use_fast_approx", "unused")
_SAMPLING = ("main_specular_sampling_rate", "clearcoat_sampling_rate", "diffuse_reflectance_sampling_rate",
             "specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate",
             "diffuse_transmittance_sampling_rate")


@dataclass
class MaterialReader:
    """Makes one material of each <bsdf>, however many shapes refer to it."""

    textures: TextureReader
    notes: Notes
    _materials: dict[tuple[int, bool], Material] = field(default_factory=dict)

    def read(self, bsdf: Plugin, name: str = "", is_two_sided: bool = False) -> Material:
        key = bsdf.key, is_two_sided
        if key not in self._materials:
            self._materials[key] = self._read(bsdf, bsdf.id or name or bsdf.type, is_two_sided)
            bsdf.note_rest(self.notes)
        return self._materials[key]

    def _read(self, bsdf: Plugin, name: str, is_two_sided: bool) -> Material:
        bsdf.ignore(*_PLAIN)
        if bsdf.type == "twosided":
            return self._twosided(bsdf, name)
        if bsdf.type in _AROUND:
            return self._around(bsdf, name, is_two_sided)
        if bsdf.type in NO_COUNTERPART:
            self.notes.refuse(f"a bsdf of type \"{bsdf.type}\"", bsdf.where)
            bsdf.ignore(*bsdf.properties)
            bsdf.all_of("texture", "bsdf")
            return models.diffuse(name, (0.5, 0.5, 0.5), self.notes, bsdf.where)
        if bsdf.type not in _SIMPLE:
            raise ImportProblem(f"{bsdf.where}: is no bsdf of Mitsuba's; known are {', '.join(BSDFS)}")
        if bsdf.type in _ONE_SIDED and not is_two_sided:
            self.notes.approximated("surfaces that Mitsuba lights on their front alone, without twosided: on both sides",
                                    bsdf.where)
        return _SIMPLE[bsdf.type](self, bsdf, name)

    def _around(self, bsdf: Plugin, name: str, is_two_sided: bool) -> Material:
        """Models that hold others."""
        inner = [self.read(child, name, is_two_sided) for child in bsdf.all_of("bsdf")]
        expected = {"blendbsdf": 2, "mixturebsdf": len(inner) or 1}.get(bsdf.type, 1)
        if len(inner) != expected:
            raise ImportProblem(f"{bsdf.where}: holds {len(inner)} <bsdf>; {expected} would be right")
        return replace(_AROUND[bsdf.type](self, bsdf, inner), name=name)

    def _twosided(self, bsdf: Plugin, name: str) -> Material:
        inner = bsdf.all_of("bsdf")
        if len(inner) not in (1, 2):
            raise ImportProblem(f"{bsdf.where}: holds {len(inner)} <bsdf>; 1 or 2 would be right")
        if len(inner) == 2 and inner[0].key != inner[1].key:
            self.notes.approximated("different materials on the two sides of a surface as that of its front", bsdf.where)
        return self.read(inner[0], name, True)

    def _mask(self, bsdf: Plugin, inner: list[Material]) -> Material:
        return models.masked(inner[0], self.textures.number(bsdf, "opacity", 0.5), self.notes, bsdf.where)

    def _bumpmap(self, bsdf: Plugin, inner: list[Material]) -> Material:
        bsdf.all_of("texture")
        bsdf.ignore("scale")
        self.notes.left_out("bump maps", bsdf.where)
        return inner[0]

    def _normalmap(self, bsdf: Plugin, inner: list[Material]) -> Material:
        texture = bsdf.child("normalmap") or next(iter(bsdf.all_of("texture")), None)
        if not texture:
            raise ImportProblem(f"{bsdf.where}: needs a <texture name=\"normalmap\">")
        return replace(inner[0], normal_map=self.textures.normal_map(texture))

    def _coating(self, bsdf: Plugin, inner: list[Material]) -> Material:
        alpha = self._alpha(bsdf) if bsdf.type == "roughcoating" else 0.0
        sigma_a = self.textures.rgb(bsdf, "sigma_a", 0.0, Use.INDEX)
        specular = self.textures.colour(bsdf, "specular_reflectance", 1.0)
        return models.coated(inner[0], self._relative_index(bsdf, "bk7"), alpha, specular, bsdf.number("thickness", 1.0),
                             sigma_a, self.notes, bsdf.where)

    def _blend(self, bsdf: Plugin, inner: list[Material]) -> Material:
        """A weight of 0 is the first alone (BlendBSDF::eval)."""
        return models.blended(inner[0], inner[1], self.textures.number(bsdf, "weight", 0.5), self.notes, bsdf.where)

    def _mixture(self, bsdf: Plugin, inner: list[Material]) -> Material:
        """Weights that sum to less than 1 take light away in Mitsuba (MixtureBSDF)."""
        weights = _weights(bsdf, len(inner))
        if sum(weights) < 1.0 - 1e-4:
            self.notes.approximated("a mixture whose weights sum to less than 1 as one of weights that sum to 1", bsdf.where)
        material, total = inner[0], weights[0]
        for other, weight in zip(inner[1:], weights[1:]):
            total += weight
            material = models.blended(material, other, weight / total if total else 0.0, self.notes, bsdf.where)
        return material

    def _diffuse(self, bsdf: Plugin, name: str) -> Material:
        key = "diffuse_reflectance" if bsdf.gives("diffuse_reflectance") else "reflectance"  # older versions' name
        return models.diffuse(name, self.textures.colour(bsdf, key, 0.5), self.notes, bsdf.where)

    def _roughdiffuse(self, bsdf: Plugin, name: str) -> Material:
        reflectance = self.textures.colour(bsdf, "reflectance", 0.5)
        return models.rough_diffuse(name, reflectance, self.textures.number(bsdf, "alpha", 0.2), self.notes, bsdf.where)

    def _conductor(self, bsdf: Plugin, name: str) -> Material:
        """"none", which reflects all, is the default of Mitsuba 3, and copper that of 0.6."""
        alpha = self._alpha(bsdf) if bsdf.type == "roughconductor" else 0.0
        reflectance = self.textures.colour(bsdf, "specular_reflectance", 1.0)
        material = bsdf.string("material", "Cu" if bsdf.is_old else "none")
        outside = self._index(bsdf, "ext_eta", "air") if bsdf.is_old else 1.0
        is_measured = bsdf.gives("eta") or bsdf.gives("k")
        if material.lower() == "none" and not is_measured:
            return models.exact_mirror(name, reflectance, alpha, self.notes, bsdf.where)
        if material.lower() == "none" or is_measured and not bsdf.is_old:
            eta, k = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
        else:
            eta, k = metals.named_metal(material, bsdf.where)
        eta = _over(self.textures.rgb(bsdf, "eta", eta, Use.INDEX), outside)
        k = _over(self.textures.rgb(bsdf, "k", k, Use.INDEX), outside)
        return models.conductor(name, eta, k, reflectance, alpha, self.notes, bsdf.where)

    def _dielectric(self, bsdf: Plugin, name: str) -> Material:
        alpha = self._alpha(bsdf) if bsdf.type == "roughdielectric" else 0.0
        return models.dielectric(name, self._index(bsdf, "int_ior", "bk7"), self._index(bsdf, "ext_ior", "air"), alpha,
                                 self.textures.colour(bsdf, "specular_reflectance", 1.0),
                                 self.textures.colour(bsdf, "specular_transmittance", 1.0), self.notes, bsdf.where)

    def _thindielectric(self, bsdf: Plugin, name: str) -> Material:
        return models.thin_dielectric(name, self._index(bsdf, "int_ior", "bk7"), self._index(bsdf, "ext_ior", "air"),
                                      self.textures.colour(bsdf, "specular_reflectance", 1.0),
                                      self.textures.colour(bsdf, "specular_transmittance", 1.0), self.notes, bsdf.where)

    def _plastic(self, bsdf: Plugin, name: str) -> Material:
        alpha = self._alpha(bsdf) if bsdf.type == "roughplastic" else 0.0
        return models.plastic(name, self.textures.colour(bsdf, "diffuse_reflectance", 0.5),
                              self._relative_index(bsdf, "polypropylene"), alpha,
                              self.textures.colour(bsdf, "specular_reflectance", 1.0), bsdf.boolean("nonlinear", False),
                              self.notes, bsdf.where, 0 if bsdf.is_old else 3)

    def _phong(self, bsdf: Plugin, name: str) -> Material:
        exponent = self.textures.number(bsdf, "exponent", 30.0)
        if not isinstance(exponent, float):
            self.notes.approximated("a texture of Phong's exponents as 30", bsdf.where)
            exponent = 30.0
        return models.phong(name, self.textures.colour(bsdf, "diffuse_reflectance", 0.5),
                            self.textures.colour(bsdf, "specular_reflectance", 0.2), exponent, self.notes, bsdf.where)

    def _difftrans(self, bsdf: Plugin, name: str) -> Material:
        transmittance = self.textures.colour(bsdf, "transmittance", 0.5)
        return models.diffuse_transmitter(name, (0.0, 0.0, 0.0), transmittance, self.notes, bsdf.where)

    def _null(self, bsdf: Plugin, name: str) -> Material:
        return models.null(name)

    def _principled(self, bsdf: Plugin, name: str) -> Material:
        bsdf.ignore(*_SAMPLING)
        names = ("metallic", "spec_tint", "spec_trans", "clearcoat", "clearcoat_gloss", "anisotropic", "sheen", "sheen_tint",
                 "flatness")
        amounts = {key: self.textures.number(bsdf, key, 0.0) for key in names}
        if bsdf.has("eta") and bsdf.has("specular"):
            raise ImportProblem(f"{bsdf.where}: has both \"eta\" and \"specular\"; one of them is right")
        eta = bsdf.number("eta", 1.5) if bsdf.has("eta") else models.index_of_specular(bsdf.number("specular", 0.5))
        return models.principled(name, self.textures.colour(bsdf, "base_color", 0.5), self.notes, bsdf.where, eta=eta,
                                 roughness=self.textures.number(bsdf, "roughness", 0.5), **amounts)

    def _principledthin(self, bsdf: Plugin, name: str) -> Material:
        bsdf.ignore(*_SAMPLING)
        names = ("spec_tint", "spec_trans", "anisotropic", "sheen", "sheen_tint", "flatness", "diff_trans")
        amounts = {key: self.textures.number(bsdf, key, 0.0) for key in names}
        return models.principled(name, self.textures.colour(bsdf, "base_color", 0.5), self.notes, bsdf.where, is_thin=True,
                                 eta=bsdf.number("eta", 1.5), roughness=self.textures.number(bsdf, "roughness", 0.5),
                                 **amounts)

    def _alpha(self, bsdf: Plugin) -> Number:
        """Beckmann's distribution is the default, and an alpha of 0.1 (MicrofacetDistribution)."""
        roughness.note_distribution(bsdf.string("distribution", "beckmann").lower(), self.notes, bsdf.where)
        alpha = self.textures.number(bsdf, "alpha", 0.1)
        along = [self.textures.number(bsdf, key, 0.1) if bsdf.gives(key) else alpha for key in ("alpha_u", "alpha_v")]
        return roughness.isotropic_alpha(along[0], along[1], self.notes, bsdf.where)

    def _index(self, bsdf: Plugin, key: str, default: str) -> float:
        """A number, or a name such as "water" (lookup_ior)."""
        found = bsdf.get(key)
        if found and not isinstance(found.value, str):
            return bsdf.number(key, 1.0)
        return named_index(found.value if found else default, self.notes, bsdf.where)  # type: ignore[arg-type]

    def _relative_index(self, bsdf: Plugin, default: str) -> float:
        outside = self._index(bsdf, "ext_ior", "air")
        if outside <= 0:
            raise ImportProblem(f"{bsdf.where}: its \"ext_ior\" is {outside:g}; above 0 is right")
        return self._index(bsdf, "int_ior", default) / outside


_SIMPLE: dict[str, Callable[[MaterialReader, Plugin, str], Material]] = {
    "diffuse": MaterialReader._diffuse, "roughdiffuse": MaterialReader._roughdiffuse,
    "conductor": MaterialReader._conductor, "roughconductor": MaterialReader._conductor,
    "dielectric": MaterialReader._dielectric, "roughdielectric": MaterialReader._dielectric,
    "thindielectric": MaterialReader._thindielectric, "plastic": MaterialReader._plastic,
    "roughplastic": MaterialReader._plastic, "phong": MaterialReader._phong, "difftrans": MaterialReader._difftrans,
    "null": MaterialReader._null, "principled": MaterialReader._principled,
    "principledthin": MaterialReader._principledthin}
_AROUND: dict[str, Callable[[MaterialReader, Plugin, list[Material]], Material]] = {
    "mask": MaterialReader._mask, "bumpmap": MaterialReader._bumpmap, "normalmap": MaterialReader._normalmap,
    "coating": MaterialReader._coating, "roughcoating": MaterialReader._coating, "blendbsdf": MaterialReader._blend,
    "mixturebsdf": MaterialReader._mixture}
BSDFS = (*_SIMPLE, "twosided", *_AROUND)


def _over(values: Rgb, outside: float) -> Rgb:
    return values[0] / outside, values[1] / outside, values[2] / outside


def _weights(bsdf: Plugin, count: int) -> list[float]:
    weights = numbers(bsdf.string("weights"), bsdf.where)
    if len(weights) != count or min(weights) < 0 or sum(weights) <= 0:
        raise ImportProblem(f"{bsdf.where}: its weights must be {count} numbers of 0 or more, one for each <bsdf>")
    return weights
