"""Mitsuba's cameras in pictures: where on a large wall the ray of each pixel ends. The wall's colour is its place, so that
mirrored worlds show as well."""

from __future__ import annotations

import sys
import unittest
from dataclasses import dataclass
from pathlib import Path
from typing import Sequence

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import mitsuba_rays as rays
import mitsuba_xml as xml
from rendering import FIRST_HITS, RadianceTest, Source

_TEXELS = 128
_WALL: list[rays.Step] = [("scale", (14, 14, 1)), ("translate", (0, 0, -6))]
_PLACE: rays.Step = ("lookat", (0.5, 1, 3, 1, 0.2, -6, 0.3, 1, 0.1))
_PLAIN: list[rays.Step] = [_PLACE]


def places() -> bytes:
    """A .pfm whose red and green are u and v at the texels' middles, rows from the bottom."""
    middles = (np.arange(_TEXELS) + 0.5) / _TEXELS
    v, u = np.meshgrid(middles, middles, indexing="ij")
    pixels = np.stack([u, v, np.full_like(u, 0.25)], axis=2).astype("<f4")
    return f"PF\n{_TEXELS} {_TEXELS}\n-1.0\n".encode() + pixels[::-1].tobytes()


@dataclass(frozen=True)
class Camera:
    parameters: str
    half_width: float  # tangent of half the field of view along x, or half the width of an orthographic picture
    size: tuple[int, int] = (16, 8)
    steps: Sequence[rays.Step] = tuple(_PLAIN)
    kind: str = "perspective"
    crop: str = ""
    version: str = "3.0.0"

    def scene(self) -> str:
        texture = f'<texture type="bitmap" name="reflectance">{xml.word("filename", "places.pfm")}</texture>'
        wall = f'<shape type="rectangle">{rays.steps_xml(_WALL)}{xml.matt(texture)}</shape>'
        sensor = xml.sensor(self.kind, self.steps, *self.size, self.parameters, self.crop)
        return xml.scene(self.version, f'<emitter type="constant"/>{sensor}{wall}')

    def rays(self) -> rays.Rays:
        matrix = rays.steps_matrix(self.steps)
        if self.kind == "orthographic":
            return rays.orthographic(matrix, *self.size)
        return rays.perspective(matrix, 2 * np.degrees(np.arctan(self.half_width)), *self.size)

    def expected(self) -> np.ndarray:
        return rays.rectangle(self.rays().moved(np.linalg.inv(rays.steps_matrix(_WALL)))).uv


def fov(degrees: float, axis: str = "") -> str:
    return xml.number("fov", degrees) + (xml.word("fov_axis", axis) if axis else "")


T25, T30 = np.tan(np.radians(25)), np.tan(np.radians(30))
UPRIGHT, SQUARE = (8, 16), (12, 12)
# Half of the diagonal of a film of 36 mm x 24 mm; that of a picture whose width is 2 and height is 1 is sqrt(5).
_DIAGONAL = np.hypot(36, 24) / 2
CAMERAS = {
    "x by default": Camera(fov(60), T30), "x": Camera(fov(60, "x"), T30), "x, upright": Camera(fov(50, "x"), T25, UPRIGHT),
    "y": Camera(fov(50, "y"), 2 * T25), "y, upright": Camera(fov(60, "y"), T30 / 2, UPRIGHT),
    "smaller": Camera(fov(50, "smaller"), 2 * T25), "smaller, upright": Camera(fov(50, "smaller"), T25, UPRIGHT),
    "larger": Camera(fov(60, "larger"), T30), "larger, upright": Camera(fov(60, "larger"), T30 / 2, UPRIGHT),
    "diagonal": Camera(fov(60, "diagonal"), T30 * 2 / np.sqrt(5)),
    "focal length": Camera(xml.word("focal_length", "35mm"), _DIAGONAL / 35 * 2 / np.sqrt(5)),
    "by default": Camera("", _DIAGONAL / 50 / np.sqrt(2), SQUARE),
    "the older x": Camera(fov(60), T30, version="0.6.0"),
    "the older smaller": Camera(fov(50, "smaller"), 2 * T25, version="0.5.0"),
    "the older focal length": Camera(xml.word("focal_length", "35"), _DIAGONAL / 35 * 2 / np.sqrt(5),
                                     version="0.6.0"),
    "thinlens": Camera(fov(60) + xml.number("aperture_radius", 0.1) + xml.number("focus_distance", 9), T30, kind="thinlens"),
    "rolled": Camera(fov(60), T30, steps=[("rotate", (0, 0, 1, 25)), _PLACE]),
    "mirrored": Camera(fov(60), T30, steps=[("scale", (-1, 1, 1)), _PLACE]),
    "mirrored world": Camera(fov(60), T30, steps=[_PLACE, ("scale", (1, -1, 1))]),
    "scaled": Camera(fov(60), T30, steps=[("scale", (3, 3, 3)), _PLACE]),
    "orthographic": Camera("", 1, kind="orthographic", steps=[("scale", (2, 2, 1)), _PLACE]),
    "orthographic, upright": Camera("", 1, UPRIGHT, kind="orthographic", steps=[("scale", (1.5, 1.5, 1)), _PLACE]),
    "mirrored orthographic": Camera("", 1, kind="orthographic", steps=[("scale", (-2, 2, 1)), _PLACE], version="0.6.0"),
}
_CROP = "".join(xml.whole(f"crop_{name}", value)
                for name, value in (("offset_x", 4), ("offset_y", 3), ("width", 8), ("height", 2)))
CROPPED = Camera(fov(60), T30, crop=_CROP)
CROPPED_FLAT = Camera("", 1, kind="orthographic", steps=[("scale", (2, 2, 1)), _PLACE], crop=_CROP)


class CamerasTest(RadianceTest):
    @classmethod
    def sources(cls) -> dict[str, Source]:
        cameras = {**CAMERAS, "cropped": CROPPED, "cropped orthographic": CROPPED_FLAT}
        return {name: Source(camera.scene(), {"places.pfm": places()}, keys=FIRST_HITS) for name, camera in cameras.items()}

    def seen(self, name: str) -> np.ndarray:
        return self.pictures[name].albedo[..., :2]

    def test_the_ray_of_each_pixel(self) -> None:
        """To 0.0007 of the wall: texels are kept as half floats, whose steps are 0.0005 there."""
        for name, camera in CAMERAS.items():
            with self.subTest(name):
                expected = camera.expected()
                self.assertGreater(np.ptp(expected[..., 0]), 0.04)
                self.assertTrue(((expected > 0.01) & (expected < 0.99)).all(), "the wall is too small")
                self.assertEqual(self.seen(name).shape, expected.shape)
                self.assert_near(self.seen(name), expected, 7e-4)

    def test_a_crop_about_the_middle(self) -> None:
        for name, camera in (("cropped", CROPPED), ("cropped orthographic", CROPPED_FLAT)):
            with self.subTest(name):
                self.assert_near(self.seen(name), camera.expected()[3:5, 4:12], 7e-4)


if __name__ == "__main__":
    unittest.main()
