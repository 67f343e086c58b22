"""Mitsuba's shapes in pictures: where they stand, which texel shows at which pixel, and which side shines, ray by ray as
Mitsuba's sources define them."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import mitsuba_exhibits as gallery
import mitsuba_rays as rays
from mitsuba_exhibits import Colour, Exhibit, shape
from mitsuba_scenes import linear, png
from rendering import FIRST_HITS, Picture, RadianceTest, Source

TEXELS = np.random.default_rng(5).integers(20, 250, (4, 8, 3))
LINEAR = np.vectorize(linear)(TEXELS)
FILES = {"texels.png": png(TEXELS.tolist()), "square.obj": gallery.obj_square(), "square.ply": gallery.ply_square(),
         "square.serialized": gallery.serialized_square(), "normals.obj": gallery.obj_square(1.0),
         "against.obj": gallery.obj_square(-1.0), "reversed.obj": gallery.obj_square(is_reversed=True)}
NO_TURN: list[rays.Step] = [("scale", (0.6, 0.6, 0.6))]
TURN: list[rays.Step] = [*NO_TURN, ("rotate", (0.4, 1, -0.3, 40))]
OVER: list[rays.Step] = [*NO_TURN, ("rotate", (1, 0.2, 0.1, 215))]  # seen from behind
MIRRORED: list[rays.Step] = [("scale", (-0.6, 0.6, 0.6)), ("rotate", (0.4, 1, -0.3, 40))]
MIRRORED_Z: list[rays.Step] = [("scale", (0.6, 0.6, -0.6)), ("rotate", (0.4, 1, -0.3, 40))]
FLIPPED = '<boolean name="flip_normals" value="true"/>'


def texel(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Row 0 of the picture is at v = 0 (bitmap.cpp)."""
    return LINEAR[np.clip(np.floor(y * 4), 0, 3).astype(int), np.clip(np.floor(x * 8), 0, 7).astype(int)]


def repeated(uv: np.ndarray) -> np.ndarray:
    return texel(uv[..., 0] % 1, uv[..., 1] % 1)


def turned_over(uv: np.ndarray) -> np.ndarray:
    """The .obj's v is turned over as it is read (flip_tex_coords of obj.cpp is true)."""
    return repeated(uv * (1, -1) + (0, 1))


def moved(matrix: np.ndarray, then: Colour = repeated) -> Colour:
    return lambda uv: then(uv @ matrix[:2, :2].T + matrix[:2, 3])


def mirrored(uv: np.ndarray) -> np.ndarray:
    return texel(*(1 - abs(uv[..., i] % 2 - 1) for i in (0, 1)))


def clamped(uv: np.ndarray) -> np.ndarray:
    return texel(*(np.clip(uv[..., i], 0, 1) for i in (0, 1)))


def checkered(a: object, b: object, scale: float) -> Colour:
    """The first colour where both halves of the periods agree (checkerboard.cpp)."""
    def colour(uv: np.ndarray) -> np.ndarray:
        halves = uv * scale % 1 > 0.5
        return np.where((halves[..., 0] == halves[..., 1])[..., None], np.array(a, float), np.array(b, float))
    return colour


def bitmap(inside: str = "", name: str = "reflectance") -> str:
    return (f'<texture type="bitmap" name="{name}"><string name="filename" value="texels.png"/>'
            f'<string name="filter_type" value="nearest"/>{inside}</texture>')


def matt(texture: str) -> str:
    return f'<bsdf type="twosided"><bsdf type="diffuse">{texture}</bsdf></bsdf>'


