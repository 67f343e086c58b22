"""Scenes of pbrt for the tests of radiance: text, and the camera that pbrt's book says it has, by hand."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence

import numpy as np

Vector = Sequence[float]


@dataclass(frozen=True)
class View:
    """Where a camera stands and its axes in the world: x to the picture's right, y up, z ahead. The screen's halves are
    those of the whole picture: at a distance of 1, or as it is of an orthographic camera (pbr-book, 5.2)."""

    eye: Vector
    right: Vector
    up: Vector
    ahead: Vector
    half_width: float
    half_height: float
    width: int
    height: int
    is_orthographic: bool = False

    def point(self, x: float | np.ndarray, y: float | np.ndarray, distance: float) -> np.ndarray:
        """Before the pixel position, which counts from the picture's upper left corner; before each one of arrays."""
        x, y = np.asarray(x, float)[..., None], np.asarray(y, float)[..., None]
        across = (2 * x / self.width - 1) * self.half_width * np.asarray(self.right, float)
        upwards = (1 - 2 * y / self.height) * self.half_height * np.asarray(self.up, float)
        step = 1.0 if self.is_orthographic else distance
        return np.asarray(self.eye, float) + step * (across + upwards) + distance * np.asarray(self.ahead, float)

    def direction(self, x: float | np.ndarray, y: float | np.ndarray) -> np.ndarray:
        return self.point(x, y, 2.0) - self.point(x, y, 1.0)

    def pixel(self, point: Vector) -> np.ndarray:
        """The position at which a point is seen."""
        apart = np.asarray(point, float) - np.asarray(self.eye, float)
        across, upwards, ahead = (float(apart @ np.asarray(axis, float)) for axis in (self.right, self.up, self.ahead))
        if not self.is_orthographic:
            across, upwards = across / ahead, upwards / ahead
        shares = (1 + across / self.half_width) / 2, (1 - upwards / self.half_height) / 2
        return np.array(shares) * (self.width, self.height)


def film(width: int, height: int, version: int = 4, more: str = "") -> str:
    kind = "rgb" if version == 4 else "image"
    size = f'"integer xresolution" {width} "integer yresolution" {height}'
    return f'Film "{kind}" {size} {more}\nPixelFilter "box"\n'


def scene(before: str, world: str, bounces: int = 0, version: int = 4) -> str:
    """`before`: camera and film."""
    end = "WorldEnd\n" if version == 3 else ""
    return f'{before}\nIntegrator "path" "integer maxdepth" {bounces}\nWorldBegin\n{world}\n{end}'


def numbers(values: object) -> str:
    return " ".join(f"{value:.9g}" for value in np.asarray(values, float).ravel())


def quad(corners: object, more: str = "") -> str:
    """Two triangles, by corners in turn."""
    return f'Shape "trianglemesh" "point3 P" [{numbers(corners)}] "integer indices" [0 1 2 0 2 3] {more}\n'


def lamp(shape: str, radiance: object, is_two_sided: bool = True, version: int = 4) -> str:
    sides = "true" if is_two_sided else "false"
    sides = sides if version == 4 else f'"{sides}"'
    return attributes(f'AreaLightSource "diffuse" "rgb L" [{numbers(radiance)}] "bool twosided" {sides}', shape)


def attributes(*statements: str) -> str:
    return "AttributeBegin\n" + "\n".join(statements) + "\nAttributeEnd\n"


def unit(vector: Vector) -> np.ndarray:
    return np.asarray(vector, float) / np.linalg.norm(vector)


def look_at(eye: Vector, target: Vector, up: Vector, half_width: float, half_height: float, width: int, height: int,
            is_orthographic: bool = False) -> View:
    """The book's LookAt (3.9.7): right = up x ahead, which is left-handed; up anew from both."""
    ahead = unit(np.subtract(target, eye))
    right = unit(np.cross(unit(up), ahead))
    return View(eye, right, np.cross(ahead, right), ahead, half_width, half_height, width, height, is_orthographic)


def tangent(degrees: float) -> float:
    return math.tan(math.radians(degrees))
