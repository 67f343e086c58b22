"""The sRGB curve (IEC 61966-2-1), both ways, and an image's linear colours."""

from __future__ import annotations

import numpy as np

from importer.scene import Image


def to_linear(value: np.ndarray) -> np.ndarray:
    """Of encoded values in [0, 1]."""
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def from_linear(value: np.ndarray) -> np.ndarray:
    """Clipped to [0, 1] first."""
    value = np.clip(value, 0, 1)
    return np.where(value <= 0.0031308, 12.92 * value, 1.055 * value ** (1 / 2.4) - 0.055)


_OF_BYTES = to_linear(np.arange(256) / 255)


def linear(image: Image) -> np.ndarray:
    """(height, width, 3) float64: without alpha."""
    return linear_lines(image, slice(None))


def linear_lines(image: Image, rows: slice) -> np.ndarray:
    return _of(image.pixels[rows, :, :3])


def linear_at(image: Image, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    return _of(image.pixels[rows, columns, :3])


def _of(colours: np.ndarray) -> np.ndarray:
    return _OF_BYTES[colours] if colours.dtype == np.uint8 else colours
