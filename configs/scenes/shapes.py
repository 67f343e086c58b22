"""Building blocks: rectangles, boxes and closed surfaces made of rings.

All lengths are metres, y is up, outsides are counter-clockwise.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Sequence

import numpy as np

from unwrap import Island

Vec = Sequence[float]


def rectangle(centre: Vec, half_u: Vec, half_v: Vec, uv_size: Vec | None = None) -> Island:
    """Flat rectangle with normal half_u x half_v; `uv_size` overrides its UV size."""
    c, u, v = (np.asarray(a, float) for a in (centre, half_u, half_v))
    normal = np.cross(u, v)
    normal /= np.linalg.norm(normal)
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    if uv_size is None:
        uv_size = 2 * np.linalg.norm(u), 2 * np.linalg.norm(v)
    return Island(
        c + signs[:, :1] * u + signs[:, 1:] * v,
        np.tile(normal, (4, 1)),
        (signs + 1) / 2 * np.asarray(uv_size, float),
        np.array([(0, 1, 2), (0, 2, 3)]),
    )


def box(centre: Vec, size: Vec, turn: float = 0.0, uv_scale: Vec = (1, 1, 1)) -> list[Island]:
    """Box of the given edge lengths, turned by `turn` radians about its y axis.

    `uv_scale` is the scale that a node will apply to the box later on: with it
    the UV islands get the proportions of the scaled faces.
    """
    half, scale = np.asarray(size, float) / 2, np.asarray(uv_scale, float)
    cos, sin = np.cos(turn), np.sin(turn)
    axes = np.array([(cos, 0, -sin), (0, 1, 0), (sin, 0, cos)])
    faces = []
    for u, v, w in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        uv = 2 * half[u] * scale[u], 2 * half[v] * scale[v]
        for side in (1, -1):  # u x v = w; flipping u as well keeps it outward
            middle = np.asarray(centre, float) + side * half[w] * axes[w]
            faces.append(rectangle(middle, side * half[u] * axes[u], half[v] * axes[v], uv))
    return faces


def catmull_rom(points: Sequence[Vec], steps: Sequence[int]) -> np.ndarray:
    """Samples a smooth curve through `points`; steps[i] samples from point i on.

    The last point is included. Unequal steps put samples where the shape needs
    them, for instance around a rim.
    """
    p = np.asarray(points, float)
    tangents = np.empty_like(p)
    chord = np.linalg.norm(np.diff(p, axis=0), axis=1)
    slope = np.diff(p, axis=0) / chord[:, None]
    # Chord-weighted slopes do not overshoot where short and long pieces meet.
    weight = (chord[:-1] / (chord[:-1] + chord[1:]))[:, None]
    tangents[1:-1] = slope[:-1] * (1 - weight) + slope[1:] * weight
    tangents[0], tangents[-1] = slope[0], slope[-1]
    samples = []
    for i, count in enumerate(steps):
        t = (np.arange(count) / count)[:, None]
        samples.append(
            (2 * t**3 - 3 * t**2 + 1) * p[i] + (3 * t**2 - 2 * t**3) * p[i + 1]
            + chord[i] * ((t**3 - 2 * t**2 + t) * tangents[i] + (t**3 - t**2) * tangents[i + 1]))
    return np.concatenate([*samples, p[-1:]])


def place(points: np.ndarray, turn: float, base: Vec) -> np.ndarray:
    """Turns points (..., 3) about the y axis by `turn` radians, then moves them."""
    cos, sin = np.cos(turn), np.sin(turn)
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([cos * x + sin * z, y, cos * z - sin * x], axis=-1) + np.asarray(base, float)


def moved(islands: Sequence[Island], turn: float, base: Vec, lean: float = 0.0) -> list[Island]:
    """The islands leant about their z axis (counter-clockwise seen from +z), turned about y, then moved."""
    cos, sin = np.cos(lean), np.sin(lean)
    leant = np.array([(cos, sin, 0), (-sin, cos, 0), (0, 0, 1)])
    return [replace(i, positions=place(i.positions @ leant, turn, base), normals=place(i.normals @ leant, turn, (0, 0, 0)))
            for i in islands]
