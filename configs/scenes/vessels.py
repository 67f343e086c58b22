"""Surfaces of revolution for baths and tables: glassware and ceramics with an inside, a tap, an open lampshade.

Each vessel is one closed surface, its wall as thick as it looks, open to the top and standing on the origin. So glass
encloses a volume of glass and no other.
"""

from __future__ import annotations

import numpy as np

from models import BOWL, revolve
from rings import MICROMETRE, RingSurface
from unwrap import Island

# Outlines as (radius, height, samples up to the next point): up the outside, over the rim, down the inside.
TUMBLER = [
    (0.0280, 0.0000, 1), (0.0320, 0.0010, 1), (0.0345, 0.0045, 4), (0.0385, 0.0500, 4), (0.0425, 0.1090, 1),
    (0.0418, 0.1104, 1), (0.0406, 0.1104, 1), (0.0400, 0.1090, 4), (0.0358, 0.0500, 4), (0.0318, 0.0160, 1),
    (0.0280, 0.0128, 1), (0.0150, 0.0120, 0)]
BOTTLE = [
    (0.0360, 0.0000, 1), (0.0405, 0.0015, 1), (0.0430, 0.0060, 2), (0.0435, 0.0300, 3), (0.0435, 0.1450, 4),
    (0.0370, 0.1780, 3), (0.0200, 0.2080, 3), (0.0150, 0.2400, 3), (0.0148, 0.2820, 1), (0.0172, 0.2850, 1),
    (0.0175, 0.2960, 1), (0.0150, 0.2990, 1), (0.0122, 0.2960, 2), (0.0112, 0.2400, 3), (0.0160, 0.2075, 3),
    (0.0332, 0.1760, 3), (0.0398, 0.1440, 3), (0.0398, 0.0300, 2), (0.0380, 0.0130, 1), (0.0300, 0.0100, 0)]
VASE = [
    (0.0420, 0.0000, 1), (0.0480, 0.0020, 1), (0.0520, 0.0080, 3), (0.0830, 0.0700, 4), (0.0900, 0.1200, 4),
    (0.0600, 0.1900, 4), (0.0400, 0.2350, 3), (0.0560, 0.2950, 1), (0.0555, 0.2985, 1), (0.0530, 0.2985, 1),
    (0.0515, 0.2950, 3), (0.0345, 0.2350, 4), (0.0545, 0.1880, 4), (0.0840, 0.1200, 4), (0.0775, 0.0720, 3),
    (0.0460, 0.0180, 1), (0.0300, 0.0140, 0)]
TUB = [
    (0.480, 0.000, 1), (0.520, 0.006, 1), (0.540, 0.030, 3), (0.610, 0.200, 3), (0.670, 0.430, 2), (0.700, 0.540, 2),
    (0.735, 0.568, 1), (0.738, 0.580, 1), (0.730, 0.588, 2), (0.690, 0.580, 2), (0.650, 0.520, 3), (0.590, 0.300, 3),
    (0.500, 0.120, 3), (0.300, 0.085, 0)]
GLOBE = 0.13  # outer radius of the lamp's cover
# An open cone of sheet metal: a closed outline, from the upper rim down the outside and up the inside.
CONE = [
    (0.062, 0.160), (0.070, 0.158), (0.120, 0.112), (0.170, 0.060), (0.222, 0.003), (0.226, 0.000), (0.224, 0.007),
    (0.172, 0.064), (0.122, 0.116), (0.071, 0.162), (0.064, 0.164)]


def _vessel(outline: list[tuple[float, float, int]], bottom: float, n: int, south: int, north: int) -> list[Island]:
    """`bottom`: height of the middle of the inside; `south`, `north`: bands of the discs in the UV map."""
    return RingSurface((0, 0, 0), revolve(outline, n), (0, bottom, 0)).unwrap(south, north)


def tumbler(n: int = 40) -> list[Island]:
    return _vessel(TUMBLER, 0.0118, n, 4, 4)


def bottle(n: int = 40) -> list[Island]:
    return _vessel(BOTTLE, 0.0095, n, 4, 5)


def glass_vase(n: int = 44) -> list[Island]:
    return _vessel(VASE, 0.0135, n, 4, 6)


def basin(n: int = 40) -> list[Island]:
    """0.4 m wide and 0.16 m high."""
    return _vessel([(r * 1.25, h * 1.4, steps) for r, h, steps in BOWL], 0.0243, n, 6, 7)


