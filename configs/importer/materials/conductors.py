"""Metals."""

from __future__ import annotations

import numpy as np

from importer.materials import fresnel, limits, metals, parameters
from importer.materials.roughness import mitsuba_roughness
from importer.materials.simple import mirror, strength_and_colour
from importer.problems import ImportProblem, Notes
from importer.scene import BLACK, WHITE, Colour, Material, Number, Rgb


def indices_of_reflectance(reflectance: Rgb) -> tuple[Rgb, Rgb]:
    """eta 1 and the k of a reflectance at normal incidence, as pbrt-v4's conductors read their `reflectance`:
    k = 2 sqrt(r / (1 - r)), r being below 0.9999 there (ConductorMaterial::GetBxDF)."""
    red, green, blue = (2.0 * (r / (1.0 - r)) ** 0.5 for r in (min(max(c, 0.0), 0.9999) for c in reflectance))
    return WHITE, (red, green, blue)


def conductor(name: str, eta: Rgb, k: Rgb, reflectance: Colour, alpha: Number, notes: Notes, where: str) -> Material:
    """`reflectance`: a factor of the whole lobe (Mitsuba's specular_reflectance). Without one a glTF metal, whose base
    colour is F0 and whose F90 is 1. With one, KHR_materials_specular over an index of 0: F0 = factor times F0 and
    F90 = factor, so that a dark metal stays dark at grazing angles."""
    check_indices(eta, k, where)
    f0 = metals.f0(eta, k)
    _note_curve(eta, k, f0, notes, where)
    roughness = mitsuba_roughness(limits.alpha(alpha, notes, where))
    reflectance = limits.reflectance(reflectance, "the factor of a conductor", notes, where)
    if parameters.is_constant(reflectance, 1.0):
        return Material(name, base_colour=f0, metallic=1.0, roughness=roughness)
    strength, colour = strength_and_colour(reflectance, notes, where)
    return Material(name, base_colour=BLACK, roughness=roughness, specular=strength, ior=0.0,
                    specular_colour=parameters.scaled(colour, f0))


def check_indices(eta: Rgb, k: Rgb, where: str) -> None:
    for values, what in ((eta, "eta"), (k, "k")):
        for value in values:
            limits.checked_number(float(value), f"{what} of a conductor", where, most=1e6)
    if min(np.hypot(eta, k)) < 1e-3:
        raise ImportProblem(f"{where}: a conductor's eta and k are both 0; measured indices would be right")


def conductor_of_reflectance(name: str, reflectance: Colour, alpha: Number, notes: Notes, where: str) -> Material:
    """pbrt-v4's conductor that is given by its reflectance at normal incidence, a texture too; at grazing angles it has
    all of it, since k follows from it with an eta of 1."""
    reflectance = limits.reflectance(reflectance, "the reflectance of a conductor", notes, where)
    mean = parameters.mean_rgb(reflectance)
    _note_curve(*indices_of_reflectance(mean), mean, notes, where)
    return Material(name, base_colour=reflectance, metallic=1.0,
                    roughness=mitsuba_roughness(limits.alpha(alpha, notes, where)))


def exact_mirror(name: str, reflectance: Colour, alpha: Number, notes: Notes, where: str) -> Material:
    """Mitsuba's conductor of the material "none", which reflects all at every angle."""
    return mirror(name, reflectance, notes, where, alpha)


def worst_of_curve(eta: Rgb, k: Rgb, f0: Rgb) -> float:
    """How far Schlick's curve is from the conductor's at most, up to 89 degrees."""
    cosines = np.cos(np.radians(np.arange(0.0, 90.0)))
    return max(fresnel.worst_of_schlick(fresnel.conductor(cosines, n, absorption), cosines, f)
               for n, absorption, f in zip(eta, k, f0))


def _note_curve(eta: Rgb, k: Rgb, f0: Rgb, notes: Notes, where: str) -> None:
    worst = worst_of_curve(eta, k, f0)
    if worst > limits.TOLERANCE:
        notes.approximated(f"a conductor's Fresnel reflectance by Schlick's curve, which is off by {limits.bound(worst)} at "
                           "most, near grazing angles", where)
