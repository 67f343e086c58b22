"""Materials of pbrt side by side as tiles of one plane, so that they do not light each other, seen under an angle."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable, Mapping

import numpy as np

from pbrt_rendering import attributes, film, numbers, quad, scene
from rendering import Picture, RadianceTest, Source, mean_of

_PIXELS = 3  # along a side of what is seen of a tile
FAR = 60.0  # half a tile's length


@dataclass(frozen=True)
class Tile:
    """A material's statements, what is expected of it by the angle of view in degrees, and by how much a picture may differ
    besides its noise: what the import approximates, per angle."""

    material: str
    expected: Callable[[float], object]
    allowed: Mapping[float, float]


def cosine_of(degrees: float) -> float:
    return math.cos(math.radians(degrees))


def tiles_source(tiles: Mapping[str, Tile], angle: float, world: str, bounces: int, version: int = 4, more: str = "",
                 shape: str = "") -> Source:
    """In a row along x, seen from the side of -y under an angle to the normal, +z."""
    count = len(tiles)
    shape = shape or quad([(0, -FAR, 0), (1, -FAR, 0), (1, FAR, 0), (0, FAR, 0)], more)
    row = "".join(attributes(f"Translate {index} 0 0", tile.material, shape) for index, tile in enumerate(tiles.values()))
    sine, cosine = math.sin(math.radians(angle)), cosine_of(angle)
    eye, target = (count / 2, -20 * sine, 20 * cosine), (count / 2, 0, 0)
    before = (f"Scale -1 1 1\nLookAt {numbers(eye)}  {numbers(target)}  0 {numbers([cosine, sine])}\n"
              f'Camera "orthographic" "float screenwindow" [{-count / 2} {count / 2} -.5 .5]\n'
              + film(count * _PIXELS, _PIXELS, version))
    return Source(scene(before, world + row, bounces, version))


class TilesTest(RadianceTest):
    EXTENSION = ".pbrt"

    def check(self, picture: Picture, tiles: Mapping[str, Tile], angle: float) -> None:
        for index, (name, tile) in enumerate(tiles.items()):
            with self.subTest(name, angle=angle):
                where = np.zeros(picture.radiance.shape[:2], bool)
                where[:, index * _PIXELS + _PIXELS // 2] = True  # away from the neighbours
                mean, error = mean_of(picture, where)
                self.assert_near(mean, tile.expected(angle), 5 * error + tile.allowed[angle], f"{name} at {angle} degrees")
