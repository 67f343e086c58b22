"""Texels as files: what a source's file holds goes on as it is where it says the same, else a PNG is made."""

from __future__ import annotations

from enum import Enum

import numpy as np

from importer.images import srgb
from importer.problems import ImportProblem
from importer.scene import Image
from scenes.png_file import png_bytes

_SIGNATURES = {"image/png": b"\x89PNG\r\n\x1a\n", "image/jpeg": b"\xff\xd8\xff"}
_WHOLE_STEP = 1e-3  # so near to a whole number of 255ths, 8 bits say all there is
_LARGE = 1 << 22  # bytes; from here on a file that is a little smaller is not worth the time


class Channels(Enum):
    """What the reader makes of the texels."""

    COLOUR = "sRGB, alpha of no consequence"
    COLOUR_ALONE = "sRGB, and there must be no alpha"
    COLOUR_AND_ALPHA = "sRGB and alpha"
    NUMBERS = "linear"


def _check(image: Image) -> None:
    shape = image.pixels.shape
    if len(shape) != 3 or shape[2] not in (3, 4) or 0 in shape:
        raise ImportProblem(f"image {image.name}: it has {shape} numbers; (height, width, 3 or 4) would be right")
    if image.pixels.dtype != np.uint8 and not np.isfinite(image.pixels).all():
        raise ImportProblem(f"image {image.name}: a texel is no finite number")


def _quantised(values: np.ndarray) -> np.ndarray:
    """Of [0, 1]: 8 bits where they lose nothing, else 16."""
    values = np.clip(values, 0, 1)
    steps = values * 255
    if np.abs(steps - np.round(steps)).max() < _WHOLE_STEP:
        return np.round(steps).astype(np.uint8)
    return np.round(values * 65535).astype(np.uint16)


def _values(image: Image, channels: Channels) -> np.ndarray:
    """In [0, 1], in the file's own encoding."""
    pixels, is_bytes = image.pixels, image.pixels.dtype == np.uint8
    if channels is Channels.NUMBERS:
        return srgb.linear(image)
    colours = pixels[..., :3] / 255 if is_bytes else srgb.from_linear(pixels[..., :3])
    if channels is not Channels.COLOUR_AND_ALPHA or pixels.shape[2] == 3:
        return colours
    return np.concatenate([colours, pixels[..., 3:] / 255 if is_bytes else pixels[..., 3:]], axis=2)


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
    if image.pixels.dtype == np.uint8 and channels is not Channels.NUMBERS:
        texels = image.pixels if channels is Channels.COLOUR_AND_ALPHA else image.pixels[..., :3]
    else:
        texels = _quantised(_values(image, channels))
    if texels.nbytes > _LARGE:
        return png_bytes(texels, filters=(2,), level=4), "image/png"
    return png_bytes(texels, filters=(1, 2), level=6), "image/png"
