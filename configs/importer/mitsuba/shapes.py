"""<shape> as meshes in the object's own space, with the front where Mitsuba's light leaves: on the side of the shading
normal (AreaLight::eval)."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

import numpy as np

from importer.meshes import orient, primitives
from importer.meshes.obj import read_obj
from importer.meshes.ply import read_ply
from importer.meshes.serialized import read_serialized
from importer.mitsuba.creases import creased
from importer.mitsuba.files import SceneFolder
from importer.mitsuba.plugin import Plugin
from importer.mitsuba.transforms import mirrors
from importer.moves import translation
from importer.problems import ImportProblem, Notes
from importer.scene import Mesh

FILES = ("obj", "ply", "serialized")
ANALYTIC = ("sphere", "rectangle", "cube", "disk", "cylinder")
NO_COUNTERPART = {"hair", "heightfield", "deformable", "bsplinecurve", "linearcurve", "sdfgrid", "ellipsoids",
                  "ellipsoidsmesh", "animatedinstance"}
_FILE_PLAIN = ("silhouette_sampling_weight", "collapse", "load_materials", "srgb", "name")


@dataclass(eq=False)
class Geometry:
    mesh: Mesh
    to_world: np.ndarray


@dataclass
class ShapeReader:
    """Reads each mesh file once. Parts share a mesh where its options are the same."""

    folder: SceneFolder
    notes: Notes
    _meshes: dict[tuple[object, ...], Mesh] = field(default_factory=dict)

    def read(self, shape: Plugin) -> Geometry:
        shape.ignore(*_FILE_PLAIN)
        to_world = shape.transform("to_world")
        if shape.type in FILES:
            geometry = self._file(shape, to_world)
        else:
            readers: dict[str, Callable[[Plugin, np.ndarray], Geometry]] = {
                "sphere": self._sphere, "cylinder": self._cylinder, "rectangle": self._flat, "disk": self._flat,
                "cube": self._cube}
            geometry = readers[shape.type](shape, to_world)
        if shape.boolean("flip_normals", False):
            geometry.mesh = self._variant(geometry.mesh, "flipped", orient.flipped)
        return geometry

    def inside_out(self, geometry: Geometry) -> Geometry:
        """For glass whose dense side is before the front."""
        return Geometry(self._variant(geometry.mesh, "flipped", orient.flipped), geometry.to_world)

    def _file(self, shape: Plugin, to_world: np.ndarray) -> Geometry:
        _check_volume(to_world, shape)
        path = self.folder.find(shape.string("filename"), shape.folders, shape.where)
        with self.folder.reading(shape.where):
            mesh = self._from_file(shape, path)
        angle = shape.number("max_smooth_angle", 180.0)
        if shape.boolean("face_normals", False):
            mesh = self._variant(mesh, "flat", orient.flat)
        elif shape.has("max_smooth_angle"):  # which takes the place of normals that the file has
            mesh = self._variant(mesh, f"creased at {angle}", lambda source: creased(source, angle))
        elif mesh.normals is not None:
            return Geometry(self._variant(mesh, "fronts", orient.fronts_by_normals), to_world)
        else:
            mesh = self._variant(mesh, "smooth", orient.smooth)
        # Normals that no file gives follow the order of the corners in the world (OBJMesh transforms them first). glTF's
        # follow that in the object, which a mirroring transform turns round.
        if mirrors(to_world):
            mesh = self._variant(mesh, "flipped", orient.flipped)
        return Geometry(mesh, to_world)

    def _from_file(self, shape: Plugin, path: Path) -> Mesh:
        if shape.type == "serialized":
            index = shape.integer("shape_index", 0)
            return self._cached(("serialized", path, index), lambda: read_serialized(path, index))
        is_flipped = shape.boolean("flip_tex_coords", shape.type == "obj")
        if shape.type == "obj":
            if shape.get("shape_index"):
                self.notes.refuse("one group of an .obj (shape_index)", shape.where)
            return self._cached(("obj", path, is_flipped), lambda: read_obj(path, is_flipped))
        mesh = self._cached(("ply", path), lambda: read_ply(path))
        return self._variant(mesh, "uvs upside down", _with_flipped_v) if is_flipped and mesh.uvs is not None else mesh

    def _sphere(self, shape: Plugin, to_world: np.ndarray) -> Geometry:
        """Mitsuba intersects a sphere about the transformed centre, whose radius is the length of the transformed x axis
        (Sphere::update); 3 turns the normals of a mirrored one inwards."""
        _check_volume(to_world, shape)
        radius = shape.number("radius", 1.0)
        if radius <= 0:
            raise ImportProblem(f"{shape.where}: its radius is {radius:g}; more than 0 is right")
        centre = shape.vector("center", (0.0, 0.0, 0.0))
        scale = np.linalg.norm(to_world[:3, 0])
        if shape.is_old and shape.has("to_world"):
            centre = centre / scale  # 0.6 takes the scale out before it moves the centre
        linear, is_uniform = _rotation(to_world)
        if not is_uniform:
            self.notes.approximated("a sphere under different scales, which Mitsuba renders with the radius of its x axis",
                                    shape.where)
        matrix = to_world @ translation(centre)
        matrix[:3, :3] = linear * scale * radius
        mesh = primitives.sphere()
        if not shape.is_old and mirrors(to_world):
            mesh = self._variant(mesh, "flipped", orient.flipped)
        return Geometry(mesh, matrix)

    def _cylinder(self, shape: Plugin, to_world: np.ndarray) -> Geometry:
        """Its normals are the cross product of its transformed tangents in 0.6, and turned inwards where it is mirrored
        in 3, which is the same."""
        _check_volume(to_world, shape)
        ends = [shape.vector("p0", (0.0, 0.0, 0.0)), shape.vector("p1", (0.0, 0.0, 1.0))]
        radius = shape.number("radius", 1.0)
        if radius <= 0 or not np.linalg.norm(ends[1] - ends[0]) > 1e-12:
            raise ImportProblem(f"{shape.where}: a cylinder needs a radius above 0 and two different ends")
        key = ("cylinder", tuple(ends[0]), tuple(ends[1]), radius)
        mesh = self._cached(key, lambda: primitives.cylinder(tuple(ends[0]), tuple(ends[1]), radius))
        if mirrors(to_world):
            mesh = self._variant(mesh, "flipped", orient.flipped)
        return Geometry(mesh, to_world)

    def _flat(self, shape: Plugin, to_world: np.ndarray) -> Geometry:
        """Scenes scale rectangles and disks by 0 along z at times, which changes nothing but their matrix's inverse."""
        mesh = primitives.rectangle() if shape.type == "rectangle" else primitives.disk()
        normal = np.cross(to_world[:3, 0], to_world[:3, 1])
        area = np.linalg.norm(normal)
        if not area > 1e-18:
            raise ImportProblem(f"{shape.where}: its to_world leaves it no area")
        height = abs(normal @ to_world[:3, 2]) / area
        if height < 1e-9 * np.sqrt(area):
            to_world = to_world.copy()
            to_world[:3, 2] = normal / np.sqrt(area)
        return Geometry(mesh, to_world)

    def _cube(self, shape: Plugin, to_world: np.ndarray) -> Geometry:
        _check_volume(to_world, shape)
        return Geometry(primitives.cube(), to_world)

    def _cached(self, key: tuple[object, ...], make: Callable[[], Mesh]) -> Mesh:
        if key not in self._meshes:
            self._meshes[key] = make()
        return self._meshes[key]

    def _variant(self, mesh: Mesh, what: str, make: Callable[[Mesh], Mesh]) -> Mesh:
        """The mesh changed, once for all who want it so; the key holds the mesh, so that its id stays its own."""
        return self._cached((what, _ById(mesh)), lambda: make(mesh))


@dataclass(frozen=True)
class _ById:
    mesh: Mesh

    def __hash__(self) -> int:
        return id(self.mesh)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ById) and self.mesh is other.mesh


def _with_flipped_v(mesh: Mesh) -> Mesh:
    assert mesh.uvs is not None
    return Mesh(mesh.positions, mesh.triangles, mesh.normals, mesh.uvs * (1, -1) + (0, 1), mesh.name)


def _check_volume(to_world: np.ndarray, shape: Plugin) -> None:
    """A matrix that flattens has no inverse, which Mitsuba needs for normals as glTF does."""
    lengths = np.linalg.norm(to_world[:3, :3], axis=0)
    if not abs(np.linalg.det(to_world[:3, :3])) > 1e-12 * np.prod(lengths) > 0:
        raise ImportProblem(f"{shape.where}: its to_world leaves it no volume")


def _rotation(to_world: np.ndarray) -> tuple[np.ndarray, bool]:
    """The orthogonal matrix that is nearest to the linear part, and whether that differs from it by one scale alone."""
    linear = to_world[:3, :3]
    u, scales, v = np.linalg.svd(linear)
    return u @ v, bool(np.ptp(scales) < 1e-4 * scales.max())
