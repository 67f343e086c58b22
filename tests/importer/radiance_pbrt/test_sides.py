"""Which side of a shape shines in pbrt, and where the copies of an object stand, seen in pictures.

A lamp shines on the side of its surface's normal (DiffuseAreaLight::L). The normal of a triangle is (p1 - p0) x (p2 - p0),
or on the side of its vertex normals; of a bilinear patch dp/du x dp/dv; of a sphere and a cylinder outwards; of a disk +z.
ReverseOrientation turns it over. What a mirroring transformation does to the order of corners, pbrt takes back
(Shape::transformSwapsHandedness)."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_rendering import View, attributes, film, numbers, scene
from rendering import RadianceTest, Source

_CELL = 4  # pixels along the side of a cell of 1, in which one card stands
_RADIANCE = (3.0, 2.0, 1.0)

_TRIANGLE = 'Shape "trianglemesh" "point3 P" [-.49 -.49 0  .49 -.49 0  0 .95 0] "integer indices" [{}] {}'
_FORWARD, _BACKWARD = "0 1 2", "0 2 1"  # counter-clockwise from +z, and clockwise
_TOWARDS, _AWAY = ('"normal3 N" [' + f"0 0 {z} " * 3 + "]" for z in (1, -1))
_PATCH = 'Shape "bilinearmesh" "point3 P" [{}]'
_PATCH_FORWARD, _PATCH_BACKWARD = "-.4 -.4 0  .4 -.4 0  -.4 .4 0  .4 .4 0", "-.4 -.4 0  -.4 .4 0  .4 -.4 0  .4 .4 0"
_DISK, _BALL = 'Shape "disk" "float radius" .4', 'Shape "sphere" "float radius" .4'
_TUBE = 'Shape "cylinder" "float radius" .4 "float zmin" -.45 "float zmax" .45'
_REVERSED = "ReverseOrientation"
_PLY = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{}"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n{}3 0 1 2\n")
_CORNERS = ("-.49 -.49 0", ".49 -.49 0", "0 .95 0")

# Statements of a shape, and whether it shines towards +z.
_CARDS: dict[str, tuple[list[str], bool]] = {
    "triangle": ([_TRIANGLE.format(_FORWARD, "")], True),
    "triangle, clockwise": ([_TRIANGLE.format(_BACKWARD, "")], False),
    "triangle, reversed": ([_REVERSED, _TRIANGLE.format(_FORWARD, "")], False),
    "triangle, clockwise and reversed": ([_REVERSED, _TRIANGLE.format(_BACKWARD, "")], True),
    "triangle, reversed twice": ([_REVERSED, _REVERSED, _TRIANGLE.format(_FORWARD, "")], True),
    "triangle, mirrored": (["Scale -1 1 1", _TRIANGLE.format(_FORWARD, "")], True),
    "triangle, mirrored and reversed": (["Scale -1 1 1", _REVERSED, _TRIANGLE.format(_FORWARD, "")], False),
    "triangle, sheared and mirrored": (["Scale -1 1 1\nConcatTransform [1 0 0 0  .1 1 0 0  0 0 1 0  0 0 0 1]",
                                        _TRIANGLE.format(_FORWARD, "")], True),
    "triangle, mirrored along z": (["Scale 1 1 -1", _TRIANGLE.format(_FORWARD, "")], False),
    "triangle, turned over": (["Rotate 180 0 1 0", _TRIANGLE.format(_FORWARD, "")], False),
    "normals away": ([_TRIANGLE.format(_FORWARD, _AWAY)], False),
    "normals towards": ([_TRIANGLE.format(_BACKWARD, _TOWARDS)], True),
    "normals towards, reversed": ([_REVERSED, _TRIANGLE.format(_BACKWARD, _TOWARDS)], False),
    "normals towards, mirrored": (["Scale -1 1 1", _TRIANGLE.format(_BACKWARD, _TOWARDS)], True),
    "patch": ([_PATCH.format(_PATCH_FORWARD)], True),
    "patch, other way": ([_PATCH.format(_PATCH_BACKWARD)], False),
    "patch, reversed": ([_REVERSED, _PATCH.format(_PATCH_FORWARD)], False),
    "disk": ([_DISK], True),
    "disk, reversed": ([_REVERSED, _DISK], False),
    "disk, turned over": (["Rotate 180 1 0 0", _DISK], False),
    "ball": ([_BALL], True),
    "ball, reversed": ([_REVERSED, _BALL], False),
    "tube": (["Rotate 90 1 0 0", _TUBE], True),
    "tube, reversed": (["Rotate 90 1 0 0", _REVERSED, _TUBE], False),
    "ply": (['Shape "plymesh" "string filename" "plain.ply"'], True),
    "ply, reversed": ([_REVERSED, 'Shape "plymesh" "string filename" "plain.ply"'], False),
    "ply, normals away": (['Shape "plymesh" "string filename" "normals.ply"'], False),
}


def _cards(is_two_sided: bool, version: int) -> Source:
    """In a row along x, a cell each, seen from +z with x to the right."""
    said = ("true" if is_two_sided else "false") if version == 4 else f'"{"true" if is_two_sided else "false"}"'
    light = f'AreaLightSource "diffuse" "rgb L" [{numbers(_RADIANCE)}] "bool twosided" {said}'
    world = "".join(attributes(f"Translate {cell + 0.5} .5 0", light, *shape)
                    for cell, (shape, _) in enumerate(_shapes(version).values()))
    files = {"plain.ply": _PLY.format("", "\n".join(_CORNERS) + "\n"),
             "normals.ply": _PLY.format("".join(f"property float n{axis}\n" for axis in "xyz"),
                                        "".join(f"{corner} 0 0 -1\n" for corner in _CORNERS))}
    count = len(_shapes(version))
    before = (f"Scale -1 1 1\nLookAt {count / 2} .5 5  {count / 2} .5 0  0 1 0\n"
              f'Camera "orthographic" "float screenwindow" [{-count / 2} {count / 2} -.5 .5]\n'
              + film(count * _CELL, _CELL, version))
    return Source(scene(before, world, version=version), files)


def _shapes(version: int) -> dict[str, tuple[list[str], bool]]:
    """Version 3 has no bilinear patches, and does not agree with itself about meshes with normals that are reversed or
    mirrored (Triangle::Intersect, ::Sample)."""
    return {name: card for name, card in _CARDS.items()
            if version == 4 or not (name.startswith("patch") or name.startswith("normals towards,"))}


class Sides(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 4}
    ROWS = ((3, "one"), (4, "one"), (4, "both"))

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {f"v{version}-{sides}": _cards(sides == "both", version) for version, sides in cls.ROWS}

    def test_a_lamp_shines_on_the_side_of_its_normal(self) -> None:
        for version, sides in self.ROWS:
            radiance = self.pictures[f"v{version}-{sides}"].radiance
            for cell, (name, (_, is_lit)) in enumerate(_shapes(version).items()):
                with self.subTest(name, version=version, sides=sides):
                    # Two pixels of 1/4 below the middle, which each of the shapes covers.
                    seen = radiance[2, cell * _CELL + 1:cell * _CELL + 3]
                    self.assert_near(seen, np.array(_RADIANCE) * (is_lit or sides == "both"), 1e-5)


_OBJECT = """ObjectBegin "pair"
  AttributeBegin
    {red}
    Translate 0 0 .1
    {card}
  AttributeEnd
  AttributeBegin
    {green}
    Translate 1 0 .1
    {card}
  AttributeEnd
