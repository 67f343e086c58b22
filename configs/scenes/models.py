"""The curved objects: a teapot, a head, a bowl, a lampshade and a ball.

Both are modelled here from control points of our own, so that the scenes carry
no third-party data. Metres, y up; each model stands on its own origin, the head
faces +z and the teapot's spout points along +x.
"""

from __future__ import annotations

import numpy as np

from rings import RingSurface
from shapes import Vec, catmull_rom, place
from unwrap import Island

TEAPOT_TRIANGLES = 6320
HEAD_TRIANGLES = 968

# Outlines as (radius, height, samples up to the next point), bottom to top.
BODY = [
    (0.120, 0.000, 2), (0.138, 0.002, 2), (0.146, 0.010, 2), (0.150, 0.020, 2),
    (0.186, 0.052, 3), (0.222, 0.104, 3), (0.229, 0.150, 3), (0.212, 0.212, 3),
    (0.180, 0.264, 2), (0.160, 0.290, 1), (0.155, 0.302, 1), (0.150, 0.308, 1),
    (0.143, 0.306, 1), (0.138, 0.298, 1), (0.100, 0.296, 0)]
LID = [
    (0.110, 0.299, 1), (0.130, 0.300, 1), (0.137, 0.305, 1), (0.134, 0.312, 2),
    (0.100, 0.328, 2), (0.050, 0.342, 1), (0.028, 0.350, 1), (0.022, 0.357, 1),
    (0.026, 0.366, 2), (0.038, 0.378, 2), (0.034, 0.391, 1), (0.024, 0.397, 1),
    (0.012, 0.3995, 0)]
# Centre lines as (x, y, in-plane radius, sideways radius, samples).
SPOUT = [
    (0.165, 0.096, 0.070, 0.056, 5), (0.250, 0.117, 0.056, 0.045, 8),
    (0.308, 0.188, 0.036, 0.032, 8), (0.352, 0.262, 0.027, 0.027, 6),
    (0.395, 0.308, 0.028, 0.028, 0)]
HANDLE = [
    (-0.165, 0.255, 0.016, 0.022, 5), (-0.250, 0.276, 0.017, 0.023, 7),
    (-0.345, 0.248, 0.018, 0.024, 7), (-0.358, 0.170, 0.018, 0.024, 7),
    (-0.290, 0.098, 0.017, 0.023, 7), (-0.195, 0.064, 0.016, 0.022, 0)]
# The spout turns inwards at its end: (distance along it, share of the radius).
LIP = [(0.004, 0.94), (0.004, 0.84), (-0.004, 0.76), (-0.030, 0.72), (-0.055, 0.70),
       (-0.060, 0.40)]


def teapot(turn: float, base: Vec) -> list[Island]:
    """Teapot 0.4 m high, turned about y by `turn` radians, standing on `base`."""
    spout, handle = _tube(SPOUT, 20), _tube(HANDLE, 20)
    spout = np.concatenate([spout, _lip(spout)])
    surfaces = [
        (revolve(BODY, 40), 0.000, 0.296), (revolve(LID, 40), 0.299, 0.400)]
    parts = []
    for rings, low, high in surfaces:
        parts.append(_closed(rings, turn, base, (0, low, 0), (0, high, 0)))
    for rings in (spout, handle):
        parts.append(_closed(rings, turn, base, rings[0].mean(0), rings[-1].mean(0)))
    assert sum(2 * part.n * part.count for part in parts) == TEAPOT_TRIANGLES
    body, lid, spout_part, handle_part = parts
    return [*body.unwrap(5, 6, pieces=2), *lid.unwrap(4, 11),
            *spout_part.unwrap(1, 5), *handle_part.unwrap(1, 1)]


def _closed(rings: np.ndarray, turn: float, base: Vec, south: Vec, north: Vec) -> RingSurface:
    """Closes the rings with two poles and puts the part into its place."""
    low, high = place(np.array([south, north], float), turn, base)
    return RingSurface(low, place(rings, turn, base), high)


def _angles(n: int) -> np.ndarray:
    return 2 * np.pi * np.arange(n) / n


def revolve(outline: list[tuple[float, float, int]], n: int) -> np.ndarray:
    """Rings of n points of a surface of revolution about y."""
    curve = catmull_rom([p[:2] for p in outline], [p[2] for p in outline[:-1]])
    a = _angles(n)
    radius, height = curve[:, :1], curve[:, 1:]
    return np.stack([radius * np.sin(a), np.broadcast_to(height, (len(curve), n)),
                     radius * np.cos(a)], axis=2)


