"""From the roughness that a source names to that of glTF, which is the square root of the microfacets' alpha (glTF 2.0,
appendix B)."""

from __future__ import annotations

import math

import numpy as np

from importer.materials import parameters
from importer.problems import ImportProblem, Notes
from importer.scene import Number


def mitsuba_roughness(alpha: Number) -> Number:
    """glTF's roughness of an alpha; where alpha is a texture, texel by texel."""
    return parameters.map_number(alpha, lambda a: np.sqrt(np.clip(a, 0.0, 1.0)), "root")


def _alpha_of_v4(roughness: np.ndarray) -> np.ndarray:
    """pbrt-v4, TrowbridgeReitzDistribution::RoughnessToAlpha."""
    return np.sqrt(np.maximum(roughness, 0.0))


def _alpha_of_v3(roughness: np.ndarray) -> np.ndarray:
    """pbrt-v3, TrowbridgeReitzDistribution::RoughnessToAlpha: a polynomial in the logarithm, from 0.001 upwards."""
    x = np.log(np.maximum(roughness, 1e-3))
    return 1.62142 + 0.819955 * x + 0.1734 * x ** 2 + 0.0171201 * x ** 3 + 0.000640711 * x ** 4


def pbrt_alpha(roughness: Number, remap: bool, version: int) -> Number:
    """pbrt's alpha. Of a roughness of 0 v3's polynomial makes 0.047, in all materials but glass that is smooth both ways
    (GlassMaterial)."""
    if version not in (3, 4):
        raise ValueError(f"pbrt has versions 3 and 4, not {version}")
    if not remap:
        return roughness
    if version == 4:
        return parameters.map_number(roughness, _alpha_of_v4, "v4")
    return parameters.map_number(roughness, _alpha_of_v3, "v3")


def isotropic_alpha(alpha_u: Number, alpha_v: Number, notes: Notes, where: str) -> Number:
    """One alpha for two: the geometric mean, which keeps the density 1/(pi alpha_u alpha_v) of microfacets that face
    the normal."""
    if alpha_u is alpha_v or (isinstance(alpha_u, float) and isinstance(alpha_v, float) and alpha_u == alpha_v):
        return alpha_u
    notes.approximated("an anisotropic lobe as an isotropic one, alpha by the geometric mean", where)
    return parameters.combine_numbers(alpha_u, alpha_v, lambda u, v: np.sqrt(np.maximum(u, 0.0) * np.maximum(v, 0.0)))


def phong_alpha(exponent: float) -> float:
    """Alpha of the Beckmann lobe that is as wide as Phong's: Walter et al. 2007, section 5.2: n = 2/alpha^2 - 2."""
    return math.sqrt(2.0 / (exponent + 2.0))


def note_distribution(name: str, notes: Notes, where: str) -> None:
    """Says what became of a distribution that is not GGX; refuses names that no source has.

    Beckmann's alpha is taken as it is: then both distributions have the same density 1/(pi alpha^2) of microfacets that
    face the normal, so that the middle of a highlight is as bright as in the source, and GGX's has the wider skirt.
    Mitsuba's masking and shadowing is the product of both directions' (MicrofacetDistribution::G), glTF's height-correlated.
    Phong's distribution, of the older Mitsuba, has the same alpha there (MicrofacetDistribution::computePhongExponent)."""
    if name == "beckmann":
        notes.approximated("Beckmann's microfacets as GGX's of the same alpha, which have a wider skirt", where)
    elif name in ("phong", "as"):
        notes.approximated("Phong's microfacets as GGX's of the same alpha, which have a wider skirt", where)
    elif name == "ggx":
        notes.approximated("masking and shadowing of microfacets as height-correlated, which is brighter at grazing angles",
                           where)
    else:
        raise ImportProblem(f"{where}: the distribution \"{name}\" is none of beckmann, ggx, phong and as")
