"""pbrt's bilinear patches as triangles."""

from __future__ import annotations

import numpy as np

from importer.meshes.orient import area_vectors, smooth, unit
from importer.problems import ImportProblem
from importer.scene import Mesh

_FINEST = 32
_ERROR = 1 / 4096  # of the diagonal; a third of a pixel where a patch is as wide as a picture of 1280 columns


def bilinear(corners: np.ndarray, normals: np.ndarray | None = None, uvs: np.ndarray | None = None) -> Mesh:
    """A patch by its corners p00, p10, p01, p11, that is (2, 2, 3) by [v][u], or (4, 3); so its normals and uvs.

    The front is that of dp/du x dp/dv, the other way round where normals point there (BilinearPatch::Intersect). A
    parallelogram is two triangles. Others are a grid of n x n cells with the patch's own normals: a cell's diagonal is
    off the patch by a quarter of the twist p00 - p10 - p01 + p11 over n^2, and n makes that 1/4096 of the diagonal, but
    is at most 32. Cells where a side is a point have one triangle.
    """
    points = np.asarray(corners, float).reshape(4, 3)
    coordinates = np.array([(0, 0), (1, 0), (0, 1), (1, 1)], float) if uvs is None else np.asarray(uvs, float).reshape(4, 2)
    cells = _cells(points, coordinates)
    at = np.arange(cells + 1) / cells
    v, u = (grid.reshape(-1) for grid in np.meshgrid(at, at, indexing="ij"))
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v], axis=1)
    geometric = unit(np.cross(np.stack([1 - v, v], 1) @ (points[1::2] - points[::2]),
                              np.stack([1 - u, u], 1) @ (points[2:] - points[:2])))
    shading = geometric if normals is None else unit(weights @ np.asarray(normals, float).reshape(4, 3))
    triangles = _grid(cells)
    if np.einsum("ij,ij->", geometric, shading) < 0:
        triangles = triangles[:, ::-1].copy()
    mesh = Mesh(weights @ points, triangles, shading, weights @ coordinates, "bilinear")
    mesh.triangles = triangles[area_vectors(mesh).any(axis=1)]
    if len(mesh.triangles) == 0:
        raise ImportProblem("a bilinear patch has no area; its corners have to span one")
    missing = ~shading.any(axis=1)  # at a side that is a point
    mesh.normals[missing] = smooth(mesh).normals[missing]
    return mesh


def _cells(points: np.ndarray, uvs: np.ndarray) -> int:
    """Along each side. Texture coordinates bend with the square's twist as positions do, and count alike."""
    diagonal = max(np.linalg.norm(points[3] - points[0]), np.linalg.norm(points[2] - points[1]))
    twist = np.linalg.norm(points[0] - points[1] - points[2] + points[3]) / diagonal if diagonal > 0 else 0.0
    bend = np.abs(uvs[0] - uvs[1] - uvs[2] + uvs[3]).max()
    share = max(twist, bend)
    if share < 1e-6:  # of numbers with seven digits: flat
        return 1
    return int(np.clip(np.ceil(np.sqrt(share / 4 / _ERROR)), 1, _FINEST))


def _grid(cells: int) -> np.ndarray:
    row = np.arange(cells)
    here = (row[:, None] * (cells + 1) + row).reshape(-1)
    above = here + cells + 1
    return np.concatenate([np.stack([here, here + 1, above + 1], axis=1), np.stack([here, above + 1, above], axis=1)])
