"""Reads the OpenEXR files that `qtrace run` writes, without a library: Debian has none for Python that is
small (OpenImageIO and OpenCV each bring more than a hundred packages), and the part of the format in use is.

Read are single-part scan-line files, half and float channels, compression none, ZIPS or ZIP; anything else
is refused by name. Source: OpenEXR, "File Layout", and ImfZip.cpp for the predictor.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from analysis.command import AnalysisError

MAGIC = 20000630
KINDS = {0x200: "tiled", 0x800: "deep", 0x1000: "multi-part"}  # bits of the version field
PIXEL_TYPES = ["<u4", "<f2", "<f4"]
COMPRESSIONS = ["none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"]
LINES_PER_CHUNK = {"none": 1, "ZIPS": 1, "ZIP": 16}
MAX_SIDE = 65536  # the limit of `qtrace compare`, too


class ExrError(AnalysisError):
    """A file that is not an OpenEXR image of the kind read here."""


@dataclass(frozen=True)
class ExrImage:
    channels: dict[str, np.ndarray]  # by name; float32, height x width, top row first
    metadata: dict[str, str]         # the text attributes: spp, seed, configHash, ...

    def rgb(self, file: Path) -> np.ndarray:
        """height x width x 3, scene-linear."""
        if not all(name in self.channels for name in "RGB"):
            raise ExrError(f"{file}: has no channels R, G, B; it has {', '.join(self.channels)}")
        return np.stack([self.channels[name] for name in "RGB"], axis=-1)


def _text(data: bytes, start: int) -> tuple[str, int]:
    """A name that ends with a zero byte, and the position behind it."""
    end = data.index(b"\0", start)
    return data[start:end].decode(), end + 1


def _header(data: bytes) -> tuple[dict[str, tuple[str, bytes]], int]:
    """The attributes as (type, value), and the position behind them."""
    attributes = {}
    position = 8
    while data[position] != 0:
        name, position = _text(data, position)
        kind, position = _text(data, position)
        (size,) = struct.unpack_from("<i", data, position)
        attributes[name] = (kind, data[position + 4:position + 4 + size])
        position += 4 + size
    return attributes, position + 1


def _channels(value: bytes) -> list[tuple[str, str]]:
    """Names and numpy types, in the order of the file."""
    channels = []
    position = 0
    while value[position] != 0:
        name, position = _text(value, position)
        kind, _, x_sampling, y_sampling = struct.unpack_from("<iIii", value, position)
        if (x_sampling, y_sampling) != (1, 1):
            raise ExrError(f"channel '{name}' is subsampled")
        channels.append((name, PIXEL_TYPES[kind]))
        position += 16
    return channels


def _inflate(packed: bytes, size: int) -> bytes:
    """ZIP: bytes differ from their predecessors by value - 128; first halves and second halves interleave."""
    if len(packed) == size:  # stored as it was where compression would not have helped
        return packed
    deltas = np.frombuffer(zlib.decompress(packed), np.uint8).copy()
    deltas[1:] -= 128
    halves = np.cumsum(deltas, dtype=np.uint8)
    result = np.empty_like(halves)
    result[0::2], result[1::2] = np.split(halves, [(size + 1) // 2])
    return result.tobytes()


def _parse(data: bytes) -> ExrImage:
    magic, version = struct.unpack_from("<iI", data)
    if magic != MAGIC:
        raise ExrError("it does not begin as one")
    for bit, kind in KINDS.items():
        if version & bit:
            raise ExrError(f"{kind} files are not read")
    attributes, position = _header(data)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = right - left + 1, bottom - top + 1
    if not (0 < width <= MAX_SIDE and 0 < height <= MAX_SIDE):
        raise ExrError(f"{width}x{height} pixels are not between 1 and {MAX_SIDE} each way")
    compression = COMPRESSIONS[attributes["compression"][1][0]]
    if compression not in LINES_PER_CHUNK:
        raise ExrError(f"compression {compression} is not read; ZIP is")
    line = np.dtype([(name, kind, (width,)) for name, kind in _channels(attributes["channels"][1])])
    per_chunk = LINES_PER_CHUNK[compression]
    offsets = struct.unpack_from(f"<{-(-height // per_chunk)}Q", data, position)
    lines = np.empty(height, line)
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        wanted = lines[y - top:y - top + per_chunk]
        chunk = _inflate(data[offset + 8:offset + 8 + size], wanted.nbytes)
        if len(chunk) != wanted.nbytes:
            raise ExrError("it is truncated or damaged")
        wanted[:] = np.frombuffer(chunk, line)
    channels = {name: lines[name].astype(np.float32) for name in line.names}
    texts = {name: value.decode() for name, (kind, value) in attributes.items() if kind == "string"}
    return ExrImage(channels, texts)


def read_exr(file: Path) -> ExrImage:
    try:
        return _parse(file.read_bytes())
    except OSError as error:
        raise ExrError(f"{file}: cannot be read: {error.strerror}") from error
    except ExrError as error:
        raise ExrError(f"{file}: cannot be read as an OpenEXR image: {error}") from error
    except (struct.error, zlib.error, ValueError, LookupError, OverflowError, MemoryError) as error:
        raise ExrError(f"{file}: cannot be read as an OpenEXR image: it is truncated or damaged") from error
