"""Writes a scene of plain objects as a glTF 2.0 binary file."""

from __future__ import annotations

import json
import math
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Sequence

import numpy as np

from unwrap import Mesh

FLOAT, UINT16, UINT32 = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


@dataclass(frozen=True)
class Material:
    """Reflectance (linear RGB) and one-sided emission (W / (sr m^2)); Lambert unless it has a specular lobe."""

    name: str
    reflectance: Sequence[float]
    radiance: Sequence[float] = (0.0, 0.0, 0.0)
    metallic: float = 0
    roughness: float = 1
    specular: float = 0

    def to_json(self) -> dict[str, Any]:
        extensions: dict[str, Any] = {"KHR_materials_specular": {"specularFactor": self.specular}}
        result: dict[str, Any] = {
            "name": self.name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [*self.reflectance, 1],
                "metallicFactor": self.metallic, "roughnessFactor": self.roughness},
        }
        strength = max(self.radiance)
        if strength > 0:
            result["emissiveFactor"] = [round(c / strength, 9) for c in self.radiance]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        return {**result, "extensions": extensions}


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
    """Collects the binary chunk with one buffer view and accessor per array."""

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


def _floats(values: np.ndarray) -> np.ndarray:
    """Rounded to 1e-6 (and never -0.0), so that every CPU writes the same bytes."""
    return (np.round(values, 6) + 0.0).astype("<f4")


def _primitive(buffer: _Buffer, mesh: Mesh, material: int) -> dict[str, Any]:
    wide = len(mesh.positions) > 65535
    indices = mesh.triangles.ravel().astype("<u4" if wide else "<u2")
    return {
        "attributes": {
            "POSITION": buffer.add(_floats(mesh.positions), "VEC3", FLOAT, bounds=True),
            "NORMAL": buffer.add(_floats(mesh.normals), "VEC3", FLOAT),
            "TEXCOORD_0": buffer.add(_floats(mesh.uvs), "VEC2", FLOAT)},
        "indices": buffer.add(indices, "SCALAR", UINT32 if wide else UINT16),
        "material": material}


def write_glb(path: Path, name: str, camera: Camera, objects: Sequence[Object],
              above: dict[str, Any] | None = None) -> int:
    """Writes the scene and returns the file's size in bytes; `above`: transform of a node over all others."""
    buffer = _Buffer()
    materials = list(dict.fromkeys(o.material for o in objects))
    meshes = [{"name": o.name, "primitives": [
        _primitive(buffer, o.mesh, materials.index(o.material))]} for o in objects]
    nodes = [{"name": o.name, **o.transform, "mesh": i} for i, o in enumerate(objects)]
    nodes.append(camera.node())
    roots = list(range(len(nodes)))
    if above:
        nodes.append({"name": "all", **above, "children": roots})
        roots = [len(nodes) - 1]
    described = [material.to_json() for material in materials]
    document = {
        "asset": {"version": "2.0", "generator": "qtrace scene generator",
                  "copyright": "CC0-1.0"},
        "extensionsUsed": sorted({e for m in described for e in m["extensions"]}),
        "scene": 0,
        "scenes": [{"name": name, "nodes": roots}],
        "nodes": nodes,
        "cameras": [camera.to_json()],
        "materials": described,
        "meshes": meshes,
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
