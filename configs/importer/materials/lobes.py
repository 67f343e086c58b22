"""How much light the lobes of microfacets and of what lies below them reflect, by quadrature: of a direction of view all
that it sees in a white sky (directional), and the mean of that over the hemisphere with the cosine (in all)."""

from __future__ import annotations

import functools
from typing import Callable

import numpy as np

from importer.materials import fresnel

Curve = Callable[[np.ndarray], np.ndarray]

_GAUSS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(16)
COSINES = 0.5 * (_GAUSS + 1.0)
WEIGHTS = _GAUSS_WEIGHTS * COSINES
# Points of the unit disc, by Gauss-Legendre quadrature over its height sqrt(1 - r^2): near its rim, where the far normals
# of narrow lobes are, they are dense.
_STEPS = 32
_HEIGHTS, _HEIGHT_WEIGHTS = ((a + b) / 2 for a, b in zip(np.polynomial.legendre.leggauss(_STEPS), (1.0, 0.0)))
_RADII = np.repeat(np.sqrt(1.0 - _HEIGHTS ** 2), _STEPS)[None]
_TURNS = np.tile(2.0 * np.pi * (np.arange(_STEPS) + 0.5) / _STEPS, _STEPS)[None]
_SHARES = np.repeat(2.0 * _HEIGHTS * _HEIGHT_WEIGHTS / _STEPS, _STEPS)  # they add up to 1
SMOOTH = 1e-4  # an alpha below which a surface counts as smooth
# Where errors are looked for: up to 60 degrees from the normal and up to 85.
STEEP_VIEWS = np.cos(np.radians(np.array((0.0, 15.0, 30.0, 45.0, 60.0))))
FLAT_VIEWS = np.cos(np.radians(np.array((70.0, 75.0, 80.0, 85.0))))


def mean(values: np.ndarray) -> float:
    """Of values at COSINES."""
    return float(WEIGHTS @ values)


def _visible_normals(cosines: np.ndarray, alpha: float) -> tuple[np.ndarray, np.ndarray]:
    """v.h and the cosine of h for views in rows, v being in the plane of x and z: the visible normals of GGX (Heitz 2018)
    of the grid below."""
    sines = np.sqrt(np.maximum(1.0 - cosines ** 2, 0.0))[:, None]
    stretched = np.concatenate([alpha * sines, cosines[:, None]], axis=1)
    vx, vz = np.split(stretched / np.linalg.norm(stretched, axis=1, keepdims=True), 2, axis=1)
    p1 = _RADII * np.cos(_TURNS)
    up = 0.5 * (1.0 + vz)
    p2 = (1.0 - up) * np.sqrt(1.0 - p1 ** 2) + up * _RADII * np.sin(_TURNS)
    p3 = np.sqrt(np.maximum(1.0 - p1 ** 2 - p2 ** 2, 0.0))
    hx, hy, hz = alpha * (-vz * p2 + vx * p3), alpha * p1, np.maximum(vx * p2 + vz * p3, 1e-9)
    length = np.sqrt(hx ** 2 + hy ** 2 + hz ** 2)
    return (sines * hx + cosines[:, None] * hz) / length, hz / length


def _lambda(cosines: np.ndarray, alpha: float) -> np.ndarray:
    """Smith's auxiliary function of GGX."""
    tangent2 = 1.0 / np.maximum(np.abs(cosines), 1e-6) ** 2 - 1.0
    return 0.5 * (np.sqrt(1.0 + alpha ** 2 * tangent2) - 1.0)


def _unmasked(light: np.ndarray, views: np.ndarray, alpha: float, is_separable: bool) -> np.ndarray:
    """G2 over the view's G1, which the visible normals have in them already: G2 height-correlated, as glTF and pbrt have
    it, or the product of both G1, as Mitsuba has it."""
    to_light, to_view = _lambda(light, alpha), _lambda(views, alpha)
    return 1.0 / (1.0 + to_light) if is_separable else (1.0 + to_view) / (1.0 + to_view + to_light)


