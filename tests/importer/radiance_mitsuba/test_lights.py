"""Mitsuba's emitters in pictures: what a matt floor shows of them."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path
from typing import Callable

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import mitsuba_light as light
import mitsuba_rays as rays
import mitsuba_xml as xml
from rendering import RadianceTest, Source

WIDTH, HEIGHT, FOV = 12, 8, 20.0
EYE: rays.Step = ("lookat", (0, -6, 5, 0, 0, 0, 0, 0, 1))
REFLECTANCE = np.array((0.8, 0.5, 0.2))
DOWN: rays.Step = ("rotate", (1, 0, 0, 180))


def floor_scene(lights: str, version: str = "3.0.0") -> str:
    floor = (f'<shape type="rectangle">{rays.steps_xml([("scale", (8, 8, 1))])}<bsdf type="diffuse">'
             f'{xml.rgb("reflectance", REFLECTANCE)}</bsdf></shape>')
    sensor = xml.sensor("perspective", [EYE], WIDTH, HEIGHT, xml.number("fov", FOV))
    return xml.scene(version, xml.path(2) + sensor + floor + lights)


def floor_points() -> np.ndarray:
    """Four by four of each pixel: (height, width, 16, 3)."""
    seen = rays.perspective(rays.steps_matrix([EYE]), FOV, WIDTH, HEIGHT, 4)
    return seen.origins - seen.origins[..., 2:] / seen.directions[..., 2:] * seen.directions


def lamp(kind: str, steps: list[rays.Step], radiance: object, inside: str = "") -> str:
    return (f'<shape type="{kind}">{inside}{rays.steps_xml(steps)}<emitter type="area">{xml.rgb("radiance", radiance)}'
            "</emitter></shape>")


def emitter(kind: str, inside: str) -> str:
    return f'<emitter type="{kind}">{inside}</emitter>'


POINT, SPOT, TARGET = (1.0, 0.5, 2.0), (-1.5, -0.5, 3.0), (-0.2, 0.1, 0.0)
CUTOFF, BEAM = 18.0, 15.0
SUN = np.array((0.5, 0.3, -1.0)) / np.linalg.norm((0.5, 0.3, -1.0))
CONES = (rays.steps_xml([("lookat", (*SPOT, *TARGET, 0, 1, 0))]) + xml.number("cutoff_angle", CUTOFF)
         + xml.number("beam_width", BEAM))
PUNCTUAL = (emitter("point", '<point name="position" x="1" y="0.5" z="2"/>' + xml.rgb("intensity", (7, 0, 0)))
            + emitter("spot", CONES + xml.rgb("intensity", (0, 9, 0)))
            + emitter("directional", '<vector name="direction" x="0.5" y="0.3" z="-1"/>' + xml.rgb("irradiance", (0, 0, 2))))
# The same by transforms, which 0.6 has alone: lights shine along their +z.
PUNCTUAL_OLD = (emitter("point", rays.steps_xml([("translate", POINT)]) + '<spectrum name="intensity" value="7"/>'),
                emitter("spot", CONES + '<spectrum name="intensity" value="9"/>'),
                emitter("directional", rays.steps_xml([("lookat", (0, 0, 0, *SUN, 0, 1, 0))])
                        + '<spectrum name="irradiance" value="2"/>'))
SQUARE: list[rays.Step] = [("scale", (0.6, 0.4, 1)), DOWN, ("translate", (-2.5, 0, 2.5))]
SMALL_DISK: list[rays.Step] = [("scale", (0.5, 0.5, 0.5)), DOWN, ("translate", (2.5, 0, 2.5))]
BOX: list[rays.Step] = [("scale", (0.3, 0.4, 0.2)), ("translate", (0, 1, 2.5))]
LAMPS = (lamp("rectangle", SQUARE, (20, 0, 0)) + lamp("disk", SMALL_DISK, (0, 0, 30))
         + lamp("sphere", [("translate", (0, 1, 2.5))], (0, 25, 0), xml.number("radius", 0.5)))
TUBE = '<point name="p0" x="0" y="-0.5" z="0"/><point name="p1" x="0" y="0.6" z="0.2"/><float name="radius" value="0.2"/>'
GLOW = ('<texture name="radiance" type="bitmap">' + xml.word("filename", "glow.pfm") + xml.word("filter_type", "nearest")
        + "</texture>")
OTHER_LAMPS = (lamp("cylinder", [("translate", (-2.5, 0, 2.5))], (30, 0, 0), TUBE) + lamp("cube", BOX, (0, 20, 0))
               + f'<shape type="rectangle">{rays.steps_xml(SMALL_DISK)}{emitter("area", GLOW)}</shape>')
MASKED = f'<bsdf type="mask">{xml.number("opacity", 0.25)}{xml.matt(xml.rgb("reflectance", 0))}</bsdf>'
# Of three lamps, the first shines upwards, the second does so but for its flipped normals, the third is masked.
SIDES = (lamp("rectangle", [("scale", (0.6, 0.4, 1)), ("translate", (-2.5, 0, 2.5))], (20, 0, 0))
         + lamp("rectangle", [("scale", (0.4, 0.4, 0.4)), ("translate", (0, 1, 2.5))], (0, 20, 0), xml.yes("flip_normals"))
         + lamp("rectangle", SMALL_DISK, (0, 0, 30), MASKED))


def glow() -> bytes:
    """Two texels, of which the left one is black and the right one has a blue of 40; above 1, as a lamp's may be."""
    return b"PF\n2 1\n-1.0\n" + np.array([[[0, 0, 0], [0, 0, 40]]], "<f4").tobytes()


