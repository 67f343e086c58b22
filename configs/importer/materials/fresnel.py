"""Fresnel's reflectances, Schlick's curve in their place, and averages over the hemisphere."""

from __future__ import annotations

import functools

import numpy as np

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
COSINES = 0.5 * (_NODES + 1.0)  # of Gauss-Legendre quadrature on (0, 1)
COSINE_WEIGHTS = _WEIGHTS * COSINES  # 2 cos d(cos): they add up to 1


def dielectric(cosine: np.ndarray, eta: float) -> np.ndarray:
    """Of unpolarised light at a surface, `eta` being the index behind it over that before it (Born and Wolf, section
    1.5.2); 1 beyond the critical angle."""
    cosine = np.clip(np.abs(cosine), 0.0, 1.0)
    squared = 1.0 - (1.0 - cosine ** 2) / eta ** 2
    behind = np.sqrt(np.maximum(squared, 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        parallel = (eta * cosine - behind) / (eta * cosine + behind)
        perpendicular = (cosine - eta * behind) / (cosine + eta * behind)
    return np.where(squared > 0.0, 0.5 * (parallel ** 2 + perpendicular ** 2), 1.0)


def conductor(cosine: np.ndarray, eta: float, k: float) -> np.ndarray:
    """The same at an index of eta + ik, by complex arithmetic."""
    cosine = np.clip(np.abs(cosine), 1e-9, 1.0)
    index = complex(eta, k)
    behind = np.sqrt(1.0 - (1.0 - cosine ** 2) / index ** 2)
    parallel = (index * cosine - behind) / (index * cosine + behind)
    perpendicular = (cosine - index * behind) / (cosine + index * behind)
    return 0.5 * (np.abs(parallel) ** 2 + np.abs(perpendicular) ** 2)


def f0_of_index(eta: float) -> float:
    return ((eta - 1.0) / (eta + 1.0)) ** 2


def index_of_f0(f0: float) -> float:
    """The index above 1 of that reflectance at normal incidence."""
    root = min(max(f0, 0.0), 0.9999) ** 0.5
    return round((1.0 + root) / (1.0 - root), 9)  # so that 1.5 comes back as 1.5


def schlick(cosine: np.ndarray, f0: float, f90: float = 1.0) -> np.ndarray:
    """glTF 2.0, appendix B."""
    return f0 + (f90 - f0) * (1.0 - np.clip(cosine, 0.0, 1.0)) ** 5


def nodes_within(eta: float) -> tuple[np.ndarray, np.ndarray]:
    """Cosines and weights, adding up to 1, on the dense side of a surface with an index of `eta` < 1 behind it: apart for
    total reflection and for what is refracted, there by the cosine outside, in which the reflectance has no kink."""
    critical = np.sqrt(1.0 - eta ** 2)
    refracted = np.sqrt(1.0 - eta ** 2 * (1.0 - COSINES ** 2))
    return (np.concatenate([critical * COSINES, refracted]),
            np.concatenate([critical ** 2 * COSINE_WEIGHTS, eta ** 2 * COSINE_WEIGHTS]))


@functools.lru_cache(maxsize=1024)
def average(eta: float) -> float:
    """Of white light from the whole hemisphere: twice the integral of F cos over cos."""
    if eta < 1.0:  # What is not reflected as a whole is compressed by eta^2 (Stam 2001, equation 4).
        return 1.0 - eta ** 2 * (1.0 - average(1.0 / eta))
    return float(COSINE_WEIGHTS @ dielectric(COSINES, eta))


def schlick_average(f0: float, f90: float = 1.0) -> float:
    """The same of Schlick's curve in closed form: twice the integral of (1 - c)^5 c is 1/21."""
    return f0 + (f90 - f0) / 21.0


def worst_of_schlick(exact: np.ndarray, cosines: np.ndarray, f0: float, f90: float = 1.0) -> float:
    """How far Schlick's curve is from the exact reflectances at most."""
    return float(np.abs(exact - schlick(cosines, f0, f90)).max())
