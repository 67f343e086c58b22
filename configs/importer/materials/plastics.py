"""Diffuse surfaces below a dielectric one. glTF's dielectric has its lobe and below it a diffuse one that is dimmed by
1 - F at the half vector. Its base colour is chosen so that the diffuse lobe sends as much light in all as the source's, a
white sky above it; what Schlick's curve lacks of Fresnel's, 0.006 of all light at an index of 1.5, stays so."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable

import numpy as np

from importer.materials import fresnel, limits, lobes, parameters
from importer.materials.roughness import mitsuba_roughness
from importer.materials.simple import strength_and_colour
from importer.problems import ImportProblem, Notes
from importer.scene import WHITE, Colour, Material, Number

Map = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Source:
    """What the source's model does with white light, numbers for one channel."""

    diffuse_in_all: Map  # of the reflectance below the surface
    diffuse_at: Callable[[np.ndarray, float], np.ndarray]  # directional: of cosines and that reflectance
    gloss_at: Map  # directional, without the factor
    key: object  # tells one source from another
    is_proportional: bool = False  # whether diffuse_in_all is a factor


def _checked_index(eta: float, where: str) -> float:
    limits.checked_number(float(eta), "the index of a dielectric surface over that of what is above it", where)
    if eta <= 1.0:
        raise ImportProblem(f"{where}: the index of a dielectric surface is {eta:g} of that above it; above 1 would be right")
    return float(eta)


def dielectric_over(name: str, reflectance: Colour, f0: float, specular: Colour, alpha: Number, source: Source,
                    notes: Notes, where: str) -> Material:
    """The glTF dielectric for a source; `specular` is a factor of its lobe."""
    strength, colour = (1.0, WHITE) if parameters.is_constant(specular, 1.0) else strength_and_colour(specular, notes, where)
    s = parameters.mean_number(strength)
    share = lobes.below_in_all(f0 * s, s)

    def base_of(rho: np.ndarray) -> np.ndarray:
        return source.diffuse_in_all(rho) / share

    # A limit in base_of itself would make textures of a mere factor new images.
    top = float(base_of(np.array(parameters.greatest(reflectance))))
    if top > 1.0 + 1e-9:
        lost = f"{limits.bound((top - 1.0) * share)}"
        notes.approximated(f"a diffuse lobe that no base colour up to 1 gives, by less than {lost} of reflectance", where)
        base = parameters.map_colour(reflectance, lambda rho: np.minimum(base_of(rho), 1.0), (source.key, s, "at most 1"))
    elif source.is_proportional:
        base = parameters.scaled(reflectance, float(base_of(np.array(1.0))))
    else:
        base = parameters.map_colour(reflectance, base_of, (source.key, s))
    _note_angles(reflectance, base, f0, s, parameters.mean_number(alpha), source, notes, where)
    return Material(name, base_colour=base, roughness=mitsuba_roughness(alpha), specular=strength, specular_colour=colour,
                    ior=fresnel.index_of_f0(f0))


def _note_angles(reflectance: Colour, base: Colour, f0: float, strength: float, alpha: float, source: Source, notes: Notes,
                 where: str) -> None:
    """Compares both in a white sky at single angles, for the brightest channel of the mean reflectance."""
    rho, colour = max(parameters.mean_rgb(reflectance)), max(parameters.mean_rgb(base))
    views = lobes.VIEWS
    theirs = strength * source.gloss_at(views) + source.diffuse_at(views, rho)
    ours = (lobes.gloss(views, alpha, lambda c: fresnel.schlick(c, f0 * strength, strength))
            + colour * lobes.below(views, f0 * strength, strength))
    worst = float(np.abs(theirs - ours).max())
    if worst > limits.TOLERANCE:
        angle = "80 degrees and more" if np.abs(theirs - ours)[:-2].max() <= limits.TOLERANCE else "single angles"
        notes.approximated("a dielectric over a diffuse surface as glTF's, which sends as much light in all; at "
                           f"{angle} it is off by {limits.bound(worst)} of reflectance at most", where)


def _interface(eta: float, alpha: float) -> tuple[Map, Map, float, float]:
    """Of the dielectric surface: directional gloss and what passes, what passes in all, and what is reflected inside."""
    def gloss_at(cosines: np.ndarray) -> np.ndarray:
        return lobes.dielectric_gloss(cosines, alpha, eta)

    def passes(cosines: np.ndarray) -> np.ndarray:
        return 1.0 - gloss_at(cosines)

    return gloss_at, passes, 1.0 - lobes.dielectric_in_all(alpha, eta), lobes.dielectric_in_all(alpha, 1.0 / eta)


