"""Two rooms and a door that stands ajar: what lights the dark one comes through the slit, from lamps that it cannot see.

The partition stands in the plane z = 0, the dark room on its side of +z. It reaches beyond the rooms' walls, and the
door's leaf overlaps the doorway, so that light has no other way.
"""

from __future__ import annotations

import math
from faceted import GOLDEN, crumpled, gem, vase
from furniture import cabinet, chair, shelf, table
from gltf_writer import Camera, Material, Object
from models import head, teapot
from placing import placed
from shapes import Vec, box, moved, rectangle
from unwrap import pack
from walls import Wall

HALF_X, DEPTH, HEIGHT = 2.2, 4.0, 2.6  # of each room, from the partition's middle plane
THICKNESS, OVERLAP = 0.12, 0.02        # of the partition; of the leaf beyond the doorway, and of what sinks into what
DOOR_X, DOORWAY = -0.6, (0.45, 2.05)   # middle; half its width, height
AJAR = math.radians(8)
LEAF_THICKNESS = 0.04
LAMPS = [(1.5, -1.3), (-1.7, -1.5)]  # x and z
LAMP_RADIANCE = (18000.0, 15000.0, 11000.0)

CAMERA = Camera(eye=(1.95, 1.55, 3.6), target=(-0.45, 0.9, 0.5), vertical_fov=66)

FLOOR = Material("oak", (0.58, 0.40, 0.24))
CEILING = Material("ceiling", (0.85, 0.85, 0.85))
PLASTER = Material("plaster", (0.80, 0.78, 0.74))
SAGE = Material("sage", (0.52, 0.66, 0.50))
DOOR = Material("door", (0.74, 0.70, 0.62))
WOOD = Material("wood", (0.42, 0.26, 0.15))
LACQUER = Material("lacquer", (0.25, 0.35, 0.60))
PAPER = Material("paper", (0.82, 0.82, 0.80))
CLAY = Material("clay", (0.74, 0.44, 0.34))
GLAZE = Material("glaze", (0.35, 0.60, 0.62))
HOUSING = Material("housing", (0.30, 0.30, 0.30))
COVERS = [Material("cover_red", (0.60, 0.18, 0.14)), Material("cover_blue", (0.20, 0.30, 0.55)),
          Material("cover_green", (0.24, 0.46, 0.26)), Material("cover_ochre", (0.70, 0.52, 0.20)),
          Material("cover_grey", (0.55, 0.55, 0.56))]


def _shell(room: str, side: int, walls: Material) -> list[Object]:
    """Floor, ceiling and the three walls of one room, seen from inside; side 1: at +z."""
    middle, far, half = side * DEPTH / 2, side * DEPTH, HEIGHT / 2
    sheets = {
        "floor": (FLOOR, rectangle((0, 0, middle), (HALF_X, 0, 0), (0, 0, -DEPTH / 2))),
        "ceiling": (CEILING, rectangle((0, HEIGHT, middle), (HALF_X, 0, 0), (0, 0, DEPTH / 2))),
        "wall_left": (walls, rectangle((-HALF_X, half, middle), (0, 0, -DEPTH / 2), (0, half, 0))),
        "wall_right": (walls, rectangle((HALF_X, half, middle), (0, 0, DEPTH / 2), (0, half, 0))),
        "wall_far": (walls, rectangle((0, half, far), (-side * HALF_X, 0, 0), (0, half, 0)))}
    return [Object(f"{room}_{name}", pack([sheet]), material) for name, (material, sheet) in sheets.items()]


def _partition() -> list[Object]:
    """The wall between the rooms, and the leaf, whose hinge is at the doorway's left edge as seen from the dark room.

    The leaf's edge at the hinge and its lower edge sink into the wall and the floor, so that no light passes there.
    """
    wall = Wall(2 * (HALF_X + OVERLAP), HEIGHT + 2 * OVERLAP, THICKNESS, (DOORWAY[0], DOORWAY[1] + OVERLAP), DOOR_X)
    width, height = 2 * DOORWAY[0] + 2 * OVERLAP, DOORWAY[1] + 2 * OVERLAP
    hinge = (DOOR_X - DOORWAY[0] - OVERLAP, -OVERLAP / 4, THICKNESS / 2 - OVERLAP / 8)
    leaf = box((width / 2, height / 2, LEAF_THICKNESS / 2), (width, height, LEAF_THICKNESS))
    knob = moved(gem(0.03, 8), 0, (width - 0.07, 1.0, LEAF_THICKNESS + 0.024))
    return [placed("partition", PLASTER, wall.islands(), 0, (0, -OVERLAP, 0)),
            placed("door_leaf", DOOR, leaf, -math.degrees(AJAR), hinge),
            placed("door_knob", HOUSING, knob, -math.degrees(AJAR), hinge)]


def _lamps() -> list[Object]:
    """Floor lamps whose panels shine away from the partition: whoever looks through the doorway sees their backs."""
    light = Material("light", (0, 0, 0), LAMP_RADIANCE)
    objects = []
    for i, (x, z) in enumerate(LAMPS, start=1):
        stand = [*box((x, 0.015, z), (0.34, 0.03, 0.34)), *box((x, 0.78, z), (0.03, 1.5, 0.03)),
                 *box((x, 1.73, z), (0.46, 0.46, 0.04))]
        panel = rectangle((x, 1.73, z - 0.025), (-0.2, 0, 0), (0, 0.2, 0))
        objects += [placed(f"lamp_{i}_stand", HOUSING, stand), placed(f"lamp_{i}", light, [panel])]
    return objects


