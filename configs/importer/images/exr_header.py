"""The header of an OpenEXR file: windows, channels, compression and tiles."""

from __future__ import annotations

import struct
from dataclasses import dataclass

_MAGIC = 20000630
_LONG_NAMES, _TILED, _DEEP, _PARTS = 0x400, 0x200, 0x800, 0x1000  # bits of the version field
_PIXEL_TYPES = ("<u4", "<f2", "<f4")
_COMPRESSIONS = ("none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB")
_LINES = {"none": 1, "RLE": 1, "ZIPS": 1, "ZIP": 16, "PIZ": 32, "PXR24": 16}


class Damaged(Exception):
    """What is wrong with the file, without its name."""


@dataclass(frozen=True)
class Header:
    left: int
    top: int
    width: int
    height: int
    channels: list[tuple[str, str]]  # names and types of NumPy, in the file's order
    compression: str
    tile: tuple[int, int] | None  # width and height
    chromaticities: tuple[float, ...] | None
    size: int  # bytes up to the table of offsets

    @property
    def names(self) -> list[str]:
        return [name for name, _ in self.channels]

    @property
    def lines_per_chunk(self) -> int:
        return _LINES[self.compression]


def read_header(data: bytes) -> Header:
    magic, version = struct.unpack_from("<iI", data)
    if magic != _MAGIC:
        raise Damaged("it does not begin as one")
    for bit, kind in ((_DEEP, "deep images"), (_PARTS, "files of several parts")):
        if version & bit:
            raise Damaged(f"{kind} are not read; 'oiiotool IN.exr --subimage 0 -o OUT.exr' writes one that is")
    attributes, size = _attributes(data)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    number = attributes["compression"][0]
    compression = _COMPRESSIONS[number] if number < len(_COMPRESSIONS) else f"{number}"
    if compression not in _LINES:
        raise Damaged(f"compression {compression} is not read; 'oiiotool IN.exr --compression zip -o OUT.exr' changes it")
    tile = None
    if version & _TILED:
        tile = struct.unpack("<II", attributes["tiles"][:8])
        if not (0 < tile[0] <= 1 << 16 and 0 < tile[1] <= 1 << 16):
            raise Damaged(f"its tiles are {tile[0]} x {tile[1]} pixels")
    chroma = attributes.get("chromaticities")
    return Header(left, top, right - left + 1, bottom - top + 1, _channels(attributes["channels"]), compression, tile,
                  None if chroma is None else struct.unpack("<8f", chroma), size)


def _attributes(data: bytes) -> tuple[dict[str, bytes], int]:
    """Values by name, and the position behind them."""
    values = {}
    at = 8
    while data[at] != 0:
        name, at = _text(data, at)
        _, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        if not 0 <= size <= len(data) - at:
            raise Damaged("it is truncated or damaged")
        values[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return values, at + 1


def _text(data: bytes, start: int) -> tuple[str, int]:
    end = data.index(b"\0", start, start + 256)
    return data[start:end].decode("latin-1"), end + 1


def _channels(value: bytes) -> list[tuple[str, str]]:
    channels = []
    at = 0
    while value[at] != 0:
        name, at = _text(value, at)
        kind, _, x_sampling, y_sampling = struct.unpack_from("<iIii", value, at)
        if (x_sampling, y_sampling) != (1, 1):
            raise Damaged(f"its channel {name!r} has fewer samples than pixels; "
                          "'oiiotool IN.exr --ch R,G,B -o OUT.exr' writes a file that is read")
        if not 0 <= kind < len(_PIXEL_TYPES):
            raise Damaged(f"its channel {name!r} is of the unknown type {kind}")
        channels.append((name, _PIXEL_TYPES[kind]))
        at += 16
    if len(set(name for name, _ in channels)) != len(channels) or not channels:
        raise Damaged("its channels are missing or named twice")
    return channels
