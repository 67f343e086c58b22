"""Closed surfaces made of rings, with smooth normals and an unwrapping.

Teapot parts and head are all of this kind: one class gives exact triangle
counts (no degenerate pole triangles) and one way of flattening.
"""

from __future__ import annotations

import numpy as np

from shapes import Vec
from unwrap import Island

MICROMETRE = 6  # decimals kept, so that results do not hang on the CPU's last bit


class RingSurface:
    """Closed surface: a south pole, rings of n points each, a north pole.

    Rings run counter-clockwise seen from the north, so that the outside is
    counter-clockwise. It has 2 n (number of rings) triangles and no degenerate
    ones, because the poles are fans.
    """

    def __init__(self, south: Vec, rings: np.ndarray, north: Vec) -> None:
        self.count, self.n = rings.shape[:2]
        poles = np.array([south, north], float)
        self.points = np.concatenate([rings.reshape(-1, 3), poles]).round(MICROMETRE)
        self.south, self.north = len(self.points) - 2, len(self.points) - 1
        self.bands = [self._band(b) for b in range(self.count + 1)]
        self.normals = self._smooth_normals()
        self.areas = np.array([self._area(band) for band in self.bands])

    def _band(self, b: int) -> np.ndarray:
        """Triangles of band b as (columns, triangles, corners) of point indices."""
        k = np.arange(self.n)
        after = (k + 1) % self.n
        low, high = (b - 1) * self.n, b * self.n
        if b == 0:
            return np.stack([np.full(self.n, self.south), high + after, high + k], 1)[:, None]
        if b == self.count:
            return np.stack([low + k, low + after, np.full(self.n, self.north)], 1)[:, None]
        a, e, c, d = low + k, low + after, high + after, high + k
        p = self.points
        rising = np.linalg.norm(p[c] - p[a], axis=1)
        falling = np.linalg.norm(p[d] - p[e], axis=1)
        first = np.stack([np.stack([a, e, c], 1), np.stack([a, c, d], 1)], 1)
        second = np.stack([np.stack([a, e, d], 1), np.stack([e, c, d], 1)], 1)
        return np.where((rising <= falling + 1e-9)[:, None, None], first, second)

    def _area(self, band: np.ndarray) -> np.ndarray:
        """Surface area of each column of a band, in square metres."""
        p = self.points[band]
        cross = np.cross(p[..., 1, :] - p[..., 0, :], p[..., 2, :] - p[..., 0, :])
        return np.linalg.norm(cross, axis=-1).sum(axis=-1) / 2

    def _smooth_normals(self) -> np.ndarray:
        """Unit vertex normals: face normals weighted by their corner angles."""
        triangles = np.concatenate([band.reshape(-1, 3) for band in self.bands])
        normals = np.zeros_like(self.points)
        for corner in range(3):
            a, b, c = (self.points[triangles[:, (corner + i) % 3]] for i in range(3))
            cross, dot = np.cross(b - a, c - a), ((b - a) * (c - a)).sum(axis=1)
            length = np.linalg.norm(cross, axis=1)
            angle = np.arctan2(length, dot)
            np.add.at(normals, triangles[:, corner], cross * (angle / length)[:, None])
        return normals / np.linalg.norm(normals, axis=1, keepdims=True)

    def _columns(self) -> np.ndarray:
        """Share of the area left of each column line, 0 to 1 (n + 1 values)."""
        return np.concatenate([[0.0], np.cumsum(self.areas.sum(axis=0))]) / self.areas.sum()

    def unwrap(self, south: int, north: int, pieces: int = 1) -> list[Island]:
        """Flatten: discs for `south` / `north` bands at the poles, strips between.

        Radii and row heights follow from the real areas, which makes the map
        equal-area on average over each band.
        """
        split = self.count + 1 - north
        cuts = [round(i * self.n / pieces) for i in range(pieces + 1)]
        return [self._disc(list(range(south)), self.south, -1.0),
                *[self._strip(south, split, a, b) for a, b in zip(cuts, cuts[1:])],
                self._disc(list(range(self.count, split - 1, -1)), self.north, 1.0)]

    def _disc(self, bands: list[int], pole: int, sense: float) -> Island:
        """Bands around a pole (given from the pole outwards) as a disc."""
        radius = np.sqrt(np.cumsum(self.areas[bands].sum(axis=1)) / np.pi)
        angle = sense * 2 * np.pi * self._columns()[:-1]
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        rows = [b if sense < 0 else b - 1 for b in bands]
        ids = np.concatenate([[pole], *[r * self.n + np.arange(self.n) for r in rows]])
        local = np.zeros(len(self.points), int)
        local[ids] = np.arange(len(ids))
        triangles = np.concatenate([local[self.bands[b]].reshape(-1, 3) for b in bands])
        uv = np.concatenate([np.zeros((1, 2)), *[r * circle for r in radius]])
        return Island(self.points[ids], self.normals[ids], uv, triangles)

    def _strip(self, first: int, end: int, left: int, right: int) -> Island:
        """Bands first..end-1 between column lines left and right as a rectangle."""
        ids = (np.arange(first - 1, end)[:, None] * self.n
               + np.arange(left, right + 1) % self.n)
        edges = np.diff(self.points[ids], axis=1)
        width = np.linalg.norm(edges, axis=2).sum(axis=1).mean()
        area = self.areas[first:end, left:right].sum(axis=1)
        share = self._columns()[left:right + 1]
        u = (share - share[0]) / (share[-1] - share[0]) * width
        v = np.concatenate([[0.0], np.cumsum(area)]) / width
        uv = np.stack(np.broadcast_arrays(u[None, :], v[:, None]), axis=2)
        column = np.arange(left, right)[:, None, None]
        triangles = []
        for b in range(first, end):
            band = self.bands[b][left:right]
            # A corner is on its column's left line or, else, on its right one;
            # the last right line is a seam and has vertices of its own.
            line = column - left + (band % self.n != column)
            triangles.append((band // self.n - first + 1) * ids.shape[1] + line)
        flat = ids.ravel()
        return Island(self.points[flat], self.normals[flat], uv.reshape(-1, 2),
                      np.concatenate(triangles).reshape(-1, 3))