def _books(name: str, x: float, end: float, y: float, z: float, seed: int) -> list[Object]:
    """A row of books from x to `end` along a board at y; each leans, if at all, to the left, on the one before it."""
    objects: list[Object] = []
    before = 0.0  # lean of the one before
    while True:
        u, v, w, s = ((len(objects) + 29 * seed + 1) * (k + 1) * GOLDEN % 1 for k in range(4))
        thickness, height, depth = 0.018 + 0.03 * u, 0.24 + 0.14 * v, 0.16 + 0.06 * w
        lean = math.radians(24 * s - 8)
        lean = max(lean, 0.0) if objects else 0.0
        # Its upper left corner, and so all of it, stays right of the face that it leans on.
        x += max(height * (math.sin(lean) - math.cos(lean) * math.tan(before)), 0)
        if x + thickness / math.cos(lean) > end:
            return objects
        objects.append(placed(f"{name}_{len(objects) + 1}", COVERS[(3 * seed + 2 * len(objects)) % len(COVERS)],
                               box((thickness / 2, height / 2, 0), (thickness, height, depth)), 0, (x, y, z),
                               math.degrees(lean)))
        x += thickness / math.cos(lean) + 0.002
        before = lean


def _pile(name: str, x: float, z: float, y: float, count: int, seed: int) -> list[Object]:
    """Books that lie on each other, each turned in its own way."""
    objects = []
    for k in range(count):
        u, v, w = ((k + 17 * seed + 1) * (i + 1) * GOLDEN % 1 for i in range(3))
        thickness = 0.02 + 0.03 * u
        objects.append(placed(f"{name}_{k + 1}", COVERS[(seed + 3 * k) % len(COVERS)],
                               box((0, thickness / 2, 0), (0.17 + 0.05 * v, thickness, 0.24 + 0.05 * w)),
                               70 * (w - 0.5) + 20 * seed, (x, y, z)))
        y += thickness + 0.001
    return objects


def _dark_room() -> list[Object]:
    at_table: Vec = (-1.25, 0, 1.9)
    top = 0.761
    objects = [
        placed("table", WOOD, table(0, 0), 24, at_table),
        placed("chair_1", LACQUER, chair(0, 0), -20, (-1.45, 0, 1.15)),
        placed("chair_2", CLAY, chair(0, 0), 205, (-0.75, 0, 2.6)),
        placed("shelf", WOOD, shelf(0, 0), 0, (1.45, 0, THICKNESS / 2 + 0.16)),
        placed("cabinet", SAGE, cabinet(0, 0), 90, (-1.68, 0, 0.35)),
        placed("teapot", GLAZE, teapot(0, (0, 0, 0)), -40, (-1.4, top, 1.85)),
        placed("vase", CLAY, vase(), 10, (-0.95, top, 1.75)),
        placed("gem", PAPER, gem(0.16), 5, (-1.9, 1.06, 0.35)),
        placed("head", PAPER, head(0.42, 0, (0, 0, 0)), 40, (-1.45, 0.901, 0.35)),
        placed("vase_large", GLAZE, vase(9), 40, (0.62, 0.001, 0.45)),
        placed("crate", WOOD, box((0, 0.16, 0), (0.42, 0.32, 0.34)), 37, (0.55, 0.001, 1.2)),
    ]
    for seed, (x, z, y, radius) in enumerate([(0.25, 0.7, 0, 0.09), (-0.1, 1.1, 0, 0.07), (1.15, 0.9, 0, 0.08),
                                              (0.55, 1.2, 0.321, 0.09), (-0.9, 2.05, top, 0.06)], start=1):
        objects.append(placed(f"paper_{seed}", PAPER, crumpled(radius, seed), 50 * seed, (x, y + radius * 0.85, z)))
    for board, y in enumerate((0.116, 0.666, 1.216), start=1):
        objects += _books(f"book_{board}", 1.45 - 0.45, 1.45 + 0.45, y, THICKNESS / 2 + 0.15, board)
    return [*objects, *_pile("pile_1", 0.1, 1.75, 0.001, 5, 1), *_pile("pile_2", -1.3, 2.1, top, 3, 2),
            *_pile("pile_3", 1.42, 0.21, 1.766, 3, 3)]


def _lit_room() -> list[Object]:
    return [
        placed("lit_table", WOOD, table(0, 0), -12, (0.7, 0, -2.6)),
        placed("lit_chair", CLAY, chair(0, 0), 160, (0.5, 0, -1.7)),
        placed("lit_cabinet", LACQUER, cabinet(0, 0), 0, (-1.92, 0, -3.0)),
        placed("lit_shelf", WOOD, shelf(0, 0), 0, (-0.6, 0, -3.8)),
        placed("lit_vase", GLAZE, vase(), 0, (0.7, 0.761, -2.6)),
    ]


def door_ajar() -> list[Object]:
    return [*_shell("dark", 1, PLASTER), *_shell("lit", -1, PLASTER), *_partition(), *_lamps(), *_dark_room(),
            *_lit_room()]
