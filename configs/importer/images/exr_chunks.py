"""The pixels of an OpenEXR file: blocks of scan lines or tiles, each packed for itself."""

from __future__ import annotations

import struct
import zlib

import numpy as np

from importer.images.exr_header import Damaged, Header
from importer.images.piz import unpacked_piz

__all__ = ["Damaged", "read_chunks"]
_LARGEST = 1 << 29  # of a block, unpacked; usual ones are below one MiB, but a tile may be the whole image


def read_chunks(data: bytes, header: Header, names: str) -> np.ndarray:
    """(height, width), a structure of the channels of these names: files of a renderer have dozens of others."""
    wanted = [(name, kind) for name, kind in header.channels if name in set(names)]
    pixels = np.zeros((header.height, header.width), np.dtype(wanted))
    count = _count(header)
    if header.size + 8 * count > len(data):
        raise Damaged("it is truncated or damaged")
    for offset in struct.unpack_from(f"<{count}Q", data, header.size):
        if header.tile is None:
            y, size = struct.unpack_from("<ii", data, offset)
            block, start = pixels[y - header.top:y - header.top + header.lines_per_chunk], offset + 8
            is_inside = 0 <= y - header.top < header.height
        else:
            column, row, level_x, level_y, size = struct.unpack_from("<5i", data, offset)
            width, height = header.tile
            block, start = pixels[row * height:(row + 1) * height, column * width:(column + 1) * width], offset + 20
            is_inside = level_x == level_y == 0 and row >= 0 and column >= 0 and block.size > 0
        if not is_inside or not 0 <= size <= len(data) - start:
            raise Damaged("it is truncated or damaged")
        _fill(block, data[start:start + size], header)
    return pixels


def _count(header: Header) -> int:
    """Of blocks; of tiles, those of the finest level, which come first in the table."""
    if header.tile is None:
        return -(-header.height // header.lines_per_chunk)
    return -(-header.width // header.tile[0]) * -(-header.height // header.tile[1])


def _fill(block: np.ndarray, packed: bytes, header: Header) -> None:
    """A line of a block has each channel's values one after the other."""
    height, width = block.shape
    line = np.dtype([(name, kind, (width,)) for name, kind in header.channels])
    size = height * line.itemsize
    if size > _LARGEST:
        raise Damaged(f"it has a block of {size} bytes; up to {_LARGEST >> 20} MiB are read")
    raw = _unpacked(packed, size, width, height, header)
    if len(raw) != size:
        raise Damaged("it is truncated or damaged")
    lines = np.frombuffer(raw, line)
    for name in block.dtype.names:
        block[name] = lines[name]


def _unpacked(packed: bytes, size: int, width: int, height: int, header: Header) -> bytes:
    if len(packed) == size or header.compression == "none":
        return packed  # a block that compression would make longer is stored as it is
    if header.compression == "PIZ":
        return unpacked_piz(packed, width, height, [int(kind[2:]) // 2 for _, kind in header.channels])
    if header.compression == "PXR24":
        return _planes_joined(zlib.decompressobj().decompress(packed, size + 1), width, height, header)
    if header.compression == "RLE":
        return _joined(_runs(packed, size))
    return _joined(zlib.decompressobj().decompress(packed, size + 1))


def _joined(packed: bytes) -> bytes:
    """Bytes differ from their predecessors by value - 128; first halves and second halves interleave (ImfZip)."""
    deltas = np.frombuffer(packed, np.uint8).copy()
    deltas[1:] -= 128
    halves = np.cumsum(deltas, dtype=np.uint8)
    result = np.empty_like(halves)
    result[0::2], result[1::2] = np.split(halves, [(len(halves) + 1) // 2])
    return result.tobytes()


def _planes_joined(packed: bytes, width: int, height: int, header: Header) -> bytes:
    """PXR24: each channel of a line is sums of differences, whose bytes lie in planes, the highest first; floats have
    lost their lowest byte (ImfPxr24Compressor)."""
    data, at, lines = np.frombuffer(packed, np.uint8), 0, []
    for _ in range(height):
        for _, kind in header.channels:
            planes = 3 if kind == "<f4" else int(kind[2:])
            rows = data[at:at + planes * width].reshape(planes, width).astype(np.uint32)
            shifts = 8 * np.arange(int(kind[2:]) - 1, int(kind[2:]) - 1 - planes, -1, dtype=np.uint32)
            values = np.cumsum((rows << shifts[:, None]).sum(axis=0, dtype=np.uint32), dtype=np.uint32)
            lines.append(values.astype(f"<u{kind[2:]}").tobytes())
            at += planes * width
    return b"".join(lines)


def _runs(packed: bytes, size: int) -> bytes:
    """A count from 0 to 127 repeats the next byte once more than that; a negative one is followed by as many (ImfRle)."""
    result = bytearray()
    at = 0
    while at < len(packed) and len(result) <= size:
        count = packed[at]
        if count < 128:
            result += packed[at + 1:at + 2] * (count + 1)
            at += 2
        else:
            result += packed[at + 1:at + 257 - count]
            at += 257 - count
    return bytes(result)
