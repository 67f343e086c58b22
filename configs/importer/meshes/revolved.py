"""Surfaces of revolution about z as triangles: what spheres, disks and cylinders are made of.

How fine: the corners lie on the surface, `SEGMENTS` = 128 of them around. A chord of 1/128 of a circle is at most
3.0e-4 of the radius from its arc, which is 0.11 pixels where a ball is as high as a picture of 720 lines. Normals are
the surface's own, so shading has no facets. Areas are too small by 5.0e-4 (sphere), 4.0e-4 (disk) and 1.0e-4
(cylinder), and with them what a lamp of this shape sends out (tests/importer/meshes/test_primitives.py). A larger radius
would make up for that, but would put corners off the surface, and shapes that touch would overlap.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from importer.scene import Mesh

SEGMENTS = 128


@dataclass(frozen=True)
class Profile:
    """A curve in the half plane of x >= 0 and z, along which the parameter v grows or falls."""

    radius: np.ndarray
    height: np.ndarray
    normal: np.ndarray  # (n, 2): along x and z, unit
    v: np.ndarray


def revolved(profile: Profile, phi_max: float, segments: int, name: str) -> Mesh:
    """From x towards y by `phi_max` radians; u is the share of it. The front is where the normals point.

    At a point on the axis each segment has a vertex of its own, u in the segment's middle, and one triangle.
    """
    share = np.arange(segments + 1) / segments
    u = np.tile(share, (len(profile.radius), 1))
    u[profile.radius == 0, :-1] += 0.5 / segments
    phi = phi_max * share
    cos, sin = np.cos(phi), np.sin(phi)
    if phi_max >= 2 * np.pi:  # closes without a gap of the last bit
        cos[-1], sin[-1] = 1, 0
    positions = _turned(profile.radius, profile.height, cos, sin)
    normals = _turned(profile.normal[:, 0], profile.normal[:, 1], cos, sin)
    uvs = np.stack([u, np.broadcast_to(profile.v[:, None], u.shape)], axis=2).reshape(-1, 2)
    mesh = Mesh(positions, _triangles(profile.radius, segments), normals, uvs, name)
    return _used(_outwards(mesh, profile))


def _turned(x: np.ndarray, z: np.ndarray, cos: np.ndarray, sin: np.ndarray) -> np.ndarray:
    return np.stack([np.outer(x, cos), np.outer(x, sin), np.outer(z, np.ones_like(cos))], axis=2).reshape(-1, 3)


def _triangles(radius: np.ndarray, segments: int) -> np.ndarray:
    """Two for each cell of the grid, one where a side of the cell is a point."""
    parts = []
    for row in range(len(radius) - 1):
        here = row * (segments + 1) + np.arange(segments)
        above = here + segments + 1
        if radius[row] != 0:
            parts.append(np.stack([here, here + 1, above if radius[row + 1] == 0 else above + 1], axis=1))
        if radius[row + 1] != 0:
            parts.append(np.stack([here, above + 1, above], axis=1))
    return np.concatenate(parts)


def _outwards(mesh: Mesh, profile: Profile) -> Mesh:
    """The grid's triangles have their front on the right of the profile's way; turned over where its normals are left."""
    k = len(profile.radius) // 2 - 1  # a piece in the middle: at the poles of a sphere the ends are above each other
    way = profile.radius[k + 1] - profile.radius[k], profile.height[k + 1] - profile.height[k]
    normal = profile.normal[k] + profile.normal[k + 1]
    if normal @ (way[1], -way[0]) < 0:
        mesh.triangles = mesh.triangles[:, ::-1].copy()
    return mesh


def _used(mesh: Mesh) -> Mesh:
    """Without the vertices that no triangle has, such as the last ones of rows that are points."""
    kept, triangles = np.unique(mesh.triangles, return_inverse=True)
    return Mesh(mesh.positions[kept], triangles.reshape(-1, 3), mesh.normals[kept], mesh.uvs[kept], mesh.name)
