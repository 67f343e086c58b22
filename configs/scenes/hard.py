"""Scenes that are hard to render right, for stability.json: most are one small room, written down in ways that must
not change its picture."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Callable, Sequence

import numpy as np

from gltf_writer import Camera, Material, Object
from shapes import Vec, box
from unwrap import Mesh, pack

# Name: camera, objects, and the transform of the node above all of them.
Scenes = dict[str, tuple[Camera, list[Object], dict[str, Any]]]

GREY = Material("grey", (0.7, 0.7, 0.7))
RED = Material("red", (0.7, 0.2, 0.2))
GREEN = Material("green", (0.2, 0.7, 0.2))
LIGHT = Material("light", (0, 0, 0), (8, 8, 8))
GLOSSY_LIGHT = Material("light", (0, 0, 0), (2, 2, 2))
METAL = Material("metal", (0.9, 0.8, 0.6), metallic=1, roughness=0.05, specular=1)
DIELECTRIC = Material("dielectric", (0.4, 0.5, 0.6), roughness=0.05, specular=1)
CAMERA = Camera(eye=(0.1, 0.1, 0.93), target=(0, -0.1, 0), vertical_fov=75)
# Widths of strips: two slivers of 1e-5 at an edge, and two within.
SLIVERS = (0, 1e-5, 2e-5, 0.31, 0.31001, 0.5, 0.50001, 1)
FIVE_MILLION = 646  # squares along each side of each wall
WALLS = (("wall_left", RED, (-1, 0, 0), (0, 0, -1), (0, 1, 0)),
         ("wall_right", GREEN, (1, 0, 0), (0, 0, 1), (0, 1, 0)),
         ("wall_front", GREY, (0, 0, 1), (-1, 0, 0), (0, 1, 0)),
         ("wall_back", GREY, (0, 0, -1), (1, 0, 0), (0, 1, 0)),
         ("ceiling", GREY, (0, 1, 0), (1, 0, 0), (0, 0, 1)),
         ("floor", GREY, (0, -1, 0), (1, 0, 0), (0, 0, -1)))


def sheet(name: str, material: Material, centre: Vec, half_u: Vec, half_v: Vec,
          us: Sequence[float] = (0, 1), vs: Sequence[float] = (0, 1)) -> Object:
    """A rectangle that faces along half_u x half_v, cut at `us` and `vs`."""
    u, v = (a.ravel() for a in np.meshgrid(us, vs))
    c, hu, hv = (np.asarray(a, float) for a in (centre, half_u, half_v))
    normal = np.cross(hu, hv) / np.linalg.norm(np.cross(hu, hv))
    row = len(us)
    first = (np.arange(len(vs) - 1)[:, None] * row + np.arange(row - 1)).ravel()
    triangles = np.stack([first, first + 1, first + row + 1, first, first + row + 1, first + row], axis=1)
    mesh = Mesh(c + (2 * u - 1)[:, None] * hu + (2 * v - 1)[:, None] * hv, np.tile(normal, (len(u), 1)),
                np.stack([u, v], axis=1), triangles.reshape(-1, 3))
    return Object(name, mesh, material)


def room(cuts: Sequence[float] = (0, 1), rows: Sequence[float] = (0, 1), block: Material = GREY,
         light: Material = LIGHT, half_light: float = 0.3) -> list[Object]:
    """A closed cube of +-1 with a lamp under its ceiling and a block; `cuts` and `rows` divide its sheets."""
    walls = [sheet(*wall, us=cuts, vs=rows) for wall in WALLS]
    lamp = sheet("light", light, (0, 0.97, 0), (half_light, 0, 0), (0, 0, half_light), us=cuts)
    return [*walls, lamp, Object("block", pack(box((0.3, -0.6, -0.3), (0.6, 0.6, 0.6), 0.4)), block)]


def change(objects: list[Object], edit: Callable[[Mesh], Mesh], **more: Any) -> list[Object]:
    return [replace(o, mesh=edit(o.mesh), **more) for o in objects]


def with_zero_area(mesh: Mesh) -> Mesh:
    """Adds a triangle without area at a corner, and one along an edge."""
    a, b, _ = mesh.triangles[0]
    n = len(mesh.positions)

    def grown(values: np.ndarray) -> np.ndarray:
        return np.concatenate([values, values[[a]] / 2 + values[[b]] / 2])

    return Mesh(grown(mesh.positions), grown(mesh.normals), grown(mesh.uvs),
                np.concatenate([mesh.triangles, [(a, a, b), (a, n, b)]]))


def mirrored(mesh: Mesh) -> Mesh:
    """Its image in the plane x = 0, which still faces outwards."""
    flip = np.array([-1, 1, 1])
    return Mesh(mesh.positions * flip, mesh.normals * flip, mesh.uvs, mesh.triangles[:, ::-1])


def doubled(objects: list[Object]) -> list[Object]:
    """Every triangle twice, the second time from another corner on."""
    again = change(objects, lambda m: replace(m, triangles=np.roll(m.triangles, 1, axis=1)))
    return [*objects, *(replace(o, name=o.name + "_again") for o in again)]


def furnace(albedo: float) -> list[Object]:
    """Glows inside: after N bounces the radiance is (1 - albedo^(N+1)) / (1 - albedo) everywhere."""
    wall = Material("wall", (albedo,) * 3, (1, 1, 1))
    return [sheet(name, wall, *place) for name, _, *place in WALLS]


def grazing() -> list[Object]:
    """A strip of light, 20 cm high, that stands on the edge of a floor of 4 m."""
    return [sheet("floor", GREY, (0, 0, 0), (2, 0, 0), (0, 0, -2)),
            sheet("light", Material("light", (0, 0, 0), (20, 20, 20)), (0, 0.1, -2), (2, 0, 0), (0, 0.1, 0))]


def tiny_light() -> list[Object]:
    """A room of 10 m with a light of 1 mm."""
    large = [sheet(name, colour, *(5 * np.asarray(a, float) for a in place)) for name, colour, *place in WALLS]
    point = Material("light", (0, 0, 0), (1e8, 1e8, 1e8))
    return [*large, sheet("light", point, (0, 4.9, 0), (0.0005, 0, 0), (0, 0, 0.0005))]


def one_triangle() -> list[Object]:
    """A glowing triangle that fills the view."""
    triangle = sheet("triangle", Material("glow", (0.5, 0.5, 0.5), (1, 1, 1)), (0, 0, 0), (9, 0, 0), (0, 9, 0))
    return change([triangle], lambda m: replace(m, triangles=m.triangles[:1]))


def hard_scenes() -> Scenes:
    white = Material("white", (1, 1, 1))
    plain = room()
    cell = Object("cell", pack(box((0.1, 0.1, 0.93), (0.1, 0.1, 0.1))), GREY)
    dark = [o for o in plain if o.name != "light"]
    inside = Camera(eye=(0, 0, 0), target=(0.3, 0.2, -1), vertical_fov=68)
    outside = Camera(eye=(0, 1, 4), target=(0, 0, 0), vertical_fov=50)
    along = Camera(eye=(0, 0.8, 1.2), target=(0, 0, -1), vertical_fov=55)
    far = {"translation": [10000, 0, 0]}
    glossy = {"light": GLOSSY_LIGHT, "half_light": 0.6}
    return {
        "room": (CAMERA, plain, {}),
        "room_small": (CAMERA, plain, {"scale": [0.001] * 3}),
        "room_large": (CAMERA, plain, {"scale": [10000] * 3}),
        "room_moved": (CAMERA, plain, far),
        "room_slivers": (CAMERA, room(SLIVERS), {}),
        "room_zero_area": (CAMERA, change(plain, with_zero_area), {}),
        "room_doubled": (CAMERA, doubled(plain), {}),
        "room_mirrored": (CAMERA, change(plain, mirrored, transform={"scale": [-1, 1, 1]}), {}),
        "room_dark": (CAMERA, dark, {}),
        "camera_in_block": (CAMERA, [*plain, cell], {}),
        "rough_metal": (CAMERA, room(block=METAL, **glossy), {}),
        "rough_dielectric": (CAMERA, room(block=DIELECTRIC, **glossy), {}),
        "white_furnace": (inside, furnace(0.99), {}),
        "white_furnace_moved": (inside, furnace(0.99), far),
        "grazing": (along, grazing(), {}),
        "tiny_light": (Camera(eye=(0.5, 0.5, 4.65), target=(0, -0.5, 0), vertical_fov=75), tiny_light(), {}),
        "open_white": (outside, [Object("block", pack(box((0, 0, 0), (2, 2, 2), 0.5)), white)], {}),
        "one_triangle": (Camera(eye=(3, -3, 1), target=(3, -3, 0), vertical_fov=60), one_triangle(), {}),
    }


def five_million() -> list[Object]:
    """The room with walls of 5,007,792 triangles."""
    cuts = np.linspace(0, 1, FIVE_MILLION + 1)
    walls = [sheet(*wall, us=cuts, vs=cuts) for wall in WALLS]
    return [*walls, *room()[len(walls):]]
