"""What pbrt's cameras see, pixel by pixel: a card of its own colour fills each pixel's place in the world, worked out from
the axes and the screen window that pbrt gives a camera, and must fill that pixel of the picture."""

from __future__ import annotations

import sys
import unittest
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_rendering import View, film, lamp, look_at, quad, scene, tangent
from rendering import RadianceTest, Source

# An edge between two pixels that lay off by a hundredth of a pixel would mix that much of their colours, 0.1 apart or more.
_TOLERANCE = 1e-3
_FORWARD = ((0, 0, 0), (0, 0, 1), (0, 1, 0))
_BACKWARD = ((1, 2, 3), (1, 2, -7), (0, 1, 0))
_SIDEWAYS = ((4, -3, 2), (1, 1, 1), (0.2, 0.1, 1))


@dataclass(frozen=True)
class Shot:
    """Statements up to the film, and the camera that they make."""

    before: str
    view: View
    version: int = 4
    is_in_camera_space: bool = False  # whether the cards are placed in the camera's own coordinate system


def _look(place: tuple) -> str:
    return "LookAt " + "  ".join(" ".join(map(str, vector)) for vector in place) + "\n"


def _perspective(fov: float, more: str = "") -> str:
    return f'Camera "perspective" "float fov" {fov} {more}\n'