def plastic(name: str, diffuse: Colour, ior: float, alpha: Number, specular: Colour, is_nonlinear: bool, notes: Notes,
            where: str) -> Material:
    """Mitsuba's plastic and roughplastic; `ior`: inside over outside. Their diffuse lobe is
    T(v) T(l) rho / (pi eta^2 (1 - F_i)), with rho F_i for F_i where they are nonlinear."""
    eta = _checked_index(ior, where)
    diffuse = limits.reflectance(diffuse, "the diffuse reflectance", notes, where)
    specular = limits.reflectance(specular, "the specular reflectance", notes, where)
    mean_alpha = round(parameters.mean_number(limits.checked_number(alpha, "alpha", where)), 4)
    gloss_at, passes, passes_in_all, inside = _interface(eta, mean_alpha)

    def below(rho: np.ndarray) -> np.ndarray:
        return rho / (eta ** 2 * (1.0 - (rho * inside if is_nonlinear else inside)))

    source = Source(lambda rho: passes_in_all ** 2 * below(rho),
                    lambda cosines, rho: passes(cosines) * passes_in_all * below(np.array(rho)), gloss_at,
                    ("plastic", eta, mean_alpha, is_nonlinear), is_proportional=not is_nonlinear)
    return dielectric_over(name, diffuse, fresnel.f0_of_index(eta), specular, alpha, source, notes, where)


def coated_diffuse(name: str, reflectance: Colour, eta: float, alpha: Number, thickness: float, albedo: Colour,
                   max_depth: int, notes: Notes, where: str) -> Material:
    """pbrt-v4's coateddiffuse: Lambert's surface below a dielectric one, between them a medium of extinction 1
    (LayeredBxDF). Walks end after `max_depth` interfaces, so that the lowest surface is met (max_depth + 1) / 2 times."""
    eta = _checked_index(eta, where)
    reflectance = limits.reflectance(reflectance, "the reflectance", notes, where)
    thickness = float(limits.checked_number(thickness, "the thickness of a coat", where))
    mean_alpha = round(parameters.mean_number(limits.checked_number(alpha, "alpha", where)), 4)
    if parameters.greatest(albedo) > 0.0:
        notes.approximated("a coat that scatters as one that only absorbs", where)
    gloss_at, passes, _, _ = _interface(eta, mean_alpha)
    out, back = _coat_from_below(eta, mean_alpha, thickness)
    meetings = max(1, (int(max_depth) + 1) // 2)

    def through(cosines: np.ndarray) -> np.ndarray:
        below = np.sqrt(1.0 - (1.0 - cosines ** 2) / eta ** 2)
        return passes(cosines) * np.exp(-thickness / below)

    into = lobes.mean(through(lobes.COSINES))

    def below(rho: np.ndarray) -> np.ndarray:
        return out * rho * sum((rho * back) ** n for n in range(meetings))

    source = Source(lambda rho: into * below(rho), lambda cosines, rho: through(cosines) * below(np.array(rho)), gloss_at,
                    ("coated diffuse", eta, mean_alpha, thickness, meetings))
    return dielectric_over(name, reflectance, fresnel.f0_of_index(eta), WHITE, alpha, source, notes, where)


def _coat_from_below(eta: float, alpha: float, thickness: float) -> tuple[float, float]:
    """Of light that leaves Lambert's surface: what comes out of the coat, and what comes back down to the surface."""
    cosines, weights = fresnel.COSINES, fresnel.COSINE_WEIGHTS
    reflected = lobes.gloss(cosines, alpha, lambda c: fresnel.dielectric(c, 1.0 / eta))
    if alpha >= 1e-4:
        # What a rough surface loses to its second microfacet goes on to the outside, as 1 - reflectance has it outside.
        reflected = np.minimum(reflected, 1.0)
    once = np.exp(-thickness / cosines)
    return float(weights @ (once * (1.0 - reflected))), float(weights @ (once ** 2 * reflected))


def lambert_and_gloss(name: str, diffuse: Colour, specular: Colour, ior: float, alpha: Number, notes: Notes,
                      where: str) -> Material:
    """A Lambert lobe and a dielectric one, each without regard to the other, as pbrt-v3's plastic and uber have them."""
    eta = _checked_index(ior, where)
    diffuse = limits.reflectance(diffuse, "Kd", notes, where)
    specular = limits.reflectance(specular, "Ks", notes, where)
    mean_alpha = round(parameters.mean_number(limits.checked_number(alpha, "alpha", where)), 4)
    if parameters.is_constant(specular, 0.0):
        return Material(name, base_colour=diffuse)
    source = Source(lambda rho: np.asarray(rho, dtype=float), lambda cosines, rho: np.full_like(cosines, rho),
                    lambda cosines: lobes.dielectric_gloss(cosines, mean_alpha, eta), "Lambert", is_proportional=True)
    return dielectric_over(name, diffuse, fresnel.f0_of_index(eta), specular, alpha, source, notes, where)
