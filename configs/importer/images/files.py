"""Bytes of an image file, and the limits that keep memory within what an import may take."""

from __future__ import annotations

from pathlib import Path

from importer.problems import ImportProblem

MAX_SIDE = 32768  # what the engine reads of pictures
MAX_PIXELS = 1 << 27  # of bytes: 384 MiB
MAX_FLOATS = 1 << 25  # pixels of files of floats, 8192 x 4096: 384 MiB
_MAX_BYTES = 1 << 30


def read_bytes(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(_MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ImportProblem(f"{path}: the image cannot be read: {reason}") from error
    if len(data) > _MAX_BYTES:
        raise ImportProblem(f"{path}: the image is larger than {_MAX_BYTES >> 20} MiB, the most that is read")
    return data


def check_size(path: Path, width: int, height: int, most: int = MAX_FLOATS) -> None:
    if not (0 < width <= MAX_SIDE and 0 < height <= MAX_SIDE and width * height <= most):
        raise ImportProblem(f"{path}: the image has {width} x {height} pixels; it may have {MAX_SIDE} each way and "
                            f"{most >> 20} Mi in all")
