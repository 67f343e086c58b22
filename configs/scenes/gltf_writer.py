"""Writes a scene of plain objects as a glTF 2.0 binary file."""

from __future__ import annotations

import json
import math
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Sequence

import numpy as np

from gltf_material import Material
from images import Image
from unwrap import Mesh

FLOAT, UINT16, UINT32 = 5126, 5123, 5125
LINEAR, LINEAR_MIPMAP_LINEAR, REPEAT = 9729, 9987, 10497
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


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


class _Buffer:
    """Collects the binary chunk with one buffer view and accessor per array, and one view per image."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, array: np.ndarray, kind: str, component: int, bounds: bool = False) -> int:
        """Appends an array, aligned to four bytes, and returns its accessor."""
        target = ARRAY_BUFFER if component == FLOAT else ELEMENT_ARRAY_BUFFER
        raw = array.tobytes()
        self.views.append({"buffer": 0, "byteOffset": len(self.data),
                           "byteLength": len(raw), "target": target})
        self.data += raw + bytes(-len(raw) % 4)
        accessor = {"bufferView": len(self.views) - 1, "componentType": component,
                    "count": array.size if kind == "SCALAR" else len(array), "type": kind}
        if bounds:
            accessor["min"] = array.min(axis=0).tolist()
            accessor["max"] = array.max(axis=0).tolist()
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def add_image(self, image: Image) -> dict[str, Any]:
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(image.png)})
        self.data += image.png + bytes(-len(image.png) % 4)
        return {"name": image.name, "mimeType": "image/png", "bufferView": len(self.views) - 1}


def _floats(values: np.ndarray) -> np.ndarray:
    """Rounded to 1e-6 (and never -0.0), so that every CPU writes the same bytes."""
    return (np.round(values, 6) + 0.0).astype("<f4")


def _textured(buffer: _Buffer, mesh: Mesh, material: Material) -> dict[str, int]:
    """What textures need of the mesh. Images stand upright: their v falls where that of the map in metres grows."""
    attributes = {}
    if material.textures():
        attributes["TEXCOORD_1"] = buffer.add(_floats(mesh.metres * (1, -1)), "VEC2", FLOAT)
    if material.normal_map:
        tangents = np.hstack([mesh.tangents(), np.ones((len(mesh.positions), 1))])
        attributes["TANGENT"] = buffer.add(_floats(tangents), "VEC4", FLOAT)
    return attributes


def _primitive(buffer: _Buffer, mesh: Mesh, material: Material, index: int) -> dict[str, Any]:
    wide = len(mesh.positions) > 65535
    indices = mesh.triangles.ravel().astype("<u4" if wide else "<u2")
    return {
        "attributes": {
            "POSITION": buffer.add(_floats(mesh.positions), "VEC3", FLOAT, bounds=True),
            "NORMAL": buffer.add(_floats(mesh.normals), "VEC3", FLOAT),
            "TEXCOORD_0": buffer.add(_floats(mesh.uvs), "VEC2", FLOAT),
            **_textured(buffer, mesh, material)},
        "indices": buffer.add(indices, "SCALAR", UINT32 if wide else UINT16),
        "material": index}


def _images(buffer: _Buffer, images: Sequence[Image]) -> dict[str, Any]:
    """A texture for each image, in the same order."""
    if not images:
        return {}
    return {"textures": [{"source": i, "sampler": 0} for i in range(len(images))],
            "samplers": [{"magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": REPEAT, "wrapT": REPEAT}],
            "images": [buffer.add_image(image) for image in images]}


def write_glb(path: Path, name: str, camera: Camera, objects: Sequence[Object],
              above: dict[str, Any] | None = None) -> int:
    """Writes the scene and returns the file's size in bytes; `above`: transform of a node over all others."""
    buffer = _Buffer()
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
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(buffer.data)
    path.write_bytes(
        struct.pack("<4sII", b"glTF", 2, total)
        + struct.pack("<I4s", len(text), b"JSON") + text
        + struct.pack("<I4s", len(buffer.data), b"BIN\0") + bytes(buffer.data))
    return total
