"""Many lights: 64 rooms on one floor, each with a lamp, joined by doorways.

Room (i, j) is centred at ((i - 3.5) * PITCH, 0, (j - 3.5) * PITCH). Walls stand
on the lines between rooms and are closed; so are the pieces of furniture. Floors
and ceilings go on below and above the walls, so that no light passes a seam.
"""

from __future__ import annotations

import math

import numpy as np

from furniture import cabinet, shelf, table
from gltf_writer import Camera, Material, Object
from shapes import Vec, place, rectangle
from unwrap import Mesh, pack
from walls import Wall

ROOMS = 8         # along x and along z
PITCH = 4.0       # metres from room to room
HEIGHT = 2.6
THICKNESS = 0.1   # of walls
DOORWAY = (0.5, 2.1)  # half its width, height
LAMP_HALF, LAMP_Y = 0.1, 2.55
DIMMEST, RANGE = 108.0, 3.0  # luminance of the dimmest lamp, and the brightest over it
GOLDEN = 0.6180339887  # its multiples, modulo 1, are evenly spread

# In room (4, 4): through one doorway along a row of rooms, through another to the side.
CAMERA = Camera(eye=(2.3, 1.5, 3.6), target=(0.5, 1.25, 0.5), vertical_fov=74)

FLOORS = [Material("oak", (0.58, 0.40, 0.24)), Material("stone", (0.50, 0.50, 0.48)),
          Material("carpet", (0.36, 0.44, 0.52))]
WALLS = [Material("plaster", (0.80, 0.78, 0.74)), Material("sand", (0.78, 0.66, 0.46)),
         Material("sage", (0.52, 0.66, 0.50)), Material("clay", (0.74, 0.44, 0.34))]
CEILING = Material("ceiling", (0.85, 0.85, 0.85))
WOOD = Material("wood", (0.42, 0.26, 0.15))
LACQUER = Material("lacquer", (0.25, 0.35, 0.60))
# Around the camera: room, piece, and where in the room its middle stands.
FURNITURE = [
    (4, 4, table, 1.2, -1.3), (4, 4, cabinet, -1.6, -1.35), (4, 3, table, -1.2, 0.9),
    (4, 3, shelf, 1.2, -1.75), (4, 2, cabinet, 1.5, 0.9), (4, 1, shelf, -1.2, -1.75),
    (3, 4, table, -0.9, -1.2), (3, 4, shelf, 1.2, -1.75), (2, 4, cabinet, -1.6, 1.2),
    (3, 3, table, 1.0, 1.0), (2, 3, shelf, 1.2, -1.75)]
# Lamps from candle light to daylight, and two tinted ones.
TINTS = [(1, 0.62, 0.28), (1, 0.85, 0.66), (0.72, 0.86, 1), (1, 0.72, 0.46), (0.62, 1, 0.70),
         (1, 0.60, 0.62)]


def _centre(i: float, j: float, y: float) -> Vec:
    middle = (ROOMS - 1) / 2
    return (i - middle) * PITCH, y, (j - middle) * PITCH


def _lamp(i: int, j: int) -> Object:
    """A panel that shines downwards only; every one has a radiance of its own."""
    index = i * ROOMS + j
    tint = np.array(TINTS[(i + 2 * j) % len(TINTS)], float)
    luminance = DIMMEST * RANGE ** (index * GOLDEN % 1)
    # Luminance weights of linear sRGB: ITU-R BT.709.
    radiance = tint * luminance / (tint @ np.array([0.2126, 0.7152, 0.0722]))
    name = f"lamp_{i}_{j}"
    panel = rectangle(_centre(i, j, LAMP_Y), (LAMP_HALF, 0, 0), (0, 0, LAMP_HALF))
    return Object(name, pack([panel]),
                  Material(name, (0, 0, 0), tuple(round(float(c), 3) for c in radiance)))


def _room(i: int, j: int) -> list[Object]:
    half = PITCH / 2
    floor = rectangle(_centre(i, j, 0), (half, 0, 0), (0, 0, -half))
    ceiling = rectangle(_centre(i, j, HEIGHT), (half, 0, 0), (0, 0, half))
    return [Object(f"floor_{i}_{j}", pack([floor]), FLOORS[(i + j) % len(FLOORS)]),
            Object(f"ceiling_{i}_{j}", pack([ceiling]), CEILING), _lamp(i, j)]


def _moved(mesh: Mesh, turn: float, base: Vec) -> Mesh:
    return Mesh(place(mesh.positions, turn, base), place(mesh.normals, turn, (0, 0, 0)), mesh.uvs, mesh.triangles)


def _inner_walls() -> list[Object]:
    """Walls along z are as long as a room is wide; those along x end at their faces."""
    along_x, along_z = (
        pack(Wall(length, HEIGHT, THICKNESS, DOORWAY).islands()) for length in (PITCH - THICKNESS, PITCH))
    walls = []
    for line in range(ROOMS - 1):
        for k in range(ROOMS):
            colour = (2 * line + k) % len(WALLS)
            walls.append(Object(f"wall_x_{line}_{k}", _moved(along_z, math.pi / 2, _centre(line + 0.5, k, 0)),
                                WALLS[colour]))
            walls.append(Object(f"wall_z_{k}_{line}", _moved(along_x, 0, _centre(k, line + 0.5, 0)),
                                WALLS[(colour + 1) % len(WALLS)]))
    return walls


def _outer_walls() -> list[Object]:
    """The outside of the house, a rectangle per room, seen from inside."""
    reach, half, middle = ROOMS * PITCH / 2, PITCH / 2, HEIGHT / 2
    walls = []
    for k in range(ROOMS):
        along = _centre(k, 0, 0)[0]
        sides = {"west": ((-reach, middle, along), (0, 0, -half)), "east": ((reach, middle, along), (0, 0, half)),
                 "north": ((along, middle, -reach), (half, 0, 0)), "south": ((along, middle, reach), (-half, 0, 0))}
        for side, (centre, half_u) in sides.items():
            wall = rectangle(centre, half_u, (0, middle, 0))
            walls.append(Object(f"wall_{side}_{k}", pack([wall]), WALLS[k % len(WALLS)]))
    return walls


def _furniture() -> list[Object]:
    pieces = []
    for i, j, make, dx, dz in FURNITURE:
        x, _, z = _centre(i, j, 0)
        material = LACQUER if make is cabinet else WOOD
        pieces.append(Object(f"{make.__name__}_{i}_{j}", pack(make(x + dx, z + dz)), material))
    return pieces


def many_lights() -> list[Object]:
    rooms = [piece for i in range(ROOMS) for j in range(ROOMS) for piece in _room(i, j)]
    return [*rooms, *_inner_walls(), *_outer_walls(), *_furniture()]
