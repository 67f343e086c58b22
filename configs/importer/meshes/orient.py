"""Fronts and vertex normals of meshes. No function changes its argument."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from importer.scene import Mesh


def unit(vectors: np.ndarray) -> np.ndarray:
    """Of length 1; zeros stay zeros."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def area_vectors(mesh: Mesh) -> np.ndarray:
    """(m, 3): along each triangle's front, twice its area long."""
    a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def flipped(mesh: Mesh) -> Mesh:
    """With the other side as the front, its normals on that side."""
    normals = None if mesh.normals is None else -mesh.normals
    return replace(mesh, triangles=mesh.triangles[:, ::-1].copy(), normals=normals)


def fronts_by_normals(mesh: Mesh) -> Mesh:
    """Each triangle's front on the side to which its three vertex normals point on the whole, as pbrt's
    Triangle::Intersect and Mitsuba's shading frames have it; without normals the corners' order stays."""
    if mesh.normals is None:
        return mesh
    side = np.einsum("ij,ij->i", area_vectors(mesh), mesh.normals[mesh.triangles].sum(axis=1))
    triangles = mesh.triangles.copy()
    triangles[side < 0] = triangles[side < 0][:, ::-1]
    return replace(mesh, triangles=triangles)


def flat(mesh: Mesh) -> Mesh:
    """Without vertex normals: each triangle is shaded by its plane (Mitsuba's `face_normals`)."""
    return replace(mesh, normals=None)


def smooth(mesh: Mesh) -> Mesh:
    """With vertex normals that are the means of the adjacent triangles' normals, weighted by their angles there.

    That is what Mitsuba computes where a file has none (Mesh::recompute_vertex_normals; Thürmer and Wüthrich,
    "Computing Vertex Normals from Polygonal Facets", 1998). A vertex whose triangles cancel out gets (1, 0, 0), as there.
    """
    normals = _sums_at_vertices(mesh)
    normals[np.linalg.norm(normals, axis=1) == 0] = (1, 0, 0)
    return replace(mesh, normals=unit(normals))


def _sums_at_vertices(mesh: Mesh) -> np.ndarray:
    faces = unit(area_vectors(mesh))
    corners = [mesh.positions[mesh.triangles[:, k]] for k in range(3)]
    sums = np.zeros_like(mesh.positions)
    for k in range(3):
        one = unit(corners[(k + 1) % 3] - corners[k])
        other = unit(corners[(k + 2) % 3] - corners[k])
        # The half chord keeps its precision at small angles, where the arc cosine loses it (Kahan).
        angle = 2 * np.arctan2(np.linalg.norm(one - other, axis=1), np.linalg.norm(one + other, axis=1))
        for axis in range(3):
            sums[:, axis] += np.bincount(mesh.triangles[:, k], faces[:, axis] * angle, minlength=len(sums))
    return sums


def with_face_normals(mesh: Mesh) -> Mesh:
    """Corners of their own for each triangle, with its normal: flat also for whoever smooths meshes without normals."""
    corner = mesh.triangles.reshape(-1)
    normals = np.repeat(unit(area_vectors(mesh)), 3, axis=0)
    uvs = None if mesh.uvs is None else mesh.uvs[corner]
    return Mesh(mesh.positions[corner], np.arange(len(corner)).reshape(-1, 3), normals, uvs, mesh.name)
