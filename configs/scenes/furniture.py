"""Plain furniture made of boxes; each piece stands on the floor around (x, 0, z)."""

from __future__ import annotations

from shapes import box
from unwrap import Island


def _joined(parts: list[list[Island]]) -> list[Island]:
    return [face for part in parts for face in part]


def table(x: float, z: float) -> list[Island]:
    legs = [box((x + dx, 0.36, z + dz), (0.06, 0.72, 0.06)) for dx in (-0.5, 0.5) for dz in (-0.3, 0.3)]
    return _joined([box((x, 0.74, z), (1.2, 0.04, 0.8)), *legs])


def chair(x: float, z: float) -> list[Island]:
    """Its back towards -z."""
    legs = [box((x + dx, 0.215, z + dz), (0.04, 0.43, 0.04)) for dx in (-0.18, 0.18) for dz in (-0.18, 0.18)]
    posts = [box((x + dx, 0.68, z - 0.2), (0.03, 0.44, 0.03)) for dx in (-0.18, 0.18)]
    return _joined([box((x, 0.45, z), (0.44, 0.04, 0.44)), *legs, *posts, box((x, 0.82, z - 0.2), (0.33, 0.16, 0.02))])


def shelf(x: float, z: float) -> list[Island]:
    """Open to both sides, its boards between two uprights."""
    uprights = [box((x + dx, 0.9, z), (0.04, 1.8, 0.3)) for dx in (-0.48, 0.48)]
    boards = [box((x, y, z), (0.92, 0.03, 0.28)) for y in (0.1, 0.65, 1.2, 1.75)]
    return _joined(uprights + boards)


def cabinet(x: float, z: float) -> list[Island]:
    return box((x, 0.45, z), (0.5, 0.9, 0.9))
