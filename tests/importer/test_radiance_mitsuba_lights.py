"""Mitsuba's emitters in pictures: what a matt floor shows of them, what is seen of the sky, and how long paths are."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path
from typing import Callable

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

import mitsuba_light as light
import mitsuba_rays as rays
from mitsuba_exhibits import as_old
from mitsuba_scenes import png
from rendering import RadianceTest, Source

WIDTH, HEIGHT, FOV = 12, 8, 20.0
EYE: rays.Step = ("lookat", (0, -6, 5, 0, 0, 0, 0, 0, 1))
REFLECTANCE = np.array((0.8, 0.5, 0.2))
INTEGRATOR = '<integrator type="path"><integer name="max_depth" value="{}"/></integrator>'
DOWN: rays.Step = ("rotate", (1, 0, 0, 180))


def sensor(step: rays.Step = EYE, fov: float = FOV, width: int = WIDTH, height: int = HEIGHT) -> str:
    return (f'<sensor type="perspective"><float name="fov" value="{fov}"/>{rays.steps_xml([step])}<film type="hdrfilm"><integer '
            f'name="width" value="{width}"/><integer name="height" value="{height}"/><rfilter type="box"/></film></sensor>')


def floor_scene(lights: str, version: str = "3.0.0", depth: int = 2) -> str:
    rgb = ", ".join(map(str, REFLECTANCE))
    floor = (f'<shape type="rectangle">{rays.steps_xml([("scale", (8, 8, 1))])}<bsdf type="diffuse"><rgb name="reflectance" '
             f'value="{rgb}"/></bsdf></shape>')
    text = f'<scene version="{version}">{INTEGRATOR.format(depth)}{sensor()}{floor}{lights}</scene>'
    return as_old(text) if version < "2" else text


def floor_points() -> np.ndarray:
    """Four by four of each pixel: (height, width, 16, 3)."""
    seen = rays.perspective(rays.steps_matrix([EYE]), FOV, WIDTH, HEIGHT, 4)
    return seen.origins - seen.origins[..., 2:] / seen.directions[..., 2:] * seen.directions


def lamp(kind: str, steps: list[rays.Step], radiance: str, inside: str = "") -> str:
    return (f'<shape type="{kind}">{inside}{rays.steps_xml(steps)}<emitter type="area">'
            f'<rgb name="radiance" value="{radiance}"/></emitter></shape>')


POINT, SPOT, TARGET = (1.0, 0.5, 2.0), (-1.5, -0.5, 3.0), (-0.2, 0.1, 0.0)
CUTOFF, BEAM = 18.0, 15.0
SUN = np.array((0.5, 0.3, -1.0)) / np.linalg.norm((0.5, 0.3, -1.0))
PUNCTUAL = ('<emitter type="point"><point name="position" x="1" y="0.5" z="2"/><rgb name="intensity" value="7, 0, 0"/></emitter>'
            f'<emitter type="spot">{rays.steps_xml([("lookat", (*SPOT, *TARGET, 0, 1, 0))])}<float name="cutoff_angle" '
            f'value="{CUTOFF}"/><float name="beam_width" value="{BEAM}"/><rgb name="intensity" value="0, 9, 0"/></emitter>'
            '<emitter type="directional"><vector name="direction" x="0.5" y="0.3" z="-1"/>'
            '<rgb name="irradiance" value="0, 0, 2"/></emitter>')
# The same by transforms, which 0.6 has alone: lights shine along their +z.
PUNCTUAL_OLD = (f'<emitter type="point">{rays.steps_xml([("translate", POINT)])}<spectrum name="intensity" value="7"/></emitter>',
                f'<emitter type="spot">{rays.steps_xml([("lookat", (*SPOT, *TARGET, 0, 1, 0))])}<float name="cutoff_angle" '
                f'value="{CUTOFF}"/><float name="beam_width" value="{BEAM}"/><spectrum name="intensity" value="9"/></emitter>',
                f'<emitter type="directional">{rays.steps_xml([("lookat", (0, 0, 0, *SUN, 0, 1, 0))])}'
                '<spectrum name="irradiance" value="2"/></emitter>')
SQUARE: list[rays.Step] = [("scale", (0.6, 0.4, 1)), DOWN, ("translate", (-2.5, 0, 2.5))]
SMALL_DISK: list[rays.Step] = [("scale", (0.5, 0.5, 0.5)), DOWN, ("translate", (2.5, 0, 2.5))]
BOX: list[rays.Step] = [("scale", (0.3, 0.4, 0.2)), ("translate", (0, 1, 2.5))]
LAMPS = (lamp("rectangle", SQUARE, "20, 0, 0") + lamp("disk", SMALL_DISK, "0, 0, 30")
         + lamp("sphere", [("translate", (0, 1, 2.5))], "0, 25, 0", '<float name="radius" value="0.5"/>'))
TUBE = '<point name="p0" x="0" y="-0.5" z="0"/><point name="p1" x="0" y="0.6" z="0.2"/><float name="radius" value="0.2"/>'
PICTURE = ('<shape type="rectangle">{}<emitter type="area"><texture name="radiance" type="bitmap"><string name="filename" '
           'value="glow.pfm"/><string name="filter_type" value="nearest"/></texture></emitter></shape>')
OTHER_LAMPS = (lamp("cylinder", [("translate", (-2.5, 0, 2.5))], "30, 0, 0", TUBE) + lamp("cube", BOX, "0, 20, 0")
               + PICTURE.format(rays.steps_xml(SMALL_DISK)))
FLIPPED = '<boolean name="flip_normals" value="true"/>'
AWAY: list[rays.Step] = [("scale", (0.5, 0.5, 0.5)), ("translate", (2.5, 0, 2.5))]
MASKED = '<bsdf type="mask"><float name="opacity" value="0.25"/><bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf></bsdf>'
# Of three lamps, the first shines upwards, the second does so but for its flipped normals, the third is masked.
SIDES = (lamp("rectangle", [("scale", (0.6, 0.4, 1)), ("translate", (-2.5, 0, 2.5))], "20, 0, 0")
         + lamp("rectangle", [("scale", (0.4, 0.4, 0.4)), ("translate", (0, 1, 2.5))], "0, 20, 0", FLIPPED)
         + lamp("rectangle", SMALL_DISK, "0, 0, 30", MASKED))


def glow() -> bytes:
    """Two texels, of which the left one is black and the right one has a blue of 40; above 1, as a lamp's may be."""
    return b"PF\n2 1\n-1.0\n" + np.array([[[0, 0, 0], [0, 0, 40]]], "<f4").tobytes()


