"""Reflectances of pbrt's models, written from its book and documents for the tests of radiance (pbr-book, chapter 9)."""

from __future__ import annotations

import math
from typing import Callable

import numpy as np

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(400)
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2  # of the interval from 0 to 1
_GRID = 400
Fresnel = Callable[[np.ndarray], np.ndarray]


def dielectric(cosine: np.ndarray | float, eta: float) -> np.ndarray:
    """FrDielectric: from an index of 1 into one of eta; all of it beyond the critical angle."""
    cosine = np.maximum(np.asarray(cosine, float), 1e-9)
    sine2 = (1 - cosine ** 2) / eta ** 2
    behind = np.sqrt(np.maximum(1 - sine2, 0))
    parallel = (eta * cosine - behind) / (eta * cosine + behind)
    perpendicular = (cosine - eta * behind) / (cosine + eta * behind)
    return np.where(sine2 >= 1, 1.0, (parallel ** 2 + perpendicular ** 2) / 2)


def conductor(cosine: np.ndarray | float, eta: float, k: float) -> np.ndarray:
    """FrComplex."""
    cosine = np.asarray(cosine, float)
    index = eta + 1j * k
    behind = np.sqrt(1 - (1 - cosine ** 2) / index ** 2)
    parallel = (index * cosine - behind) / (index * cosine + behind)
    perpendicular = (cosine - index * behind) / (cosine + index * behind)
    return (abs(parallel) ** 2 + abs(perpendicular) ** 2) / 2


def thin(cosine: np.ndarray | float, eta: float) -> np.ndarray:
    """ThinDielectricBxDF: R + T^2 R / (1 - R^2)."""
    r = dielectric(cosine, eta)
    return r + (1 - r) ** 2 * r / (1 - r ** 2)


def _distribution(cosine: np.ndarray | float, alpha: float) -> np.ndarray:
    """TrowbridgeReitzDistribution::D."""
    cosine2 = np.asarray(cosine, float) ** 2
    return alpha ** 2 / (math.pi * (cosine2 * (alpha ** 2 - 1) + 1) ** 2)


def _masking(light: np.ndarray | float, view: np.ndarray | float, alpha: float) -> np.ndarray:
    """TrowbridgeReitzDistribution::G, of both directions together."""
    def of(cosine: np.ndarray | float) -> np.ndarray:
        cosine = np.asarray(cosine, float)
        return (np.sqrt(1 + alpha ** 2 * (1 - cosine ** 2) / cosine ** 2) - 1) / 2
    return 1 / (1 + of(light) + of(view))


def lobe(light: float, view: float, alpha: float, fresnel: Fresnel) -> float:
    """Times the cosine: what a surface shows of a light of irradiance 1 in one plane with the view and the normal. Angles
    are in degrees, on the two sides of the normal where both are positive."""
    light, view = math.radians(light), math.radians(view)
    half, apart = abs(light - view) / 2, (light + view) / 2
    cosines = math.cos(light), math.cos(view)
    return float(fresnel(np.array(math.cos(apart))) * _distribution(math.cos(half), alpha)
                 * _masking(*cosines, alpha) / (4 * cosines[1]))


def rough(view: float, alpha: float, fresnel: Fresnel) -> float:
    """Of a white sky; `view`: a cosine. Half vectors are drawn by D cos on a grid."""
    at = (np.arange(_GRID) + 0.5) / _GRID
    share, turn = np.meshgrid(at, 2 * math.pi * at, indexing="ij")
    cosine_h = 1 / np.sqrt(1 + alpha ** 2 * share / (1 - share))
    sine_h = np.sqrt(1 - cosine_h ** 2)
    v_h = math.sqrt(1 - view ** 2) * sine_h * np.cos(turn) + view * cosine_h
    light = 2 * v_h * cosine_h - view
    counts = (light > 0) & (v_h > 0)
    v_h, light, cosine_h = (np.where(counts, x, 1.0) for x in (v_h, light, cosine_h))
    values = fresnel(v_h) * _masking(light, view, alpha) * v_h / (view * cosine_h)
    return float(np.where(counts, values, 0).mean())


def coated_diffuse(view: float, reflectance: np.ndarray, eta: float, thickness: float) -> np.ndarray:
    """A smooth LayeredBxDF over Lambert's surface, all reflections summed; its medium's extinction is 1."""
    def through(cosine: np.ndarray) -> np.ndarray:
        return np.exp(-thickness / cosine)
    inside = dielectric(_NODES, 1 / eta)
    back = 2 * _WEIGHTS @ (_NODES * inside * through(_NODES) ** 2)
    out = 2 * _WEIGHTS @ (_NODES * (1 - inside) * through(_NODES))
    surface, below = float(dielectric(view, eta)), math.sqrt(1 - (1 - view ** 2) / eta ** 2)
    rho = np.asarray(reflectance, float)
    return surface + (1 - surface) * math.exp(-thickness / below) * rho * out / (1 - rho * back)


