"""Matt objects on a square of ground, and no light: for the config key `environment`, whose radiance then comes from all
of the sky alike. There is nothing to learn that the cosine does not say."""

from __future__ import annotations

import math

from faceted import gem, vase
from furniture import chair, table
from gltf_writer import Camera, Material, Object
from models import ball, bowl, head, teapot
from shapes import Vec, box, moved, rectangle
from unwrap import Island, pack

HALF = 12.0  # of the ground
CAMERA = Camera(eye=(2.1, 2.5, 3.2), target=(-0.05, 0.35, -0.1), vertical_fov=46)

GROUND = Material("ground", (0.50, 0.48, 0.44))
WHITE = Material("white", (0.80, 0.80, 0.80))
RED = Material("red", (0.70, 0.22, 0.16))
BLUE = Material("blue", (0.22, 0.36, 0.62))
GREEN = Material("green", (0.28, 0.56, 0.30))
WOOD = Material("wood", (0.52, 0.34, 0.20))


def _object(name: str, material: Material, islands: list[Island], turn: float = 0, base: Vec = (0, 0, 0)) -> Object:
    return Object(name, pack(moved(islands, math.radians(turn), base)), material)


def open_sky() -> list[Object]:
    return [
        _object("ground", GROUND, [rectangle((0, 0, 0), (HALF, 0, 0), (0, 0, -HALF))]),
        _object("table", WOOD, table(0, 0), 20, (-0.5, 0, -0.5)),
        _object("teapot", WHITE, teapot(0, (0, 0, 0)), -30, (-0.6, 0.761, -0.5)),
        _object("bowl", BLUE, bowl(), 0, (-0.1, 0.761, -0.6)),
        _object("chair", RED, chair(0, 0), 195, (-0.75, 0, 0.35)),
        _object("cube", GREEN, box((0, 0.25, 0), (0.5, 0.5, 0.5)), 32, (0.85, 0.001, -0.45)),
        _object("head", WHITE, head(0.45, 0, (0, 0, 0)), 35, (0.85, 0.502, -0.45)),
        _object("ball", BLUE, ball(0.24), 0, (0.35, 0.001, 0.65)),
        _object("gem", RED, gem(0.16), 0, (1.05, 0.156, 0.5)),
        _object("vase", GREEN, vase(), 0, (-0.1, 0.001, 1.05)),
    ]
