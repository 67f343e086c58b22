"""Wavefront .obj files, read in bulk: whole statements of a kind at once, not line by line.

Read is what Mitsuba's OBJMesh reads (v, vt, vn, f; all groups and objects as one shape), and negative indices. Names of
groups and materials, smoothing groups, lines and points are passed over as there. Source: "Object Files (.obj)",
Wavefront Technologies, and mitsuba3/src/shapes/obj.cpp.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from importer.meshes.assemble import fans, finished
from importer.meshes.files import read_bytes
from importer.meshes.obj_lines import Block, Numbers, blocks
from importer.problems import ImportProblem
from importer.scene import Mesh

_WHAT = ("vertex", "texture coordinate", "normal")


def read_obj(path: Path, flip_v: bool) -> Mesh:
    """`flip_v`: v' = 1 - v, Mitsuba's `flip_tex_coords`, which is on by default there. Without vn, `normals` is None."""
    lists: dict[str, list[np.ndarray]] = {"v": [], "vt": [], "vn": []}
    faces = [(np.empty((0, 3), np.int64), np.empty(0, np.int64))]
    counts = np.zeros(3, np.int64)  # of v, vt and vn so far
    for block in blocks(path, read_bytes(path)):
        faces.append(_faces(block, counts))
        for k, (kind, width) in enumerate((("v", 3), ("vt", 2), ("vn", 3))):
            rows = _rows(block, kind, width)
            lists[kind].append(rows)
            counts[k] += len(rows)
    corners, sizes = (np.concatenate(part) for part in zip(*faces))
    if len(sizes) == 0:
        raise ImportProblem(f"{path}: the .obj has no face, a line such as 'f 1 2 3'")
    _check(path, corners, counts)
    values = {kind: np.concatenate(rows) for kind, rows in lists.items()}
    if flip_v:
        values["vt"][:, 1] = 1 - values["vt"][:, 1]
    return finished(path, _unified(values, corners, fans(sizes), path.name.split(".")[0]))


def _rows(block: Block, kind: str, width: int) -> np.ndarray:
    """(n, width) numbers of all statements of a kind. More numbers, such as colours after v, are passed over, as is
    a missing v of vt, which means 0 (the format's one-dimensional textures)."""
    numbers = block.numbers(kind)
    least = 1 if kind == "vt" else width
    short = numbers.per_line < least
    if short.any():
        raise block.problem(numbers.lines[short][0], f"'{kind}' takes {least} numbers, not {numbers.per_line[short][0]}")
    if not np.isfinite(numbers.values).all():
        line = numbers.line_of_token(int(np.argmin(np.isfinite(numbers.values))))
        raise block.problem(line, f"'{kind}' is followed by a number that is not finite")
    if (numbers.per_line == width).all():
        return numbers.values.reshape(-1, width)
    is_there = np.arange(width) < numbers.per_line[:, None]
    first = (np.cumsum(numbers.per_line) - numbers.per_line)[:, None]
    return np.where(is_there, numbers.values[np.where(is_there, first + np.arange(width), 0)], 0.0)


def _faces(block: Block, before: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) indices of v, vt and vn of all corners, from 1 on and 0 for none, and each face's count of corners."""
    indices: Numbers = block.corners()
    width = indices.per_token
    wrong = (width < 1) | (width > 3)
    if wrong.any():
        raise block.problem(indices.line_of_token(int(np.argmax(wrong))), "a corner is 'v', 'v/vt', 'v//vn' or 'v/vt/vn'")
    if (width == 3).all():
        corners = indices.values.reshape(-1, 3).astype(np.int64)
    else:
        corners = np.zeros((len(width), 3), np.int64)
        first = np.cumsum(width) - width
        for k in range(3):
            corners[width > k, k] = indices.values[(first + k)[width > k]]
    if corners.size and corners.min() < 0:
        known = before + block.counts_before(indices.lines)  # of v, vt and vn, at each face
        known = np.repeat(known, indices.per_line, axis=0)
        is_relative = corners < 0
        corners = np.where(is_relative, corners + known + 1, corners)
        wrong = (is_relative & (corners < 1)).any(axis=1)
        if wrong.any():
            line = indices.line_of_token(int(np.argmax(wrong)))
            raise block.problem(line, "a negative index points before the first of its kind")
    return corners, indices.per_line


def _check(path: Path, corners: np.ndarray, counts: np.ndarray) -> None:
    for k, what in enumerate(_WHAT):
        least = 1 if k == 0 else 0
        wrong = (corners[:, k] < least) | (corners[:, k] > counts[k])
        if wrong.any():
            index = corners[int(np.argmax(wrong)), k]
            raise ImportProblem(f"{path}: a face names {what} {index}, and there are {counts[k]}, counted from 1")


def _unified(values: dict[str, np.ndarray], corners: np.ndarray, triangles: np.ndarray, name: str) -> Mesh:
    """One vertex for each distinct triple of indices."""
    key = corners[:, 0]
    for k in (1, 2):
        size = int(corners[:, k].max()) + 1
        if int(key.max()) >= np.iinfo(np.int64).max // size:  # the product would not fit: number what is there so far
            key = np.unique(key, return_inverse=True)[1]
        key = key * size + corners[:, k]
    _, first, vertex = np.unique(key, return_index=True, return_inverse=True)
    v, vt, vn = corners[first].T
    normals = _picked(values["vn"], vn)
    return Mesh(values["v"][v - 1], vertex[triangles], normals, _picked(values["vt"], vt), name)


def _picked(values: np.ndarray, indices: np.ndarray) -> np.ndarray | None:
    """The rows that are named, counted from 1; zeros for 0. None where all are 0."""
    if not indices.any():
        return None
    return np.where((indices > 0)[:, None], values[indices - 1], 0.0)
