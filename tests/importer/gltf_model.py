"""glTF's material as its specification has it, integrated over a white sky: written for tests alone, from appendix B of
glTF 2.0 and KHR_materials_specular, _ior and _clearcoat, and by plain sums over the hemisphere."""

from __future__ import annotations

import numpy as np

from importer.scene import Material

_COSINES = (np.arange(160) + 0.5) / 160
_ANGLES = (np.arange(160) + 0.5) / 160 * 2 * np.pi
COSINE, ANGLE = np.meshgrid(_COSINES, _ANGLES, indexing="ij")
SOLID_ANGLE = 2 * np.pi / COSINE.size  # of each of the directions, which are uniform over the hemisphere
LIGHT = np.stack([np.sqrt(1 - COSINE ** 2) * np.cos(ANGLE), np.sqrt(1 - COSINE ** 2) * np.sin(ANGLE), COSINE], axis=-1)


def view_of(cosine: float) -> np.ndarray:
    return np.array((np.sqrt(1 - cosine ** 2), 0.0, cosine))


def ggx(h_n: np.ndarray, alpha: float) -> np.ndarray:
    return alpha ** 2 / (np.pi * (h_n ** 2 * (alpha ** 2 - 1) + 1) ** 2)


def _visibility(n_v: float, n_l: np.ndarray, alpha: float) -> np.ndarray:
    """G / (4 n.l n.v), height-correlated."""
    to_light = n_l * np.sqrt(alpha ** 2 + (1 - alpha ** 2) * n_v ** 2)
    to_view = n_v * np.sqrt(alpha ** 2 + (1 - alpha ** 2) * n_l ** 2)
    return 0.5 / (to_light + to_view)


def _schlick(f0: float, f90: float, cosine: np.ndarray | float) -> np.ndarray | float:
    return f0 + (f90 - f0) * (1 - cosine) ** 5


def dielectric_f0(material: Material, channel: int = 0) -> tuple[float, float]:
    plain = 1.0 if material.ior == 0 else ((material.ior - 1) / (material.ior + 1)) ** 2
    return min(plain * material.specular_colour[channel], 1.0) * material.specular, material.specular


def diffuse_reflectance(material: Material, cosine: float, channel: int = 0) -> float:
    """Of the diffuse lobe alone; grey lobes, so that the greatest F is that of the channel."""
    half = view_of(cosine) + LIGHT
    v_h = (half @ view_of(cosine)) / np.linalg.norm(half, axis=-1)
    f = _schlick(*dielectric_f0(material, channel), v_h)
    lobe = (1 - f) * material.base_colour[channel] / np.pi
    return float((lobe * COSINE).sum() * SOLID_ANGLE) * (1 - material.metallic)


def gloss_reflectance(material: Material, cosine: float, channel: int = 0) -> float:
    """Of the lobes of microfacets, that of the metal with them."""
    dielectric, metal = dielectric_f0(material, channel), (material.base_colour[channel], 1.0)
    if material.roughness < 0.005:
        parts = [float(_schlick(*f, cosine)) for f in (dielectric, metal)]
    else:
        alpha = material.roughness ** 2
        half = view_of(cosine) + LIGHT
        half /= np.linalg.norm(half, axis=-1, keepdims=True)
        lobe = ggx(half[..., 2], alpha) * _visibility(cosine, COSINE, alpha) * COSINE * SOLID_ANGLE
        parts = [float((lobe * _schlick(*f, half @ view_of(cosine))).sum()) for f in (dielectric, metal)]
    return parts[0] * (1 - material.metallic) + parts[1] * material.metallic


def reflectance(material: Material, cosine: float, channel: int = 0) -> float:
    """All that a view of that cosine sees of a white sky; a coat without roughness on top."""
    base = diffuse_reflectance(material, cosine, channel) + gloss_reflectance(material, cosine, channel)
    coat = material.clearcoat * float(_schlick(0.04, 1.0, cosine))
    return coat + (1 - coat) * base


def in_all(function: object, *arguments: object) -> float:
    """Twice the integral over the view's cosine, times it, by Simpson's rule."""
    cosines = np.linspace(0.0, 1.0, 41)
    cosines[0] = 1e-4
    values = np.array([c * function(*arguments, float(c)) for c in cosines])  # type: ignore[operator]
    weights = np.ones(41)
    weights[1:-1:2], weights[2:-1:2] = 4, 2
    return float(2 * (weights * values).sum() / 120)
