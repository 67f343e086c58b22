"""Shapes as triangles (pbrt-v4: shapes.cpp, util/mesh.cpp; pbrt-v3: shapes/).

Which side is the front: in both versions the side of the normal, which ReverseOrientation turns over. A transformation
that mirrors turns the computed normal over as well and pbrt turns it back (transformSwapsHandedness), so that in object
space it stays where it was: glTF's rule. Where a mesh has vertex normals, they say which side it is. (pbrt-v3 does not
agree with itself on mirrored meshes with normals; as Triangle::Sample has it, by which lamps light the scene.)"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Callable

import numpy as np

from importer.meshes import assemble, orient, patch, primitives
from importer.meshes.ply import read_ply
from importer.pbrt.parameters import Parameters
from importer.pbrt.source import Folder
from importer.problems import ImportProblem, Notes
from importer.scene import Mesh

_REFUSED = {"curve": "hair and grass as curves", "loopsubdiv": "a subdivision surface", "nurbs": "a NURBS surface",
            "heightfield": "a height field", "cone": "a cone", "paraboloid": "a paraboloid",
            "hyperboloid": "a hyperboloid"}
_DEFAULT_UVS = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])


class Shapes:
    """Makes meshes of one scene's shapes; a file that is named again is the same mesh."""

    def __init__(self, folder: Folder, notes: Notes) -> None:
        self._folder = folder
        self._notes = notes
        self._files: dict[tuple[Path, bool], Mesh] = {}
        self._round: dict[tuple[object, ...], Mesh] = {}

    def read(self, kind: str, parameters: Parameters, is_reversed: bool) -> list[Mesh]:
        """In object space with the front where pbrt has it and v downwards; none for a shape that is left out."""
        makers = {"trianglemesh": self._triangles, "plymesh": self._ply, "bilinearmesh": self._patches,
                  "sphere": self._sphere, "disk": self._disk, "cylinder": self._cylinder}
        if kind in _REFUSED:
            self._notes.refuse(f'the shape "{kind}", {_REFUSED[kind]}', str(parameters.place))
            return []
        if kind not in makers:
            raise ImportProblem(f'{parameters.place}: there is no shape "{kind}"; it must be {", ".join(makers)}')
        meshes = makers[kind](parameters, is_reversed)
        if parameters.numbers("S", "vector3", width=3) is not None:
            self._notes.left_out("the tangents of a mesh", str(parameters.place))
        return meshes

    def _triangles(self, parameters: Parameters, is_reversed: bool) -> list[Mesh]:
        positions, normals, uvs = self._vertices(parameters)
        indices = parameters.numbers("indices", "integer", width=3)
        if indices is None and len(positions) == 3:
            indices = np.array([[0, 1, 2]])
        if indices is None:
            raise ImportProblem(f'{parameters.place}: the shape "trianglemesh" has no "indices"; it must have them')
        triangles = _whole(indices)
        where = Path(str(parameters.place))
        assemble.check_indices(where, "vertex", triangles, len(positions))
        mesh = assemble.finished(where, Mesh(positions, triangles, normals, uvs, "trianglemesh"))
        return [_finished(mesh, is_reversed)]

    def _patches(self, parameters: Parameters, is_reversed: bool) -> list[Mesh]:
        positions, normals, uvs = self._vertices(parameters)
        indices = parameters.numbers("indices", "integer", width=4)
        if indices is None and len(positions) == 4:
            indices = np.array([[0, 1, 2, 3]])
        if indices is None:
            raise ImportProblem(f'{parameters.place}: the shape "bilinearmesh" has no "indices"; it must have them')
        where = Path(str(parameters.place))
        corners = _whole(indices)
        assemble.check_indices(where, "vertex", corners, len(positions))
        parameters.without_effect("emissionfilename")  # by which pbrt chooses points on a lamp, and no more
        parts = [patch.bilinear(positions[row], None if normals is None else normals[row],
                                None if uvs is None else uvs[row]) for row in corners]
        joined = assemble.finished(where, _joined(parts))
        if len(joined.triangles) > 2 * len(corners):
            self._notes.approximated("bilinear patches that are bent as triangles", str(parameters.place))
        return [_finished(joined, is_reversed)]

    def _ply(self, parameters: Parameters, is_reversed: bool) -> list[Mesh]:
        name = parameters.string("filename", "")
        path = self._folder.find(name, str(parameters.place))
        if parameters.has("displacement"):
            self._notes.left_out("the displacement of a mesh", str(parameters.place))
        parameters.without_effect("displacement", "displacement.edgelength", "edgelength")
        if (path, is_reversed) not in self._files:
            mesh = read_ply(path)
            self._files[path, is_reversed] = _finished(replace(mesh, name=mesh.name or path.name.split(".")[0]), is_reversed)
        return [self._files[path, is_reversed]]

    def _vertices(self, parameters: Parameters) -> tuple[np.ndarray, np.ndarray | None, np.ndarray | None]:
        """P, N and uv, the latter two of the length of P; v3 also says st, and float for point2."""
        positions = parameters.numbers("P", "point3", width=3)
        if positions is None:
            raise ImportProblem(f'{parameters.place}: a mesh has no "P"; it must have positions')
        normals = parameters.numbers("N", "normal3", width=3)
        uvs = parameters.numbers("uv", "point2", "float", "vector2", width=2)
        st = parameters.numbers("st", "point2", "float", "vector2", width=2)
        uvs = st if uvs is None else uvs
        for what, values in (("N", normals), ("uv", uvs)):
            if values is not None and len(values) != len(positions):
                raise ImportProblem(f'{parameters.place}: a mesh has {len(values)} of "{what}" and {len(positions)} of "P";'
                                    " it must have as many")
        if parameters.has("faceIndices"):
            parameters.without_effect("faceIndices")  # of ptex, which is refused where it is a texture
        return positions, normals, uvs

    def _sphere(self, parameters: Parameters, is_reversed: bool) -> list[Mesh]:
        radius = _size(parameters, "radius", 1.0)
        low, high = parameters.number("zmin", -radius), parameters.number("zmax", radius)
        phi = _phi(parameters)
        if max(low, -radius) >= min(high, radius):
            raise ImportProblem(f'{parameters.place}: the sphere has nothing between "zmin" {low:g} and "zmax" {high:g}')
        return self._once(primitives.pbrt_sphere, (radius, low, high, phi), is_reversed, str(parameters.place))

    def _disk(self, parameters: Parameters, is_reversed: bool) -> list[Mesh]:
        radius = _size(parameters, "radius", 1.0)
        inner = parameters.number("innerradius", 0.0)
        if not 0 <= inner < radius:
            raise ImportProblem(f'{parameters.place}: the disk\'s "innerradius" is {inner:g}; it must be 0 or more and below'
                                f' "radius", {radius:g}')
        height = parameters.number("height", 0.0)
        sizes = (height, radius, inner, _phi(parameters))
        return self._once(primitives.pbrt_disk, sizes, is_reversed, str(parameters.place))

    def _cylinder(self, parameters: Parameters, is_reversed: bool) -> list[Mesh]:
        low, high = parameters.number("zmin", -1.0), parameters.number("zmax", 1.0)
        if low == high:
            raise ImportProblem(f'{parameters.place}: the cylinder\'s "zmin" and "zmax" are the same; they must differ')
        sizes = (_size(parameters, "radius", 1.0), low, high, _phi(parameters))
        return self._once(primitives.pbrt_cylinder, sizes, is_reversed, str(parameters.place))

    def _once(self, make: Callable[..., Mesh], sizes: tuple[float, ...], is_reversed: bool,
              where: str) -> list[Mesh]:
        """Equal shapes share their mesh, of which a sphere's has 16 thousand triangles."""
        key = (make, sizes, is_reversed)
        self._notes.approximated("spheres, disks and cylinders as triangles", where)
        if key not in self._round:
            self._round[key] = _finished(make(*sizes), is_reversed)
        return [self._round[key]]