class FloorTest(RadianceTest):
    """Radiance of a matt floor: reflectance times irradiance over pi. Each light has a channel of its own."""

    KEYS = {"frames": 256}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        old = {f"old {i}": Source(floor_scene(text, "0.6.0"), keys={"frames": 64}) for i, text in enumerate(PUNCTUAL_OLD)}
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
        points = floor_points()[:, :, 5]
        angle = light.angle_from(points, SPOT, TARGET)
        linear = np.clip((CUTOFF - angle) / (CUTOFF - BEAM), 0, 1)
        full = light.point_light(points, SPOT, 9) * REFLECTANCE[1] / np.pi
        share = self.pictures["punctual"].radiance[..., 1] / full
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


ROOM = ('<shape type="{}">{}' + FLIPPED + '<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.25, '
        '0.75"/></bsdf></bsdf><emitter type="area"><rgb name="radiance" value="1, 2, 3"/></emitter></shape>')


def room(kind: str, integrator: str, version: str = "3.0.0") -> str:
    body = f'<scene version="{version}">{integrator}{sensor(("lookat", (0, 0, 0, 1, 1, 0.5, 0, 0, 1)), 60)}'
    body += ROOM.format(kind, rays.steps_xml([("scale", (2, 2, 2))])) + "</scene>"
    return as_old(body) if version < "2" else body


