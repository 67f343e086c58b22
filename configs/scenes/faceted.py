"""Closed bodies of flat facets, each with a normal of its own: many directions on little room."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from rings import RingSurface
from unwrap import Island

GOLDEN = 0.6180339887  # its multiples, modulo 1, are evenly spread


def facets(islands: Sequence[Island]) -> list[Island]:
    """The same surface with the triangles' own normals instead of smooth ones."""
    flat = []
    for island in islands:
        corners = island.positions[island.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        flat.append(Island(corners.reshape(-1, 3), np.repeat(normals, 3, axis=0),
                           island.uv[island.triangles].reshape(-1, 2),
                           np.arange(island.triangles.size).reshape(-1, 3)))
    return flat


def _rings(outline: Sequence[tuple[float, float]], n: int, twist: float) -> np.ndarray:
    """Rings of n points about y, each turned against the one below by `twist` columns; outline: (radius, height)."""
    radius, height = np.array(outline, float).T[:, :, None]
    a = 2 * np.pi * (np.arange(n) + twist * np.arange(len(outline))[:, None]) / n
    return np.stack([radius * np.sin(a), np.broadcast_to(height, a.shape), radius * np.cos(a)], axis=2)


def vase(n: int = 11) -> list[Island]:
    """0.34 m high, standing on the origin."""
    outline = [(0.055, 0.0), (0.085, 0.05), (0.11, 0.11), (0.10, 0.17), (0.065, 0.22), (0.04, 0.27), (0.06, 0.34)]
    inside = [(0.05, 0.335), (0.03, 0.27)]
    surface = RingSurface((0, 0, 0), _rings([*outline, *inside], n, 0.5), (0, 0.25, 0))
    return facets(surface.unwrap(1, 3))


def _ball(radius: float, n: int, crumple: float, seed: int) -> list[Island]:
    """Around the origin; `crumple` is the share of the radius that dents may take."""
    rows = n // 2
    polar = np.pi * (np.arange(rows) + 1) / (rows + 1)
    rings = _rings(np.stack([np.sin(polar), -np.cos(polar)], axis=1).tolist(), n, 0.5)
    index = np.arange(rows * n + 2) + 7919 * seed
    size = radius * (1 - crumple * (index * index * GOLDEN % 1))
    points = rings * size[2:].reshape(rows, n, 1)
    return facets(RingSurface((0, -size[0], 0), points, (0, size[1], 0)).unwrap(1, 1))


def gem(radius: float, n: int = 12) -> list[Island]:
    return _ball(radius, n, 0.0, 0)


def crumpled(radius: float, seed: int, n: int = 10) -> list[Island]:
    """A ball of crumpled paper."""
    return _ball(radius, n, 0.4, seed)
