"""Vertex normals that stop at creases, as Mitsuba 0.6 makes them where a shape has a `maxSmoothAngle`."""

from __future__ import annotations

import numpy as np

from importer.meshes import orient
from importer.scene import Mesh

_MAX_ROUNDS = 100  # a vertex with more creases than that has a normal of its own for each triangle left


def creased(mesh: Mesh, degrees: float) -> Mesh:
    """Corners at one point (and one uv) share a normal where their triangles' normals are within the angle of the first
    triangle there that has none yet (TriMesh::rebuildTopology). Angles are those of the object's own space."""
    faces = orient.unit(orient.area_vectors(mesh))
    points = mesh.positions if mesh.uvs is None else np.hstack([mesh.positions, mesh.uvs])
    point_of_vertex = np.unique(points, axis=0, return_inverse=True)[1].reshape(-1)
    point = point_of_vertex[mesh.triangles].reshape(-1)
    vertex = np.full(len(point), -1)
    count, left = 0, np.arange(len(point))
    for _ in range(_MAX_ROUNDS):
        _, first, place = np.unique(point[left], return_index=True, return_inverse=True)
        leader = left[first][place]
        is_near = (faces[left // 3] * faces[leader // 3]).sum(axis=1) > np.cos(np.radians(degrees))
        is_near |= left == leader
        vertex[left[is_near]] = count + place[is_near]
        count += len(first)
        left = left[~is_near]
        if len(left) == 0:
            break
    vertex[left] = count + np.arange(len(left))
    corner = np.zeros(count + len(left), np.int64)  # one that each new vertex was made of
    corner[vertex] = mesh.triangles.reshape(-1)
    uvs = None if mesh.uvs is None else mesh.uvs[corner]
    return orient.smooth(Mesh(mesh.positions[corner], vertex.reshape(-1, 3), None, uvs, mesh.name))
