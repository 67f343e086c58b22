"""Normals of meshes and normal maps of pbrt under light from two sides: a matt surface shows rho / pi times the cosine
between the light and its shading normal.

The frame of v4's maps has dp/du for x, the surface's normal n for z and n x dp/du for y, whichever way v runs (NormalMap,
Frame::FromXZ)."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_rendering import attributes, film, numbers, quad, scene, unit
from pbrt_scene import png
from rendering import RadianceTest, Source

_TEXEL = (191, 159, 234)
_X, _Y, _Z = unit(2 * np.array(_TEXEL) / 255 - 1)
_CORNERS = ((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0))
_STRAIGHT, _MIRRORED, _TURNED = "0 0  1 0  1 1  0 1", "1 0  0 0  0 1  1 1", "1 0  1 1  0 1  0 0"
_CARD = 'ObjectBegin "card"\n{}ObjectEnd\n'
_LIGHTS = {"from-x": (1, 0, 1), "from-y": (0, 1, 1)}


def _square(uvs: str) -> str:
    return quad(_CORNERS, f'"point2 uv" [{uvs}]')


_PLAIN = f'"normal3 N" [{numbers([(_X, _Y, _Z)] * 4)}]'

# Statements, and the normal that is seen from +z.
_MAPPED = {
    "straight": ([_square(_STRAIGHT)], (_X, _Y, _Z)),
    # dp/du is -x, and n x dp/du is -y, although v runs along +y.
    "mirrored u": ([_square(_MIRRORED)], (-_X, -_Y, _Z)),
    # u = (1 - y) / 2, so that dp/du is -y and n x dp/du is x.
    "turned": ([_square(_TURNED)], (_Y, -_X, _Z)),
    "mirrored world": (["Scale -1 1 1", _square(_STRAIGHT)], (-_X, -_Y, _Z)),
    "both mirrored": (["Scale -1 1 1", _square(_MIRRORED)], (_X, _Y, _Z)),
    # n is -z: the normal is x dp/du - y (z x dp/du) - z z, of which the other side is seen.
    "reversed": (["ReverseOrientation", _square(_STRAIGHT)], (-_X, _Y, _Z)),
    "copy": ([_CARD.format(_square(_STRAIGHT)), 'ObjectInstance "card"'], (_X, _Y, _Z)),
    "mirrored copy": ([_CARD.format(_square(_STRAIGHT)), "Scale -1 1 1", 'ObjectInstance "card"'], (-_X, -_Y, _Z)),
}
# Normals are taken along by the inverse transpose, and ReverseOrientation turns them over together with the side.
_OF_VERTICES = {
    "plain": ([quad(_CORNERS, _PLAIN)], (_X, _Y, _Z)),
    "other winding": ([quad(_CORNERS[::-1], _PLAIN)], (_X, _Y, _Z)),
    "stretched": (["Scale 1 2 1", quad(_CORNERS, _PLAIN)], unit((_X, _Y / 2, _Z))),
    "mirrored": (["Scale -1 1 1", quad(_CORNERS, _PLAIN)], (-_X, _Y, _Z)),
    # z' = z + x/2, so that the inverse transpose takes half of z from x.
    "sheared": (["ConcatTransform [1 0 .5 0  0 1 0 0  0 0 1 0  0 0 0 1]", quad(_CORNERS, _PLAIN)],
                unit((_X - _Z / 2, _Y, _Z))),
    "turned": (["Rotate 90 0 0 1", quad(_CORNERS, _PLAIN)], (-_Y, _X, _Z)),
    "reversed": (["ReverseOrientation", quad(_CORNERS, _PLAIN)], (_X, _Y, _Z)),
}
_OF_VERSION_3 = {name: case for name, case in _OF_VERTICES.items() if name in ("plain", "stretched", "turned")}


def _source(cases: dict, light: tuple[int, int, int], material: str, version: int = 4) -> Source:
    count = len(cases)
    point = "point3" if version == 4 else "point"
    world = f'LightSource "distant" "{point} from" [{numbers(light)}] "{point} to" [0 0 0]\n{material}\n'
    for index, (statements, _) in enumerate(cases.values()):
        # An object's copies stand where the transformation of its definition and that of the copy put it.
        placed = [statement.replace('"card"', f'"card {index}"') for statement in statements]
        *defined, last = placed if "ObjectBegin" in placed[0] else ["", *placed]
        world += defined[0] + attributes(f"Translate {2 * index + 1} 1 0", *defined[1:], last)
    before = (f"Scale -1 1 1\nLookAt {count} 1 5  {count} 1 0  0 1 0\n"
              f'Camera "orthographic" "float screenwindow" [{-count} {count} -1 1]\n' + film(2 * count, 2, version))
    return Source(scene(before, world, 1, version), {"n.png": png([[_TEXEL]])})


_SETS = {
    "map": (_MAPPED, 'Material "diffuse" "rgb reflectance" [.8 .8 .8] "string normalmap" "n.png"', 4),
    "vertices": (_OF_VERTICES, 'Material "diffuse" "rgb reflectance" [.8 .8 .8]', 4),
    "v3": (_OF_VERSION_3, 'Material "matte" "rgb Kd" [.8 .8 .8]', 3),
}


class Normals(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 2}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {f"{name}-{light}": _source(cases, direction, material, version)
                for name, (cases, material, version) in _SETS.items() for light, direction in _LIGHTS.items()}

    def test_cosines(self) -> None:
        for which, (cases, *_) in _SETS.items():
            for light, direction in _LIGHTS.items():
                for index, (name, (_, normal)) in enumerate(cases.items()):
                    with self.subTest(name, which=which, light=light):
                        expected = 0.8 / math.pi * max(0.0, float(np.dot(normal, unit(direction))))
                        seen = self.pictures[f"{which}-{light}"].radiance[:, 2 * index:2 * index + 2]
                        self.assert_near(seen, expected, 2e-3 * expected + 1e-6)


if __name__ == "__main__":
    unittest.main()
