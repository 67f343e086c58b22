"""Diffuse surfaces below a dielectric one. glTF's dielectric has its lobe and below it a diffuse one that is dimmed by
1 - F at the half vector. Its base colour is chosen so that the diffuse lobe sends as much light in all as the source's, a
white sky above it; what Schlick's curve lacks of Fresnel's, 0.006 of all light at an index of 1.5, stays so."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Callable

import numpy as np

from importer.materials import fresnel, limits, lobes, parameters
from importer.materials.roughness import mitsuba_roughness
from importer.materials.simple import strength_and_colour
from importer.problems import ImportProblem, Notes
from importer.scene import BLACK, WHITE, Colour, Material, Number

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
    limits.checked_number(float(eta), "the index of a dielectric surface over that of what is above it", where,
                          most=limits.MOST_INDEX)
    if eta < 1.0:
        raise ImportProblem(f"{where}: the index of a dielectric surface is {eta:g} of that above it; 1 or more would be "
                            "right")
    return float(eta)


def _mean_alpha(alpha: Number, eta: float, notes: Notes, where: str) -> float:
    """Of the surface on top, which is none where the index does not change (DielectricBxDF takes it as smooth)."""
    mean = round(parameters.mean_number(limits.alpha(alpha, notes, where)), 4)
    return mean if eta > 1.0 else 0.0


def dielectric_over(name: str, reflectance: Colour, f0: float, specular: Colour, alpha: Number, source: Source,
                    notes: Notes, where: str) -> Material:
    """The glTF dielectric for a source; `specular` is a factor of its lobe. Without a step of the index there is none."""
    specular = BLACK if f0 == 0.0 else specular
    strength, colour = (1.0, WHITE) if parameters.is_constant(specular, 1.0) else strength_and_colour(specular, notes, where)
    s = parameters.mean_number(strength)
    share = lobes.below_in_all(f0 * s, s)

    def base_of(rho: np.ndarray) -> np.ndarray:
        return source.diffuse_in_all(rho) / share

    key = (source.key, f0, s)
    # A limit in base_of itself would make textures of a mere factor new images.
    top = float(base_of(np.array(parameters.greatest(reflectance))))
    if top > 1.0 + 1e-9:
        lost = limits.bound((top - 1.0) * share)
        notes.approximated(f"a diffuse lobe that no base colour up to 1 gives, by less than {lost} of reflectance", where)
        base = parameters.map_colour(reflectance, lambda rho: np.minimum(base_of(rho), 1.0), (*key, "at most 1"))
    elif source.is_proportional:
        base = parameters.scaled(reflectance, float(base_of(np.array(1.0))))
    else:
        base = parameters.map_colour(reflectance, base_of, key)
    _note_angles(reflectance, base, f0, s, parameters.mean_number(alpha), source, notes, where)
    return Material(name, base_colour=base, roughness=mitsuba_roughness(alpha), specular=strength, specular_colour=colour,
                    ior=fresnel.index_of_f0(f0))


def _note_angles(reflectance: Colour, base: Colour, f0: float, strength: float, alpha: float, source: Source, notes: Notes,
                 where: str) -> None:
    """Compares both in a white sky at single angles, for the brightest channel of the mean reflectance."""
    rho, colour = max(parameters.mean_rgb(reflectance)), max(parameters.mean_rgb(base))

    def worst(views: np.ndarray) -> float:
        theirs = strength * source.gloss_at(views) + source.diffuse_at(views, rho)
        ours = (lobes.gloss(views, alpha, lambda c: fresnel.schlick(c, f0 * strength, strength))
                + colour * lobes.below(views, f0 * strength, strength))
        return float(np.abs(theirs - ours).max())

    steep, flat = worst(lobes.STEEP_VIEWS), worst(lobes.FLAT_VIEWS)
    if max(steep, flat) > limits.TOLERANCE:
        notes.approximated("a dielectric over a diffuse surface as glTF's, which sends as much diffuse light in all; seen "
                           f"up to 60 degrees from the normal it is off by {limits.bound(steep)} of reflectance at most, up "
                           f"to 85 by {limits.bound(flat)}", where)


def plastic(name: str, diffuse: Colour, ior: float, alpha: Number, specular: Colour, is_nonlinear: bool, notes: Notes,
            where: str, version: int = 3) -> Material:
    """Mitsuba's plastic and roughplastic; `ior`: inside over outside. Their diffuse lobe is
    T(v) T(l) rho / (pi eta^2 (1 - F)), with rho F for F where they are nonlinear. F is what the surface reflects inside: in
    version 3 once scattered at its microfacets (eval_reflectance), before it all that does not pass (evalDiffuse of the
    rough transmittance)."""
    eta = _checked_index(ior, where)
    diffuse = limits.reflectance(diffuse, "the diffuse reflectance", notes, where)
    specular = limits.reflectance(specular, "the specular reflectance", notes, where)
    mean_alpha = _mean_alpha(alpha, eta, notes, where)
    in_all = lobes.passed_in_all(mean_alpha, eta, True)
    inside = lobes.dielectric_in_all(mean_alpha, 1.0 / eta, True) if version >= 3 else 1.0 - in_all / eta ** 2

    def below(rho: np.ndarray) -> np.ndarray:
        return rho / (eta ** 2 * (1.0 - (rho * inside if is_nonlinear else inside)))

    source = Source(lambda rho: in_all ** 2 * below(rho),
                    lambda cosines, rho: lobes.passed(cosines, mean_alpha, eta, True) * in_all * below(np.array(rho)),
                    lambda cosines: lobes.dielectric_gloss(cosines, mean_alpha, eta, True),
                    ("plastic", eta, mean_alpha, is_nonlinear, version), is_proportional=not is_nonlinear)
    return dielectric_over(name, diffuse, fresnel.f0_of_index(eta), specular, alpha, source, notes, where)


def coated_diffuse(name: str, reflectance: Colour, eta: float, alpha: Number, thickness: float, albedo: Colour,
                   max_depth: int, notes: Notes, where: str) -> Material:
    """pbrt-v4's coateddiffuse: Lambert's surface below a dielectric one, between them a medium of extinction 1
    (LayeredBxDF). Walks end after `max_depth` interfaces, so that the lowest surface is met (max_depth + 1) / 2 times."""
    eta = _checked_index(eta, where)
    reflectance = limits.reflectance(reflectance, "the reflectance", notes, where)
    thickness = float(limits.checked_number(thickness, "the thickness of a coat", where))
    mean_alpha = _mean_alpha(alpha, eta, notes, where)
    if parameters.greatest(albedo) > 0.0:
        notes.approximated("a coat that scatters as one that only absorbs", where)
    out, back = _coat_from_below(eta, mean_alpha, thickness)
    meetings = max(1, (int(max_depth) + 1) // 2)

    def through(cosines: np.ndarray) -> np.ndarray:
        below = np.sqrt(1.0 - (1.0 - cosines ** 2) / eta ** 2)
        return lobes.passed(cosines, mean_alpha, eta) * np.exp(-thickness / below)

    into = lobes.mean(through(lobes.COSINES))

    def below(rho: np.ndarray) -> np.ndarray:
        return out * rho * sum((rho * back) ** n for n in range(meetings))

    source = Source(lambda rho: into * below(rho), lambda cosines, rho: through(cosines) * below(np.array(rho)),
                    lambda cosines: lobes.dielectric_gloss(cosines, mean_alpha, eta),
                    ("coated diffuse", eta, mean_alpha, thickness, meetings))
    return dielectric_over(name, reflectance, fresnel.f0_of_index(eta), WHITE, alpha, source, notes, where)


@functools.lru_cache(maxsize=1024)
def _coat_from_below(eta: float, alpha: float, thickness: float) -> tuple[float, float]:
    """Of light that leaves Lambert's surface: what comes out of the coat, and what comes back down to the surface."""
    cosines, weights = fresnel.nodes_within(1.0 / eta)
    once = np.exp(-thickness / cosines)
    return (float(weights @ (once * lobes.passed(cosines, alpha, 1.0 / eta))),
            float(weights @ (once ** 2 * lobes.dielectric_gloss(cosines, alpha, 1.0 / eta))))


def lambert_and_gloss(name: str, diffuse: Colour, specular: Colour, ior: float, alpha: Number, notes: Notes,
                      where: str) -> Material:
    """A Lambert lobe and a dielectric one, each without regard to the other, as pbrt-v3's plastic and uber have them."""
    eta = _checked_index(ior, where)
    diffuse = limits.reflectance(diffuse, "Kd", notes, where)
    specular = limits.reflectance(specular, "Ks", notes, where)
    mean_alpha = _mean_alpha(alpha, eta, notes, where)
    if parameters.is_constant(specular, 0.0):
        return Material(name, base_colour=diffuse)
    source = Source(lambda rho: np.asarray(rho, dtype=float), lambda cosines, rho: np.full_like(cosines, rho),
                    lambda cosines: lobes.dielectric_gloss(cosines, mean_alpha, eta), "Lambert", is_proportional=True)
    return dielectric_over(name, diffuse, fresnel.f0_of_index(eta), specular, alpha, source, notes, where)