PLAIN = matt(bitmap())
BALL = '<point name="center" x="0.1" y="-0.05" z="0.2"/><float name="radius" value="0.5"/>'
OWN_OF_BALL = rays.steps_matrix([("scale", (0.5, 0.5, 0.5)), ("translate", (0.1, -0.05, 0.2))])
# 0.6 takes the scale out of to_world before it moves the centre (Sphere::Sphere).
OWN_OF_OLD_BALL = rays.steps_matrix([("scale", (0.4, 0.4, 0.4)), ("translate", (0.1, -0.05, 0.2)), ("scale", (1.25,) * 3)])
TUBE = '<point name="p0" x="0" y="0" z="-0.5"/><point name="p1" x="0" y="0" z="0.7"/><float name="radius" value="0.8"/>'
OWN_OF_TUBE = rays.steps_matrix([("scale", (0.8, 0.8, 1.2)), ("translate", (0, 0, -0.5))])
SQUARES = {kind: shape(kind, f'<string name="filename" value="square.{kind}"/>') for kind in ("obj", "ply", "serialized")}
SHAPES = [
    Exhibit("ball", shape("sphere", BALL), [("rotate", (0.4, 1, -0.3, 40))], rays.sphere, repeated, PLAIN, OWN_OF_BALL),
    Exhibit("moved ball", shape("sphere"), OVER, rays.sphere, repeated, PLAIN),
    Exhibit("cylinder", shape("cylinder", TUBE), [*NO_TURN, ("rotate", (1, 0.3, 0.1, 65))], rays.cylinder, repeated, PLAIN,
            OWN_OF_TUBE),
    Exhibit("mirrored cylinder", shape("cylinder", TUBE), [*MIRRORED, ("rotate", (1, 0, 0, -50))], rays.cylinder, repeated,
            PLAIN, OWN_OF_TUBE),
    Exhibit("disk", shape("disk"), TURN, rays.disk, repeated, PLAIN),
    Exhibit("rectangle", shape("rectangle"), TURN, rays.rectangle, repeated, PLAIN),
    Exhibit("rectangle from behind", shape("rectangle"), OVER, rays.rectangle, repeated, PLAIN),
    Exhibit("cube", shape("cube"), [("scale", (0.4, 0.3, 0.5)), ("rotate", (0.4, 1, -0.3, 40))], rays.cube, repeated, PLAIN),
    Exhibit("cube from behind", shape("cube"), [("scale", (0.4, 0.4, 0.4)), ("rotate", (1, 0.6, 0.1, 215))], rays.cube,
            repeated, PLAIN),
    Exhibit("mirrored rectangle", shape("rectangle"), MIRRORED, rays.rectangle, repeated, PLAIN),
    Exhibit("obj", SQUARES["obj"], TURN, rays.rectangle, turned_over, PLAIN),
    Exhibit("ply", SQUARES["ply"], TURN, rays.rectangle, repeated, PLAIN),
    Exhibit("serialized", SQUARES["serialized"], TURN, rays.rectangle, repeated, PLAIN)]
TO_UV: list[rays.Step] = [("scale", (2, 3, 1)), ("rotate", (0, 0, 1, 30)), ("translate", (0.2, -0.1, 0))]
THRICE: list[rays.Step] = [("scale", (3, 3, 1)), ("translate", (-1.2, -0.7, 0))]
GROUP = f'<shape type="shapegroup" id="group"><shape type="rectangle">{{moved}}{PLAIN}</shape></shape>'
MASK = ('<bsdf type="mask"><texture type="checkerboard" name="opacity"><rgb name="color0" value="0"/>'
        f'<rgb name="color1" value="1"/>{{}}</texture>{PLAIN}</bsdf>')
CHECKERS = '<texture type="checkerboard" name="reflectance"><rgb name="color0" value="0.7, 0.2, 0.1"/>{}</texture>'
# What only one version has: the textures' transforms.
TEXTURES_3 = [
    Exhibit("to_uv", shape("rectangle"), TURN, rays.rectangle, moved(rays.steps_matrix(TO_UV)),
            matt(bitmap(rays.steps_xml(TO_UV, "to_uv")))),
    Exhibit("mirrored repeats", shape("rectangle"), TURN, rays.rectangle, moved(rays.steps_matrix(THRICE), mirrored),
            matt(bitmap(rays.steps_xml(THRICE, "to_uv") + '<string name="wrap_mode" value="mirror"/>'))),
    Exhibit("clamp", shape("rectangle"), TURN, rays.rectangle, moved(rays.steps_matrix(THRICE), clamped),
            matt(bitmap(rays.steps_xml(THRICE, "to_uv") + '<string name="wrap_mode" value="clamp"/>'))),
    Exhibit("checkerboard", shape("rectangle"), TURN, rays.rectangle, checkered((0.7, 0.2, 0.1), (0.2, 0.2, 0.2), 3),
            matt(CHECKERS.format(rays.steps_xml([("scale", (3, 3, 1))], "to_uv")))),
    Exhibit("checkerboard of no period", shape("rectangle"), TURN, rays.rectangle,
            checkered((0.7, 0.2, 0.1), (0.2, 0.2, 0.2), 1), matt(CHECKERS.format(""))),
    Exhibit("mask", shape("rectangle"), TURN, rays.rectangle,
            lambda uv: np.where(np.isnan(checkered((np.nan,) * 3, (1, 1, 1), 2)(uv)), np.nan, repeated(uv)),
            MASK.format(rays.steps_xml([("scale", (2, 2, 1))], "to_uv"))),
    Exhibit("obj as it is", shape("obj", '<string name="filename" value="square.obj"/>'
                                         '<boolean name="flip_tex_coords" value="false"/>'), TURN, rays.rectangle, repeated,
            PLAIN),
    Exhibit("instance", '<shape type="instance">{transform}<ref id="group"/>{inside}</shape>', TURN, rays.rectangle,
            repeated, "", rays.steps_matrix([("scale", (1, 0.5, 1)), ("rotate", (0, 0, 1, 70))]))]
