"""What light passes: closed bodies of glass and thin walls."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from importer.materials import fresnel, limits, parameters
from importer.materials.roughness import mitsuba_roughness
from importer.materials.simple import strength_and_colour
from importer.problems import Notes
from importer.scene import WHITE, Colour, Material, Number, Rgb


@dataclass(eq=False)
class InwardGlass(Material):
    """A dielectric whose dense side is before the mesh's front, as of a bubble in glass: the mesh must be turned inside
    out (`meshes.orient.flipped`), since glTF's volumes have indices of 1 and more."""


def is_inward(material: Material) -> bool:
    """Whether the mesh of that material must be turned inside out."""
    return isinstance(material, InwardGlass)


def can_absorb(material: Material) -> bool:
    """Whether it bounds a body that all light passes, so that what the body takes up can be said of the material."""
    is_clear = isinstance(material.transmission, float) and material.transmission == 1.0 and material.opacity == 1.0
    return is_clear and not material.is_thin and not is_inward(material)


def absorbing(material: Material, absorption: Rgb, where: str) -> Material:
    """Of the light in such a body exp(-absorption * length) is left (Beer and Lambert)."""
    most = max(absorption)
    limits.checked_number(most, "what a medium absorbs on a unit of length", where, least=0.0, most=1e12)
    if most < 1e-12:
        return material
    red, green, blue = (math.exp(-share / most) for share in absorption)
    return replace(material, attenuation_colour=(red, green, blue), attenuation_distance=1.0 / most)


def _curve_note(exact: np.ndarray, cosines: np.ndarray, f0: float, what: str, notes: Notes, where: str) -> None:
    worst = fresnel.worst_of_schlick(exact, cosines, f0)
    if worst > limits.TOLERANCE:
        notes.approximated(f"{what} by Schlick's curve, which is off by {limits.bound(worst)} at most, near grazing angles",
                           where)


def dielectric(name: str, int_ior: float, ext_ior: float, alpha: Number, reflectance: Colour, transmittance: Colour,
               notes: Notes, where: str) -> Material:
    """A closed body with `int_ior` behind the fronts of its mesh; `InwardGlass` where that is the smaller one."""
    for index in (int_ior, ext_ior):
        limits.checked_number(float(index), "an index of refraction", where, least=1e-3, most=limits.MOST_INDEX)
    reflectance = limits.reflectance(reflectance, "the factor of what glass reflects", notes, where)
    transmittance = limits.reflectance(transmittance, "the factor of what glass passes", notes, where)
    eta = int_ior / ext_ior
    if abs(eta - 1.0) < 1e-6:
        # Without an interface nothing is reflected or bent, and pbrt takes it as smooth (BxDF's EffectivelySmooth).
        return _nothing_but_colour(name, transmittance)
    dense = max(eta, 1.0 / eta)
    cosines = np.cos(np.radians(np.arange(0.0, 90.0)))
    _curve_note(fresnel.dielectric(cosines, dense), cosines, fresnel.f0_of_index(dense), "Fresnel's reflectance of glass",
                notes, where)
    strength, colour = _lobe(reflectance, notes, where)
    make = InwardGlass if eta < 1.0 else Material
    return make(name, base_colour=transmittance, roughness=mitsuba_roughness(limits.alpha(alpha, notes, where)),
                specular=strength, specular_colour=colour, ior=dense, transmission=1.0, is_thin=False)


def _nothing_but_colour(name: str, transmittance: Colour) -> Material:
    return Material(name, base_colour=transmittance, roughness=0.0, specular=0.0, ior=1.0, transmission=1.0, is_thin=True)


def _lobe(reflectance: Colour, notes: Notes, where: str) -> tuple[Number, Colour]:
    if parameters.is_constant(reflectance, 1.0):
        return 1.0, WHITE
    notes.approximated("a factor of what glass reflects: what it takes away passes, and total reflection has none of it",
                       where)
    return strength_and_colour(reflectance, notes, where)


def thin_reflectance(reflectance: np.ndarray | float) -> np.ndarray | float:
    """Of both faces of a thin wall with all reflections between them: R + T^2 R / (1 - R^2) = 2 R / (1 + R), as in
    Mitsuba's thindielectric and pbrt-v4's ThinDielectricBxDF."""
    return 2.0 * reflectance / (1.0 + reflectance)


def thin_dielectric(name: str, int_ior: float, ext_ior: float, reflectance: Colour, transmittance: Colour, notes: Notes,
                    where: str) -> Material:
    """A thin wall that reflects what both its faces do together: an index of that F0."""
    for index in (int_ior, ext_ior):
        limits.checked_number(float(index), "an index of refraction", where, least=1e-3, most=limits.MOST_INDEX)
    reflectance = limits.reflectance(reflectance, "the factor of what glass reflects", notes, where)
    transmittance = limits.reflectance(transmittance, "the factor of what glass passes", notes, where)
    eta = max(int_ior / ext_ior, ext_ior / int_ior)
    f0 = float(thin_reflectance(fresnel.f0_of_index(eta)))
    if f0 < 1e-12:
        return _nothing_but_colour(name, transmittance)
    cosines = np.cos(np.radians(np.arange(0.0, 90.0)))
    exact = np.asarray(thin_reflectance(fresnel.dielectric(cosines, eta)))
    _curve_note(exact, cosines, f0, "the reflectance of both faces of thin glass", notes, where)
    strength, colour = _lobe(reflectance, notes, where)
    return Material(name, base_colour=transmittance, roughness=0.0, specular=strength, specular_colour=colour,
                    ior=fresnel.index_of_f0(f0), transmission=1.0, is_thin=True)
