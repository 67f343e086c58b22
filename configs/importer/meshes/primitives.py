"""Shapes without a file, as both renderers define them: where they lie, which side is the front, and u and v.

`uvs` are the source's own u and v. Mitsuba's v = 0 is the first row of an image (its .obj loader turns v over for that),
as in `Mesh`; pbrt looks images up at 1 - v (ImageTexture), so its front end turns v over for these shapes as for others.
A sphere has 16 thousand triangles: share one mesh by parts with different `to_world` where there are many.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Sequence

import numpy as np

from importer.meshes.patch import bilinear
from importer.meshes.revolved import SEGMENTS, Profile, revolved
from importer.problems import ImportProblem
from importer.scene import Mesh

__all__ = ["bilinear", "cube", "cylinder", "disk", "pbrt_cylinder", "pbrt_disk", "pbrt_sphere", "rectangle", "sphere"]
_LARGEST = 1e18  # of lengths, as of positions in files
_UP = (0.0, 0.0, 1.0)


def sphere(centre: Sequence[float] = (0, 0, 0), radius: float = 1.0) -> Mesh:
    """Mitsuba's: poles along z, u = phi / 2 pi from x towards y, v = theta / pi from +z (sphere.cpp); front outside.
    The same mesh for the same arguments, so that it is in the .glb once."""
    _check("sphere", radius=radius)
    return _sphere(tuple(float(x) for x in centre), float(radius))


@lru_cache(maxsize=256)
def _sphere(centre: tuple[float, ...], radius: float) -> Mesh:
    theta = np.linspace(0, np.pi, SEGMENTS // 2 + 1)
    mesh = revolved(_arc(radius, theta, theta / np.pi), 2 * np.pi, SEGMENTS, "sphere")
    mesh.positions += centre
    return _shared(mesh)


def _shared(mesh: Mesh) -> Mesh:
    """Made safe against changes in place, since the next caller gets it, too."""
    for array in (mesh.positions, mesh.triangles, mesh.normals, mesh.uvs):
        array.setflags(write=False)
    return mesh


def _check(shape: str, **lengths: float) -> None:
    for name, value in lengths.items():
        if not 0 < value < _LARGEST:
            raise ImportProblem(f"the {name} of a {shape} is {value:g}; it has to be above 0 and below {_LARGEST:g}")


def _arc(radius: float, theta: np.ndarray, v: np.ndarray) -> Profile:
    sin, cos = np.sin(theta), np.cos(theta)
    sin[(theta == 0) | (theta == np.pi)] = 0  # the poles are points
    return Profile(radius * sin, radius * cos, np.stack([sin, cos], axis=1), v)


@lru_cache(maxsize=1)
def rectangle() -> Mesh:
    """Mitsuba's: -1 to 1 in x and y, front along +z, u and v from 0 to 1 along x and y (rectangle.cpp)."""
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    positions = np.concatenate([corners, np.zeros((4, 1))], axis=1)
    mesh = Mesh(positions, np.array([(0, 1, 2), (0, 2, 3)]), np.tile(_UP, (4, 1)), (corners + 1) / 2, "rectangle")
    return _shared(mesh)


# The corners of each face of Mitsuba's cube in the order of its u, v = (0, 1), (1, 1), (1, 0), (0, 0).
_CUBE = (((1, -1, -1), (1, -1, 1), (-1, -1, 1), (-1, -1, -1)), ((1, 1, -1), (-1, 1, -1), (-1, 1, 1), (1, 1, 1)),
         ((1, -1, -1), (1, 1, -1), (1, 1, 1), (1, -1, 1)), ((1, -1, 1), (1, 1, 1), (-1, 1, 1), (-1, -1, 1)),
         ((-1, -1, 1), (-1, 1, 1), (-1, 1, -1), (-1, -1, -1)), ((1, 1, -1), (1, -1, -1), (-1, -1, -1), (-1, 1, -1)))


@lru_cache(maxsize=1)
def cube() -> Mesh:
    """Mitsuba's: -1 to 1 each way, fronts outside, each face with all of the image (cube.cpp)."""
    faces = np.array(_CUBE, float)
    quad = np.array([(0, 1, 2), (3, 0, 2)])
    triangles = (4 * np.arange(6)[:, None, None] + quad).reshape(-1, 3)
    uvs = np.tile([(0, 1), (1, 1), (1, 0), (0, 0)], (6, 1)).astype(float)
    return _shared(Mesh(faces.reshape(-1, 3), triangles, np.repeat(faces.mean(axis=1), 4, axis=0), uvs, "cube"))


