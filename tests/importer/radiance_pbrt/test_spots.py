"""The rest of pbrt's lights: cones of spots, spectra, and how long paths of light are."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_floor import CHORDS, LUMINANCE, RHO, floor_points, floor_under, point, seen
from pbrt_rendering import film, numbers, scene, unit
from rendering import RadianceTest, Source

_INTENSITY = (10.0, 6.0, 3.0)
_CONE, _SOFT = 30.0, 12.0
_SPOT_AT, _SPOT_TO = (0.1, 0.2, 1.6), (0.2, 0.1, 0.0)


class Spots(RadianceTest):
    """Within the hard part of the cone a spot is a point, without the cone it is dark. Between them pbrt's falloff is
    another one than glTF's x^2, x being the share of the way in the cosine: v4's smoothstep 3 x^2 - 2 x^3 is above it by
    8/27 at most (at x = 2/3), v3's x^4 below it by 1/4 at most (at x^2 = 1/2)."""

    EXTENSION = ".pbrt"
    KEYS = {"frames": 16}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        place = f'"point3 from" [{numbers(_SPOT_AT)}] "point3 to" [{numbers(_SPOT_TO)}]'
        light = f'LightSource "spot" "rgb I" [10 6 3] "float coneangle" {_CONE} "float conedeltaangle" {_SOFT} '
        return {"v4": floor_under(light + place), "v3": floor_under(light + place.replace("point3", "point"), 3),
                "v4-power": floor_under(light.replace('"rgb I" [10 6 3]', '"float power" 50') + place)}

    def _shares(self) -> np.ndarray:
        """(height, width, 16): x, below 0 without the cone and above 1 within its hard part."""
        points = floor_points()
        from_light = np.concatenate([points, np.zeros_like(points[..., :1])], axis=-1) - _SPOT_AT
        cosine = from_light @ unit(np.subtract(_SPOT_TO, _SPOT_AT)) / np.linalg.norm(from_light, axis=-1)
        outer, inner = math.cos(math.radians(_CONE)), math.cos(math.radians(_CONE - _SOFT))
        return (cosine - outer) / (inner - outer)

    def test_hard_part_and_outside(self) -> None:
        x, alone = self._shares(), seen(point(_SPOT_AT, _INTENSITY))
        for name in ("v3", "v4"):
            picture = self.pictures[name]
            for where, share in ((x.min(axis=2) >= 1.02, 1.0), (x.max(axis=2) <= -0.02, 0.0)):
                self.assertGreater(where.sum(), 8)
                self.assert_near(picture.radiance[where], share * alone[where],
                                 6 * picture.error[where] + CHORDS * alone[where], name)

    def test_soft_part(self) -> None:
        x, alone = np.clip(self._shares(), 0, 1), seen(point(_SPOT_AT, _INTENSITY))
        for name, falloff, allowed in (("v4", 3 * x ** 2 - 2 * x ** 3, 8 / 27), ("v3", x ** 4, 1 / 4)):
            picture = self.pictures[name]
            # A picture of 16 frames knows the share of a pixel across an edge to some hundredths.
            self.assert_near(picture.radiance, falloff.mean(axis=2)[..., None] * alone,
                             6 * picture.error + (allowed + 0.02) * alone, name)

    def test_power(self) -> None:
        """2 pi ((1 - cos inner) + (cos inner - cos outer) / 2) I = 50 (SpotLight::Create)."""
        outer, inner = math.cos(math.radians(_CONE)), math.cos(math.radians(_CONE - _SOFT))
        intensity = 50 / (2 * math.pi * ((1 - inner) + (inner - outer) / 2))
        expected, picture = seen(point(_SPOT_AT, (intensity,) * 3)), self.pictures["v4-power"]
        where = self._shares().min(axis=2) >= 1.02
        self.assert_near(picture.radiance[where], expected[where], 6 * picture.error[where] + CHORDS * expected[where])


class Colours(RadianceTest):
    """pbrt-v4's spectra of lights have a luminance of 1 before their scale (lights.cpp: SpectrumToPhotometric), so that the
    floor's luminance is that of a white light."""

    EXTENSION = ".pbrt"
    KEYS = {"frames": 4}
    SPECTRA = {"blackbody": '"blackbody L" 3000', "pairs": '"spectrum L" [400 5 500 7 700 9]',
               "name": '"spectrum L" "stdillum-A"'}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {name: floor_under(f'LightSource "distant" {said} "float scale" 4 "point3 from" [0 0 1] "point3 to" [0 0 0]')
                for name, said in cls.SPECTRA.items()}

    def test_luminance(self) -> None:
        for name in self.SPECTRA:
            irradiance = self.pictures[name].radiance * math.pi / RHO
            self.assert_near(irradiance @ LUMINANCE, 4, 0.01, name)
        warm = self.pictures["blackbody"].radiance[0, 0] / RHO
        self.assertGreater(warm[0], 1.5 * warm[1])
        self.assertGreater(warm[1], 1.5 * warm[2])


class Bounces(RadianceTest):
    """In a closed box whose walls emit 1 and reflect 1/2, paths of up to n bounces show 1 + 1/2 + ... + 1/2^n; pbrt's
    "maxdepth" is n (PathIntegrator::Li)."""

    EXTENSION = ".pbrt"
    KEYS = {"frames": 32}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        corners = "-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1"
        faces = "0 1 2 0 2 3  4 5 6 4 6 7  0 1 5 0 5 4  2 3 7 2 7 6  1 2 6 1 6 5  0 3 7 0 7 4"
        box = f'Shape "trianglemesh" "point3 P" [{corners}] "integer indices" [{faces}]'
        found = {}
        for version, flag, kind in ((4, "true", '"diffuse" "rgb reflectance"'), (3, '"true"', '"matte" "rgb Kd"')):
            world = f'AreaLightSource "diffuse" "bool twosided" {flag}\nMaterial {kind} [.5 .5 .5]\n{box}'
            before = 'Camera "perspective" "float fov" 60\n' + film(8, 8, version)
            found |= {f"v{version}-{n}": Source(scene(before, world, n, version)) for n in (0, 1, 3)}
        return found

    def test_maxdepth(self) -> None:
        for version in (3, 4):
            for bounces in (0, 1, 3):
                name = f"v{version}-{bounces}"
                self.assert_radiance(self.pictures[name], 2 - 0.5 ** bounces, 1e-4, name)


if __name__ == "__main__":
    unittest.main()
