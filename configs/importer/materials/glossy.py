"""Reflection models of older scenes: Phong's, and pbrt-v3's substrate and uber."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from importer.materials import fresnel, limits, lobes, parameters
from importer.materials.plastics import Source, dielectric_over, lambert_and_gloss
from importer.materials.roughness import mitsuba_roughness, phong_alpha
from importer.materials.simple import masked, strength_and_colour
from importer.problems import Notes
from importer.scene import WHITE, Colour, Material, Number, Texture


def phong(name: str, diffuse: Colour, specular: Colour, exponent: float, notes: Notes, where: str) -> Material:
    """Mitsuba's phong: Lambert's lobe and Phong's about the mirrored direction, as one of F0 and F90 `specular`, which is
    right straight on. Phong's reflectance then falls with the cosine of the view (Phong::eval has no cosine in its
    denominator), for which glTF has no means. A lobe cos^n about the mirrored direction is as wide as one of cos^4n about
    the half vector (Ashikhmin and Shirley 2000), and that as GGX's by Walter et al. 2007."""
    limits.checked_number(float(exponent), "Phong's exponent", where)
    notes.approximated("Phong's lobe as GGX's about as wide, which does not grow darker towards grazing angles", where)
    diffuse = limits.reflectance(diffuse, "the diffuse reflectance", notes, where)
    specular = limits.reflectance(specular, "the specular reflectance", notes, where)
    if parameters.is_constant(specular, 0.0):
        return Material(name, base_colour=diffuse)
    strength, colour = strength_and_colour(specular, notes, where)
    s = parameters.mean_number(strength)
    # glTF dims the diffuse lobe by 1 - F, which is the same at all angles where F0 is F90.
    base = parameters.map_colour(diffuse, lambda rho: np.minimum(rho / max(1.0 - s, 1e-6), 1.0))
    return Material(name, base_colour=base, roughness=mitsuba_roughness(min(phong_alpha(4.0 * exponent), 1.0)),
                    specular=strength, specular_colour=colour, ior=0.0)


def substrate(name: str, diffuse: Colour, specular: Colour, alpha: Number, notes: Notes, where: str) -> Material:
    """pbrt-v3's substrate (FresnelBlend; Ashikhmin and Shirley 2000): F0 is `specular` and F90 is 1, below it a diffuse
    lobe that sends Rd (1 - Rs) (1 - (1 - cos/2)^5) of a white sky."""
    diffuse = limits.reflectance(diffuse, "Kd", notes, where)
    specular = limits.reflectance(specular, "Ks", notes, where)
    f0 = min(float(np.mean(parameters.mean_rgb(specular))), 0.9999)
    if isinstance(diffuse, Texture) or isinstance(specular, Texture):
        notes.approximated("a substrate with textures: its diffuse lobe by the mean of its Ks", where)
    mean_alpha = round(parameters.mean_number(limits.alpha(alpha, notes, where)), 4)

    def at(cosines: np.ndarray) -> np.ndarray:
        return (1.0 - f0) * (1.0 - (1.0 - 0.5 * cosines) ** 5)

    # The integral of `at` with the cosine is 23/28 (1 - Rs); its own normalisation makes it so.
    source = Source(lambda rho: rho * (1.0 - f0) * 23.0 / 28.0, lambda cosines, rho: rho * at(cosines),
                    lambda cosines: lobes.gloss(cosines, mean_alpha, lambda c: fresnel.schlick(c, f0)),
                    ("substrate", f0), is_proportional=True)
    made = dielectric_over(name, diffuse, f0, WHITE, alpha, source, notes, where)
    return replace(made, ior=0.0, specular=1.0, specular_colour=specular)


def uber(name: str, diffuse: Colour, glossy: Colour, mirrored: Colour, passed: Colour, ior: float, alpha: Number,
         opacity: Colour, notes: Notes, where: str) -> Material:
    """pbrt-v3's uber: Kd, Ks, Kr, Kt and opacity. A mirror beside a rough lobe becomes one lobe; what passes is bent there
    and goes straight on here, since the mesh need not be closed."""
    diffuse, glossy, mirrored, passed = (limits.reflectance(colour, what, notes, where) for colour, what in (
        (diffuse, "Kd"), (glossy, "Ks"), (mirrored, "Kr"), (passed, "Kt")))
    has_gloss, has_mirror = (parameters.greatest(c) > 0.0 for c in (glossy, mirrored))
    if has_gloss and has_mirror:
        notes.approximated("a rough lobe and a mirror in one material as the rough lobe with both reflectances", where)
        glossy = parameters.combine_colours(glossy, mirrored, lambda a, b: np.minimum(a + b, 1.0))
    elif has_mirror:
        glossy, alpha = mirrored, 0.0
    made = lambert_and_gloss(name, diffuse, glossy, ior, alpha, notes, where)
    if parameters.greatest(passed) > 0.0:
        made = _passing(made, diffuse, passed, notes, where)
    if parameters.is_constant(opacity, 1.0):
        return made
    opaque = opacity if isinstance(opacity, Texture) else float(np.mean(opacity))
    if not isinstance(opacity, Texture) and not parameters.is_grey(opacity):
        notes.approximated("a coloured opacity as the mean of its channels", where)
    return masked(made, opaque, notes, where)


def _passing(material: Material, diffuse: Colour, passed: Colour, notes: Notes, where: str) -> Material:
    """Kd and Kt share one base colour: the sum, of which transmission is the share of Kt."""
    notes.approximated("uber's Kt as a thin wall that bends nothing and shares its colour with Kd", where)
    kd, kt = (float(np.mean(parameters.mean_rgb(c))) for c in (diffuse, passed))
    both = parameters.combine_colours(diffuse, passed, lambda a, b: np.minimum(a + b, 1.0))
    return replace(material, base_colour=both, transmission=kt / (kd + kt), is_thin=True)