class FloorTest(RadianceTest):
    """Radiance of a matt floor: reflectance times irradiance over pi. Each light has a channel of its own."""

    KEYS = {"frames": 256, "lights": "uniform"}  # by power, the sun would take nearly all light samples

    @classmethod
    def sources(cls) -> dict[str, Source]:
        old = {f"old {i}": Source(floor_scene(text, "0.6.0")) for i, text in enumerate(PUNCTUAL_OLD)}
        return {"punctual": Source(floor_scene(PUNCTUAL)), "lamps": Source(floor_scene(LAMPS)), **old,
                "old lamps": Source(floor_scene(LAMPS, "0.6.0")), "sides": Source(floor_scene(SIDES)),
                "other lamps": Source(floor_scene(OTHER_LAMPS), {"glow.pfm": glow()})}

    def expected(self, *irradiance: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        points = floor_points()
        return np.stack([e(points).mean(axis=-1) for e in irradiance], axis=-1) * REFLECTANCE / np.pi

    def spot(self, points: np.ndarray) -> np.ndarray:
        """Full within the beam, nothing beyond the cutoff; between the two not a number."""
        angle = light.angle_from(points, SPOT, TARGET)
        fade = np.where(angle <= BEAM, 1.0, np.where(angle >= CUTOFF, 0.0, np.nan))
        return light.point_light(points, SPOT, 9) * fade

    def sun(self, points: np.ndarray) -> np.ndarray:
        return np.full(points.shape[:-1], -2 * SUN[2])

    def compare(self, name: str, expected: np.ndarray, allowed: float = 1e-3) -> None:
        """Where it is known; `allowed` is a share of what is expected."""
        picture, is_known = self.pictures[name], ~np.isnan(expected)
        self.assertGreater(is_known.mean(), 0.3)
        self.assert_near(picture.radiance[is_known], expected[is_known],
                         6 * picture.error[is_known] + allowed * (expected[is_known] + 1e-3), name)
        for channel in range(3):
            known = is_known[..., channel]
            error = np.sqrt((picture.error[known, channel] ** 2).sum()) / known.sum()
            mean = expected[known, channel].mean()
            self.assert_near(picture.radiance[known, channel].mean(), mean, 4 * error + allowed * mean,
                             f"the mean of {name} in channel {channel}")

    def test_points_spots_and_directions(self) -> None:
        """The floor's radiance is steady, so that a pixel's variance is that of its area alone."""
        self.compare("punctual", self.expected(lambda p: light.point_light(p, POINT, 7), self.spot, self.sun), 2e-3)

    def test_the_same_of_the_older_version(self) -> None:
        for i, irradiance in enumerate((lambda p: light.point_light(p, POINT, 7), self.spot, self.sun)):
            self.compare(f"old {i}", self.expected(irradiance, irradiance, irradiance), 1e-2)

    def test_the_fading_of_a_spot(self) -> None:
        """Between beam and cutoff Mitsuba's is linear in the angle, glTF's is a square: both fall from 1 to 0, and glTF's is
        below by at most 0.3."""
        points = floor_points()
        linear = np.clip((CUTOFF - light.angle_from(points, SPOT, TARGET)) / (CUTOFF - BEAM), 0, 1).mean(axis=2)
        full = light.point_light(points, SPOT, 9).mean(axis=2) * REFLECTANCE[1] / np.pi
        share = self.pictures["old 1"].radiance[..., 1] / full
        self.assert_near(share, linear - 0.15, 0.2)

    def of_lamps(self) -> np.ndarray:
        corners = [(-2.5 + 0.6 * x, 0.4 * y, 2.5) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        return self.expected(lambda p: light.polygon(p, corners, 20), lambda p: light.ball(p, (0, 1, 2.5), 0.5, 25),
                             lambda p: light.flat_disk(p, (2.5, 0, 2.5), 0.5, 30))

    def test_rectangle_ball_and_disk(self) -> None:
        """A ball of triangles is smaller by 5e-4, and a disk by 4e-4."""
        self.compare("lamps", self.of_lamps(), 2e-3)
        self.compare("old lamps", self.of_lamps(), 2e-3)

    def test_cylinder_cube_and_textured_lamp(self) -> None:
        """The lamp is turned over about x: its u grows with x still, so that the bright texel has the greater x."""
        bright = [(2.5 + x, 0.5 * y, 2.5) for x, y in ((0, -1), (0.5, -1), (0.5, 1), (0, 1))]
        self.compare("other lamps", self.expected(
            lambda p: light.tube(p, (-2.5, -0.5, 2.5), (-2.5, 0.6, 2.7), 0.2, 30),
            lambda p: light.box(p, (-0.3, 0.6, 2.3), (0.3, 1.4, 2.7), 20), lambda p: light.polygon(p, bright, 40)), 4e-3)

    def test_the_side_of_a_lamp_and_its_mask(self) -> None:
        """Masks of Mitsuba's do not dim a lamp (AreaLight::eval)."""
        squares = [[(x0 + s * x, y0 + s * y, 2.5) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                   for x0, y0, s in ((0, 1, 0.4), (2.5, 0, 0.5))]
        self.compare("sides", self.expected(lambda p: np.zeros(p.shape[:-1]), lambda p: light.polygon(p, squares[0], 20),
                                            lambda p: light.polygon(p, squares[1], 30)), 2e-3)


if __name__ == "__main__":
    unittest.main()
