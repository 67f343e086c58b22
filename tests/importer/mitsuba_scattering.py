"""What Mitsuba's surfaces send to a viewer from a white sky, by the formulas of its sources. `c`: the cosine of the view."""

from __future__ import annotations

from typing import Callable

import numpy as np

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)
COSINES, SHARES = 0.5 * (_NODES + 1), 0.5 * (_NODES + 1) * _WEIGHTS  # 2 c dc, which sums to 1
_STEPS = 160
_LEVELS, _TURNS = ((np.arange(_STEPS) + 0.5) / _STEPS for _ in range(2))
Curve = Callable[[np.ndarray], np.ndarray]


def fresnel(c: np.ndarray, eta: float) -> np.ndarray:
    """Of a dielectric; `eta`: inside over outside (fresnel of mitsuba/render/fresnel.h)."""
    c = np.asarray(c, float)
    squared = 1 - (1 - c * c) / eta**2
    inner = np.sqrt(np.maximum(squared, 0))
    with np.errstate(invalid="ignore"):
        a, b = (c - eta * inner) / (c + eta * inner), (inner - eta * c) / (inner + eta * c)
    return np.where(squared > 0, (a * a + b * b) / 2, 1.0)


def fresnel_conductor(c: np.ndarray, eta: float, k: float) -> np.ndarray:
    """By the form without complex numbers that Mitsuba has (fresnel_conductor)."""
    c2, s2 = np.asarray(c, float) ** 2, 1 - np.asarray(c, float) ** 2
    c = np.sqrt(c2)
    t0 = eta**2 - k**2 - s2
    ab = np.sqrt(t0**2 + 4 * eta**2 * k**2)
    a = np.sqrt(np.maximum((ab + t0) / 2, 0))
    s = (ab + c2 - 2 * a * c) / (ab + c2 + 2 * a * c)
    p = s * (c2 * ab + s2**2 - 2 * a * c * s2) / (c2 * ab + s2**2 + 2 * a * c * s2)
    return (s + p) / 2


def _smith_ggx(c: np.ndarray, alpha: float) -> np.ndarray:
    return 2 / (1 + np.sqrt(1 + alpha**2 * (1 / np.maximum(c * c, 1e-12) - 1)))


def _smith_beckmann(c: np.ndarray, alpha: float) -> np.ndarray:
    """Walter et al. 2007, the fit below equation 27."""
    a = 1 / (alpha * np.sqrt(np.maximum(1 / np.maximum(c * c, 1e-12) - 1, 1e-12)))
    return np.where(a < 1.6, (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a), 1.0)


def _microfacets(c: float, alpha: float, is_beckmann: bool) -> tuple[np.ndarray, np.ndarray]:
    """Cosines between view and half vectors, and of those with the normal; each half vector as likely as D times its cosine
    (Walter et al. 2007, equations 28 and 35)."""
    u, turn = (grid.ravel() for grid in np.meshgrid(_LEVELS, 2 * np.pi * _TURNS))
    tangent2 = alpha**2 * (-np.log1p(-u) if is_beckmann else u / (1 - u))
    h_z = 1 / np.sqrt(1 + tangent2)
    return np.sqrt(1 - c * c) * np.sqrt(1 - h_z**2) * np.cos(turn) + c * h_z, h_z


def rough(c: float, alpha: float, curve: Curve, is_beckmann: bool = False, through: float = 0.0) -> float:
    """Of microfacets, all that is reflected by `curve`, or with `through`, an index, all that passes so: the mean of curve
    times G (v.h) / (c h.n), G the product of both directions' (MicrofacetDistribution::G; Walter et al., equation 41)."""
    smith = _smith_beckmann if is_beckmann else _smith_ggx
    v_h, h_z = _microfacets(c, alpha, is_beckmann)
    if through:
        inner = np.sqrt(np.maximum(1 - (1 - v_h**2) / through**2, 0))
        other = -((v_h / through - inner) * h_z - c / through)
    else:
        other = 2 * v_h * h_z - c
    is_there = (v_h > 0) & (other > 0)
    v_h = np.maximum(v_h, 0)
    return float(np.where(is_there, curve(v_h) * smith(np.array(c), alpha) * smith(np.abs(other), alpha) * v_h / (c * h_z),
                          0).mean())


def average(curve: Curve) -> float:
    return float(SHARES @ np.array([float(curve(c)) for c in COSINES]))


def plastic(c: float, rho: float, eta: float, is_nonlinear: bool = False) -> float:
    """F + T(v) <T> rho / (eta^2 (1 - <F inside>)), with rho <F inside> in its place where it is nonlinear
    (SmoothPlastic)."""
    inside = 1 - (1 - average(lambda x: fresnel(x, eta))) / eta**2  # fresnel_diffuse_reflectance of 1 / eta
    passed = 1 - average(lambda x: fresnel(x, eta))
    return float(fresnel(c, eta) + (1 - fresnel(c, eta)) * passed * rho
                 / (eta**2 * (1 - inside * (rho if is_nonlinear else 1))))


def rough_plastic(c: float, rho: float, eta: float, alpha: float) -> float:
    """The same with the rough surface's transmittances, and inside once scattered (RoughPlastic of 3)."""
    passed = lambda x: rough(x, alpha, lambda v: 1 - fresnel(v, eta), through=eta)  # noqa: E731
    inside = average(lambda x: rough(x, alpha, lambda v: fresnel(v, 1 / eta)))
    return rough(c, alpha, lambda v: fresnel(v, eta)) + passed(c) * average(passed) * rho / (eta**2 * (1 - inside))


def coated(c: float, rho: float, eta: float) -> float:
    """A smooth coat over Lambert's surface: F + T(v) <T> rho / eta^2 (SmoothCoating::eval)."""
    return float(fresnel(c, eta) + (1 - fresnel(c, eta)) * (1 - average(lambda x: fresnel(x, eta))) * rho / eta**2)


def slab(c: float, eta: float, tint: float) -> float:
    """Of a plate between two faces, each of which passes 1 - F of the light times `tint`: what is reflected, what leaves
    behind and what comes back after reflections inside, in a sky of 1 on both sides."""
    f = fresnel(c, eta)
    return float(f + (1 - f) ** 2 * tint**2 / (1 - f))


def thin(c: float, eta: float, tint: float) -> float:
    """R = 2 F / (1 + F) and the rest times the tint (ThinDielectric)."""
    f = fresnel(c, eta)
    reflected = 2 * f / (1 + f)
    return float(reflected + (1 - reflected) * tint)


def phong(c: float, rho: float, specular: float, exponent: float) -> float:
    """Lambert's lobe and (n + 2) / (2 pi) cos^n of the angle to the mirrored direction (Phong::eval): without the cosine of
    the light's direction in the denominator, so that what is reflected falls with it."""
    u, turn = (grid.ravel() for grid in np.meshgrid(_LEVELS, 2 * np.pi * _TURNS))
    a = u ** (1 / (exponent + 1))  # as likely as the lobe itself
    light = np.sqrt(1 - c * c) * np.sqrt(1 - a * a) * np.cos(turn) + c * a
    return rho + specular * (exponent + 2) / (exponent + 1) * float(np.maximum(light, 0).mean())
