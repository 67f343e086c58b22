"""Two materials in one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from importer.materials import parameters
from importer.materials.simple import masked
from importer.problems import ImportProblem, Notes
from importer.scene import BLACK, Colour, Material, Number, Texture

_COLOURS = ("base_colour", "specular_colour", "radiance")
_NUMBERS = ("roughness", "specular", "transmission", "clearcoat", "opacity")
_FLOATS = ("metallic", "clearcoat_roughness")
_CHOICES = ("ior", "is_thin", "attenuation_colour", "attenuation_distance", "normal_map", "emits_both_sides")


def blended(a: Material, b: Material, weight: Number, notes: Notes, where: str) -> Material:
    """`weight`: the share of b. Exact where it is all or nothing, where one of the two is not seen, and where both are
    Lambert's; else a material of mixed parameters."""
    lowest, highest = parameters.span(weight)
    if not np.isfinite((lowest, highest)).all():
        raise ImportProblem(f"{where}: the weight of a blend is no number; 0 to 1 would be right")
    if highest <= 0.0:
        return a
    if lowest >= 1.0:
        return b
    if parameters.is_constant(a.opacity, 0.0):
        return masked(b, weight, notes, where)
    if parameters.is_constant(b.opacity, 0.0):
        return masked(a, parameters.map_number(weight, lambda w: 1.0 - w), notes, where)
    if not (_is_lambert(a) and _is_lambert(b)):
        notes.approximated("a blend of two materials as one with the mean of their parameters", where)
    return _mixed(a, b, weight)


def _is_lambert(material: Material) -> bool:
    return (material.metallic == 0.0 and parameters.is_constant(material.opacity, 1.0)
            and all(parameters.is_constant(n, 0.0) for n in (material.specular, material.transmission, material.clearcoat)))


def _mixed(a: Material, b: Material, weight: Number) -> Material:
    mean = min(max(parameters.mean_number(weight), 0.0), 1.0)
    made: dict[str, Any] = {n: _mix_numbers(getattr(a, n), getattr(b, n), weight) for n in _NUMBERS}
    made |= {n: _mix_colours(getattr(a, n), getattr(b, n), weight) for n in _COLOURS}
    made |= {n: (1.0 - mean) * getattr(a, n) + mean * getattr(b, n) for n in _FLOATS}
    # What is one or the other: of the material that has a dielectric lobe, or else of the heavier one.
    heavier = b if mean > 0.5 else a
    made |= {n: getattr(heavier, n) for n in _CHOICES}
    made["ior"], made["specular_colour"] = _lobe(a, b, mean, heavier.ior, made["specular_colour"])
    if parameters.is_constant(a.roughness, 1.0) and _is_lambert(a):
        made["roughness"] = b.roughness
    elif _is_lambert(b):
        made["roughness"] = a.roughness
    if parameters.is_constant(a.radiance, 0.0) and parameters.is_constant(b.radiance, 0.0):
        made["radiance"] = BLACK
    return replace(heavier, name=f"{a.name} and {b.name}", **made)


def _lobe(a: Material, b: Material, mean: float, ior: float, colour: Colour) -> tuple[float, Colour]:
    """Index and colour of the dielectric lobe: a Lambert surface has none to add; an index of 0, which stands for an F0
    that the colour alone says, does not mix with others."""
    if parameters.is_constant(a.specular, 0.0):
        return b.ior, b.specular_colour
    if parameters.is_constant(b.specular, 0.0):
        return a.ior, a.specular_colour
    if a.ior == b.ior:
        return a.ior, colour
    if a.ior >= 1.0 and b.ior >= 1.0:
        return (1.0 - mean) * a.ior + mean * b.ior, colour
    return ior, (b if mean > 0.5 else a).specular_colour


def _mix_colours(a: Colour, b: Colour, weight: Number) -> Colour:
    if not isinstance(a, Texture) and not isinstance(b, Texture) and np.allclose(a, b):
        return a
    if not isinstance(weight, Texture):
        w = min(max(float(weight), 0.0), 1.0)
        return parameters.combine_colours(a, b, lambda x, y: (1.0 - w) * x + w * y)

    def share(of: Colour, is_second: bool) -> Colour:
        def times(x: np.ndarray, w: np.ndarray) -> np.ndarray:
            w = np.clip(w.mean(axis=-1, keepdims=True), 0.0, 1.0)
            return x * (w if is_second else 1.0 - w)
        return parameters.combine_colours(of, weight, times)

    return parameters.combine_colours(share(a, False), share(b, True), np.add)


def _mix_numbers(a: Number, b: Number, weight: Number) -> Number:
    if not any(isinstance(n, Texture) for n in (a, b, weight)):
        w = min(max(float(weight), 0.0), 1.0)  # type: ignore[arg-type]
        return (1.0 - w) * a + w * b  # type: ignore[operator]
    if not isinstance(a, Texture) and not isinstance(b, Texture) and a == b:
        return a
    mixed = _mix_colours(parameters.colour_of_number(a), parameters.colour_of_number(b), weight)
    return mixed if isinstance(mixed, Texture) else float(np.mean(mixed))
