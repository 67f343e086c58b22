"""Image files as textures and as skies.

8 and 16 bits are sRGB and floats linear, as both renderers take them (Mitsuba's `raw` and pbrt's `encoding` say
otherwise: `is_linear`). Embedded colour profiles are not applied, as there.
"""

from __future__ import annotations

import io
import struct
import warnings
from pathlib import Path

import numpy as np
from PIL import Image as Pillow

from importer.images import srgb
from importer.images.exr_file import read_exr
from importer.images.files import MAX_PIXELS, check_size, read_bytes
from importer.images.radiance import read_hdr, read_pfm
from importer.problems import ImportProblem
from importer.scene import Image

_FLOATS = {".exr": read_exr, ".hdr": read_hdr, ".pic": read_hdr, ".rgbe": read_hdr, ".pfm": read_pfm}
_FORMATS = ("PNG", "JPEG", "TGA", "BMP")
_MANY = 1 << 22  # texels
_PILLOW_ERRORS = (OSError, SyntaxError, ValueError, LookupError, TypeError, OverflowError, struct.error, EOFError,
                  NotImplementedError, MemoryError)


def load_image(path: Path, is_linear: bool | None = None) -> Image:
    """`is_linear`: whether 8 and 16 bits hold linear values; None: no. The file's bytes are kept in `encoded` where
    glTF reads the same colours from them. Floats above 1 are clipped, which is the most that is reflected or passes;
    for what radiates use `load_scaled`."""
    if path.suffix.lower() in _FLOATS:
        return Image(path.stem, np.clip(_finite(path), 0, 1).astype(np.float64))
    data = read_bytes(path)
    picture = _opened(path, data)
    pixels = _pixels(path, picture, data)
    if is_linear:
        return Image(path.stem, _as_numbers(pixels) if pixels.dtype == np.uint8 else pixels)
    kept = data if picture.format in ("PNG", "JPEG") and picture.mode != "CMYK" else None
    if pixels.dtype != np.uint8:
        pixels[..., :3] = srgb.to_linear(pixels[..., :3])
    return Image(path.stem, pixels, kept, "image/jpeg" if picture.format == "JPEG" else "image/png")


def load_scaled(path: Path, is_linear: bool | None = None) -> tuple[Image, float]:
    """An image in [0, 1] and what it has to be multiplied by: for textures of radiance, whose floats go above 1."""
    if path.suffix.lower() not in _FLOATS:
        return load_image(path, is_linear), 1.0
    values = _finite(path)
    scale = max(float(values.max()), 1.0)
    return Image(path.stem, np.clip(values / np.float64(scale), 0, 1)), scale


def load_radiance(path: Path) -> np.ndarray:
    """(height, width, 3) float32, linear, not below 0: the filters of those who make such files leave values there."""
    if path.suffix.lower() in _FLOATS:
        return np.maximum(_finite(path), 0)
    image = load_image(path)
    height, width = image.pixels.shape[:2]
    check_size(path, width, height)  # before its bytes become floats
    return srgb.linear(image).astype(np.float32)


def _finite(path: Path) -> np.ndarray:
    values = _FLOATS[path.suffix.lower()](path)
    is_finite = np.isfinite(values).all(axis=2)
    if not is_finite.all():
        y, x = (int(i[0]) for i in np.nonzero(~is_finite))
        raise ImportProblem(f"{path}: the pixel in column {x} and row {y} is not a finite number")
    return values


def _opened(path: Path, data: bytes) -> Pillow.Image:
    """By its content, since names of textures are often wrong."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Pillow.DecompressionBombWarning)
        try:
            picture = Pillow.open(io.BytesIO(data), formats=_FORMATS)
        except Pillow.DecompressionBombError as error:
            raise ImportProblem(f"{path}: the image has more than the {MAX_PIXELS >> 20} Mi pixels that are read") from error
        except _PILLOW_ERRORS as error:
            known = ", ".join(_FORMATS)
            raise ImportProblem(f"{path}: the image is none of {known}, EXR, HDR and PFM, or is damaged") from error
    check_size(path, *picture.size, MAX_PIXELS)
    return picture


def _as_numbers(pixels: np.ndarray) -> np.ndarray:
    """Of bytes; of many in single precision, or 8192 x 8192 texels would take 1.6 GB, and as much again once changed."""
    return pixels / (np.float32(255) if pixels[..., 0].size > _MANY else np.float64(255))


def _pixels(path: Path, picture: Pillow.Image, data: bytes) -> np.ndarray:
    """(height, width, 3 or 4): uint8, or of files with 16 bits float64 in [0, 1]; the file's values, not linear yet."""
    try:
        if picture.format == "PNG" and data[24:25] == b"\x10":
            return _of_16_bits(picture, data)
        has_alpha = picture.mode in ("RGBA", "LA", "PA", "RGBa", "La") or "transparency" in picture.info
        return np.array(picture.convert("RGBA" if has_alpha else "RGB"))
    except _PILLOW_ERRORS as error:
        raise ImportProblem(f"{path}: the image is damaged: {error}") from error


def _of_16_bits(picture: Pillow.Image, data: bytes) -> np.ndarray:
    """Pillow has no images of three channels of 16 bits. It unpacks the high bytes of those of a PNG, and told that
    their order is the other one, the low bytes."""
    if picture.mode in ("I", "I;16", "I;16B"):
        grey = np.array(picture).astype(np.float64) / 65535
        return np.repeat(grey[..., None], 3, axis=2)
    high = np.array(picture).astype(np.float64)
    swapped = Pillow.open(io.BytesIO(data), formats=("PNG",))
    codec, extents, offset, order = swapped.tile[0]
    if order != f"{picture.mode};16B":  # grey with alpha, whose low bytes Pillow does not give
        return high / 255
    swapped.tile = [(codec, extents, offset, f"{picture.mode};16L")]
    return (high * 256 + np.array(swapped)) / 65535