ObjectEnd
"""
_CARD = 'Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  1 1 0  0 1 0] "integer indices" [0 1 2 0 2 3]'


def _instances(version: int) -> Source:
    """A pair of cards, red from (0, 0) to (1, 1) and green to its right, shown four times on a board of 6 x 4."""
    kind, role = ("diffuse", "reflectance") if version == 4 else ("matte", "Kd")
    red, green = (f'Material "{kind}" "rgb {role}" [{colour}]' for colour in (".8 .1 .1", ".1 .7 .1"))
    copies = [attributes(where, 'ObjectInstance "pair"') for where in (
        "Translate 0 0 0",  # red at (0, 0), green at (1, 0)
        "Translate 4 0 0\nRotate 90 0 0 1",  # x becomes y, y becomes -x: red at (3, 0), green at (3, 1)
        "Translate 6 2 0\nScale -1 1 1",  # red at (5, 2), green at (4, 2)
        "Translate 0 2 0\nScale .5 2 1",  # half as wide, twice as high: red at 0 to .5, green at .5 to 1
    )]
    sky = 'LightSource "infinite" "rgb L" [1 1 1]\n'
    # What holds where the object is defined is part of it.
    defined = attributes("Translate 0 0 .2", _OBJECT.format(red=red, green=green, card=_CARD)) if version == 4 else (
        "TransformBegin\nTranslate 0 0 .2\n" + _OBJECT.format(red=red, green=green, card=_CARD) + "TransformEnd\n")
    before = ("Scale -1 1 1\nLookAt 3 2 5  3 2 0  0 1 0\n"
              'Camera "orthographic" "float screenwindow" [-3 3 -2 2]\n' + film(24, 16, version))
    return Source(scene(before, sky + defined + "".join(copies), 1, version))


class Instances(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 4}
    VIEW = View((3, 2, 5), (1, 0, 0), (0, 1, 0), (0, 0, -1), 3, 2, 24, 16, True)

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {"v3": _instances(3), "v4": _instances(4)}

    def test_copies_stand_where_they_are_put(self) -> None:
        red, green, sky = (0.8, 0.1, 0.1), (0.1, 0.7, 0.1), (1.0, 1.0, 1.0)
        at = {(0, 0): red, (1, 0): green, (3, 0): red, (3, 1): green, (5, 2): red, (4, 2): green}
        for version in ("v3", "v4"):
            for y in range(4):
                for x in range(6):
                    for dx in (0.25, 0.75):
                        colour = at.get((x, y), sky)
                        if x == 0 and y >= 2:
                            colour = red if dx < 0.5 else green
                        column, row = np.floor(self.VIEW.pixel((x + dx, y + 0.5, 0))).astype(int)
                        self.assert_near(self.pictures[version].radiance[row, column], colour, 1e-3, f"{version} {x} {y}")


if __name__ == "__main__":
    unittest.main()
