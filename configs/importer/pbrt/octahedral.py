"""The octahedral map of equal areas, in which pbrt-v4 keeps skies (pbr-book, 3.8.3; Clarberg, "Fast Equal-Area Mapping
of the (Hemi)Sphere using SIMD", 2008)."""

from __future__ import annotations

import numpy as np

_SAMPLES = 4096  # per latitude: a pixel keeps its share of light to a few per cent, a sun's in a large image too
_ROWS_AT_ONCE = 16
MOST_ROWS = 4096


def square_of_directions(directions: np.ndarray) -> np.ndarray:
    """(..., 2) in [0, 1]^2 for unit vectors: the upper half within the inner diamond, the lower one folded about it."""
    absolute = np.abs(directions)
    radius = np.sqrt(np.maximum(1 - absolute[..., 2], 0))
    t = radius * np.arctan2(absolute[..., 1], absolute[..., 0]) * (2 / np.pi)
    s = radius - t
    is_below = directions[..., 2] < 0
    s, t = np.where(is_below, 1 - t, s), np.where(is_below, 1 - s, t)
    return np.stack([np.copysign(s, directions[..., 0]), np.copysign(t, directions[..., 1])], axis=-1) / 2 + 0.5


def heights_of_square(size: int) -> np.ndarray:
    """(size, size): z of the direction of each pixel's centre: 1 - r^2 by the distance r from the nearer pole."""
    side = np.abs((np.arange(size) + 0.5) / size * 2 - 1)
    distance = 1 - (side[:, None] + side[None, :])
    return np.copysign(1 - (1 - np.abs(distance)) ** 2, distance)


def upper_illuminance(image: np.ndarray, luminance: np.ndarray) -> float:
    """On what lies flat and faces +z. Every pixel has the same solid angle (Light::Create, "illuminance")."""
    height = heights_of_square(image.shape[0])
    pixel = 4 * np.pi / height.size
    return float((image @ luminance * np.maximum(height, 0)).sum() * pixel)


def latitude_longitude(image: np.ndarray) -> np.ndarray:
    """(n, 2 n, 3): row 0 at +z, column 0 at +x, +y a quarter to the right. Each texel is the mean over samples within
    it of the nearest pixel, as pbrt looks it up."""
    size = image.shape[0]
    rows = min(size, MOST_ROWS)
    fine = max(2, min(8, _SAMPLES // rows))
    longitude = (np.arange(2 * rows * fine) + 0.5) / (2 * rows * fine) * (2 * np.pi)
    around = np.stack([np.cos(longitude), np.sin(longitude)], axis=-1)
    result = np.empty((rows, 2 * rows, 3), np.float32)
    for first in range(0, rows, _ROWS_AT_ONCE):
        count = min(_ROWS_AT_ONCE, rows - first)
        colatitude = (first + (np.arange(count * fine) + 0.5) / fine) / rows * np.pi
        directions = np.empty((count * fine, len(longitude), 3))
        directions[..., :2] = np.sin(colatitude)[:, None, None] * around
        directions[..., 2] = np.cos(colatitude)[:, None]
        pixel = np.minimum((square_of_directions(directions) * size).astype(np.int64), size - 1)
        found = image[pixel[..., 1], pixel[..., 0]].reshape(count, fine, 2 * rows, fine, 3)
        share = np.sin(colatitude).reshape(count, fine)  # of the texel's solid angle: rows at the poles taper
        share /= share.sum(axis=1, keepdims=True)
        result[first:first + count] = np.einsum("rf,rfcgk->rck", share, found) / fine
    return result
