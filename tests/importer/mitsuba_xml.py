"""Pieces of Mitsuba's XML, in the names of version 3."""

from __future__ import annotations

import re
from typing import Sequence

import numpy as np

from mitsuba_rays import Step, steps_xml


def as_old(text: str) -> str:
    """With the names of 0.6: toWorld for to_world."""
    return re.sub(r'name="[a-z_]+"', lambda found: re.sub(r"_([a-z])", lambda part: part[1].upper(), found[0]), text)


def scene(version: str, body: str) -> str:
    """Version 0.6 and before with their own names."""
    text = f'<scene version="{version}">{body}</scene>'
    return as_old(text) if version < "2" else text


def rgb(name: str, values: object) -> str:
    return f'<rgb name="{name}" value="{", ".join(str(float(v)) for v in np.ravel(values))}"/>'


def number(name: str, value: float) -> str:
    return f'<float name="{name}" value="{value}"/>'


def whole(name: str, value: int) -> str:
    return f'<integer name="{name}" value="{value}"/>'


def word(name: str, value: str) -> str:
    return f'<string name="{name}" value="{value}"/>'


def yes(name: str) -> str:
    return f'<boolean name="{name}" value="true"/>'


def film(width: int, height: int, inside: str = "") -> str:
    return f'<film type="hdrfilm">{whole("width", width)}{whole("height", height)}{inside}<rfilter type="box"/></film>'


def sensor(kind: str, steps: Sequence[Step], width: int, height: int, inside: str = "", crop: str = "") -> str:
    return f'<sensor type="{kind}">{inside}{steps_xml(steps)}{film(width, height, crop)}</sensor>'


def path(depth: int, kind: str = "path") -> str:
    return f'<integrator type="{kind}">{whole("max_depth", depth)}</integrator>'


def matt(inside: str) -> str:
    return twosided("diffuse", inside)


def twosided(kind: str, inside: str) -> str:
    return f'<bsdf type="twosided"><bsdf type="{kind}">{inside}</bsdf></bsdf>'
