"""Writes a scene of plain objects as a glTF 2.0 binary file."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Sequence

import numpy as np

from glb_file import FLOAT, Buffer, glb
from gltf_material import Material
from images import Image
from unwrap import Mesh

LINEAR, LINEAR_MIPMAP_LINEAR, REPEAT = 9729, 9987, 10497


@dataclass(frozen=True)
class Object:
    """A node with a mesh of its own; `transform` holds glTF node properties."""

    name: str
    mesh: Mesh
    material: Material
    transform: dict[str, list[float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Camera:
    """Pinhole camera, y up, square image; angle in degrees, the rest in metres."""

    eye: Sequence[float]
    target: Sequence[float]
    vertical_fov: float

    def to_json(self) -> dict[str, Any]:
        return {"name": "camera", "type": "perspective", "perspective": {
            "aspectRatio": 1, "yfov": round(math.radians(self.vertical_fov), 9),
            "znear": 0.01, "zfar": 100}}

    def node(self) -> dict[str, Any]:
        """A glTF camera looks along -z: pitch it about x, then turn it about y, towards the target."""
        x, y, z = (t - e for t, e in zip(self.target, self.eye))
        pitch, turn = math.atan2(y, math.hypot(x, z)) / 2, math.atan2(-x, -z) / 2
        quaternion = (math.cos(turn) * math.sin(pitch), math.sin(turn) * math.cos(pitch),
                      -math.sin(turn) * math.sin(pitch), math.cos(turn) * math.cos(pitch))
        node: dict[str, Any] = {"name": "camera", "translation": list(self.eye)}
        if any(quaternion[:3]):
            node["rotation"] = [round(q, 9) or 0 for q in quaternion]
        return {**node, "camera": 0}


def _floats(values: np.ndarray) -> np.ndarray:
    """Rounded to 1e-6 (and never -0.0), so that every CPU writes the same bytes."""
    return (np.round(values, 6) + 0.0).astype("<f4")


def _textured(buffer: Buffer, mesh: Mesh, material: Material) -> dict[str, int]:
    """What textures need of the mesh. Images stand upright: their v falls where that of the map in metres grows."""
    attributes = {}
    if material.textures():
        attributes["TEXCOORD_1"] = buffer.add(_floats(mesh.metres * (1, -1)), "VEC2", FLOAT)
    if material.normal_map:
        tangents = np.hstack([mesh.tangents(), np.ones((len(mesh.positions), 1))])
        attributes["TANGENT"] = buffer.add(_floats(tangents), "VEC4", FLOAT)
    return attributes


def _primitive(buffer: Buffer, mesh: Mesh, material: Material, index: int) -> dict[str, Any]:
    return {
        "attributes": {
            "POSITION": buffer.add(_floats(mesh.positions), "VEC3", FLOAT, bounds=True),
            "NORMAL": buffer.add(_floats(mesh.normals), "VEC3", FLOAT),
            "TEXCOORD_0": buffer.add(_floats(mesh.uvs), "VEC2", FLOAT),
            **_textured(buffer, mesh, material)},
        "indices": buffer.add_triangles(mesh.triangles, len(mesh.positions)),
        "material": index}


def _images(buffer: Buffer, images: Sequence[Image]) -> dict[str, Any]:
    """A texture for each image, in the same order."""
    if not images:
        return {}
    return {"textures": [{"source": i, "sampler": 0} for i in range(len(images))],
            "samplers": [{"magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": REPEAT, "wrapT": REPEAT}],
            "images": [buffer.add_image(image.name, image.png) for image in images]}


def write_glb(path: Path, name: str, camera: Camera, objects: Sequence[Object],
              above: dict[str, Any] | None = None) -> int:
    """Writes the scene and returns the file's size in bytes; `above`: transform of a node over all others."""
    buffer = Buffer()
    materials = list(dict.fromkeys(o.material for o in objects))
    meshes = [{"name": o.name, "primitives": [
        _primitive(buffer, o.mesh, o.material, materials.index(o.material))]} for o in objects]
    nodes = [{"name": o.name, **o.transform, "mesh": i} for i, o in enumerate(objects)]
    nodes.append(camera.node())
    roots = list(range(len(nodes)))
    if above:
        nodes.append({"name": "all", **above, "children": roots})
        roots = [len(nodes) - 1]
    images = list(dict.fromkeys(t.image for m in materials for t in m.textures()))
    described = [material.to_json(images.index) for material in materials]
    extensions = {e for m in described for e in m["extensions"]} | ({"KHR_texture_transform"} if images else set())
    document = {
        "asset": {"version": "2.0", "generator": "qtrace scene generator",
                  "copyright": "CC0-1.0"},
        "extensionsUsed": sorted(extensions),
        "scene": 0,
        "scenes": [{"name": name, "nodes": roots}],
        "nodes": nodes,
        "cameras": [camera.to_json()],
        "materials": described,
        "meshes": meshes,
        **_images(buffer, images),
        **buffer.to_json(),
    }
    return path.write_bytes(glb(document, buffer.data))