OLD_UV = '<float name="uscale" value="2"/><float name="vscale" value="3"/><float name="uoffset" value="0.2"/>'
TEXTURES_OLD = [
    Exhibit("uscale", shape("rectangle"), TURN, rays.rectangle,
            moved(rays.steps_matrix([("scale", (2, 3, 1)), ("translate", (0.2, 0, 0))])), matt(bitmap(OLD_UV))),
    Exhibit("checkerboard", shape("rectangle"), TURN, rays.rectangle, checkered((0.7, 0.2, 0.1), (0.2, 0.2, 0.2), 3),
            matt(CHECKERS.format('<float name="uvscale" value="3"/>'))),
    Exhibit("scaled ball", shape("sphere", BALL), [("scale", (0.8, 0.8, 0.8)), ("rotate", (0.4, 1, -0.3, 40))], rays.sphere,
            repeated, PLAIN, OWN_OF_OLD_BALL)]
GROUP_XML = GROUP.format(moved=rays.steps_xml([("scale", (1, 0.5, 1)), ("rotate", (0, 0, 1, 70))]))


class WhatIsSeenTest(RadianceTest):
    @classmethod
    def sources(cls) -> dict[str, Source]:
        scenes = {"3": gallery.scene(SHAPES, "3.0.0"), "0.6": gallery.scene(SHAPES, "0.6.0"),
                  "textures 3": gallery.scene(TEXTURES_3, "3.0.0", also=GROUP_XML),
                  "textures 0.6": gallery.scene(TEXTURES_OLD, "0.6.0")}
        return {name: Source(text, FILES, keys=FIRST_HITS) for name, text in scenes.items()}

    def compare(self, picture: Picture, exhibits: list[Exhibit]) -> None:
        seen = gallery.view(exhibits)
        for index, exhibit in enumerate(exhibits):
            with self.subTest(exhibit.name):
                where = seen.is_even & (seen.index == index)
                self.assertGreater(where.sum(), 25)
                self.assert_near(picture.albedo[where], seen.colour[where], 2e-3, "the texel")
                self.assert_near(picture.position[where], seen.position[where], 3e-3, "the place")
                aligned = abs((picture.normal[where] * seen.normal[where]).sum(-1))
                self.assert_near(aligned, 1, 1e-3, "the normal's cosine")
        self.assertFalse((picture.is_hit & seen.is_even & (seen.index < 0)).any(), "something stands where nothing should")

    def test_shapes_of_3(self) -> None:
        self.compare(self.pictures["3"], SHAPES)

    def test_shapes_of_the_older_version(self) -> None:
        self.compare(self.pictures["0.6"], SHAPES)

    def test_textures_of_3(self) -> None:
        self.compare(self.pictures["textures 3"], TEXTURES_3)

    def test_textures_of_the_older_version(self) -> None:
        self.compare(self.pictures["textures 0.6"], TEXTURES_OLD)


