"""What Mitsuba's emitters send to a floor, z = 0 with its front upwards, in closed forms. Points are (..., 3)."""

from __future__ import annotations

from typing import Sequence

import numpy as np

SKY_ROWS = 64


def point_light(points: np.ndarray, position: Sequence[float], intensity: float) -> np.ndarray:
    """Irradiance I cos / d^2."""
    away = np.array(position, float) - points
    distance = np.linalg.norm(away, axis=-1)
    return intensity * np.maximum(away[..., 2], 0) / distance**3


def angle_from(points: np.ndarray, position: Sequence[float], target: Sequence[float]) -> np.ndarray:
    """Between the axis from position to target and the way to each point, in degrees."""
    axis = np.array(target, float) - position
    way = points - np.array(position, float)
    return np.degrees(np.arccos(way @ axis / np.linalg.norm(way, axis=-1) / np.linalg.norm(axis)))


def polygon(points: np.ndarray, corners: Sequence[Sequence[float]], radiance: float) -> np.ndarray:
    """Of a polygon above the floor: L / 2 times the sum of its edges' angles times the cosines of their planes' normals
    (Lambert 1760; Arvo 1994, equation 2.3), by the absolute value, so that the order of corners means nothing."""
    ways = [np.array(corner, float) - points for corner in corners]
    ways = [way / np.linalg.norm(way, axis=-1, keepdims=True) for way in ways]
    total = np.zeros(points.shape[:-1])
    for a, b in zip(ways, ways[1:] + ways[:1]):
        normal = np.cross(a, b)
        angle = np.arccos(np.clip((a * b).sum(-1), -1, 1))
        total += angle * normal[..., 2] / np.maximum(np.linalg.norm(normal, axis=-1), 1e-30)
    return radiance * abs(total) / 2


def box(points: np.ndarray, low: Sequence[float], high: Sequence[float], radiance: float) -> np.ndarray:
    """Its faces that look at a point, each as a polygon."""
    ends = np.array([low, high], float)
    total = np.zeros(points.shape[:-1])
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side, sign in ((0, -1), (1, 1)):
            corners = []
            for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = np.zeros(3)
                corner[[axis, u, v]] = ends[side, axis], ends[i, u], ends[j, v]
                corners.append(corner)
            is_seen = sign * (points[..., axis] - ends[side, axis]) > 0
            total += np.where(is_seen, polygon(points, corners, radiance), 0)
    return total


def ball(points: np.ndarray, centre: Sequence[float], radius: float, radiance: float) -> np.ndarray:
    """Wholly above the floor: L pi (r / d)^2 cos (Howell, an element and a sphere)."""
    away = np.array(centre, float) - points
    distance = np.linalg.norm(away, axis=-1)
    return radiance * np.pi * radius**2 * away[..., 2] / distance**3


def flat_disk(points: np.ndarray, centre: Sequence[float], radius: float, radiance: float) -> np.ndarray:
    """Parallel to the floor (Howell, an element and a parallel disk): pi L / 2 (1 - (x^2 + h^2 - r^2) / root), with the root
    of (x^2 + h^2 + r^2)^2 - 4 x^2 r^2."""
    away = np.array(centre, float) - points
    x2, h2, r2 = away[..., 0] ** 2 + away[..., 1] ** 2, away[..., 2] ** 2, radius**2
    return np.pi * radiance / 2 * (1 - (x2 + h2 - r2) / np.sqrt((x2 + h2 + r2) ** 2 - 4 * x2 * r2))


def tube(points: np.ndarray, start: Sequence[float], end: Sequence[float], radius: float, radiance: float) -> np.ndarray:
    """A cylinder whose outside shines, by the middles of small patches: the sum of L cos cos' dA / d^2."""
    start, axis = np.array(start, float), np.subtract(end, start)
    length = np.linalg.norm(axis)
    axis = axis / length
    across = np.cross(axis, (0.3, 0.5, 0.8))
    across /= np.linalg.norm(across)
    total = np.zeros(points.shape[:-1])
    steps, turns = 40, 64
    for turn in 2 * np.pi * (np.arange(turns) + 0.5) / turns:
        normal = np.cos(turn) * across + np.sin(turn) * np.cross(axis, across)
        for height in length * (np.arange(steps) + 0.5) / steps:
            way = start + height * axis + radius * normal - points
            squared = (way * way).sum(-1)
            cosines = np.maximum(way[..., 2], 0) * np.maximum(-way @ normal, 0) / squared
            total += radiance * cosines / squared * (2 * np.pi * radius * length / steps / turns)
    return total


def sky() -> bytes:
    """Red is 1 + 0.8 x of the direction that a texel is for, green and blue so of y and z. In Mitsuba's space
    u = atan2(x, -z) / 2 pi and v = acos(y) / pi (EnvironmentMap::eval)."""
    v, u = np.meshgrid((np.arange(SKY_ROWS) + 0.5) / SKY_ROWS, (np.arange(2 * SKY_ROWS) + 0.5) / (2 * SKY_ROWS),
                       indexing="ij")
    direction = np.stack([np.sin(np.pi * v) * np.sin(2 * np.pi * u), np.cos(np.pi * v),
                          -np.sin(np.pi * v) * np.cos(2 * np.pi * u)], axis=-1)
    texels = (1 + 0.8 * direction).astype("<f4")
    return f"PF\n{2 * SKY_ROWS} {SKY_ROWS}\n-1.0\n".encode() + texels[::-1].tobytes()
