"""Meshes as the arrays of a .glb: each once, however many parts show it, and transforms that glTF can hold."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from importer.output.world import FLOAT_MAX
from importer.problems import ImportProblem, Notes
from importer.scene import Mesh
from scenes.glb_file import FLOAT, Buffer


def is_translation_rotation_scale(matrix: np.ndarray) -> bool:
    """What a node's matrix must be (glTF 2.0, 3.5.2): its columns stand at right angles, and none is zero."""
    axes = matrix[:3, :3]
    lengths = np.linalg.norm(axes, axis=0)
    if not (lengths > 0).all():
        return False
    return bool(np.abs(np.triu((axes / lengths).T @ (axes / lengths), 1)).max() < 1e-6)


def transformed(mesh: Mesh, to_world: np.ndarray) -> Mesh:
    """In the world. Normals go by the cofactors, which are the inverse transpose but for a factor; where the transform
    flattens, faces have their own. A mirroring one turns triangles round, so that their fronts stay."""
    axes = to_world[:3, :3]
    volume = float(np.linalg.det(axes))
    positions = mesh.positions @ axes.T + to_world[:3, 3]
    normals = None
    if mesh.normals is not None and volume != 0:
        cofactors = np.stack([np.cross(axes[:, 1], axes[:, 2]), np.cross(axes[:, 2], axes[:, 0]),
                              np.cross(axes[:, 0], axes[:, 1])], axis=1) * np.sign(volume)
        normals = mesh.normals @ cofactors.T
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = normals / np.where(lengths > 0, lengths, 1)
    triangles = mesh.triangles[:, [0, 2, 1]] if volume < 0 else mesh.triangles
    return dataclasses.replace(mesh, positions=positions, normals=normals, triangles=triangles)


def _check_mesh(mesh: Mesh, where: str) -> None:
    count = len(mesh.positions)
    if mesh.positions.shape != (count, 3) or mesh.triangles.ndim != 2 or mesh.triangles.shape[1] != 3:
        raise ImportProblem(f"{where}: its arrays are of {mesh.positions.shape} and {mesh.triangles.shape} numbers; "
                            f"three a vertex and three a triangle would be right")
    for name, values in (("position", mesh.positions), ("normal", mesh.normals), ("texture coordinate", mesh.uvs)):
        if values is None:
            continue
        if len(values) != count:
            raise ImportProblem(f"{where}: it has {count} positions and {len(values)} {name}s; as many would be right")
        if not (np.abs(values) <= FLOAT_MAX).all():  # false of NaN, too
            vertex = int(np.argmin((np.abs(values) <= FLOAT_MAX).all(axis=1)))
            raise ImportProblem(f"{where}: the {name} of vertex {vertex} is {values[vertex].tolist()}; "
                                f"numbers that single precision holds would be right")
    if len(mesh.triangles) and not (0 <= mesh.triangles.min() and mesh.triangles.max() < count):
        raise ImportProblem(f"{where}: a triangle names vertex {int(mesh.triangles.max())} or one below 0; "
                            f"it has {count}, counted from 0")


def _faces(positions: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Normals of triangles, twice as long as their areas, and which of these are more than rounding leaves. That is judged
    by the positions as they are written, with the bound that the reader has (engine/gltf/triangle.cpp)."""
    a, b, c = (positions[triangles[:, i]].astype(float) for i in range(3))
    faces = np.cross(b - a, c - a)
    longest = np.maximum.reduce([((q - p) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))])
    return faces, np.linalg.norm(faces, axis=1) > 1e-7 * longest


def _unit_normals(normals: np.ndarray, faces: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Of a vertex without a direction, one of its triangles' normals, as glTF has no zeros."""
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    has_none = lengths[:, 0] < 1e-30
    if has_none.any():
        of_face = np.zeros_like(normals)
        of_face[triangles.ravel()] = np.repeat(faces, 3, axis=0)
        normals = np.where(has_none[:, None], of_face, normals)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / lengths


@dataclass
class _Written:
    mesh: Mesh  # kept, so that no other one gets its identity
    used: np.ndarray  # vertices of the mesh that the file has
    attributes: dict[str, int]
    indices: int


@dataclass
class MeshArrays:
    """The accessors of all meshes so far."""

    buffer: Buffer
    notes: Notes
    triangles: int = 0
    _written: dict[int, _Written | Mesh] = field(default_factory=dict)  # by identity; the mesh alone: nothing to see of it
    _second_uvs: dict[tuple[int, bytes], int] = field(default_factory=dict)

    def primitive(self, mesh: Mesh, where: str, second_uv: np.ndarray | None = None) -> dict[str, Any] | None:
        """Without its material; None where no triangle has an area. `second_uv`: (2, 3) on (u, v, 1), what a material's
        textures read that its texture transforms cannot say."""
        if id(mesh) not in self._written:
            self._written[id(mesh)] = self._add(mesh, where)
        written = self._written[id(mesh)]
        if isinstance(written, Mesh):
            return None
        attributes = dict(written.attributes)
        if second_uv is not None and mesh.uvs is not None:
            attributes["TEXCOORD_1"] = self._second_uv(written, second_uv)
        return {"attributes": attributes, "indices": written.indices}

    def _add(self, mesh: Mesh, where: str) -> _Written | Mesh:
        _check_mesh(mesh, where)
        positions = mesh.positions.astype("<f4") + np.float32(0)  # never -0.0
        faces, has_area = _faces(positions, mesh.triangles)
        triangles, faces = mesh.triangles[has_area], faces[has_area]
        if not has_area.all():
            self.notes.left_out("triangles without an area", where)
        if not len(triangles):
            return mesh
        # Without lone vertices, as these would move the bounds.
        is_used = np.zeros(len(positions), bool)
        is_used[triangles] = True
        used = np.flatnonzero(is_used)
        triangles = (np.cumsum(is_used) - 1)[triangles]
        attributes = {"POSITION": self.buffer.add(positions[used], "VEC3", FLOAT, bounds=True)}
        if mesh.normals is not None:
            unit = _unit_normals(mesh.normals[used], faces, triangles)
            attributes["NORMAL"] = self.buffer.add(unit.astype("<f4"), "VEC3", FLOAT)
        if mesh.uvs is not None:
            attributes["TEXCOORD_0"] = self.buffer.add(mesh.uvs[used].astype("<f4"), "VEC2", FLOAT)
        self.triangles += len(triangles)
        return _Written(mesh, used, attributes, self.buffer.add_triangles(triangles, len(used)))

    def _second_uv(self, written: _Written, matrix: np.ndarray) -> int:
        key = (id(written.mesh), matrix.tobytes())
        if key not in self._second_uvs:
            uvs = written.mesh.uvs[written.used] @ matrix[:, :2].T + matrix[:, 2]
            self._second_uvs[key] = self.buffer.add(uvs.astype("<f4"), "VEC2", FLOAT)
        return self._second_uvs[key]
