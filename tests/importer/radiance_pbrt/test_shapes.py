"""Where the texels of a texture and the light of a lamp are on pbrt's shapes, seen in pictures.

Each shape is what the book's parametric form makes of u and v (pbr-book, chapter 6); a texture of 16 squares is looked up
where ImageTexture::Evaluate does, v upwards, and each square must be seen where the form puts it. A white sky over a convex
matt shape makes each point as bright as its reflectance."""

from __future__ import annotations

import sys
import unittest
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_rendering import View, attributes, film, look_at, numbers, quad, scene, tangent
from pbrt_scene import png
from rendering import RadianceTest, Source

Point = Callable[[float, float], tuple[np.ndarray, np.ndarray]]  # of u and v: place and outward normal, in object space

_SIZE, _FOV = 80, 30.0
_SQUARES, _TEXELS = 4, 16  # a texture's squares along a side, and texels along a square's
_HALF = 0.42  # of a square: within it and a texel from its border, where texels are not blended
_TOLERANCE = 3e-3  # a texture's 16-bit floats, and Mesh's chords for arcs, which move colours by less than a texel
_RNG = np.random.default_rng(7)
_VALUES = _RNG.integers(30, 256, (_SQUARES, _SQUARES, 3))  # in 8-bit sRGB; row 0 is the image's top


def _image() -> bytes:
    return png(np.kron(_VALUES, np.ones((_TEXELS, _TEXELS, 1))).astype(np.uint8))