def rough_coated_diffuse(view: float, reflectance: np.ndarray, eta: float, thickness: float, alpha: float) -> np.ndarray:
    """The same below a rough surface, by walks of light from the view; the standard error is below 0.003."""
    generator = np.random.default_rng(5)
    count, rho = 60_000, np.asarray(reflectance, float)
    direction = np.tile((math.sqrt(1 - view ** 2), 0.0, view), (count, 1))
    weight, found, meetings = np.ones(count), np.zeros(3), 0
    direction, passed, weight = _at_surface(direction, weight, eta, alpha, generator)
    found += weight[~passed].sum()
    while passed.any() and meetings < 12:
        meetings += 1
        down, weight = direction[passed], weight[passed]
        weight = weight * np.exp(-thickness / np.abs(down[:, 2]))
        turn, radius = 2 * math.pi * generator.random(len(weight)), np.sqrt(generator.random(len(weight)))
        height = np.maximum(np.sqrt(1 - radius ** 2), 1e-6)
        weight = weight * np.exp(-thickness / height)
        # Seen from below: the surface's frame upside down, in which the walk comes back where it was reflected.
        up = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=1)
        direction, left, weight = _at_surface(up, weight, 1 / eta, alpha, generator)
        found += weight[left].sum() * rho ** meetings
        passed = ~left
    return found / count


def _at_surface(towards: np.ndarray, weight: np.ndarray, eta: float, alpha: float,
                generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A rough dielectric met from +z, `towards` being where the light is followed from: the new directions, whether they
    have passed to -z, and weights (DielectricBxDF::Sample_f). Half vectors are drawn by D cos."""
    share, turn = generator.random(len(weight)), 2 * math.pi * generator.random(len(weight))
    cosine_h = 1 / np.sqrt(1 + alpha ** 2 * share / (1 - share))
    sine_h = np.sqrt(1 - cosine_h ** 2)
    half = np.stack([sine_h * np.cos(turn), sine_h * np.sin(turn), cosine_h], axis=1)
    o_h = (towards * half).sum(axis=1)
    passed = generator.random(len(weight)) >= dielectric(np.maximum(o_h, 0), eta)
    inside = np.sqrt(np.maximum(1 - (1 - o_h ** 2) / eta ** 2, 0))
    mirrored, bent = 2 * o_h[:, None] * half - towards, (o_h / eta - inside)[:, None] * half - towards / eta
    direction = np.where(passed[:, None], bent, mirrored)
    view, light = towards[:, 2], direction[:, 2]
    is_right = (o_h > 0) & np.where(passed, light < 0, light > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = _masking(light, view, alpha) * o_h / (view * cosine_h)
    return direction, passed, np.where(is_right, weight * factor, 0)


def coated_conductor(view: float, coat: float, thickness: float, eta: np.ndarray, k: np.ndarray) -> np.ndarray:
    """A smooth LayeredBxDF over a smooth metal, whose index counts over the coat's."""
    surface, below = float(dielectric(view, coat)), math.sqrt(1 - (1 - view ** 2) / coat ** 2)
    metal = np.array([float(conductor(below, n / coat, a / coat)) for n, a in zip(eta, k)])
    twice = math.exp(-2 * thickness / below)
    return surface + (1 - surface) ** 2 * metal * twice / (1 - surface * metal * twice)


def alpha_of_version_3(roughness: float) -> float:
    """TrowbridgeReitzDistribution::RoughnessToAlpha."""
    x = math.log(max(roughness, 1e-3))
    return 1.62142 + 0.819955 * x + 0.1734 * x ** 2 + 0.0171201 * x ** 3 + 0.000640711 * x ** 4


def substrate(view: float, kd: np.ndarray, ks: np.ndarray, alpha: float) -> np.ndarray:
    """pbrt-v3's FresnelBlend in a white sky: the diffuse lobe in closed form over the light's directions, the glossy one
    D F / (4 (v.h) max(cos, cos')) on a grid of half vectors."""
    kd, ks = np.asarray(kd, float), np.asarray(ks, float)
    received = 2 * math.pi * _WEIGHTS @ ((1 - (1 - _NODES / 2) ** 5) * _NODES)
    diffuse = 28 / (23 * math.pi) * kd * (1 - ks) * (1 - (1 - view / 2) ** 5) * received
    at = (np.arange(_GRID) + 0.5) / _GRID
    share, turn = np.meshgrid(at, 2 * math.pi * at, indexing="ij")
    cosine_h = 1 / np.sqrt(1 + alpha ** 2 * share / (1 - share))
    v_h = math.sqrt(1 - view ** 2) * np.sqrt(1 - cosine_h ** 2) * np.cos(turn) + view * cosine_h
    light = 2 * v_h * cosine_h - view
    counts = (light > 0) & (v_h > 0)
    # D cos_h / (4 v.h) is the density of the light's direction.
    weight = np.where(counts, light / (np.maximum(light, view) * cosine_h), 0)
    fifth = (1 - np.clip(v_h, 0, 1)) ** 5
    return diffuse + ks * weight.mean() + (1 - ks) * (weight * fifth).mean()