def lamps(is_old: bool) -> list[Exhibit]:
    """Light leaves on the side of the shading normal (AreaLight::eval). Of a mirrored ball that is inside in 3
    (Sphere::update), and outside in 0.6; of a mirrored cylinder inside, since it is the cross product of its tangents. A
    mesh without normals has those of the order of its corners in the world."""
    def lamp(name: str, kind: str, steps: list[rays.Step], hits: object, sign: int = 1, inside: str = "",
             own: np.ndarray | None = None, extra: str = "") -> Exhibit:
        colour = np.array((1 + len(found) / 4, 1.0, 0.5))
        emitter = extra + '<emitter type="area"><rgb name="radiance" value="{}, {}, {}"/></emitter>'.format(*colour)
        return Exhibit(name, shape(kind, inside), steps, hits, lambda uv: np.broadcast_to(colour, (*uv.shape[:-1], 3)),
                       emitter, own, sign)

    found: list[Exhibit] = []
    tilted: list[rays.Step] = [("rotate", (1, 0.3, 0.1, 50))]
    cases = [
        ("ball", "sphere", TURN, rays.sphere), ("flipped ball", "sphere", TURN, rays.sphere, -1, FLIPPED),
        ("mirrored ball", "sphere", [*MIRRORED], rays.sphere, 1 if is_old else -1),
        ("tube", "cylinder", [*NO_TURN, *tilted], rays.cylinder, 1, TUBE, OWN_OF_TUBE),
        ("flipped tube", "cylinder", [*NO_TURN, *tilted], rays.cylinder, -1, TUBE + FLIPPED, OWN_OF_TUBE),
        ("mirrored tube", "cylinder", [*MIRRORED, *tilted], rays.cylinder, -1, TUBE, OWN_OF_TUBE),
        ("disk", "disk", TURN, rays.disk), ("rectangle mirrored in x", "rectangle", MIRRORED, rays.rectangle),
        ("rectangle mirrored in z", "rectangle", MIRRORED_Z, rays.rectangle),
        ("flipped rectangle", "rectangle", OVER, rays.rectangle, -1, FLIPPED),
        ("rectangle of two sides", "rectangle", OVER, rays.rectangle, 1, "", None, PLAIN),
        ("cube", "cube", [("scale", (-0.4, 0.3, 0.5)), ("rotate", (0.4, 1, -0.3, 40))], rays.cube),
        ("obj", "obj", TURN, rays.rectangle, 1, '<string name="filename" value="square.obj"/>'),
        ("mirrored obj", "obj", MIRRORED, rays.rectangle, -1, '<string name="filename" value="square.obj"/>'),
        ("obj against its normals", "obj", TURN, rays.rectangle, -1, '<string name="filename" value="against.obj"/>'),
        ("mirrored obj with normals", "obj", MIRRORED, rays.rectangle, 1, '<string name="filename" value="normals.obj"/>')]
    for case in cases:
        found.append(lamp(*case))
    return found


class WhatShinesTest(RadianceTest):
    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {f"{version} {'behind' if from_behind else 'before'}":
                Source(gallery.scene(lamps(version < "2"), version, from_behind), FILES, keys=FIRST_HITS)
                for version in ("3.0.0", "0.6.0") for from_behind in (False, True)}

    def compare(self, version: str) -> None:
        exhibits = lamps(version < "2")
        sides: dict[str, set[bool]] = {exhibit.name: set() for exhibit in exhibits}
        for from_behind in (False, True):
            picture = self.pictures[f"{version} {'behind' if from_behind else 'before'}"]
            seen = gallery.view(exhibits, from_behind)
            for index, exhibit in enumerate(exhibits):
                where = seen.is_even & (seen.index == index)
                with self.subTest(exhibit.name, from_behind=from_behind):
                    self.assertGreater(where.sum(), 25)
                    self.assert_near(picture.emission[where], seen.colour[where] * seen.is_front[where][:, None], 1e-3)
                sides[exhibit.name] |= set(seen.is_front[where].tolist())
        open_ones = [exhibit.name for exhibit in exhibits if "ball" not in exhibit.name and exhibit.name != "cube"]
        self.assertEqual({name for name in open_ones if len(sides[name]) < 2}, set(), "seen from one side alone")

    def test_lamps_of_3(self) -> None:
        self.compare("3.0.0")

    def test_lamps_of_the_older_version(self) -> None:
        self.compare("0.6.0")


if __name__ == "__main__":
    unittest.main()