@lru_cache(maxsize=1)
def disk() -> Mesh:
    """Mitsuba's: of radius 1 about z, front along +z, u = the distance from the axis, v = phi / 2 pi (disk.cpp)."""
    mesh = revolved(_ring(0.0, 0.0, 1.0, np.array([0.0, 1.0])), 2 * np.pi, SEGMENTS, "disk")
    mesh.uvs = mesh.uvs[:, ::-1].copy()
    return _shared(mesh)


def _ring(height: float, inner: float, outer: float, v: np.ndarray) -> Profile:
    return Profile(np.array([inner, outer]), np.full(2, height), np.array([(0.0, 1.0)] * 2), v)


def cylinder(p0: Sequence[float] = (0, 0, 0), p1: Sequence[float] = (0, 0, 1), radius: float = 1.0) -> Mesh:
    """Mitsuba's: without caps, front outside, u = phi / 2 pi, v = the share of the way from p0 to p1 (cylinder.cpp).
    Where u is 0 follows Mitsuba 3 (`coordinate_system`); 0.6 has another axis there, which only textures show."""
    start, end = np.asarray(p0, float), np.asarray(p1, float)
    length = float(np.linalg.norm(end - start))
    _check("cylinder", radius=radius, length=length)
    mesh = _tube(float(radius), 0.0, length, 2 * np.pi)
    frame = _frame((end - start) / length)
    return Mesh(mesh.positions @ frame + start, mesh.triangles, mesh.normals @ frame, mesh.uvs, "cylinder")


def _tube(radius: float, low: float, high: float, phi_max: float) -> Mesh:
    profile = Profile(np.full(2, radius), np.array([low, high]), np.array([(1.0, 0.0)] * 2), np.array([0.0, 1.0]))
    return revolved(profile, phi_max, SEGMENTS, "cylinder")


def _frame(n: np.ndarray) -> np.ndarray:
    """Rows: two axes square to `n`, and `n` (Duff et al., "Building an Orthonormal Basis, Revisited", 2017)."""
    sign = np.copysign(1.0, n[2])
    a = -1 / (sign + n[2])
    b = n[0] * n[1] * a
    return np.array([(1 + sign * n[0] ** 2 * a, sign * b, -sign * n[0]), (b, sign + n[1] ** 2 * a, -n[1]), n])


def pbrt_sphere(radius: float = 1.0, zmin: float | None = None, zmax: float | None = None, phimax: float = 360.0) -> Mesh:
    """pbrt's, cut at zmin, zmax and phimax degrees: u = phi / phimax, v from 0 at zmin to 1 at zmax in theta (Sphere)."""
    low, high = -radius if zmin is None else zmin, radius if zmax is None else zmax
    _check("sphere", radius=radius)
    ends = np.arccos(np.clip([min(low, high) / radius, max(low, high) / radius], -1, 1))
    _check("sphere", height=ends[0] - ends[1], phimax=phimax)
    count = max(2, int(np.ceil((ends[0] - ends[1]) / np.pi * SEGMENTS / 2)))
    v = np.arange(count + 1) / count
    theta = ends[0] + v * (ends[1] - ends[0])
    theta[-1] = ends[1]  # exactly, so that a pole is known as one
    return revolved(_arc(radius, theta, v), _phi(phimax), SEGMENTS, "sphere")


def pbrt_disk(height: float = 0.0, radius: float = 1.0, innerradius: float = 0.0, phimax: float = 360.0) -> Mesh:
    """pbrt's: front along +z, u = phi / phimax, v = 0 at the rim and 1 at the inner radius (Disk)."""
    _check("disk", radius=radius, width=radius - innerradius, phimax=phimax)
    profile = _ring(float(height), max(float(innerradius), 0.0), float(radius), np.array([1.0, 0.0]))
    return revolved(profile, _phi(phimax), SEGMENTS, "disk")


def pbrt_cylinder(radius: float = 1.0, zmin: float = -1.0, zmax: float = 1.0, phimax: float = 360.0) -> Mesh:
    """pbrt's: without caps, front outside, u = phi / phimax, v from zmin to zmax (Cylinder)."""
    _check("cylinder", radius=radius, length=abs(zmax - zmin), phimax=phimax)
    return _tube(float(radius), min(zmin, zmax), max(zmin, zmax), _phi(phimax))


def _phi(degrees: float) -> float:
    """pbrt clamps to a whole turn."""
    return float(np.radians(np.clip(degrees, 0, 360)))
