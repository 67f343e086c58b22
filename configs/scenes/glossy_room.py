"""A room without a matt surface: polished floor, lacquer, brass and steel, and two small lamps, one of which shines at a
metal screen, so that much of the light has been reflected by gloss before it meets anything else."""

from __future__ import annotations

from faceted import gem, vase
from furniture import cabinet, chair, table
from gltf_writer import Camera, Material, Object
from models import ball, bowl, shade, teapot
from placing import placed, room_walls
from shapes import Vec, box, rectangle

HALF, HEIGHT = 2.5, 2.7
CAMERA = Camera(eye=(1.45, 1.6, 1.75), target=(-0.35, 0.65, -0.6), vertical_fov=62)


def _glossy(name: str, colour: Vec, roughness: float, metallic: float = 0) -> Material:
    return Material(name, tuple(colour), metallic=metallic, roughness=roughness, specular=1)


FLOOR = _glossy("polished_stone", (0.16, 0.15, 0.15), 0.12)
PAINT = _glossy("satin_paint", (0.72, 0.70, 0.66), 0.3)
BLUE = _glossy("satin_blue", (0.22, 0.34, 0.55), 0.3)
LACQUER = _glossy("lacquer_red", (0.42, 0.06, 0.05), 0.1)
BLACK = _glossy("lacquer_black", (0.03, 0.03, 0.03), 0.15)
GLAZE = _glossy("glaze", (0.20, 0.50, 0.42), 0.15)
BRASS = _glossy("brass", (0.91, 0.78, 0.42), 0.15, 1)
STEEL = _glossy("steel", (0.77, 0.78, 0.78), 0.2, 1)
COPPER = _glossy("copper", (0.95, 0.64, 0.54), 0.1, 1)
SCREEN = _glossy("screen", (0.92, 0.90, 0.86), 0.1, 1)
LIGHT = Material("light", (0, 0, 0), (1600.0, 1360.0, 1050.0), roughness=0.3, specular=1)
WALLS = {"floor": FLOOR, "ceiling": PAINT, "wall_left": BLUE, "wall_right": PAINT, "wall_back": PAINT, "wall_front": PAINT}


def _lamps() -> list[Object]:
    """One in a brass shade over the table; one low on the left that shines at the screen, away from the camera."""
    over: Vec = (-0.2, 1.75, -0.5)
    return [
        placed("shade", BRASS, shade(), 0, over),
        placed("cord", BLACK, box((over[0], (HEIGHT + over[1] + 0.2) / 2, over[2]), (0.012, HEIGHT - over[1] - 0.2, 0.012))),
        placed("lamp_table", LIGHT, [rectangle((over[0], over[1] + 0.11, over[2]), (0.06, 0, 0), (0, 0, 0.06))]),
        placed("spot", BLACK, box((-0.9, 0.18, -1.25), (0.2, 0.36, 0.08))),
        placed("lamp_screen", LIGHT, [rectangle((-0.9, 0.26, -1.295), (-0.08, 0, 0), (0, 0.08, 0))]),
    ]


def _screen() -> list[Object]:
    """Three leaves behind the table, that send the spot's light up and over the room."""
    leaves = [(-1.62, -1.98, 28), (-0.95, -2.14, 0), (-0.28, -1.98, -28)]
    return [placed(f"screen_{i}", SCREEN, box((0, 0.85, 0), (0.66, 1.7, 0.03)), turn, (x, 0.001, z))
            for i, (x, z, turn) in enumerate(leaves, start=1)]


def glossy_room() -> list[Object]:
    top = 0.761
    return [
        *room_walls(HALF, HALF, HEIGHT, WALLS), *_lamps(), *_screen(),
        placed("table", LACQUER, table(0, 0), 12, (-0.2, 0, -0.5)),
        placed("chair", BLACK, chair(0, 0), 150, (0.05, 0, 0.4)),
        placed("cabinet", LACQUER, cabinet(0, 0), 0, (-2.2, 0, 0.1)),
        placed("bowl", BRASS, bowl(), 0, (-0.1, top, -0.35)),
        placed("teapot", COPPER, teapot(0, (0, 0, 0)), -25, (-0.5, top, -0.6)),
        placed("vase", GLAZE, vase(), 0, (0.2, top, -0.62)),
        placed("ball_cabinet", STEEL, ball(0.16), 0, (-2.2, 0.901, 0.2)),
        placed("ball_floor", STEEL, ball(0.22), 0, (0.95, 0.001, -0.75)),
        placed("gem", GLAZE, gem(0.14), 0, (0.75, 0.138, 0.1)),
        placed("column", BLACK, box((0, 0.45, 0), (0.3, 0.9, 0.3)), 20, (1.55, 0.001, -1.7)),
        placed("bowl_column", COPPER, bowl(), 0, (1.55, 0.902, -1.7)),
    ]
