"""What glTF allows of parameters, and how errors are said so that materials of one kind share a note."""

from __future__ import annotations

import numpy as np

from importer.materials import parameters
from importer.problems import ImportProblem, Notes
from importer.scene import Colour, Number

TOLERANCE = 0.02  # of reflectance: below it a curve counts as the same
_BOUNDS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)


MOST_INDEX = 1e3  # of refraction: more is a slip of the pen


def bound(error: float) -> str:
    """The least of a few round numbers that the error does not pass."""
    return f"{next((b for b in _BOUNDS if error <= b), error):g}"


def checked_number(value: Number, what: str, where: str, least: float = 0.0, most: float = np.inf) -> Number:
    """Refuses numbers without meaning; of textures the texels are looked at."""
    low, high = parameters.span(value)
    if not (np.isfinite((low, high)).all() and least <= low and high <= most):
        bad = low if not np.isfinite(low) or low < least else high
        right = f"from {least:g} to {most:g}" if np.isfinite(most) else f"of {least:g} or more"
        raise ImportProblem(f"{where}: {what} is {bad:g}; a number {right} would be right")
    return value


def alpha(value: Number, notes: Notes, where: str) -> Number:
    """Of microfacets: glTF's is 1 at most."""
    checked_number(value, "alpha", where)
    if parameters.span(value)[1] <= 1.0 + 1e-9:
        return value
    notes.approximated("microfacets with an alpha above 1 as with 1", where)
    return parameters.map_number(value, lambda a: np.minimum(a, 1.0), "at most 1")


def reflectance(colour: Colour, what: str, notes: Notes, where: str) -> Colour:
    """A colour of [0, 1]: both renderers clamp what is above, and say that what is below 0 has no meaning."""
    low, high = parameters.span(colour)
    if not (np.isfinite((low, high)).all() and low >= 0.0):
        raise ImportProblem(f"{where}: {what} has a channel that is negative or no number; 0 to 1 would be right")
    if high <= 1.0 + 1e-9:
        return colour
    notes.approximated("reflectances above 1 as 1", where)
    return parameters.map_colour(colour, lambda rgb: np.minimum(rgb, 1.0), "at most 1")


def opacity(number: Number, notes: Notes, where: str) -> Number:
    """Of [0, 1]."""
    checked_number(number, "an opacity", where)
    if parameters.greatest(parameters.colour_of_number(number)) <= 1.0 + 1e-9:
        return number
    notes.approximated("opacities above 1 as 1", where)
    return parameters.map_number(number, lambda x: np.minimum(x, 1.0), "at most 1")
