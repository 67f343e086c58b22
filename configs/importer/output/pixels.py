"""Texels as files: what a source's file holds goes on as it is where it says the same, else a PNG is made."""

from __future__ import annotations

from enum import Enum
from typing import Iterator

import numpy as np

from importer.images import srgb
from importer.problems import ImportProblem
from importer.scene import Image
from scenes.png_file import png_bytes

_SIGNATURES = {"image/png": b"\x89PNG\r\n\x1a\n", "image/jpeg": b"\xff\xd8\xff"}
_WHOLE_STEP = 1e-3  # so near to a whole number of 255ths, 8 bits say all there is
_BLOCK = 1 << 18  # texels at a time
_LARGE = 1 << 22  # bytes; from here on a file that is a little smaller is not worth the time


class Channels(Enum):
    """What the reader makes of the texels."""

    COLOUR = "sRGB, alpha of no consequence"
    COLOUR_ALONE = "sRGB, and there must be no alpha"
    COLOUR_AND_ALPHA = "sRGB and alpha"
    NUMBERS = "linear"
    GREEN = "linear, the first in G; R and B are 1, as B is multiplied with metallicFactor"
    ALPHA = "linear, the first in A under white"


def _check(image: Image) -> None:
    shape = image.pixels.shape
    if len(shape) != 3 or shape[2] not in (3, 4) or 0 in shape:
        raise ImportProblem(f"image {image.name}: it has {shape} numbers; (height, width, 3 or 4) would be right")
    if image.pixels.dtype != np.uint8 and not np.isfinite(image.pixels).all():
        raise ImportProblem(f"image {image.name}: a texel is no finite number")


def _values(image: Image, channels: Channels) -> Iterator[np.ndarray]:
    """In [0, 1] and in the file's own encoding, some rows at a time, as floats take many times the room of what is
    written."""
    rows = max(1, _BLOCK // image.pixels.shape[1])
    for top in range(0, len(image.pixels), rows):
        pixels = image.pixels[top:top + rows]
        yield np.clip(_laid_out(srgb.linear(Image(image.name, pixels)), pixels[..., 3:], channels), 0, 1)


def _laid_out(linear: np.ndarray, alpha: np.ndarray, channels: Channels) -> np.ndarray:
    ones = np.ones_like(linear[..., 0])
    if channels is Channels.GREEN:
        return np.stack([ones, linear[..., 0], ones], axis=2)
    if channels is Channels.ALPHA:
        return np.stack([ones, ones, ones, linear[..., 0]], axis=2)
    if channels is Channels.NUMBERS:
        return linear
    colours = srgb.from_linear(linear)
    return np.concatenate([colours, alpha], axis=2) if channels is Channels.COLOUR_AND_ALPHA else colours


def _are_bytes(values: np.ndarray) -> bool:
    steps = values * 255
    return bool(np.abs(steps - np.round(steps)).max() < _WHOLE_STEP)


def _quantised(image: Image, channels: Channels) -> np.ndarray:
    """8 bits where they lose nothing, else 16."""
    is_coarse = all(_are_bytes(values) for values in _values(image, channels))
    kind, most = (np.uint8, 255) if is_coarse else (np.uint16, 65535)
    return np.concatenate([np.round(values * most).astype(kind) for values in _values(image, channels)])


def _is_same_file(image: Image, channels: Channels) -> bool:
    """Whether the reader makes of `encoded` what `pixels` say. It is there where glTF reads the same colours from it
    (importer.images.load), and numbers are read in another way than colours."""
    if image.encoded is None:
        return False
    fits = channels is Channels.COLOUR or (channels is Channels.COLOUR_ALONE and image.pixels.shape[2] == 3)
    return fits and image.encoded.startswith(_SIGNATURES.get(image.mime_type, b"\0"))


def encoded(image: Image, channels: Channels) -> tuple[bytes, str]:
    """A file's bytes and its media type."""
    _check(image)
    if _is_same_file(image, channels):
        return image.encoded, image.mime_type
    if image.pixels.dtype == np.uint8 and channels in (Channels.COLOUR, Channels.COLOUR_ALONE):
        texels = image.pixels[..., :3]
    else:
        texels = _quantised(image, channels)
    if texels.nbytes > _LARGE:
        return png_bytes(texels, filters=(2,), level=4), "image/png"
    return png_bytes(texels, filters=(1, 2), level=6), "image/png"
