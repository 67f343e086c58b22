"""PNG files of grey values, colours and palettes, in 8 or 16 bits a channel."""

from __future__ import annotations

import struct
import zlib

import numpy as np

GREY, RGB, PALETTE, RGBA = 0, 2, 3, 6  # PNG's colour types
_KINDS = {1: GREY, 3: RGB, 4: RGBA}  # by channels


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def _filtered(rows: np.ndarray, step: int, kind: int) -> np.ndarray:
    """PNG's filters 0 to 2: bytes as they are, less the pixel before them, less the pixel above. In one array, as an image
    may have hundreds of megabytes."""
    filtered = np.empty((rows.shape[0], rows.shape[1] + 1), np.uint8)
    filtered[:, 0], filtered[:, 1:] = kind, rows
    if kind == 1:
        filtered[:, 1 + step:] -= rows[:, :-step]
    elif kind == 2:
        filtered[1:, 1:] -= rows[:-1]
    return filtered


def png_bytes(pixels: np.ndarray, palette: np.ndarray | None = None, filters: tuple[int, ...] = (0, 1, 2),
              level: int = 9) -> bytes:
    """(height, width) grey values or indices of the palette, or (height, width, 3 or 4) colours; 16 bits where
    `pixels` are uint16, else 8. Of `filters` the one whose file is smallest."""
    height, width = pixels.shape[:2]
    channels = pixels.shape[2] if pixels.ndim == 3 else 1
    depth = 16 if pixels.dtype == np.uint16 else 8
    kind = PALETTE if palette is not None else _KINDS[channels]
    values = np.ascontiguousarray(pixels, ">u2" if depth == 16 else np.uint8)
    rows = values.reshape(height, width * channels).view(np.uint8)
    packed = min((zlib.compress(_filtered(rows, channels * depth // 8, f), level) for f in filters), key=len)
    colours = _chunk(b"PLTE", palette.astype(np.uint8).tobytes()) if palette is not None else b""
    header = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + colours + _chunk(b"IDAT", packed) + _chunk(b"IEND", b"")