def tub(n: int = 48) -> list[Island]:
    """1.48 m long along x, 0.74 m wide, 0.59 m high."""
    return RingSurface((0, 0, 0), revolve(TUB, n) * (1, 1, 0.5), (0, 0.083, 0)).unwrap(5, 9)


def tap(n: int = 16) -> list[Island]:
    """A bent pipe, 0.24 m high, whose spout points along +x; its foot is a wider ring."""
    bend = [(0.06 - 0.06 * np.cos(a), 0.18 + 0.06 * np.sin(a), a) for a in np.linspace(0, 1.0, 13) * np.pi * 0.95]
    line = [(0, 0.0, 0), (0, 0.012, 0), (0, 0.014, 0), (0, 0.10, 0), *bend]
    radii = [0.026, 0.026, 0.013, 0.013, *[0.013] * len(bend)]
    a = 2 * np.pi * np.arange(n) / n
    rings = np.array([[(x + r * np.cos(t) * np.cos(turn), y + r * np.cos(t) * np.sin(turn) * -1, r * np.sin(-t)) for t in a]
                      for (x, y, turn), r in zip(line, radii)])
    return RingSurface((0, 0, 0), rings, tuple(rings[-1].mean(axis=0))).unwrap(1, 1)


def _sphere(radius: float, n: int) -> np.ndarray:
    polar = np.pi * (np.arange(n // 2 - 1) + 1) / (n // 2)
    return revolve([(radius * np.sin(a), -radius * np.cos(a), 1) for a in polar], n)


def bulb(radius: float, n: int = 20) -> list[Island]:
    """A ball around the origin."""
    return RingSurface((0, -radius, 0), _sphere(radius, n), (0, radius, 0)).unwrap(2, 2)


def globe(wall: float, n: int = 40) -> list[Island]:
    """A hollow ball of glass around the origin: two closed surfaces, of which the inner one faces its middle."""
    outer = RingSurface((0, -GLOBE, 0), _sphere(GLOBE, n), (0, GLOBE, 0))
    inner = RingSurface((0, wall - GLOBE, 0), _sphere(GLOBE - wall, n), (0, GLOBE - wall, 0))
    inside = [Island(i.positions, -i.normals, i.uv * (-1, 1), i.triangles[:, ::-1]) for i in inner.unwrap(4, 4)]
    return [*outer.unwrap(4, 4), *inside]


def cone(n: int = 48) -> list[Island]:
    """A lampshade that is open to both ends, 0.45 m wide; its lower rim lies around the origin."""
    profile = np.array(CONE)
    way = np.roll(profile, -1, axis=0) - profile
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    outward = np.stack([-way[:, 1], way[:, 0]], axis=1)  # what lies to the left of the way along the outline
    return [_band(profile[[i, (i + 1) % len(profile)]], _corner_normals(outward, i), n) for i in range(len(profile))]


def _corner_normals(outward: np.ndarray, i: int) -> np.ndarray:
    """Of both ends of piece i of an outline: together with its neighbours where these go on nearly straight."""
    ends = []
    for other in (outward[i - 1], outward[(i + 1) % len(outward)]):
        normal = outward[i] + other if outward[i] @ other > 0.8 else outward[i]
        ends.append(normal / np.linalg.norm(normal))
    return np.array(ends)


def _band(ends: np.ndarray, normals: np.ndarray, n: int) -> Island:
    """Piece of an outline, from its first end (above, seen from outside) to its last, once around y."""
    a = 2 * np.pi * np.append(np.arange(n), 0) / n  # the seam has both its sides
    def around(points: np.ndarray) -> np.ndarray:
        return np.concatenate([np.stack([np.sin(a) * r, np.full(n + 1, h), np.cos(a) * r], axis=1) for r, h in points])
    u = np.linspace(0, 2 * np.pi * ends[:, 0].mean(), n + 1)
    uv = np.concatenate([np.stack([u, np.full(n + 1, v)], axis=1) for v in (np.linalg.norm(ends[1] - ends[0]), 0)])
    high = np.arange(n)
    low = high + n + 1
    triangles = np.concatenate([np.stack([low, low + 1, high + 1], 1), np.stack([low, high + 1, high], 1)])
    return Island(around(ends).round(MICROMETRE), around(normals), uv, triangles)
