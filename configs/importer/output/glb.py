"""A scene as a glTF 2.0 binary file."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from importer.output.geometry import MeshArrays, is_translation_rotation_scale, transformed
from importer.output.materials import Materials
from importer.output.nodes import camera_json, lights_json, matrix_json
from importer.output.packing import Packer
from importer.output.textures import Textures
from importer.output.world import World, check_affine, check_single, world_of
from importer.problems import ImportProblem, Notes
from importer.scene import Mesh, Part, Scene
from scenes.glb_file import Buffer, glb

GENERATOR = "qtrace importer"


@dataclass(frozen=True)
class Totals:
    """What the file holds, for who reads the terminal. Triangles count as often as they are seen."""

    parts: int
    meshes: int
    triangles: int
    materials: int
    images: int
    lights: int  # without a surface
    lamps: int  # parts that emit
    bytes: int


class _Writer:
    """Collects meshes and nodes, each mesh with each of its materials once."""

    def __init__(self, scene: Scene, notes: Notes) -> None:
        self.scene, self.notes = scene, notes
        self.world: World = world_of(scene)
        self.buffer = Buffer()
        self.arrays = MeshArrays(self.buffer, notes)
        self.textures = Textures(self.buffer)
        self.materials = Materials(self.textures, Packer(notes))
        self.meshes: list[dict[str, Any]] = []
        self.nodes: list[dict[str, Any]] = []
        self.corners: list[np.ndarray] = []  # of the parts' bounds, in the file's world
        self.triangles = self.lamps = 0
        self._mesh_of: dict[tuple[int, int], int | None] = {}

    def add(self, part: Part) -> None:
        if part.material.opacity == 0:  # nobody sees it, and every ray would have to pass it
            return
        where = f"shape {part.name}"
        check_affine(part.to_world, where)
        to_world = self.world.place(np.asarray(part.to_world, float))
        mesh = part.mesh
        if not is_translation_rotation_scale(to_world):
            mesh, to_world = transformed(mesh, to_world), np.eye(4)
        index = self._mesh(part, mesh, where)
        if index is None:
            return
        self.nodes.append({"name": part.name, **matrix_json(to_world), "mesh": index})
        self._count(index, to_world, where)

    def _mesh(self, part: Part, mesh: Mesh, where: str) -> int | None:
        material = self.materials.written(part.material)
        key = (id(mesh), material.index)
        if key not in self._mesh_of:
            primitive = self.arrays.primitive(mesh, where, material.second_uv)
            self._mesh_of[key] = None if primitive is None else len(self.meshes)
            if primitive is not None:
                self.meshes.append({"name": mesh.name or part.name,
                                    "primitives": [{**primitive, "material": material.index}]})
        return self._mesh_of[key]

    def _count(self, index: int, to_world: np.ndarray, where: str) -> None:
        primitive = self.meshes[index]["primitives"][0]
        bounds = self.buffer.accessors[primitive["attributes"]["POSITION"]]
        corners = np.array(list(itertools.product(*zip(bounds["min"], bounds["max"]))))
        self.corners.append(corners @ to_world[:3, :3].T + to_world[:3, 3])
        check_single(self.corners[-1], f"{where}: what its transform makes of it")
        self.triangles += self.buffer.accessors[primitive["indices"]]["count"] // 3
        self.lamps += "emissiveFactor" in self.materials.listed[primitive["material"]]

    def document(self, source: dict[str, Any]) -> tuple[dict[str, Any], int]:
        """And how many lights without a surface there are."""
        for part in self.scene.parts:
            self.add(part)
        corners = np.concatenate(self.corners) if self.corners else np.zeros((0, 3))
        camera, camera_node = camera_json(self.scene.camera, self.world, corners)
        lights, light_nodes = lights_json(self.scene.lights, self.world)
        self.nodes += [*light_nodes, camera_node]
        extensions = self.materials.extensions() | ({"KHR_lights_punctual"} if lights else set())
        if self.textures.uses_transforms:
            extensions.add("KHR_texture_transform")
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": GENERATOR,
                      "extras": {"source": source, "approximations": self.notes.rows()}},
            "extensionsUsed": sorted(extensions), "scene": 0,
            "scenes": [{"name": self.scene.name, "nodes": list(range(len(self.nodes)))}],
            "nodes": self.nodes, "cameras": [camera], "materials": self.materials.listed, "meshes": self.meshes,
            **self.textures.to_json(), **self.buffer.to_json()}
        if lights:
            document["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
        return {key: value for key, value in document.items() if value not in ([], {})}, len(lights)


def write_glb(scene: Scene, path: Path, notes: Notes, source: dict[str, Any]) -> Totals:
    """`source`: where the scene comes from; it stands in `asset.extras` beside what `notes` say at the end."""
    writer = _Writer(scene, notes)
    document, lights = writer.document(source)
    if not writer.meshes:
        raise ImportProblem(f"{source.get('file', scene.name)}: it shows no surface; a scene with a shape would be right")
    size = path.write_bytes(glb(document, writer.buffer.data))
    return Totals(parts=len(writer.nodes) - lights - 1, meshes=len(writer.meshes), triangles=writer.triangles,
                  materials=len(writer.materials.listed), images=len(writer.textures.images), lights=lights,
                  lamps=writer.lamps, bytes=size)
