#!/usr/bin/env python3
"""Models the test scenes and writes them as simple, occluded, cornell_box, many_lights, furnace, door_ajar,
glossy_room, open_sky, sunlit_bath, lamp_in_fixture, corridor .glb, sunlit_sky.hdr and hard/*.glb.

Needs Python 3 and numpy only. The same bytes come out every time
(those of textures are zlib's, and so of its version). Lengths are
metres, y is up, colours are linear.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from corridor import CAMERA as CORRIDOR_CAMERA, corridor
from door_ajar import CAMERA as DOOR_CAMERA, door_ajar
from gltf_writer import Camera, Material, Object, write_glb
from glossy_room import CAMERA as GLOSSY_CAMERA, glossy_room
from hard import CAMERA as HARD_CAMERA, five_million, hard_scenes
from lamp_in_fixture import CAMERA as LAMP_CAMERA, lamp_in_fixture
from models import head, teapot
from open_sky import CAMERA as SKY_CAMERA, open_sky
from rooms import CAMERA as HOUSE_CAMERA, many_lights
from shapes import Vec, box, rectangle
from sky import write_sky
from sunlit_bath import CAMERA as BATH_CAMERA, sunlit_bath
from unwrap import Island, Mesh, pack

GREEN = Material("green", (0.10, 0.80, 0.13))
ORANGE_BROWN = Material("orange_brown", (0.80, 0.29, 0.10))
GREY = Material("grey", (0.80, 0.80, 0.80))

ROOM_CAMERA = Camera(eye=(0, 2.2, 3.5), target=(0, 3, 0), vertical_fov=60)
# At this distance the 5.488 high opening is slightly larger than the image.
CORNELL_CAMERA = Camera(eye=(0, 2.744, 7.7), target=(0, 2.744, 0), vertical_fov=39)
FURNACE_CAMERA = Camera(eye=(0, 0, 0), target=(0.3, 0.2, -1), vertical_fov=68)


def _quad(name: str, material: Material, centre: Vec, half_u: Vec, half_v: Vec) -> Object:
    """One rectangle that faces along half_u x half_v and fills its UV square."""
    return Object(name, pack([rectangle(centre, half_u, half_v)]), material)


def _solid(name: str, material: Material, islands: list[Island]) -> Object:
    return Object(name, pack(islands), material)


def _room_walls() -> list[Object]:
    """A 10 x 5 x 10 room, seen from inside; `front` is behind the camera."""
    def wall(name: str, colour: Vec, centre: Vec, half_u: Vec, half_v: Vec) -> Object:
        return _quad(name, Material(name, tuple(colour)), centre, half_u, half_v)

    return [
        wall("wall_left", (1, 0.8, 0.78), (-5, 2.5, 0), (0, 0, -5), (0, 2.5, 0)),
        wall("wall_right", (1, 1, 0.9), (5, 2.5, 0), (0, 0, 5), (0, 2.5, 0)),
        wall("wall_front", (0.96, 0.6, 0.29), (0, 2.5, 5), (-5, 0, 0), (0, 2.5, 0)),
        wall("wall_back", (0.63, 0.82, 0.37), (0, 2.5, -5), (5, 0, 0), (0, 2.5, 0)),
        wall("ceiling", (0.16, 0.45, 0.9), (0, 5, 0), (5, 0, 0), (0, 0, 5)),
        wall("floor", (0.9, 0.85, 0.78), (0, 0, 0), (5, 0, 0), (0, 0, -5)),
    ]


def _room_light() -> Object:
    """A 2 x 2 panel that shines downwards only."""
    panel = Material("light", (0, 0, 0), (16.6, 27.4, 30))
    return _quad("light", panel, (0, 4.85, 0), (1, 0, 0), (0, 0, 1))


def _table() -> list[Object]:
    top = _solid("table_top", ORANGE_BROWN, box((0, 1.25, 0), (2, 0.1, 2)))
    corners = [(-0.8, 0.8), (0.8, 0.8), (0.8, -0.8), (-0.8, -0.8)]
    legs = [_solid(f"table_leg_{i}", ORANGE_BROWN, box((x, 0.6, z), (0.1, 1.2, 0.1)))
            for i, (x, z) in enumerate(corners, start=1)]
    return [top, *legs]


def _exhibits() -> list[Object]:
    """Head on the table, teapot and cube floating; none hides or touches another."""
    return [
        _solid("head", GREEN, head(0.56, math.radians(20), (-0.52, 1.3, 0.2))),
        _solid("teapot", GREEN, teapot(math.radians(-20), (0.44, 1.6, 0.3))),
        _solid("cube", GREEN, box((-0.08, 2.35, 0.1), (0.5, 0.5, 0.5), math.radians(30))),
    ]


def simple() -> list[Object]:
    """Everything directly lit: 15 objects."""
    return [*_room_walls(), _room_light(), *_table(), *_exhibits()]


def occluded() -> list[Object]:
    """`simple` with a slab under the light, so that most light is indirect."""
    slab = _solid("slab", GREY, box((0, 3.53, 0), (3.1, 0.1, 3.1)))
    return [*simple(), slab]


def _cornell_block(name: str, material: Material, centre: Vec, scale: Vec,
                   turn: float) -> Object:
    """A unit cube that its node scales, turns about y (degrees) and moves."""
    half = math.radians(turn) / 2
    transform = {
        "translation": list(centre),
        "rotation": [0, round(math.sin(half), 9), 0, round(math.cos(half), 9)],
        "scale": list(scale)}
    mesh: Mesh = pack(box((0, 0, 0), (1, 1, 1), uv_scale=scale))
    return Object(name, mesh, material, transform)


def cornell_box() -> list[Object]:
    """The Cornell box at ten times its size: 1 unit is 100 mm of the original.

    The original's coordinates are turned by 180 degrees about y and centred, so
    that the camera looks along -z and the opening lies in the plane z = 0.
    """
    white = Material("white", (0.73, 0.73, 0.73))
    red = Material("red", (0.63, 0.065, 0.05))
    green = Material("green", (0.14, 0.45, 0.091))
    light = Material("light", (0, 0, 0), (17, 12, 4))
    w, h, d = 2.764, 2.744, 2.796  # half the inner width, height, depth
    return [
        _quad("floor", white, (0, 0, -d), (w, 0, 0), (0, 0, -d)),
        _quad("ceiling", white, (0, 2 * h, -d), (w, 0, 0), (0, 0, d)),
        _quad("wall_back", white, (0, h, -2 * d), (w, 0, 0), (0, h, 0)),
        _quad("wall_left", red, (-w, h, -d), (0, 0, -d), (0, h, 0)),
        _quad("wall_right", green, (w, h, -d), (0, 0, d), (0, h, 0)),
        _quad("light", light, (-0.016, 5.48, -2.795), (0.65, 0, 0), (0, 0, 0.525)),
        _cornell_block("box_short", white, (0.909, 0.825, -1.69), (1.65, 1.65, 1.65), -16.6),
        _cornell_block("box_tall", white, (-0.921, 1.65, -3.5125), (1.65, 3.3, 1.65), 17.2),
    ]


def furnace() -> list[Object]:
    """A closed cube of albedo 0.5 that emits 1 inwards: with all bounces the radiance is 2, everywhere."""
    wall = Material("wall", (0.5, 0.5, 0.5), (1, 1, 1))
    return [
        _quad("wall_left", wall, (-1, 0, 0), (0, 0, -1), (0, 1, 0)),
        _quad("wall_right", wall, (1, 0, 0), (0, 0, 1), (0, 1, 0)),
        _quad("wall_front", wall, (0, 0, 1), (-1, 0, 0), (0, 1, 0)),
        _quad("wall_back", wall, (0, 0, -1), (1, 0, 0), (0, 1, 0)),
        _quad("ceiling", wall, (0, 1, 0), (1, 0, 0), (0, 0, 1)),
        _quad("floor", wall, (0, -1, 0), (1, 0, 0), (0, 0, -1)),
    ]


def write(file: Path, camera: Camera, objects: list[Object], above: dict[str, Any] | None = None) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    size = write_glb(file, file.stem, camera, objects, above)
    triangles = sum(len(o.mesh.triangles) for o in objects)
    print(f"{file.name}: {len(objects)} objects, {triangles} triangles, {size} bytes")


def main() -> None:
    here = Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=here, help="folder to write to")
    parser.add_argument("--five-million", action="store_true",
                        help="write hard/five_million.glb alone: 5 million triangles, 144 MB")
    options = parser.parse_args()
    out: Path = options.out
    if options.five_million:
        write(out / "hard/five_million.glb", HARD_CAMERA, five_million())
        return
    for name, camera, objects in (
            ("simple", ROOM_CAMERA, simple()),
            ("occluded", ROOM_CAMERA, occluded()),
            ("cornell_box", CORNELL_CAMERA, cornell_box()),
            ("many_lights", HOUSE_CAMERA, many_lights()),
            ("furnace", FURNACE_CAMERA, furnace()),
            ("door_ajar", DOOR_CAMERA, door_ajar()),
            ("glossy_room", GLOSSY_CAMERA, glossy_room()),
            ("open_sky", SKY_CAMERA, open_sky()),
            ("sunlit_bath", BATH_CAMERA, sunlit_bath()),
            ("lamp_in_fixture", LAMP_CAMERA, lamp_in_fixture()),
            ("corridor", CORRIDOR_CAMERA, corridor())):
        write(out / f"{name}.glb", camera, objects)
    print(f"sunlit_sky.hdr: {write_sky(out / 'sunlit_sky.hdr')} bytes")
    for name, (camera, objects, above) in hard_scenes().items():
        write(out / "hard" / f"{name}.glb", camera, objects, above)


if __name__ == "__main__":
    main()