def _shots() -> dict[str, Shot]:
    t30, t45, t20 = tangent(30), 1.0, tangent(20)
    wide, tall = film(8, 6), film(6, 8)
    orthographic = 'Camera "orthographic" '
    return {
        # "fov" is across the shorter side (PerspectiveCamera: the screen window is 1 there).
        "wide": Shot(_look(_FORWARD) + _perspective(60) + wide,
                     View((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), 8 / 6 * t30, t30, 8, 6)),
        "tall": Shot(_look(_BACKWARD) + _perspective(60) + tall,
                     View((1, 2, 3), (-1, 0, 0), (0, 1, 0), (0, 0, -1), t30, 8 / 6 * t30, 6, 8)),
        "sideways": Shot(_look(_SIDEWAYS) + _perspective(40) + wide, look_at(*_SIDEWAYS, 8 / 6 * t20, t20, 8, 6)),
        # Scale comes first, so that what the camera has on its left is on its right.
        "mirrored": Shot("Scale -1 1 1\n" + _look(_BACKWARD) + _perspective(60) + wide,
                         View((1, 2, 3), (1, 0, 0), (0, 1, 0), (0, 0, -1), 8 / 6 * t30, t30, 8, 6)),
        "upside-down": Shot("Scale 1 -1 1\n" + _look(_BACKWARD) + _perspective(60) + wide,
                            View((1, 2, 3), (-1, 0, 0), (0, -1, 0), (0, 0, -1), 8 / 6 * t30, t30, 8, 6)),
        # The point p of the world is R (p + (1, 2, 3)) of the camera, R being x to y to -x.
        "turned-and-moved": Shot("Rotate 90 0 0 1\nTranslate 1 2 3\n" + _perspective(90) + wide,
                                 View((-1, -2, -3), (0, -1, 0), (1, 0, 0), (0, 0, 1), 8 / 6 * t45, t45, 8, 6)),
        # Columns (0, 0, 1), (0, 1, 0), (-1, 0, 0), (1, 2, 3): the camera's axes are the rows, its place -R^T (1, 2, 3).
        "matrix": Shot("Transform [0 0 1 0  0 1 0 0  -1 0 0 0  1 2 3 1]\n" + _perspective(60) + tall,
                       View((-3, -2, 1), (0, 0, -1), (0, 1, 0), (1, 0, 0), t30, 8 / 6 * t30, 6, 8)),
        "two-matrices": Shot("Translate 1 2 3\nConcatTransform [0 0 1 0  0 1 0 0  -1 0 0 0  0 0 0 1]\n" + _perspective(60)
                             + tall, View((-3, -2, 1), (0, 0, -1), (0, 1, 0), (1, 0, 0), t30, 8 / 6 * t30, 6, 8)),
        "scaled-world": Shot("Scale 3 3 3\n" + _look(_SIDEWAYS) + _perspective(40) + wide,
                             look_at(*_SIDEWAYS, 8 / 6 * t20, t20, 8, 6)),
        "screen-window": Shot(_look(_BACKWARD) + _perspective(90, '"float screenwindow" [-1 1 -.5 .5]') + film(8, 4),
                              View((1, 2, 3), (-1, 0, 0), (0, 1, 0), (0, 0, -1), 1, 0.5, 8, 4)),
        # The middle 6 x 4 of 12 x 8.
        "cropped": Shot(_look(_BACKWARD) + _perspective(60)
                        + film(12, 8, 4, '"float cropwindow" [.25 .75 .25 .75]'),
                        View((1, 2, 3), (-1, 0, 0), (0, 1, 0), (0, 0, -1), 0.75 * t30, 0.5 * t30, 6, 4)),
        "pixel-bounds": Shot(_look(_BACKWARD) + _perspective(60) + film(12, 8, 4, '"integer pixelbounds" [2 10 1 7]'),
                             View((1, 2, 3), (-1, 0, 0), (0, 1, 0), (0, 0, -1), t30, 0.75 * t30, 8, 6)),
        "orthographic": Shot(_look(_SIDEWAYS) + orthographic + wide, look_at(*_SIDEWAYS, 8 / 6, 1, 8, 6, True)),
        "orthographic-window": Shot("Scale -1 1 1\n" + _look(_BACKWARD) + orthographic + '"float screenwindow" [-3 3 -4 4]\n'
                                    + tall, View((1, 2, 3), (1, 0, 0), (0, 1, 0), (0, 0, -1), 3, 4, 6, 8, True)),
        # Twice as large in the camera's space, so half as much of the world is seen.
        "orthographic-scaled": Shot("Scale 2 2 2\n" + _look(_BACKWARD) + orthographic + wide,
                                    View((1, 2, 3), (-1, 0, 0), (0, 1, 0), (0, 0, -1), 4 / 6, 0.5, 8, 6, True)),
        "camera-space": Shot("Scale -1 1 1\n" + _look(_SIDEWAYS) + _perspective(60) + wide,
                             View((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), 8 / 6 * t30, t30, 8, 6),
                             is_in_camera_space=True),
        "version-3": Shot("Scale -1 1 1\n" + _look(_BACKWARD) + _perspective(10, '"float halffov" 20') + film(8, 6, 3),
                          View((1, 2, 3), (1, 0, 0), (0, 1, 0), (0, 0, -1), 8 / 6 * t20, t20, 8, 6), version=3),
        "version-3-orthographic": Shot(_look(_SIDEWAYS) + orthographic + film(6, 8, 3),
                                        look_at(*_SIDEWAYS, 1, 8 / 6, 6, 8, True), version=3),
    }


def _colours(view: View) -> np.ndarray:
    """(height, width, 3): red grows to the right, green downwards, blue jumps."""
    y, x = np.mgrid[:view.height, :view.width]
    return np.stack([(x + 1) / view.width, (y + 1) / view.height, ((3 * x + 5 * y) % 7 + 1) / 7], axis=2)


def _source(shot: Shot) -> Source:
    view, distance = shot.view, 5.0
    world = 'CoordSysTransform "camera"\n' if shot.is_in_camera_space else ""
    for (y, x), _ in np.ndenumerate(np.empty((view.height, view.width))):
        corners = [view.point(x + dx, y + dy, distance) for dx, dy in ((0, 0), (1, 0), (1, 1), (0, 1))]
        world += lamp(quad(corners), _colours(view)[y, x], version=shot.version)
    return Source(scene(shot.before, world, version=shot.version))


class Cameras(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 8}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {name: _source(shot) for name, shot in _shots().items()}

    def test_every_pixel_shows_what_lies_before_it(self) -> None:
        for name, shot in _shots().items():
            with self.subTest(name):
                self.assert_near(self.pictures[name].radiance, _colours(shot.view), _TOLERANCE)


if __name__ == "__main__":
    unittest.main()
