"""Objects put in their places, and the six walls of a room that they stand in."""

from __future__ import annotations

import math
from typing import Mapping

from gltf_writer import Material, Object
from shapes import Vec, moved, rectangle
from unwrap import Island, pack


def placed(name: str, material: Material, islands: list[Island], turn: float = 0, base: Vec = (0, 0, 0),
           lean: float = 0) -> Object:
    """Turned and leant by degrees, then moved to `base`."""
    return Object(name, pack(moved(islands, math.radians(turn), base, math.radians(lean))), material)


def room_walls(half_x: float, half_z: float, height: float, materials: Mapping[str, Material]) -> list[Object]:
    """Floor, ceiling and walls of a room, seen from inside: those that `materials` names, in its order."""
    half = height / 2
    sheets = {
        "floor": rectangle((0, 0, 0), (half_x, 0, 0), (0, 0, -half_z)),
        "ceiling": rectangle((0, height, 0), (half_x, 0, 0), (0, 0, half_z)),
        "wall_left": rectangle((-half_x, half, 0), (0, 0, -half_z), (0, half, 0)),
        "wall_right": rectangle((half_x, half, 0), (0, 0, half_z), (0, half, 0)),
        "wall_back": rectangle((0, half, -half_z), (half_x, 0, 0), (0, half, 0)),
        "wall_front": rectangle((0, half, half_z), (-half_x, 0, 0), (0, half, 0))}
    return [Object(name, pack([sheets[name]]), material) for name, material in materials.items()]
