"""What pbrt's lights make of a matt floor: rho / pi times the irradiance, which each light has in closed form (lights.cpp;
pbr-book, chapter 12)."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_floor import CHORDS, Irradiance, ball, evenly, floor_under, point, polygon, seen, tube
from pbrt_rendering import attributes, numbers, quad, unit
from rendering import RadianceTest, Source

_PLACE, _INTENSITY = (0.4, -0.3, 1.5), (10.0, 6.0, 3.0)
_FROM = f'"point3 from" [{numbers(_PLACE)}]'
_LAMP = 'AreaLightSource "diffuse" "rgb L" [{}] {}'
_PANEL = ((-0.5, -0.2, 1.2), (0.3, -0.2, 1.2), (0.3, 0.6, 1.2), (-0.5, 0.6, 1.2))  # its front is above
_BALL = 'Translate .3 .2 1.5\nShape "sphere" "float radius" .4'
_L = (4.0, 2.0, 1.0)
# A light towards z, at 45 degrees to it.
_ALONG = unit((1, 0, -1))


def _cases() -> dict[str, tuple[Source, Irradiance]]:
    disk = [(0.2 + 0.5 * math.cos(a), -0.3 + 0.5 * math.sin(a), 0.9) for a in np.arange(512) * math.pi / 256]
    above = ball((0.3, 0.2, 1.5), 0.4, _L)
    lamp, reversed_panel = _LAMP.format(numbers(_L), ""), ("ReverseOrientation", quad(_PANEL))
    return {
        "point": (floor_under(f'LightSource "point" "rgb I" [10 6 3] {_FROM}'), point(_PLACE, _INTENSITY)),
        "point-moved": (floor_under(attributes("Translate .5 0 1\nRotate 90 0 0 1", 'LightSource "point" "rgb I" [5 3 1.5] '
                                               '"float scale" 2 "point3 from" [.2 .1 .5]')),
                        point((0.4, 0.2, 1.5), _INTENSITY)),
        # 4 pi I = 100 of a white light.
        "point-power": (floor_under(f'LightSource "point" "float power" 100 {_FROM}'),
                        point(_PLACE, (100 / (4 * math.pi),) * 3)),
        # A radiance of L in one direction: L times the cosine (DistantLight::SampleLi has a density of 1).
        "distant": (floor_under('LightSource "distant" "rgb L" [3 2 1] "point3 from" [1 2 3] "point3 to" [0 0 0]'),
                    evenly(np.array([3, 2, 1]) * 3 / math.sqrt(14))),
        "distant-turned": (floor_under(attributes("Scale 2 2 2\nRotate 135 0 1 0",  # z becomes (1, 0, -1) / sqrt 2
                                              'LightSource "distant" "rgb L" [3 2 1] "float scale" .5')),
                           evenly(np.array([3, 2, 1]) * 0.5 * -_ALONG[2])),
        "distant-lux": (floor_under('LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "float illuminance" 7'),
                        evenly((7, 7, 7))),
        "panel": (floor_under(attributes(lamp, *reversed_panel)), polygon(_PANEL, _L)),
        "panel-from-behind": (floor_under(attributes(lamp, quad(_PANEL))), evenly((0, 0, 0))),
        "panel-both": (floor_under(attributes(_LAMP.format("2 1 .5", '"bool twosided" true "float scale" 2'), quad(_PANEL))),
                       polygon(_PANEL, _L)),
        # Each triangle has the power: pi L A = 10 with A = 0.32, for the rgb 1 1 1.
        "panel-power": (floor_under(attributes('AreaLightSource "diffuse" "float power" 10', *reversed_panel)),
                        polygon(_PANEL, (10 / (math.pi * 0.32),) * 3)),
        "disk": (floor_under(attributes("Translate .2 -.3 .9\nRotate 180 1 0 0", lamp, 'Shape "disk" "float radius" .5')),
                 polygon(disk, _L)),
        "ball": (floor_under(attributes(lamp, _BALL)), above),
        "ball-reversed": (floor_under(attributes("ReverseOrientation", lamp, _BALL)), evenly((0, 0, 0))),
        "ball-power": (floor_under(attributes('AreaLightSource "diffuse" "float power" 20', _BALL)),
                       ball((0.3, 0.2, 1.5), 0.4, (20 / (math.pi * 4 * math.pi * 0.16),) * 3)),
        "tube": (floor_under(attributes("Translate 0 .2 .8\nRotate 90 0 1 0", lamp,
                                    'Shape "cylinder" "float radius" .2 "float zmin" -.6 "float zmax" .6')),
                 tube((0, 0.2, 0.8), 0.2, 0.6, _L)),
        "sky": (floor_under('LightSource "infinite" "rgb L" [.5 1 2] "float scale" 3'),
                evenly(math.pi * np.array([1.5, 3, 6]))),
        "sky-lux": (floor_under('LightSource "infinite" "float illuminance" 5'), evenly((5, 5, 5))),
        # ISO / 100 times the time that the shutter is open (PixelSensor's imaging ratio).
        "exposed": (floor_under(f'LightSource "point" "rgb I" [10 6 3] {_FROM}', 4, '"float iso" 50',
                            '"float shutteropen" 1 "float shutterclose" 4'), point(_PLACE, 1.5 * np.array(_INTENSITY))),
        "exposed-panel": (floor_under(attributes(lamp, *reversed_panel), 4, '"float iso" 150'),
                          polygon(_PANEL, 1.5 * np.array(_L))),
        "exposed-sky": (floor_under('LightSource "infinite" "rgb L" [.5 1 2]', 4, '"float iso" 150'),
                        evenly(1.5 * math.pi * np.array([0.5, 1, 2]))),
        "v3-point": (floor_under('LightSource "point" "rgb I" [5 3 1] "color scale" [2 2 3] "point from" [.4 -.3 1.5]', 3),
                     point(_PLACE, _INTENSITY)),
        "v3-distant": (floor_under('LightSource "distant" "color L" [3 2 1] "point from" [1 2 3] "point to" [0 0 0]', 3),
                       evenly(np.array([3, 2, 1]) * 3 / math.sqrt(14))),
        "v3-panel": (floor_under(attributes('AreaLightSource "diffuse" "color L" [4 2 1]', *reversed_panel), 3),
                     polygon(_PANEL, _L)),
        "v3-ball": (floor_under(attributes('AreaLightSource "area" "color L" [2 1 .5] "rgb scale" [2 2 2]', _BALL), 3),
                    above),
        "v3-sky": (floor_under('LightSource "infinite" "color L" [.5 1 2] "rgb scale" [3 3 3]', 3),
                   evenly(math.pi * np.array([1.5, 3, 6]))),
        "v3-exposed": (floor_under('LightSource "distant" "rgb L" [1 1 1] "point from" [0 0 1] "point to" [0 0 0]', 3,
                               '"float scale" 3'), evenly((3, 3, 3))),
        "no-bounces": (floor_under(f'LightSource "point" {_FROM}', bounces=0), evenly((0, 0, 0))),
    }


def _shadow(points: np.ndarray) -> np.ndarray:
    """Light towards +x and down, at 45 degrees, past a card from x = -1 to -1/2 that is 1/2 above the floor."""
    is_lit = (points[..., 0] < -0.5) | (points[..., 0] > 0)
    return is_lit[..., None] * np.array([3.0, 2, 1]) / math.sqrt(2)


def _mirrored_cases() -> dict[str, tuple[Source, Irradiance]]:
    """Under a camera that mirrors, for which the whole world is mirrored in the .glb."""
    card = quad([(-1, -9, .5), (-.5, -9, .5), (-.5, 9, .5), (-1, 9, .5)])
    distant = 'LightSource "distant" "rgb L" [3 2 1] "point3 from" [-1 0 1] "point3 to" [0 0 0]\n'
    lamp = _LAMP.format(numbers(_L), "")
    worlds: dict[str, tuple[str, Irradiance]] = {
        "point": (f'LightSource "point" "rgb I" [10 6 3] {_FROM}', point(_PLACE, _INTENSITY)),
        "distant": (distant + card, _shadow),
        "panel": (attributes("ReverseOrientation", lamp, quad(_PANEL)), polygon(_PANEL, _L)),
        "panel-from-behind": (attributes(lamp, quad(_PANEL)), evenly((0, 0, 0))),
        "ball": (attributes(lamp, _BALL), ball((0.3, 0.2, 1.5), 0.4, _L)),
    }
    return {name: (floor_under(world, is_mirrored=True), irradiance) for name, (world, irradiance) in worlds.items()}


class Lights(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 64}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {**{name: source for name, (source, _) in _cases().items()},
                **{f"mirrored-{name}": source for name, (source, _) in _mirrored_cases().items()}}

    def test_a_floor_is_as_bright_as_its_irradiance_makes_it(self) -> None:
        for name, (_, irradiance) in _cases().items():
            with self.subTest(name):
                expected = seen(irradiance)
                self.assert_radiance(self.pictures[name], expected, CHORDS * expected + 1e-6, name)

    def test_a_mirrored_world(self) -> None:
        for name, (_, irradiance) in _mirrored_cases().items():
            with self.subTest(name):
                expected = seen(irradiance)[:, ::-1]
                self.assert_radiance(self.pictures[f"mirrored-{name}"], expected, CHORDS * expected + 1e-6, name)


if __name__ == "__main__":
    unittest.main()
