"""Radiance pictures (.hdr, .pic) and portable float maps (.pfm), as float32 of linear colours, top row first."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from importer.images.files import check_size, read_bytes
from importer.problems import ImportProblem


def read_hdr(path: Path) -> np.ndarray:
    """(height, width, 3). EXPOSURE and primaries of the header are not applied, as in both renderers.
    Source: Greg Ward, "Real Pixels", Graphics Gems II, and Radiance's color.c for the packed lines."""
    data = read_bytes(path)
    if not data.startswith(b"#?"):
        raise ImportProblem(f"{path}: the file is not a Radiance picture, which begins with '#?RADIANCE'")
    end = data.find(b"\n\n")
    header, line_end = data[:max(end, 0)], data.find(b"\n", end + 2)
    if end < 0 or line_end < 0:
        raise ImportProblem(f"{path}: the Radiance picture's header has no end")
    if b"\nFORMAT=" in header and b"\nFORMAT=32-bit_rle_rgbe" not in header:
        raise ImportProblem(f"{path}: the Radiance picture is not of the format 32-bit_rle_rgbe, the one that is read")
    size = data[end + 2:line_end].decode("latin-1").strip()
    match = re.fullmatch(r"-Y (\d{1,9}) \+X (\d{1,9})", size)
    if match is None:
        raise ImportProblem(f"{path}: the Radiance picture's pixels run as {size[:40]!a}; '-Y height +X width' is read")
    height, width = int(match[1]), int(match[2])
    check_size(path, width, height)
    return _colours(_hdr_lines(path, np.frombuffer(data, np.uint8, offset=line_end + 1), width, height))


def _colours(rgbe: np.ndarray) -> np.ndarray:
    """mantissa / 256 * 2^(exponent - 128), and 0 for exponent 0, as pbrt and Mitsuba decode them."""
    factor = np.ldexp(np.float32(1), rgbe[..., 3].astype(np.int32) - 136)
    factor[rgbe[..., 3] == 0] = 0
    return rgbe[..., :3] * factor[..., None]


def _hdr_lines(path: Path, data: np.ndarray, width: int, height: int) -> np.ndarray:
    """(height, width, 4). A line is packed by component if it begins with 2, 2 and its width; else by pixel or not."""
    lines = np.empty((height, width, 4), np.uint8)
    at = 0
    for y in range(height):
        mark = data[at:at + 4]
        if len(mark) == 4 and 8 <= width <= 32767 and mark.tolist() == [2, 2, *divmod(width, 256)]:
            at = _packed_line(path, data, at + 4, lines[y])
        else:
            lines[y:] = _old_lines(path, data[at:], width * (height - y)).reshape(-1, width, 4)
            break
    return lines


def _packed_line(path: Path, data: np.ndarray, at: int, line: np.ndarray) -> int:
    """Fills the line, component by component, and returns the position behind it."""
    stream, width = memoryview(data), len(line)
    for component in range(4):
        x = 0
        while x < width:
            count = stream[at] if at + 1 < len(stream) else 0
            is_run = count > 128
            count -= 128 * is_run
            if count == 0 or x + count > width or at + 1 + (1 if is_run else count) > len(stream):
                raise _truncated(path)
            if is_run:
                line[x:x + count, component] = stream[at + 1]
                at += 2
            else:
                line[x:x + count, component] = data[at + 1:at + 1 + count]
                at += 1 + count
            x += count
    return at


def _old_lines(path: Path, data: np.ndarray, count: int) -> np.ndarray:
    """(count, 4). Pixels of 1, 1, 1, n repeat the one before n times; further ones at once after it, n * 256 times."""
    pixels = data[:len(data) // 4 * 4].reshape(-1, 4)
    is_run = (pixels[:, :3] == 1).all(axis=1)
    if not is_run[:count].any():
        if len(pixels) < count:
            raise _truncated(path)
        return pixels[:count]
    index = np.arange(len(pixels))
    source = np.maximum.accumulate(np.where(is_run, -1, index))
    if source[0] < 0:
        raise _truncated(path)
    shift = np.minimum(8 * (index - source - 1), 32)
    repeats = np.where(is_run, pixels[:, 3].astype(np.int64) << np.maximum(shift, 0), 1)
    ends = np.cumsum(np.minimum(repeats, count))
    needed = int(np.searchsorted(ends, count)) + 1
    if needed > len(pixels) or ends[needed - 1] != count:
        raise _truncated(path)
    return pixels[np.repeat(source[:needed], repeats[:needed])]


def _truncated(path: Path) -> ImportProblem:
    return ImportProblem(f"{path}: the Radiance picture is truncated or damaged")


def read_pfm(path: Path) -> np.ndarray:
    """(height, width, 3), rows from the bottom in the file; times the header's scale, whose sign is the order of bytes
    (Paul Debevec, "PFM Portable FloatMap Image Format"; pbrt-v4, ReadPFM)."""
    data = read_bytes(path)
    match = re.match(rb"P([Ff])\s+(\d{1,9})\s+(\d{1,9})\s+([-+.\deE]{1,30})\s", data)
    if match is None:
        raise ImportProblem(f"{path}: the file is not a .pfm, which begins with 'PF', width, height and scale")
    width, height, channels = int(match[2]), int(match[3]), 3 if match[1] == b"F" else 1
    check_size(path, width, height)
    try:
        scale = float(match[4])
    except ValueError as error:
        raise ImportProblem(f"{path}: the .pfm's scale {match[4].decode()!r} is not a number") from error
    if len(data) - match.end() < 4 * width * height * channels:
        raise ImportProblem(f"{path}: the .pfm is truncated")
    kind = "<f4" if scale < 0 else ">f4"
    values = np.frombuffer(data, kind, width * height * channels, match.end()).astype(np.float32)
    rows = values.reshape(height, width, channels)[::-1] * np.float32(abs(scale) or 1)
    return np.ascontiguousarray(np.broadcast_to(rows, (height, width, 3)))
