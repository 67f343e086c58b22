"""Mitsuba's .serialized files, versions 3 and 4: several meshes, each a stream of zlib.

Source: the format's description in the documentation of Mitsuba 3's shape plugin `serialized` and the loader of 0.6,
whose version 3 has no names and a dictionary of 32 bits.
"""

from __future__ import annotations

import mmap
import struct
import zlib
from pathlib import Path

import numpy as np

from importer.meshes.assemble import check_indices, finished
from importer.meshes.files import MAX_BYTES, mapped_bytes
from importer.meshes.orient import with_face_normals
from importer.problems import ImportProblem
from importer.scene import Mesh

_MAGIC = 0x041C
_NORMALS, _UVS, _COLOURS, _FACE_NORMALS, _DOUBLE = 0x0001, 0x0002, 0x0008, 0x0010, 0x2000
_LONGEST_NAME = 4096
_PIECE = 1 << 16  # inflated at least at a time, for each call copies what is left of its input
_PACKED_PIECE = 1 << 18  # which is that much of the file at most: behind a mesh there may be hundreds of others
Bytes = bytes | mmap.mmap


def read_serialized(path: Path, index: int) -> Mesh:
    """The mesh of this number, from 0 on. Where its flags ask for face normals, each triangle has its own in `normals`."""
    data = mapped_bytes(path)
    start, version = _start(path, data, index)
    stream = _Stream(path, memoryview(data)[start + 4:], index)
    (flags,) = stream.unpack("<I")
    name = stream.name() if version >= 4 else ""
    vertices, triangles = stream.unpack("<QQ")
    kind = np.dtype("<f8" if flags & _DOUBLE else "<f4")
    index_kind = np.dtype("<u8" if vertices > 0xFFFFFFFF else "<u4")
    per_vertex = 3 + 3 * bool(flags & _NORMALS) + 2 * bool(flags & _UVS) + 3 * bool(flags & _COLOURS)
    stream.check_size(vertices * per_vertex * kind.itemsize + triangles * 3 * index_kind.itemsize)
    positions = stream.array(vertices, 3, kind)
    normals = stream.array(vertices, 3, kind) if flags & _NORMALS else None
    uvs = stream.array(vertices, 2, kind) if flags & _UVS else None
    if flags & _COLOURS:
        stream.array(vertices, 3, kind)
    corners = stream.array(triangles, 3, index_kind).astype(np.int64)
    check_indices(path, "vertex", corners, vertices)
    mesh = finished(path, Mesh(positions, corners, normals, uvs, name or f"{path.stem}_{index}"))
    return with_face_normals(mesh) if flags & _FACE_NORMALS else mesh


def _start(path: Path, data: Bytes, index: int) -> tuple[int, int]:
    """Where the mesh's header begins, and the version that it states."""
    if index < 0:
        raise ImportProblem(f"{path}: shape_index {index} is less than 0")
    _, version = _header(path, data, 0)
    if index == 0:  # as the renderers do, which need no dictionary for it
        return 0, version
    if len(data) < 8:
        raise ImportProblem(f"{path}: the .serialized file is truncated")
    (count,) = struct.unpack("<I", data[-4:])
    size = 8 if version >= 4 else 4
    if index >= count or count * size + 4 > len(data):
        raise ImportProblem(f"{path}: shape_index {index} is not there; the .serialized file has {count} meshes")
    (start,) = struct.unpack_from("<Q" if size == 8 else "<I", data, len(data) - 4 - (count - index) * size)
    return _header(path, data, start)


def _header(path: Path, data: Bytes, start: int) -> tuple[int, int]:
    magic, version = struct.unpack_from("<HH", data, start) if start + 4 <= len(data) else (0, 0)
    if magic != _MAGIC:
        raise ImportProblem(f"{path}: there is no .serialized mesh at byte {start}; one begins with 0x041C")
    if version not in (3, 4):
        raise ImportProblem(f"{path}: the .serialized mesh is of version {version}; 3 and 4 are read")
    return start, version


class _Stream:
    """A zlib stream, inflated as far as asked for."""

    def __init__(self, path: Path, packed: memoryview, index: int) -> None:
        self._path, self._index, self._packed = path, index, packed
        self._input: bytes | memoryview = b""  # the beginning of the rest, as far as it has been looked at
        self._inflate = zlib.decompressobj()
        self._ready = b""  # inflated and not asked for yet
        self._most = 1100 * len(packed)  # what zlib can make of it: 258 bytes of 2 bits (RFC 1951)

    def _read(self, size: int) -> bytes:
        parts, left = [self._ready], size - len(self._ready)
        while left > 0:
            if not self._input:
                self._input, self._packed = self._packed[:_PACKED_PIECE], self._packed[_PACKED_PIECE:]
            try:
                part = self._inflate.decompress(self._input, max(left, _PIECE))
            except zlib.error as error:
                raise ImportProblem(f"{self._path}: mesh {self._index} is damaged: {error}") from error
            self._input = self._inflate.unconsumed_tail
            if not part and (self._inflate.eof or not self._packed):
                raise ImportProblem(f"{self._path}: mesh {self._index} is truncated")
            parts.append(part)
            left -= len(part)
        found = b"".join(parts)
        self._ready = found[size:]
        return found[:size]

    def unpack(self, form: str) -> tuple[int, ...]:
        return struct.unpack(form, self._read(struct.calcsize(form)))

    def name(self) -> str:
        """UTF-8 up to a zero byte."""
        letters = bytearray()
        while (letter := self._read(1)) != b"\0":
            letters += letter
            if len(letters) > _LONGEST_NAME:
                raise ImportProblem(f"{self._path}: the name of mesh {self._index} has no end")
        return letters.decode("utf-8", "replace")

    def check_size(self, size: int) -> None:
        if size > self._most:
            raise ImportProblem(f"{self._path}: mesh {self._index} states more vertices and triangles than it has bytes for")
        if size > MAX_BYTES:
            raise ImportProblem(f"{self._path}: mesh {self._index} is larger than the {MAX_BYTES >> 20} MiB that are read")

    def array(self, rows: int, columns: int, kind: np.dtype) -> np.ndarray:
        values = np.frombuffer(self._read(rows * columns * kind.itemsize), kind).reshape(rows, columns)
        return values.astype(np.float64) if kind.kind == "f" else values
