"""Matt surfaces, mirrors, and what is laid over any material: masks and emission."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from importer.materials import limits, parameters
from importer.materials.roughness import mitsuba_roughness
from importer.problems import ImportProblem, Notes
from importer.scene import BLACK, WHITE, Colour, Material, Number, Texture


def diffuse(name: str, reflectance: Colour, notes: Notes, where: str) -> Material:
    """Lambert's law, exactly: glTF without a dielectric lobe."""
    return Material(name, base_colour=limits.reflectance(reflectance, "the reflectance", notes, where))


def rough_diffuse(name: str, reflectance: Colour, roughness: Number, notes: Notes, where: str) -> Material:
    """Oren and Nayar's surface, whose roughness is Mitsuba's alpha or pbrt-v3's sigma: as Lambert's."""
    limits.checked_number(roughness, "the roughness of a diffuse surface", where)
    if not parameters.is_constant(roughness, 0.0):
        notes.approximated("Oren and Nayar's rough diffuse surface as Lambert's", where)
    return diffuse(name, reflectance, notes, where)


def diffuse_transmitter(name: str, reflectance: Colour, transmittance: Colour, notes: Notes, where: str) -> Material:
    """glTF's thin walls pass a lobe and no diffuse light, so only what is reflected remains."""
    if parameters.greatest(transmittance) > 0.0:
        notes.refuse("diffuse light through a surface", where)
    return diffuse(name, reflectance, notes, where)


def mirror(name: str, reflectance: Colour, notes: Notes, where: str, alpha: Number = 0.0) -> Material:
    """The same reflectance at all angles. White is a metal of F0 1. Otherwise KHR_materials_specular over an index of 0
    has F0 = colour times strength and F90 = strength, which is the same where the reflectance is grey."""
    reflectance = limits.reflectance(reflectance, "the reflectance of a mirror", notes, where)
    roughness = mitsuba_roughness(limits.alpha(alpha, notes, where))
    if parameters.is_constant(reflectance, 1.0):
        return Material(name, base_colour=WHITE, metallic=1.0, roughness=roughness)
    strength, colour = strength_and_colour(reflectance, notes, where)
    return Material(name, base_colour=BLACK, roughness=roughness, specular=strength, specular_colour=colour, ior=0.0)


def strength_and_colour(factor: Colour, notes: Notes, where: str) -> tuple[Number, Colour]:
    """A factor of a lobe as KHR_materials_specular has it: strength, which is the reflectance at grazing angles, times a
    colour, which holds for light that comes straight on."""
    if parameters.is_grey(factor):
        return (factor if isinstance(factor, Texture) else factor[0]), WHITE
    notes.approximated("a coloured factor of a glossy lobe: at grazing angles all channels have that of the greatest", where)
    if not isinstance(factor, Texture):
        return max(factor), parameters.scaled(factor, 1.0 / max(factor))  # type: ignore[return-value]
    strength = parameters.map_colour(factor, lambda rgb: np.repeat(rgb.max(axis=2, keepdims=True), 3, axis=2), "greatest")
    colour = parameters.map_colour(factor, lambda rgb: rgb / np.maximum(rgb.max(axis=2, keepdims=True), 1e-6), "hue")
    assert isinstance(strength, Texture)
    return strength, colour


def null(name: str) -> Material:
    """An interface that nothing sees."""
    return Material(name, base_colour=WHITE, opacity=0.0)


def masked(material: Material, opacity: Number, notes: Notes, where: str) -> Material:
    """Opaque with that chance; of a coloured opacity the mean of its channels."""
    if isinstance(opacity, Texture) and not parameters.is_grey(opacity):
        notes.approximated("a coloured opacity as the mean of its channels", where)
    opacity = limits.opacity(opacity, notes, where)
    if not isinstance(material.opacity, Texture):
        return replace(material, opacity=parameters.scaled_number(opacity, material.opacity) if material.opacity else 0.0)
    return replace(material, opacity=parameters.combine_numbers(material.opacity, opacity, lambda a, b: a * b))


def lamp(material: Material, radiance: Colour, both_sides: bool, notes: Notes, where: str) -> Material:
    """The material with emission besides."""
    low, high = parameters.span(radiance)
    if not (np.isfinite((low, high)).all() and low >= 0.0):
        raise ImportProblem(f"{where}: a radiance has a channel that is negative or no number; 0 or more would be right")
    if not parameters.is_constant(material.clearcoat, 0.0):
        notes.approximated("the emission below a coat, which dims it here", where)
    if parameters.is_constant(material.opacity, 0.0):
        notes.approximated("a lamp on a surface that is not seen as an opaque black one", where)
        material = Material(material.name, base_colour=BLACK)
    elif not parameters.is_constant(material.opacity, 1.0):
        notes.approximated("the emission of a masked surface, of which here as much is emitted as the mask leaves", where)
    return replace(material, radiance=radiance, emits_both_sides=both_sides)
