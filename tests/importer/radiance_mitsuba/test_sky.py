"""How Mitsuba's sky is seen in every direction, what it does to a floor, and how long paths are."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import mitsuba_light as light
import mitsuba_rays as rays
import mitsuba_xml as xml
from rendering import RadianceTest, Source, mean_of

SHARE, RADIANCE = np.array((0.5, 0.25, 0.75)), np.array((1, 2, 3))


def camera(steps: list[rays.Step], fov: float, pixels: int) -> str:
    return xml.sensor("perspective", steps, pixels, pixels, xml.number("fov", fov))


def room(integrator: str, version: str = "3.0.0") -> str:
    walls = (f'<shape type="cube">{rays.steps_xml([("scale", (2, 2, 2))])}{xml.yes("flip_normals")}'
             f'{xml.matt(xml.rgb("reflectance", SHARE))}<emitter type="area">{xml.rgb("radiance", RADIANCE)}</emitter>'
             "</shape>")
    return xml.scene(version, integrator + camera([("lookat", (0, 0, 0, 1, 1, 0.5, 0, 0, 1))], 60, 8) + walls)


class LengthOfPathsTest(RadianceTest):
    """Within a room whose walls emit L and reflect a share a, all that is seen is L (1 + a + a^2 ...), with as many terms as
    max_depth says: 1 is what is seen directly."""

    KEYS = {"frames": 64}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        depths = {f"depth {depth}": Source(room(xml.path(depth))) for depth in (1, 2, 3)}
        return {**depths, "direct": Source(room('<integrator type="direct"/>')), "without end": Source(room(xml.path(-1))),
                "old": Source(room(xml.path(4, "volpath"), "0.5.0"))}

    def test_each_length(self) -> None:
        for name, terms in (("depth 1", 1), ("depth 2", 2), ("depth 3", 3), ("direct", 2), ("old", 4),
                            ("without end", np.inf)):
            with self.subTest(name):
                expected = RADIANCE * (1 - SHARE**terms) / (1 - SHARE)
                mean, error = mean_of(self.pictures[name], np.ones((8, 8), bool))
                self.assert_near(mean, expected, 5 * error + 2e-3)
                self.assertLess(error.max(), 0.1)


_TURN: list[rays.Step] = [("rotate", (0.3, 1, -0.2, 70))]
_MIRROR: list[rays.Step] = [("scale", (-1, 1, 1)), *_TURN]
PIXELS = 24
VIEWS = {"ahead": (1, 0.2, 0.3), "back": (-0.3, 0.4, -1), "up": (0.1, 1, 0.2)}


def under_the_sky(steps: list[rays.Step], view: tuple[float, ...], version: str = "3.0.0") -> str:
    """A dot far behind the camera stands for the shape that a scene must have."""
    behind = tuple(-100 * x for x in view)
    dot = f'<shape type="sphere">{rays.steps_xml([("scale", (0.1, 0.1, 0.1)), ("translate", behind)])}</shape>'
    emitter = (f'<emitter type="envmap">{xml.word("filename", "sky.pfm")}{xml.number("scale", 2)}{rays.steps_xml(steps)}'
               "</emitter>")
    return xml.scene(version, xml.path(2) + camera([at(view)], 80, PIXELS) + emitter + dot)


def at(view: tuple[float, ...]) -> rays.Step:
    return "lookat", (0, 0, 0, *view, 0.1, 0.2, 1)


def floor(emitter: str, version: str = "3.0.0") -> str:
    shape = f'<shape type="rectangle">{xml.matt(xml.rgb("reflectance", SHARE))}</shape>'
    return xml.scene(version, xml.path(2) + camera([("lookat", (0, -2, 2, 0, 0, 0, 0, 0, 1))], 20, 8) + emitter + shape)


class SkyTest(RadianceTest):
    KEYS = {"frames": 32}
    TURNS = {"straight": [], "turned": _TURN, "mirrored": _MIRROR}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        files = {"sky.pfm": light.sky()}
        found = {f"{turn} {name} {version[0]}": Source(under_the_sky(steps, view, version), files)
                 for turn, steps in cls.TURNS.items() for name, view in VIEWS.items() for version in ("3.0.0", "0.6.0")
                 if turn == "turned" or version == "3.0.0"}
        constant = floor(f'<emitter type="constant">{xml.rgb("radiance", (0.5, 1, 2))}</emitter>')
        grey = floor('<emitter type="constant"><spectrum name="radiance" value="1.5"/></emitter>', "0.6.0")
        return {**found, "constant": Source(constant), "grey": Source(grey)}

    def test_each_direction(self) -> None:
        """Twice 1 + 0.8 times the direction in the map's space; to 1 %, as rows of Mitsuba 3 lie up to half a row nearer to
        the poles, and texels are straight lines between directions."""
        for turn, steps in self.TURNS.items():
            for name, view in VIEWS.items():
                for version in ("3", "0") if turn == "turned" else ("3",):
                    seen = rays.perspective(rays.steps_matrix([at(view)]), 80, PIXELS, PIXELS, 4)
                    local = seen.directions @ np.linalg.inv(rays.steps_matrix(steps))[:3, :3].T
                    with self.subTest(turn, view=name, version=version):
                        picture = self.pictures[f"{turn} {name} {version}"]
                        self.assert_radiance(picture, 2 * (1 + 0.8 * local.mean(axis=2)), 0.02, "the sky")

    def test_a_constant_sky_over_a_floor(self) -> None:
        """Irradiance pi L."""
        self.assert_radiance(self.pictures["constant"], SHARE * (0.5, 1, 2), 2e-3)
        self.assert_radiance(self.pictures["grey"], SHARE * 1.5, 2e-3)


if __name__ == "__main__":
    unittest.main()