def _linear(values: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1."""
    x = values / 255
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def _upwards(eye: tuple[float, float, float]) -> tuple[float, float, float]:
    return (0, 0, 1) if any(eye[:2]) else (0, 1, 0)


@dataclass(frozen=True)
class Textured:
    """A shape under the texture. `to_world`: statements, and what they do; `scale` and `offset` are those of the texture's
    mapping, s = scale u + offset."""

    shape: str
    point: Point
    eye: tuple[float, float, float]
    before: str = ""
    to_world: Callable[[np.ndarray], np.ndarray] = lambda point: point
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)
    more: str = ""  # of the texture
    version: int = 4
    files: dict[str, str] = field(default_factory=dict)

    @property
    def view(self) -> View:
        half = tangent(_FOV / 2)
        return look_at(self.eye, (0, 0, 0), _upwards(self.eye), half, half, _SIZE, _SIZE)


def _sphere(radius: float, low: float, high: float, phi_max: float) -> Point:
    ends = np.arccos(low / radius), np.arccos(high / radius)

    def point(u: float, v: float) -> tuple[np.ndarray, np.ndarray]:
        phi, theta = np.radians(phi_max) * u, ends[0] + v * (ends[1] - ends[0])
        normal = np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
        return radius * normal, normal
    return point


def _cylinder(radius: float, low: float, high: float, phi_max: float) -> Point:
    def point(u: float, v: float) -> tuple[np.ndarray, np.ndarray]:
        phi = np.radians(phi_max) * u
        normal = np.array([np.cos(phi), np.sin(phi), 0])
        return radius * normal + (0, 0, low + v * (high - low)), normal
    return point


def _disk(height: float, radius: float, inner: float, phi_max: float) -> Point:
    """v is 0 at the rim."""
    def point(u: float, v: float) -> tuple[np.ndarray, np.ndarray]:
        phi, r = np.radians(phi_max) * u, radius - v * (radius - inner)
        return np.array([r * np.cos(phi), r * np.sin(phi), height]), np.array([0.0, 0, 1])
    return point


def _patch(p00: object, p10: object, p01: object, p11: object) -> Point:
    """Flat ones, in the plane of x and y."""
    corners = [np.asarray(corner, float) for corner in (p00, p10, p01, p11)]

    def point(u: float, v: float) -> tuple[np.ndarray, np.ndarray]:
        weights = (1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v
        return sum(w * p for w, p in zip(weights, corners)), np.array([0.0, 0, 1])
    return point


def _triangle(corners: object, uvs: object) -> Point:
    """The point of u and v, also outside of the triangle, which is in the plane of x and y."""
    corners, uvs = np.asarray(corners, float), np.asarray(uvs, float)

    def point(u: float, v: float) -> tuple[np.ndarray, np.ndarray]:
        weights = np.linalg.solve(np.vstack([uvs.T, np.ones(3)]), (u, v, 1))
        inside = (weights > 0.02).all()
        return weights @ corners, np.array([0.0, 0, 1 if inside else -1])
    return point


_PLY = """ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property float {u}
property float {v}
element face 1
property list uchar int vertex_indices
end_header
-1 -1 0 0 0
1 -1 0 1 0
1 1 0 1 1
-1 1 0 0 1
3 0 1 2
"""
_SQUARE = ((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0))
_TURNED_UVS = '"point2 uv" [1 0  1 1  0 1  0 0]'  # of those corners: u = (1 - y) / 2, v = (1 + x) / 2


def _turned_square(u: float, v: float) -> tuple[np.ndarray, np.ndarray]:
    return np.array([2 * v - 1, 1 - 2 * u, 0]), np.array([0.0, 0, 1])


def _cases() -> dict[str, Textured]:
    square = _patch((-1, -1, 0), (1, -1, 0), (-1, 1, 0), (1, 1, 0))
    ball, above = _sphere(1.2, -1.2, 1.2, 360), (0, 0, 5)
    cases = {f"sphere-{index}": Textured('Shape "sphere" "float radius" 1.2', ball, eye)
             for index, eye in enumerate([(5.0, 1, 2), (-2, -5, -1)])}
    cases |= {
        "sphere-partial": Textured('Shape "sphere" "float radius" 1.5 "float zmin" -.6 "float zmax" 1.2 "float phimax" 250',
                                   _sphere(1.5, -0.6, 1.2, 250), (2, 6, 1)),
        # Rotate takes x to y to -x; Translate comes first in the file and so last for a point.
        "sphere-moved": Textured('Shape "sphere" "float radius" 1.2', ball, (5, 1, 2), "Translate 0 .3 .1\nRotate 90 0 0 1",
                                 lambda p: np.array([-p[1], p[0] + 0.3, p[2] + 0.1])),
        "sphere-mirrored": Textured('Shape "sphere" "float radius" 1.2', ball, (5, 1, 2), "Scale -1 1 1",
                                    lambda p: p * (-1, 1, 1)),
        "sphere-reversed": Textured('ReverseOrientation\nShape "sphere" "float radius" 1.2', ball, (5, 1, 2)),
        "cylinder": Textured('Shape "cylinder" "float radius" .9 "float zmin" -1 "float zmax" 1.2 "float phimax" 270',
                             _cylinder(0.9, -1, 1.2, 270), (2, 6, 0.5)),
        "disk": Textured('Shape "disk" "float radius" 1.3 "float innerradius" .3 "float height" .2 "float phimax" 300',
                         _disk(0.2, 1.3, 0.3, 300), (1, 1, 6)),
        "mesh": Textured(quad(_SQUARE, _TURNED_UVS), _turned_square, above),
        "triangle-default": Textured('Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  0 1 0] "integer indices" [0 1 2]',
                                     _triangle(((-1, -1, 0), (1, -1, 0), (0, 1, 0)), ((0, 0), (1, 0), (1, 1))), above),
        "patch-default": Textured('Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -.5 1 0  1.2 .8 0]',
                                  _patch((-1, -1, 0), (1, -1, 0), (-0.5, 1, 0), (1.2, 0.8, 0)), above),
        "patch": Textured('Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0] '
                          '"point2 uv" [1 0  1 1  0 0  0 1]', _turned_square, above),
        "ply-uv": Textured('Shape "plymesh" "string filename" "a.ply"', square, above,
                           files={"a.ply": _PLY.format(u="u", v="v").replace("face 1", "face 2") + "3 0 2 3\n"}),
        "ply-st": Textured('Shape "plymesh" "string filename" "a.ply"', square, above,
                           files={"a.ply": _PLY.format(u="s", v="t").replace("3 0 1 2", "4 0 1 2 3")}),
        "mapped": Textured(quad(_SQUARE, _TURNED_UVS), _turned_square, above, scale=(2, -1), offset=(0.3, 0.85)),
        "version-3": Textured(quad(_SQUARE, _TURNED_UVS.replace("point2", "float")), _turned_square, above, version=3),
    }
    return cases


def _source(case: Textured) -> Source:
    look = f"LookAt {numbers(case.eye)}  0 0 0  {numbers(_upwards(case.eye))}\n"
    before = look + f'Camera "perspective" "float fov" {_FOV}\n' + film(_SIZE, _SIZE, case.version)
    mapping = " ".join(f'"float {name}" {value}' for name, value in zip(("uscale", "vscale", "udelta", "vdelta"),
                                                                         (*case.scale, *case.offset)))
    kind, material, role = (("spectrum", "diffuse", "reflectance") if case.version == 4 else ("color", "matte", "Kd"))
    world = (f'LightSource "infinite" "rgb L" [1 1 1]\nTexture "t" "{kind}" "imagemap" "string filename" "t.png" {mapping}'
             f' {case.more}\nMaterial "{material}" "texture {role}" "t"\n') + attributes(case.before, case.shape)
    return Source(scene(before, world, 1, case.version), {"t.png": _image(), **case.files})


def _expected(case: Textured) -> list[tuple[tuple[int, int], np.ndarray]]:
    """Pixels (row, column) that see nothing but one square of the texture, and its colour."""
    found = []
    eye, view = np.asarray(case.eye, float), case.view
    steps = np.arange(0.5 / 40, 1, 1 / 40)
    for u in steps:
        for v in steps:
            st = np.array([u, v]) * case.scale + case.offset
            place = np.mod(st * _SQUARES, 1)
            point, normal = (case.to_world(x) for x in case.point(u, v))
            moved = normal - case.to_world(np.zeros(3))
            towards = eye - point
            if min(u, v, 1 - u, 1 - v) < 0.03:  # the shape's own border
                continue
            if np.abs(place - 0.5).max() > 0.2 or moved @ towards < 0.35 * np.linalg.norm(towards):
                continue
            middle = np.floor(view.pixel(point)) + 0.5
            # The square's border, which must be farther away than the pixel's corners are.
            ring = [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if (a, b) != (0, 0)]
            edge = [(np.floor(st * _SQUARES) + 0.5 + _HALF * np.array(side)) / _SQUARES for side in ring]
            seen = [view.pixel(case.to_world(case.point(*((e - case.offset) / case.scale))[0])) for e in edge]
            if min(np.linalg.norm(place - middle) for place in seen) < 1.2 or not (0 < middle).all() or middle.max() > _SIZE:
                continue
            column, row = np.floor(np.mod(st, 1) * _SQUARES).astype(int)
            colour = _linear(_VALUES[_SQUARES - 1 - row, column])
            found.append(((int(middle[1]), int(middle[0])), colour))
    return found


class Textures(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 4}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {name: _source(case) for name, case in _cases().items()}

    def test_squares_are_seen_where_the_parametric_form_puts_them(self) -> None:
        for name, case in _cases().items():
            with self.subTest(name):
                pixels, colours = zip(*_expected(case))
                self.assertGreater(len(set(map(tuple, colours))), 3)
                rows, columns = np.array(pixels).T
                self.assert_near(self.pictures[name].radiance[rows, columns], np.array(colours), _TOLERANCE, name)


if __name__ == "__main__":
    unittest.main()
