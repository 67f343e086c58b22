"""Colours that are the same all over: properties such as <rgb>, and spectra that are plugins of their own."""

from __future__ import annotations

from enum import Enum
from typing import Sequence

import numpy as np

from importer.materials.colours import (White, rgb_of_blackbody, rgb_of_constant_emission, rgb_of_reflectance,
                                        rgb_of_spectrum)
from importer.mitsuba.plugin import Plugin, Property
from importer.mitsuba.values import Blackbody, Spectrum, numbers
from importer.problems import ImportProblem
from importer.scene import Rgb

# Spectra that Mitsuba 3 has as plugins: <spectrum type="...">, or <texture> of the same types.
SPECTRA = ("uniform", "srgb", "rgb", "rawconstant", "blackbody", "d65", "irregular", "regular")
_MAX_SAMPLES = 100_000


class Use(Enum):
    """What a colour is for decides under which light its spectrum is seen."""

    REFLECTANCE = 0
    EMISSION = 1
    INDEX = 2  # of refraction or absorption


def rgb_of_property(found: Property, use: Use, is_old: bool) -> Rgb:
    """A number is the same at all wavelengths. Mitsuba 3 sees that as a light of equal energy, 0.6 as white."""
    value = found.value
    if isinstance(value, (Spectrum, Blackbody)):
        return _rgb_of_samples(value, use, is_old, found.where)
    if isinstance(value, tuple):
        return _checked(value, use, found.where)
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        is_coloured = found.tag == "spectrum" and use is Use.EMISSION and not is_old
        colour = rgb_of_constant_emission(float(value)) if is_coloured else (float(value),) * 3
        return _checked(colour, use, found.where)
    raise ImportProblem(f"{found.where}: is a <{found.tag}>; a colour such as <rgb> is right")


def rgb_of_plugin(plugin: Plugin, use: Use) -> Rgb:
    """Of one of SPECTRA."""
    if plugin.type == "blackbody":
        value = Blackbody(plugin.number("temperature", 5000.0), plugin.number("scale", 1.0))
        plugin.ignore("wavelength_min", "wavelength_max")
        return _rgb_of_samples(value, use, plugin.is_old, plugin.where)
    if plugin.type in ("irregular", "regular"):
        return _rgb_of_samples(_samples(plugin), use, plugin.is_old, plugin.where)
    if plugin.type == "d65":
        return _d65(plugin, use)
    found = plugin.get("value" if plugin.type in ("uniform", "rawconstant") else "color")
    plugin.ignore("unbounded", "wavelength_min", "wavelength_max")
    if not found:
        return 1.0, 1.0, 1.0
    # The plugin is grey in Mitsuba's rgb variants, whose parser has the other colour for <spectrum value="..."> alone.
    return rgb_of_property(Property("float", found.value, found.where), use, plugin.is_old)


def _d65(plugin: Plugin, use: Use) -> Rgb:
    """White times a colour, as lights of Mitsuba 3 have it where nothing else is said."""
    scale = plugin.number("scale", 1.0)
    if plugin.has("color"):
        colour = rgb_of_property(plugin.get("color"), Use.REFLECTANCE, plugin.is_old)  # type: ignore[arg-type]
        return _checked(tuple(scale * c for c in colour), use, plugin.where)
    return _checked((scale, scale, scale), use, plugin.where)


def _samples(plugin: Plugin) -> Spectrum:
    texts = {"values": plugin.string("values")}
    if plugin.type == "irregular":
        texts["wavelengths"] = plugin.string("wavelengths")
    lists = {name: numbers(text, plugin.where) for name, text in texts.items()}
    count = len(lists["values"])
    if not 2 <= count <= _MAX_SAMPLES:
        raise ImportProblem(f"{plugin.where}: has {count} values; 2 to {_MAX_SAMPLES} are right")
    if plugin.type == "regular":
        low, high = plugin.number("wavelength_min", 360.0), plugin.number("wavelength_max", 830.0)
        return Spectrum(tuple(np.linspace(low, high, count)), tuple(lists["values"]))
    return Spectrum(tuple(lists["wavelengths"]), tuple(lists["values"]))


def _rgb_of_samples(value: Spectrum | Blackbody, use: Use, is_old: bool, where: str) -> Rgb:
    if isinstance(value, Blackbody):
        colour = rgb_of_blackbody(value.kelvin, False, where)
        return _checked(tuple(value.scale * c for c in colour), use, where)
    if use is Use.EMISSION:
        return _checked(rgb_of_spectrum(value.wavelengths, value.values, White.EQUAL_ENERGY, where=where), use, where)
    white = White.EQUAL_ENERGY if is_old else White.D65
    of = rgb_of_reflectance if use is Use.REFLECTANCE else rgb_of_spectrum
    return _checked(of(value.wavelengths, value.values, white, where=where), use, where)


def _checked(colour: Sequence[float], use: Use, where: str) -> Rgb:
    if min(colour) < 0:
        what = {Use.REFLECTANCE: "a reflectance", Use.EMISSION: "a light", Use.INDEX: "an index"}[use]
        raise ImportProblem(f"{where}: is negative, which {what} cannot be")
    red, green, blue = (float(c) for c in colour)
    return red, green, blue
