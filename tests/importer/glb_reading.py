"""A .glb as a test looks at it: arrays, nodes in the world, texels; nothing of it is the writer's."""

from __future__ import annotations

import json
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

_TYPES = {5126: "<f4", 5123: "<u2", 5125: "<u4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


@dataclass
class Glb:
    document: dict[str, Any]
    data: bytes

    @classmethod
    def read(cls, path: Path) -> Glb:
        raw = path.read_bytes()
        magic, version, total = struct.unpack_from("<4sII", raw)
        assert (magic, version, total) == (b"glTF", 2, len(raw))
        length, kind = struct.unpack_from("<I4s", raw, 12)
        assert kind == b"JSON" and length % 4 == 0
        rest = struct.unpack_from("<I4s", raw, 20 + length)
        assert rest == (len(raw) - 28 - length, b"BIN\0")
        return cls(json.loads(raw[20:20 + length]), raw[28 + length:])

    def view(self, index: int) -> bytes:
        view = self.document["bufferViews"][index]
        return self.data[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]

    def array(self, accessor: int) -> np.ndarray:
        said = self.document["accessors"][accessor]
        values = np.frombuffer(self.view(said["bufferView"]), _TYPES[said["componentType"]])
        assert values.size == said["count"] * _WIDTHS[said["type"]]
        return values.reshape(said["count"], -1) if said["type"] != "SCALAR" else values

    def node(self, name: str) -> dict[str, Any]:
        return next(node for node in self.document["nodes"] if node["name"] == name)

    def matrix(self, name: str) -> np.ndarray:
        return np.array(self.node(name).get("matrix", np.eye(4).ravel())).reshape(4, 4).T

    def primitive(self, name: str) -> dict[str, Any]:
        return self.document["meshes"][self.node(name)["mesh"]]["primitives"][0]

    def corners(self, name: str) -> np.ndarray:
        """(m, 3 corners, 3) in the world, counter-clockwise as seen from the front: a node that mirrors reverses them
        (glTF 2.0, 3.7.4)."""
        primitive, matrix = self.primitive(name), self.matrix(name)
        local = self.array(primitive["attributes"]["POSITION"]).astype(float)
        world = local @ matrix[:3, :3].T + matrix[:3, 3]
        triangles = self.array(primitive["indices"]).reshape(-1, 3).astype(int)
        if np.linalg.det(matrix[:3, :3]) < 0:
            triangles = triangles[:, ::-1]
        return world[triangles]

    def fronts(self, name: str) -> np.ndarray:
        a, b, c = self.corners(name).transpose(1, 0, 2)
        faces = np.cross(b - a, c - a)
        return faces / np.linalg.norm(faces, axis=1, keepdims=True)

    def material(self, name: str) -> dict[str, Any]:
        return next(material for material in self.document["materials"] if material["name"] == name)

    def image_of(self, info: dict[str, Any]) -> bytes:
        texture = self.document["textures"][info["index"]]
        return self.view(self.document["images"][texture["source"]]["bufferView"])

    def texels(self, info: dict[str, Any]) -> np.ndarray:
        return png_pixels(self.image_of(info))


def png_pixels(data: bytes) -> np.ndarray:
    """(height, width, channels) in [0, 1], of PNGs without interlacing whose filters are 0 to 2 (PNG 1.2, chapter 6)."""
    width, height, depth, kind = struct.unpack_from(">IIBB", data, 16)
    channels = {0: 1, 2: 3, 6: 4}[kind]
    packed, at = b"", 8
    while at < len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        assert struct.unpack_from(">I", data, at + 8 + length)[0] == zlib.crc32(name + body)
        packed += body if name == b"IDAT" else b""
        at += 12 + length
    step = channels * depth // 8
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * step)
    out = np.zeros((height, width * step), np.uint8)
    for y, row in enumerate(rows):
        out[y] = row[1:]
        if row[0] == 1:
            out[y] = np.cumsum(row[1:].reshape(width, step), axis=0, dtype=np.uint8).ravel()
        elif row[0] == 2:
            out[y] += out[y - 1] if y else 0
        else:
            assert row[0] == 0
    values = out.view(">u2") / 65535 if depth == 16 else out / 255
    return values.reshape(height, width, channels)


def image_from_uv(info: dict[str, Any]) -> np.ndarray:
    """(2, 3) of KHR_texture_transform: translation * rotation * scale, where angles grow counter-clockwise in an image
    whose v points down."""
    said = info.get("extensions", {}).get("KHR_texture_transform", {})
    c, s = np.cos(said.get("rotation", 0)), np.sin(said.get("rotation", 0))
    turn = np.array([[c, s], [-s, c]]) @ np.diag(said.get("scale", [1, 1]))
    return np.column_stack([turn, said.get("offset", [0, 0])])