def gloss(cosines: np.ndarray, alpha: float, reflectance: Curve, is_separable: bool = False) -> np.ndarray:
    """Directional reflectance of GGX's microfacets (glTF 2.0, appendix B), once scattered: the mean of F(v.h) G2/G1 over
    visible normals."""
    cosines = np.asarray(cosines, dtype=float)
    if alpha < SMOOTH:
        return reflectance(cosines)
    v_h, h_z = _visible_normals(cosines, alpha)
    light = 2.0 * v_h * h_z - cosines[:, None]
    unmasked = _unmasked(light, cosines[:, None], alpha, is_separable)
    return np.where(light > 0.0, reflectance(np.clip(v_h, 0.0, 1.0)) * unmasked, 0.0) @ _SHARES


def passed(cosines: np.ndarray, alpha: float, eta: float, is_separable: bool = False) -> np.ndarray:
    """Directional transmittance of the same surface, refracted at each microfacet (Walter et al. 2007), to an index eta."""
    cosines = np.asarray(cosines, dtype=float)
    if alpha < SMOOTH:
        return 1.0 - fresnel.dielectric(cosines, eta)
    v_h, h_z = _visible_normals(cosines, alpha)
    refracted = np.sqrt(np.maximum(1.0 - (1.0 - v_h ** 2) / eta ** 2, 0.0))
    light = (v_h / eta - refracted) * h_z - cosines[:, None] / eta  # below the surface: negative
    unmasked = _unmasked(light, cosines[:, None], alpha, is_separable)
    return np.where(light < 0.0, (1.0 - fresnel.dielectric(v_h, eta)) * unmasked, 0.0) @ _SHARES


def below(cosines: np.ndarray, f0: float, f90: float) -> np.ndarray:
    """Directional share of light that glTF's dielectric lobe leaves to a white diffuse one: the integral of
    (1 - F(v.h)) cos / pi over directions of light."""
    cosines = np.asarray(cosines, dtype=float)
    angle = 2.0 * np.pi * (np.arange(48) + 0.5) / 48
    light, weights = fresnel.COSINES[:, None], fresnel.COSINE_WEIGHTS[:, None] / 48
    sine_v, sine_l = (np.sqrt(1.0 - c ** 2) for c in (cosines, light))
    v_l = cosines[:, None, None] * light + sine_v[:, None, None] * sine_l * np.cos(angle)
    half = np.sqrt(np.maximum(0.5 * (1.0 + v_l), 0.0))
    return (weights * (1.0 - fresnel.schlick(half, f0, f90))).sum(axis=(1, 2))


@functools.lru_cache(maxsize=1024)
def below_in_all(f0: float, f90: float) -> float:
    return mean(below(COSINES, f0, f90))


def dielectric_gloss(cosines: np.ndarray, alpha: float, eta: float, is_separable: bool = False) -> np.ndarray:
    return gloss(cosines, alpha, lambda c: fresnel.dielectric(c, eta), is_separable)


def _nodes(eta: float) -> tuple[np.ndarray, np.ndarray]:
    return fresnel.nodes_within(eta) if eta < 1.0 else (COSINES, WEIGHTS)


@functools.lru_cache(maxsize=1024)
def dielectric_in_all(alpha: float, eta: float, is_separable: bool = False) -> float:
    """Reflected by the surface."""
    if alpha < SMOOTH:
        return fresnel.average(eta)
    cosines, weights = _nodes(eta)
    return float(weights @ dielectric_gloss(cosines, alpha, eta, is_separable))


@functools.lru_cache(maxsize=1024)
def passed_in_all(alpha: float, eta: float, is_separable: bool = False) -> float:
    if alpha < SMOOTH:
        return 1.0 - fresnel.average(eta)
    cosines, weights = _nodes(eta)
    return float(weights @ passed(cosines, alpha, eta, is_separable))
