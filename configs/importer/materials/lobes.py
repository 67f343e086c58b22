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
_STEPS = 32
# Where errors are looked for: from straight on to 85 degrees.
VIEWS = np.cos(np.radians(np.array((0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 75.0, 80.0, 85.0))))


def mean(values: np.ndarray) -> float:
    """Of values at COSINES."""
    return float(WEIGHTS @ values)


def gloss(cosines: np.ndarray, alpha: float, reflectance: Curve) -> np.ndarray:
    """Directional reflectance of GGX's microfacets with height-correlated masking and shadowing (glTF 2.0, appendix B),
    by the distribution of visible normals (Heitz 2018) on a regular grid: the mean of F(v.h) G2/G1."""
    cosines = np.asarray(cosines, dtype=float)
    if alpha < 1e-4:
        return reflectance(cosines)
    u1, u2 = (g.ravel() for g in np.meshgrid(*2 * [(np.arange(_STEPS) + 0.5) / _STEPS]))
    sines = np.sqrt(np.maximum(1.0 - cosines ** 2, 0.0))
    stretched = np.stack([alpha * sines, np.zeros_like(sines), cosines], axis=1)
    stretched /= np.linalg.norm(stretched, axis=1, keepdims=True)
    vx, vz = stretched[:, :1], stretched[:, 2:]
    # A disc seen from the view: t1 across it, t2 towards the normal; v lies in the plane of x and z.
    radius, angle = np.sqrt(u1)[None], 2.0 * np.pi * u2[None]
    p1 = radius * np.cos(angle)
    up = 0.5 * (1.0 + vz)
    p2 = (1.0 - up) * np.sqrt(1.0 - p1 ** 2) + up * radius * np.sin(angle)
    p3 = np.sqrt(np.maximum(1.0 - p1 ** 2 - p2 ** 2, 0.0))
    hx, hy, hz = alpha * (-vz * p2 + vx * p3), alpha * p1, np.maximum(vx * p2 + vz * p3, 1e-9)
    length = np.sqrt(hx ** 2 + hy ** 2 + hz ** 2)
    v_h = (sines[:, None] * hx + cosines[:, None] * hz) / length
    light = 2.0 * v_h * hz / length - cosines[:, None]
    passed = _masking(light, alpha, cosines[:, None])
    return np.where(light > 0.0, reflectance(np.clip(v_h, 0.0, 1.0)) * passed, 0.0).mean(axis=1)


def _masking(light: np.ndarray, alpha: float, view: np.ndarray) -> np.ndarray:
    """G2 over G1 of the view: (1 + lambda_v) / (1 + lambda_v + lambda_l)."""
    def lamb(cosine: np.ndarray) -> np.ndarray:
        tangent2 = 1.0 / np.maximum(cosine, 1e-6) ** 2 - 1.0
        return 0.5 * (np.sqrt(1.0 + alpha ** 2 * tangent2) - 1.0)
    return (1.0 + lamb(view)) / (1.0 + lamb(view) + lamb(light))


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


def dielectric_gloss(cosines: np.ndarray, alpha: float, eta: float) -> np.ndarray:
    return gloss(cosines, alpha, lambda c: fresnel.dielectric(c, eta))


@functools.lru_cache(maxsize=1024)
def dielectric_in_all(alpha: float, eta: float) -> float:
    """The exact average of smooth surfaces, quadrature of rough ones."""
    if alpha < 1e-4:
        return fresnel.average(eta)
    return mean(dielectric_gloss(COSINES, alpha, eta))
