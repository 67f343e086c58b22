"""Coats over other materials: KHR_materials_clearcoat, a layer of index 1.5 that takes its share by the viewer's angle and
lets the rest through once."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from importer.materials import fresnel, limits, metals, parameters
from importer.materials.conductors import check_indices, worst_of_curve
from importer.materials.roughness import mitsuba_roughness
from importer.problems import ImportProblem, Notes
from importer.scene import Colour, Material, Number, Rgb

_COAT_F0 = 0.04  # of KHR_materials_clearcoat


def _factor(eta: float, specular: float, notes: Notes, where: str) -> float:
    """The coat's strength at which it reflects straight on what a coat of this index does."""
    limits.checked_number(float(eta), "the index of a coat", where, least=1.0, most=limits.MOST_INDEX)
    factor = fresnel.f0_of_index(eta) / _COAT_F0 * specular
    if abs(eta - 1.5) > 1e-6:
        notes.approximated("a coat of another index than 1.5 as one of 1.5 with a factor that straight on makes it reflect "
                           "as much" + (", as far as a factor of 1 goes" if factor > 1.0 else ""), where)
    return min(factor, 1.0)


def _with_coat(material: Material, factor: float, alpha: Number, notes: Notes, where: str) -> Material:
    if isinstance(alpha, parameters.Texture):
        notes.approximated("a coat's roughness that varies as its mean", where)
    alpha = parameters.mean_number(limits.alpha(alpha, notes, where))
    if not parameters.is_constant(material.clearcoat, 0.0):
        notes.approximated("a coat over a coat as the outer one alone", where)
    if alpha >= 1e-4:
        notes.approximated("a rough coat: what it passes goes on as through a smooth one", where)
    return replace(material, clearcoat=factor, clearcoat_roughness=float(mitsuba_roughness(alpha)))  # type: ignore[arg-type]


def _absorbed(sigma_a: Rgb, thickness: float, eta: float) -> tuple[np.ndarray, np.ndarray]:
    """What a coat leaves of light on its way down and up: from a glossy surface straight on, and from a diffuse one the
    mean over the directions that light of the whole hemisphere has inside."""
    tau = np.maximum(np.array(sigma_a, dtype=float), 0.0) * thickness
    inside = np.sqrt(1.0 - (1.0 - fresnel.COSINES ** 2) / eta ** 2)
    return np.exp(-2.0 * tau), (fresnel.COSINE_WEIGHTS @ np.exp(-tau / inside[:, None])) ** 2


def _times(colour: Colour, factor: np.ndarray) -> Colour:
    red, green, blue = (float(f) for f in factor)
    return parameters.scaled(colour, (red, green, blue))


def coated(material: Material, ior: float, alpha: Number, specular: Colour, thickness: float, sigma_a: Rgb, notes: Notes,
           where: str) -> Material:
    """Mitsuba's coating and roughcoating of another material; `ior`: inside over outside.

    Of a diffuse lobe Mitsuba's coat passes T(v) T(l) / eta^2 (SmoothCoating::eval), 0.37 in all at an index of 1.5, since
    it leaves out what is reflected inside; glTF's passes 1 - F. The base colour takes the rest, so that as much diffuse
    light leaves in all. Of a glossy lobe it passes T twice, and glTF's once."""
    specular = limits.reflectance(specular, "the specular reflectance of a coat", notes, where)
    if not parameters.is_grey(specular) or isinstance(specular, parameters.Texture):
        notes.approximated("a coat's factor that has a colour or varies as its mean", where)
    notes.approximated("a coat over another surface as glTF's, which takes its share by the viewer's angle alone", where)
    factor = _factor(ior, float(np.mean(parameters.mean_rgb(specular))), notes, where)
    thickness = float(limits.checked_number(thickness, "the thickness of a coat", where))
    if max(sigma_a) * thickness > 0.0:
        notes.approximated("a coat that absorbs: by the same factor at all angles", where)
    of_gloss, of_diffuse = _absorbed(sigma_a, thickness, ior)
    of_gloss = of_gloss * (1.0 - fresnel.f0_of_index(ior)) ** 2 / (1.0 - factor * _COAT_F0)
    of_diffuse = of_diffuse * ((1.0 - fresnel.average(ior)) / ior) ** 2 / (1.0 - factor * fresnel.schlick_average(_COAT_F0))
    is_diffuse = material.metallic == 0.0 and parameters.is_constant(material.transmission, 0.0)
    base = limits.reflectance(_times(material.base_colour, of_diffuse if is_diffuse else of_gloss), "a colour below a coat",
                              notes, where)
    dimmed = replace(material, base_colour=base, specular_colour=_times(material.specular_colour, of_gloss))
    return _with_coat(dimmed, factor, alpha, notes, where)


def coated_conductor(name: str, coat_eta: float, coat_alpha: Number, thickness: float, albedo: Colour, eta: Rgb, k: Rgb,
                     alpha: Number, notes: Notes, where: str) -> Material:
    """pbrt-v4's coatedconductor: a metal seen within the coat, with all reflections between the two and a medium of
    extinction 1 (LayeredBxDF). The base colour is that at which as much light comes back straight on:
    (1 - R) a^2 Rc / (1 - R Rc a^2), with a = exp(-thickness)."""
    if not 1.0 < coat_eta < limits.MOST_INDEX:  # false of NaN
        raise ImportProblem(f"{where}: the index of a coat is {coat_eta:g}; above 1 would be right")
    if parameters.greatest(albedo) > 0.0:
        notes.approximated("a coat that scatters as one that only absorbs", where)
    check_indices(eta, k, where)
    below = tuple(n / coat_eta for n in eta), tuple(a / coat_eta for a in k)
    metal = np.array(metals.f0(*below))  # type: ignore[arg-type]
    worst = worst_of_curve(*below, tuple(metal))  # type: ignore[arg-type]
    if worst > limits.TOLERANCE:
        notes.approximated("a coated conductor's Fresnel reflectance by Schlick's curve, which within the coat is off by "
                           f"{limits.bound(worst)} at most", where)
    r, a2 = fresnel.f0_of_index(coat_eta), math.exp(-2.0 * float(limits.checked_number(thickness, "thickness", where)))
    factor = _factor(coat_eta, 1.0, notes, where)
    red, green, blue = (1.0 - r) ** 2 * a2 * metal / (1.0 - r * metal * a2) / (1.0 - factor * _COAT_F0)
    base = Material(name, base_colour=(min(red, 1.0), min(green, 1.0), min(blue, 1.0)), metallic=1.0,
                    roughness=mitsuba_roughness(limits.alpha(alpha, notes, where)))
    return _with_coat(base, factor, coat_alpha, notes, where)