def power_area(kind: str, parameters: Parameters, mesh: Mesh, to_world: np.ndarray) -> tuple[float, int, bool]:
    """The area by which pbrt-v4 divides a light's "power", how many lights the shape is, and whether these are alike.

    Each triangle is a light of its own with all of the power; a sphere's, a disk's and a cylinder's area is that before
    the transformation (Sphere::Area and so on)."""
    if kind in ("trianglemesh", "plymesh", "bilinearmesh"):
        areas = np.linalg.norm(orient.area_vectors(_moved(mesh, to_world)), axis=1) / 2
        if kind == "bilinearmesh":
            count = len(np.asarray(parameters.numbers("indices", "integer"))) // 4 if parameters.has("indices") else 1
            return float(areas.sum()), count, count == 1
        return float(areas.sum()), len(areas), bool(np.ptp(areas) <= 1e-3 * areas.max())
    phi = np.radians(_phi(parameters))
    radius = parameters.number("radius", 1.0)
    if kind == "disk":
        return float(phi / 2 * (radius ** 2 - parameters.number("innerradius", 0.0) ** 2)), 1, True
    ends = (-radius, radius) if kind == "sphere" else (-1.0, 1.0)
    low, high = sorted((parameters.number("zmin", ends[0]), parameters.number("zmax", ends[1])))
    if kind == "sphere":
        low, high = max(low, -radius), min(high, radius)
    return float(phi * radius * (high - low)), 1, True


