"""Bytes of a mesh file, unpacked where it is gzip'd, and the sentence that says why there are none."""

from __future__ import annotations

import mmap
import zlib
from pathlib import Path

from importer.problems import ImportProblem

MAX_BYTES = 1 << 30  # unpacked; 1.5 million triangles take about 150 MB of text
_GZIP = b"\x1f\x8b"


def read_bytes(path: Path) -> bytes:
    """The file's content. Gzip is known by its first bytes, since both `.gz` and `.ply.gz` are in use."""
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ImportProblem(f"{path}: the mesh cannot be read: {reason}") from error
    if data.startswith(_GZIP):
        data = _unpacked(path, data)
    if len(data) > MAX_BYTES:
        raise ImportProblem(f"{path}: the mesh is larger than {MAX_BYTES >> 20} MiB, the most that is read")
    return data


def mapped_bytes(path: Path) -> bytes | mmap.mmap:
    """The same, but read where it is looked at: a file of hundreds of meshes is asked for each of them."""
    try:
        with path.open("rb") as file:
            head = file.read(len(_GZIP))
            if head and head != _GZIP:
                return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    except (OSError, ValueError):
        pass  # which the other one says, if it fails there, too
    return read_bytes(path)


def _unpacked(path: Path, data: bytes) -> bytes:
    """All members of a gzip file (RFC 1952, 2.2), but never more than one byte above the limit."""
    parts, left = [], MAX_BYTES + 1
    try:
        while data.startswith(_GZIP) and left > 0:
            stream = zlib.decompressobj(zlib.MAX_WBITS | 16)
            parts.append(stream.decompress(data, left))
            left -= len(parts[-1])
            if left > 0 and not stream.eof:
                raise ImportProblem(f"{path}: the gzip'd mesh is truncated")
            data = stream.unused_data
    except zlib.error as error:
        raise ImportProblem(f"{path}: the gzip'd mesh is damaged: {error}") from error
    return b"".join(parts)
