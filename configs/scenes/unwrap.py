"""UV islands and a small packer that lays them out in the unit square.

Every object of a scene is a list of islands. An island's own `uv` is in metres
and (nearly) area-true, so one common scale for all islands of an object gives
every square metre of its surface about the same number of texels.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

GUTTER = 1.0 / 256.0  # empty UV border between islands, against texel bleeding


@dataclass
class Mesh:
    """Indexed triangles: positions in metres, unit normals, UV in [0,1]^2."""

    positions: np.ndarray  # (n, 3)
    normals: np.ndarray  # (n, 3)
    uvs: np.ndarray  # (n, 2)
    triangles: np.ndarray  # (m, 3) counter-clockwise seen from outside
    metres: np.ndarray | None = None  # (n, 2) the islands' own UV, in metres and not packed: for textures

    def tangents(self) -> np.ndarray:
        """Unit vectors of the vertices along the growing u of `metres`, in the plane of the normals, (n, 3)."""
        (a, b, c), (p, q, r) = ([values[self.triangles[:, i]] for i in range(3)] for values in (self.positions, self.metres))
        rise = (r - p)[:, 1:] * (b - a) - (q - p)[:, 1:] * (c - a)
        along = np.zeros_like(self.positions)
        for corner in range(3):
            np.add.at(along, self.triangles[:, corner], rise)
        along -= (along * self.normals).sum(axis=1, keepdims=True) * self.normals
        return along / np.linalg.norm(along, axis=1, keepdims=True)


@dataclass
class Island:
    """A connected patch of surface, flattened; `uv` in metres, any origin."""

    positions: np.ndarray
    normals: np.ndarray
    uv: np.ndarray
    triangles: np.ndarray

    def at_origin(self, landscape: bool) -> np.ndarray:
        """UV moved to the origin, turned by 90 degrees if that lays it flat."""
        uv = self.uv - self.uv.min(axis=0)
        width, height = uv.max(axis=0)
        if (width < height - 1e-9) == landscape and abs(width - height) > 1e-9:
            uv = np.stack([height - uv[:, 1], uv[:, 0]], axis=1)
        return uv


@dataclass
class _Layout:
    score: float
    corners: np.ndarray  # lower left corner of each island's cell, metres
    extent: np.ndarray  # size of the whole layout, metres


def _drop(sizes: np.ndarray, limit: float) -> np.ndarray:
    """Bottom-left packing into a column `limit` wide; returns the corners."""
    corners = np.zeros_like(sizes)
    order = sorted(range(len(sizes)), key=lambda i: (-round(sizes[i, 1], 9), i))
    placed: list[int] = []
    for i in order:
        best = None
        for x in [0.0] + [corners[j, 0] + sizes[j, 0] for j in placed]:
            if x + sizes[i, 0] > limit + 1e-9:
                continue
            below = [j for j in placed
                     if corners[j, 0] < x + sizes[i, 0] - 1e-9
                     and corners[j, 0] + sizes[j, 0] > x + 1e-9]
            y = max((corners[j, 1] + sizes[j, 1] for j in below), default=0.0)
            key = (round(y, 9), round(x, 9))
            if best is None or key < best:
                best = key
        corners[i] = best[1], best[0]
        placed.append(i)
    return corners


def _layout(sizes: np.ndarray, limit: float) -> _Layout:
    """Layout for one width limit, scored by fill and by nearness to a square."""
    corners = _drop(sizes, limit)
    extent = (corners + sizes).max(axis=0)
    fill = sizes.prod(axis=1).sum() / extent.prod()
    squareness = np.sqrt(extent.min() / extent.max())
    return _Layout(round(float(fill * squareness), 9), corners, extent)


def pack(islands: list[Island]) -> Mesh:
    """Place all islands without overlap in the unit square and join them.

    The layout's bounding box is stretched to the square: that keeps relative
    areas and wastes no texels, at the price of a modest anisotropy.
    """
    best: tuple[_Layout, list[np.ndarray]] | None = None
    for landscape in (True, False):
        flat = [island.at_origin(landscape) for island in islands]
        sizes = np.array([uv.max(axis=0) for uv in flat])
        low, high = sizes[:, 0].max(), sizes[:, 0].sum()
        for limit in np.linspace(low, high, 97):
            layout = _layout(sizes, float(limit))
            if best is None or layout.score > best[0].score:
                best = layout, flat
    return _join(islands, *best)


def _join(islands: list[Island], layout: _Layout, flat: list[np.ndarray]) -> Mesh:
    """Map each island's cell into the unit square, less the gutter."""
    gutter = GUTTER if len(islands) > 1 else 0.0
    uvs, triangles, first = [], [], 0
    for island, uv, corner in zip(islands, flat, layout.corners):
        size = uv.max(axis=0)
        cell = size / layout.extent
        inner = cell - gutter
        uvs.append(corner / layout.extent + gutter / 2 + uv / size * inner)
        triangles.append(island.triangles + first)
        first += len(island.positions)
    return Mesh(
        np.concatenate([i.positions for i in islands]),
        np.concatenate([i.normals for i in islands]),
        np.concatenate(uvs),
        np.concatenate(triangles),
        np.concatenate([i.uv for i in islands]),
    )
