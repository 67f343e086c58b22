"""Burley's materials (Physically Based Shading at Disney, 2012 and 2015): Mitsuba's principled and principledthin, pbrt-v3's
disney. glTF's model has grown out of them, so that most parameters go over as they are."""

from __future__ import annotations

import math

import numpy as np

from importer.materials import limits, parameters
from importer.problems import Notes
from importer.scene import Colour, Material, Number

_LEFT_OUT = {"anisotropic": "the anisotropy of a principled material", "sheen": "the sheen of a principled material",
             "flatness": "the flatness of a principled material"}


def index_of_specular(specular: float, where: str = "a principled material") -> float:
    """F0 is 0.08 times `specular` (Burley 2012, section 5.5)."""
    limits.checked_number(specular, "specular", where, most=10.0)
    return 2.0 / (1.0 - math.sqrt(0.08 * specular)) - 1.0


def principled(name: str, base_colour: Colour, notes: Notes, where: str, *, metallic: Number = 0.0, roughness: Number = 0.5,
               eta: float = 1.5, spec_tint: Number = 0.0, spec_trans: Number = 0.0, is_thin: bool = False,
               clearcoat: Number = 0.0, clearcoat_gloss: Number = 0.0, anisotropic: Number = 0.0, sheen: Number = 0.0,
               sheen_tint: Number = 0.0, flatness: Number = 0.0, diff_trans: Number = 0.0) -> Material:
    """`eta`: of Mitsuba's `specular` by index_of_specular. `sheen_tint` has no effect without sheen, which is left out."""
    base_colour = limits.reflectance(base_colour, "the base colour", notes, where)
    limits.checked_number(eta, "the index of a principled material", where, least=1.0, most=limits.MOST_INDEX)
    for key, value in (("anisotropic", anisotropic), ("sheen", sheen), ("flatness", flatness)):
        limits.checked_number(value, key, where)
        if not parameters.is_constant(value, 0.0):
            notes.left_out(_LEFT_OUT[key], where)
    limits.checked_number(sheen_tint, "sheen_tint", where)
    if not parameters.is_constant(diff_trans, 0.0):
        notes.refuse("diffuse light through a surface", where)
    metal = _one_number(metallic, "the metallic share", notes, where)
    passes = parameters.mean_number(limits.checked_number(spec_trans, "spec_trans", where, most=1.0))
    if metal < 1.0 and passes < 1.0:
        notes.approximated("Burley's diffuse lobe as Lambert's below a dielectric one", where)
    # Without an interface there is no lobe, of which Schlick's curve would leave the grazing end.
    strength = 1.0 if eta > 1.0 + 1e-6 else 0.0
    coat, coat_roughness = _coat(clearcoat, clearcoat_gloss, notes, where)
    return Material(name, base_colour=_base(base_colour, passes, is_thin, notes, where), metallic=metal,
                    roughness=limits.checked_number(roughness, "roughness", where, most=1.0), specular=strength,
                    specular_colour=_tint(base_colour, spec_tint, notes, where), ior=eta, transmission=spec_trans,
                    is_thin=is_thin or passes == 0.0, clearcoat=coat, clearcoat_roughness=coat_roughness)


def _one_number(value: Number, what: str, notes: Notes, where: str) -> float:
    limits.checked_number(value, what, where, most=1.0)
    if isinstance(value, parameters.Texture):
        notes.approximated(f"{what} of a material that varies as its mean", where)
    return parameters.mean_number(value)


def _base(colour: Colour, passes: float, is_thin: bool, notes: Notes, where: str) -> Colour:
    """What passes takes the root of the base colour at each of a closed body's faces (Burley 2015, section 5.1), and in
    principledthin at the one face, too."""
    if passes <= 0.0:
        return colour
    if passes < 1.0:
        notes.approximated("a surface that partly passes light: both parts with the base colour of the diffuse one", where)
        return colour
    return parameters.map_colour(colour, np.sqrt, "root")


def _tint(colour: Colour, amount: Number, notes: Notes, where: str) -> Colour:
    """White and the hue of the base colour, mixed: the hue is the colour over its luminance."""
    share = _one_number(amount, "the tint of the gloss", notes, where)
    if share == 0.0:
        return (1.0, 1.0, 1.0)

    def mixed(rgb: np.ndarray) -> np.ndarray:
        luminance = rgb @ np.array((0.212671, 0.715160, 0.072169))
        hue = np.where(luminance[..., None] > 0.0, rgb / np.maximum(luminance[..., None], 1e-6), 1.0)
        return 1.0 - share + share * hue

    return parameters.map_colour(colour, mixed, ("tint", share))


def _coat(clearcoat: Number, gloss: Number, notes: Notes, where: str) -> tuple[Number, float]:
    """A quarter of a coat of index 1.5, with an alpha from 0.1 to 0.001 (Burley 2012, section 5.5)."""
    limits.checked_number(clearcoat, "clearcoat", where, most=4.0)
    if parameters.is_constant(clearcoat, 0.0):
        return 0.0, 0.0
    notes.approximated("the coat's microfacets of a principled material, GTR1's, as GGX's; and what it reflects dims what "
                       "is below", where)
    alpha = 0.1 + (0.001 - 0.1) * _one_number(gloss, "the gloss of a coat", notes, where)
    return parameters.scaled_number(clearcoat, 0.25), math.sqrt(alpha)

