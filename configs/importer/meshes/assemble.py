"""What all readers of mesh files end with: polygons into triangles, checks, and a mesh without useless parts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from importer.meshes.orient import area_vectors, smooth, unit
from importer.problems import ImportProblem
from importer.scene import Mesh


def fans(corners: np.ndarray) -> np.ndarray:
    """(m, 3) positions in the list of all corners: polygon i has the next `corners[i]` of them, and becomes a fan
    about its first, as Mitsuba's OBJMesh cuts it. Fewer than three corners make no triangle."""
    first = np.cumsum(corners) - corners
    count = np.maximum(corners - 2, 0)
    start = np.repeat(first, count)
    step = np.arange(len(start)) - np.repeat(np.cumsum(count) - count, count)
    return np.stack([start, start + step + 1, start + step + 2], axis=1)


def finished(path: Path, mesh: Mesh) -> Mesh:
    """The mesh with finite numbers, unit normals and triangles that have an area; else an ImportProblem."""
    for what, values in (("position", mesh.positions), ("normal", mesh.normals), ("texture coordinate", mesh.uvs)):
        if values is not None and not np.isfinite(values).all():
            row = int(np.argmin(np.isfinite(values).all(axis=1)))
            raise ImportProblem(f"{path}: the {what} of vertex {row + 1} is not a finite number")
    _check_range(path, mesh)
    mesh = replace(mesh, triangles=mesh.triangles[area_vectors(mesh).any(axis=1)])
    if len(mesh.triangles) == 0:
        raise ImportProblem(f"{path}: the mesh has no triangle with an area")
    return _with_unit_normals(mesh)


def _check_range(path: Path, mesh: Mesh) -> None:
    """Positions are floats in the .glb, and their squares are formed on the way there."""
    if mesh.positions.size and np.abs(mesh.positions).max() > 1e18:
        row = int(np.abs(mesh.positions).max(axis=1).argmax())
        raise ImportProblem(f"{path}: vertex {row + 1} is farther out than 1e18, the farthest that is read")


def _with_unit_normals(mesh: Mesh) -> Mesh:
    """Normals of length 1; where the file has zeros, those of `smooth` take their place, for zeros have no direction."""
    if mesh.normals is None:
        return mesh
    normals = unit(mesh.normals)
    missing = ~normals.any(axis=1)
    if missing.any():
        normals[missing] = smooth(replace(mesh, normals=None)).normals[missing]
    return replace(mesh, normals=normals)


def check_indices(path: Path, what: str, indices: np.ndarray, count: int) -> None:
    """Indices from 0 on."""
    if indices.size and (indices.min() < 0 or indices.max() >= count):
        wrong = int(indices.min() if indices.min() < 0 else indices.max())
        raise ImportProblem(f"{path}: a face names {what} {wrong}, and there are {count}, counted from 0")
