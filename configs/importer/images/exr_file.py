"""OpenEXR files: RGB read as float32, and written for the sky.

Read are single-part files, scan lines or tiles (of several levels the finest), half, float and whole numbers,
compression none, RLE, ZIPS, ZIP, PIZ and PXR24; others are refused by name. Source: OpenEXR, "File Layout", and the
library's ImfRleCompressor, ImfZip and ImfTiledMisc for what that leaves open.
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

from importer.images.exr_chunks import Damaged, read_chunks
from importer.images.exr_header import Header, read_header
from importer.images.files import check_size, read_bytes
from importer.problems import ImportProblem

# CIE xy of red, green, blue and white (ITU-R BT.709).
_SRGB = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)


def read_exr(path: Path) -> np.ndarray:
    """(height, width, 3) float32, linear sRGB, top row first. A file with Y alone is grey."""
    data = read_bytes(path)
    try:
        header = read_header(data)
        check_size(path, header.width, header.height)
        names = _names(header)
        lines = read_chunks(data, header, names)
    except Damaged as error:
        raise ImportProblem(f"{path}: the image cannot be read as OpenEXR: {error}") from error
    except (struct.error, zlib.error, ValueError, LookupError, OverflowError) as error:
        raise ImportProblem(f"{path}: the image cannot be read as OpenEXR: it is truncated or damaged") from error
    rgb = np.stack([lines[name].astype(np.float32) for name in names], axis=-1)
    return rgb if names == "YYY" else _in_srgb(rgb, header)


def _names(header: Header) -> str:
    """Of the channels for red, green and blue."""
    found = "RGB" if all(name in header.names for name in "RGB") else "YYY"
    if found[0] not in header.names:
        raise Damaged(f"it has neither R, G and B nor Y, but {', '.join(ascii(name) for name in header.names)}")
    return found


def _in_srgb(rgb: np.ndarray, header: Header) -> np.ndarray:
    """By way of XYZ, as both renderers take the attribute `chromaticities`; without it primaries are those of sRGB."""
    if header.chromaticities is None or np.allclose(header.chromaticities, _SRGB, atol=1e-3):
        return rgb
    matrix = np.linalg.solve(_xyz_of_rgb(_SRGB), _xyz_of_rgb(header.chromaticities))
    return (rgb.reshape(-1, 3) @ matrix.T.astype(np.float32)).reshape(rgb.shape)


def _xyz_of_rgb(xy: tuple[float, ...]) -> np.ndarray:
    """SMPTE RP 177: the primaries' XYZ, scaled so that they add up to white of Y = 1."""
    points = np.array([(x, y, 1 - x - y) for x, y in zip(xy[::2], xy[1::2])]).T
    white = points[:, 3] / xy[7]
    try:
        return points[:, :3] * np.linalg.solve(points[:, :3], white)
    except np.linalg.LinAlgError as error:
        raise ImportProblem(f"an OpenEXR image states chromaticities that lie on one line: {xy}") from error


def write_exr(path: Path, rgb: np.ndarray) -> None:
    """(height, width, 3) as float32 in scan lines, ZIP."""
    height, width, _ = rgb.shape
    planes = np.ascontiguousarray(rgb[..., ::-1].transpose(0, 2, 1), "<f4")  # by line: B, G, R, as names are sorted
    head = struct.pack("<iI", 20000630, 2) + _attributes(width, height)
    chunks = [_chunk(y, planes[y:y + 16].tobytes()) for y in range(0, height, 16)]
    first = len(head) + 8 * len(chunks)
    offsets = first + np.cumsum([0] + [len(c) for c in chunks[:-1]])
    path.write_bytes(head + offsets.astype("<u8").tobytes() + b"".join(chunks))


def _attributes(width: int, height: int) -> bytes:
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    rows = [("channels", "chlist", channels), ("compression", "compression", b"\3"), ("dataWindow", "box2i", window),
            ("displayWindow", "box2i", window), ("lineOrder", "lineOrder", b"\0"),
            ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
            ("screenWindowWidth", "float", struct.pack("<f", 1))]
    values = (f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value for name, kind, value in rows)
    return b"".join(values) + b"\0"


def _chunk(y: int, raw: bytes) -> bytes:
    """ImfZip: even bytes before odd ones, each but the first as its difference from the one before, plus 128."""
    data = np.frombuffer(raw, np.uint8)
    sorted_bytes = np.concatenate([data[0::2], data[1::2]])
    deltas = sorted_bytes.copy()
    deltas[1:] = sorted_bytes[1:] - sorted_bytes[:-1] + np.uint8(128)
    packed = zlib.compress(deltas.tobytes(), 6)
    body = packed if len(packed) < len(raw) else raw
    return struct.pack("<ii", y, len(body)) + body