class LengthOfPathsTest(RadianceTest):
    """Within a room whose walls emit L and reflect a share a, all that is seen is L (1 + a + a^2 ...), with as many terms as
    max_depth says: 1 is what is seen directly."""

    KEYS = {"frames": 64}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        depths = {f"depth {depth}": Source(room("cube", INTEGRATOR.format(depth))) for depth in (1, 2, 3)}
        return {**depths, "direct": Source(room("cube", '<integrator type="direct"/>')),
                "without end": Source(room("cube", INTEGRATOR.format(-1))),
                "old": Source(room("cube", '<integrator type="volpath"><integer name="max_depth" value="4"/></integrator>',
                                   "0.5.0"))}

    def expected(self, terms: float) -> np.ndarray:
        share = np.array((0.5, 0.25, 0.75))
        return np.array((1, 2, 3)) * (1 - share**terms) / (1 - share)

    def test_each_length(self) -> None:
        for name, terms in (("depth 1", 1), ("depth 2", 2), ("depth 3", 3), ("direct", 2), ("old", 4), ("without end", np.inf)):
            with self.subTest(name):
                self.assert_radiance(self.pictures[name], self.expected(terms), 2e-3, name)


_TURN: list[rays.Step] = [("rotate", (0.3, 1, -0.2, 70))]
_MIRROR: list[rays.Step] = [("scale", (-1, 1, 1)), *_TURN]
SKY_WIDTH = 24
VIEWS = {"ahead": (1, 0.2, 0.3), "back": (-0.3, 0.4, -1), "up": (0.1, 1, 0.2)}


def under_the_sky(steps: list[rays.Step], view: tuple[float, ...], version: str = "3.0.0") -> str:
    """A dot far behind the camera stands for the shape that a scene must have."""
    behind = tuple(-100 * x for x in view)
    dot = f'<shape type="sphere">{rays.steps_xml([("scale", (0.1, 0.1, 0.1)), ("translate", behind)])}</shape>'
    emitter = (f'<emitter type="envmap"><string name="filename" value="sky.pfm"/><float name="scale" value="2"/>'
               f"{rays.steps_xml(steps)}</emitter>")
    at = sensor(("lookat", (0, 0, 0, *view, 0.1, 0.2, 1)), 80, SKY_WIDTH, SKY_WIDTH)
    text = f'<scene version="{version}">{INTEGRATOR.format(2)}{at}{emitter}{dot}</scene>'
    return as_old(text) if version < "2" else text


class SkyTest(RadianceTest):
    KEYS = {"frames": 32}
    TURNS = {"straight": [], "turned": _TURN, "mirrored": _MIRROR}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        files = {"sky.pfm": light.sky()}
        found = {f"{turn} {name} {version[0]}": Source(under_the_sky(steps, view, version), files)
                 for turn, steps in cls.TURNS.items() for name, view in VIEWS.items() for version in ("3.0.0", "0.6.0")
                 if turn == "turned" or version == "3.0.0"}
        constant = floor_scene('<emitter type="constant"><rgb name="radiance" value="0.5, 1, 2"/></emitter>')
        grey = floor_scene('<emitter type="constant"><spectrum name="radiance" value="1.5"/></emitter>', "0.6.0")
        return {**found, "constant": Source(constant), "grey": Source(grey)}

    def test_each_direction(self) -> None:
        """Twice 1 + 0.8 times the direction in the map's space; to 1 %, as rows of Mitsuba 3 lie up to half a row nearer to
        the poles, and texels are straight lines between directions."""
        for turn, steps in self.TURNS.items():
            for name, view in VIEWS.items():
                for version in ("3", "0") if turn == "turned" else ("3",):
                    at = rays.steps_matrix([("lookat", (0, 0, 0, *view, 0.1, 0.2, 1))])
                    seen = rays.perspective(at, 80, SKY_WIDTH, SKY_WIDTH, 4)
                    local = seen.directions @ np.linalg.inv(rays.steps_matrix(steps))[:3, :3].T
                    with self.subTest(turn, view=name, version=version):
                        picture = self.pictures[f"{turn} {name} {version}"]
                        self.assert_radiance(picture, 2 * (1 + 0.8 * local.mean(axis=2)), 0.02, "the sky")

    def test_a_constant_sky_over_a_floor(self) -> None:
        """Irradiance pi L."""
        self.assert_radiance(self.pictures["constant"], REFLECTANCE * (0.5, 1, 2), 2e-3)
        self.assert_radiance(self.pictures["grey"], REFLECTANCE * 1.5, 2e-3)


if __name__ == "__main__":
    unittest.main()