def _tube(line: list[tuple[float, float, float, float, int]], n: int) -> np.ndarray:
    """Rings of n points swept along a centre line in the x-y plane."""
    curve = catmull_rom([p[:4] for p in line], [p[4] for p in line[:-1]])
    centre, radii = curve[:, :2], curve[:, 2:]
    along = np.gradient(centre, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    a = _angles(n)
    # In-plane normal N = z x T, sideways B = T x N = z: N x B = T.
    side = np.stack([-along[:, 1], along[:, 0]], axis=1)
    plane = centre[:, None] + (radii[:, :1] * np.cos(a))[..., None] * side[:, None]
    return np.concatenate([plane, (radii[:, 1:] * np.sin(a))[..., None]], axis=2)


def _lip(tube: np.ndarray) -> np.ndarray:
    """Rings that round off the last ring of a tube and go back inside it."""
    last, middle = tube[-1], tube[-1].mean(axis=0)
    step = middle - tube[-2].mean(axis=0)
    step /= np.linalg.norm(step)
    return np.array([middle + move * step + share * (last - middle) for move, share in LIP])


# Head outline: height, half width, reach to the front, reach to the back,
# samples up to the next line; in units of the head's whole height.
HEAD = [
    (0.000, 0.190, 0.150, 0.195, 1), (0.012, 0.200, 0.160, 0.205, 1),
    (0.130, 0.176, 0.146, 0.192, 1), (0.180, 0.182, 0.195, 0.203, 1),
    (0.210, 0.190, 0.268, 0.212, 1), (0.245, 0.200, 0.312, 0.222, 1),
    (0.285, 0.214, 0.316, 0.234, 1), (0.315, 0.222, 0.318, 0.244, 1),
    (0.338, 0.228, 0.318, 0.252, 1), (0.362, 0.234, 0.318, 0.260, 1),
    (0.400, 0.241, 0.319, 0.276, 1), (0.440, 0.248, 0.320, 0.296, 1),
    (0.500, 0.257, 0.320, 0.325, 1), (0.560, 0.264, 0.318, 0.345, 1),
    (0.610, 0.268, 0.318, 0.356, 1), (0.665, 0.270, 0.330, 0.362, 1),
    (0.740, 0.268, 0.322, 0.360, 1), (0.830, 0.250, 0.285, 0.330, 1),
    (0.900, 0.212, 0.225, 0.275, 1), (0.955, 0.155, 0.145, 0.190, 1),
    (0.988, 0.080, 0.060, 0.095, 0)]
# Features: azimuth in degrees from the face, height, spread of both, push out.
FEATURES = [
    (0, 0.445, 8.5, 0.023, 0.082), (0, 0.510, 8, 0.040, 0.060), (0, 0.590, 8, 0.030, 0.025),
    (20, 0.590, 9, 0.035, -0.042), (-20, 0.590, 9, 0.035, -0.042),
    (18, 0.665, 12, 0.022, 0.014), (-18, 0.665, 12, 0.022, 0.014),
    (0, 0.364, 15, 0.013, 0.022), (0, 0.338, 20, 0.009, -0.022),
    (0, 0.312, 14, 0.013, 0.024), (0, 0.240, 13, 0.022, 0.024),
    (96, 0.545, 8, 0.055, 0.066), (-96, 0.545, 8, 0.055, 0.066)]


def head(height: float, turn: float, base: Vec) -> list[Island]:
    """A head with neck, `height` metres high, turned about y, standing on `base`."""
    n = 22
    rows = catmull_rom([p[:4] for p in HEAD], [p[4] for p in HEAD[:-1]])
    a = _angles(n)
    a = a - 0.35 * np.sin(a)  # more columns where the face is
    up, width, front, back = (rows[:, i:i + 1] for i in range(4))
    depth = np.where(np.cos(a) > 0, front, back)
    push = np.zeros((len(rows), n))
    for azimuth, level, spread_a, spread_y, amount in FEATURES:
        off = np.degrees((a - np.radians(azimuth) + np.pi) % (2 * np.pi) - np.pi)
        push += amount * np.exp(-((off / spread_a) ** 2 + ((up - level) / spread_y) ** 2) / 2)
    rings = np.stack([(width + push) * np.sin(a), np.broadcast_to(up, push.shape),
                      (depth + push) * np.cos(a)], axis=2) * height
    under = np.array([0.9, 0.0, 0.9]) * rings[:1]  # keeps the flat base's edge sharp
    part = _closed(np.concatenate([under, rings]), turn, base,
                   (0, 0, 0), (0, height, -0.02 * height))
    assert 2 * part.n * part.count == HEAD_TRIANGLES
    return part.unwrap(2, 6, pieces=2)


# Outlines as (radius, height, samples up to the next point), from pole to pole.
BOWL = [
    (0.055, 0.000, 1), (0.068, 0.003, 1), (0.072, 0.010, 1), (0.078, 0.016, 3), (0.130, 0.050, 3), (0.158, 0.105, 1),
    (0.160, 0.112, 1), (0.157, 0.114, 1), (0.153, 0.110, 3), (0.124, 0.055, 3), (0.074, 0.024, 2), (0.030, 0.018, 0)]
SHADE = [
    (0.030, 0.198, 2), (0.075, 0.180, 3), (0.160, 0.090, 3), (0.212, 0.004, 1), (0.215, 0.000, 1), (0.218, 0.004, 3),
    (0.167, 0.095, 3), (0.082, 0.188, 1), (0.040, 0.206, 0)]


def bowl(n: int = 36) -> list[Island]:
    """0.32 m wide, open to the top, standing on the origin."""
    return RingSurface((0, 0, 0), revolve(BOWL, n), (0, 0.017, 0)).unwrap(6, 7)


def shade(n: int = 32) -> list[Island]:
    """A bell 0.44 m wide, open to below, whose rim lies around the origin."""
    return RingSurface((0, 0.2, 0), revolve(SHADE, n), (0, 0.208, 0)).unwrap(9, 8)


def ball(radius: float, n: int = 32) -> list[Island]:
    """Standing on the origin."""
    polar = np.pi * np.arange(1, n // 2) / (n // 2)
    outline = [(radius * np.sin(a), radius * (1 - np.cos(a)), 1) for a in polar]
    return RingSurface((0, 0, 0), revolve(outline, n), (0, 2 * radius, 0)).unwrap(n // 8, n // 8)