def with_default_uvs(mesh: Mesh) -> Mesh:
    """pbrt gives each triangle without coordinates (0,0), (1,0), (1,1), v upwards (Triangle::GetUVs)."""
    if mesh.uvs is not None:
        return mesh
    corner = mesh.triangles.reshape(-1)
    uvs = np.tile(_DEFAULT_UVS * (1, -1) + (0, 1), (len(mesh.triangles), 1))
    normals = None if mesh.normals is None else mesh.normals[corner]
    return Mesh(mesh.positions[corner], np.arange(len(corner)).reshape(-1, 3), normals, uvs, mesh.name)


def _finished(mesh: Mesh, is_reversed: bool) -> Mesh:
    mesh = orient.fronts_by_normals(mesh)
    if mesh.uvs is not None:
        mesh = replace(mesh, uvs=mesh.uvs * (1, -1) + (0, 1))
    return orient.flipped(mesh) if is_reversed else mesh


def _moved(mesh: Mesh, to_world: np.ndarray) -> Mesh:
    return replace(mesh, positions=mesh.positions @ to_world[:3, :3].T + to_world[:3, 3], normals=None)


def _whole(indices: np.ndarray) -> np.ndarray:
    """Of what may be far out of range, and stays so."""
    return np.clip(indices, -1, 1 << 40).astype(np.int64)


def _joined(parts: list[Mesh]) -> Mesh:
    starts = np.cumsum([0, *(len(part.positions) for part in parts)])
    triangles = np.concatenate([part.triangles + start for part, start in zip(parts, starts)])
    positions, normals, uvs = (np.concatenate([getattr(part, name) for part in parts])
                               for name in ("positions", "normals", "uvs"))
    return Mesh(positions, triangles, normals, uvs, "bilinearmesh")


def _size(parameters: Parameters, name: str, default: float) -> float:
    value = parameters.number(name, default)
    if value <= 0:
        raise ImportProblem(f'{parameters.place}: {parameters.what} has a "{name}" of {value:g}; it must be above 0')
    return value


def _phi(parameters: Parameters) -> float:
    degrees = parameters.number("phimax", 360.0)
    if degrees <= 0:
        raise ImportProblem(f'{parameters.place}: {parameters.what} has a "phimax" of {degrees:g}; it must be above 0')
    return min(degrees, 360.0)
