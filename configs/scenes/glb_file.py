"""The container of a glTF 2.0 binary file: one buffer of arrays and images, and the JSON document before it."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

FLOAT, UINT16, UINT32 = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


class Buffer:
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

    def add_triangles(self, triangles: np.ndarray, vertices: int) -> int:
        """Indices of `vertices` corners: 16 bits where these hold them, as the greatest number must stay unused."""
        wide = vertices > 65535
        indices = triangles.ravel().astype("<u4" if wide else "<u2")
        return self.add(indices, "SCALAR", UINT32 if wide else UINT16)

    def add_image(self, name: str, encoded: bytes, mime_type: str = "image/png") -> dict[str, Any]:
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(encoded)})
        self.data += encoded + bytes(-len(encoded) % 4)
        return {"name": name, "mimeType": mime_type, "bufferView": len(self.views) - 1}

    def to_json(self) -> dict[str, Any]:
        """What the document says of the arrays; an empty list is no valid glTF."""
        if not self.data:
            return {}
        parts = {"accessors": self.accessors, "bufferViews": self.views}
        return {**{key: value for key, value in parts.items() if value}, "buffers": [{"byteLength": len(self.data)}]}


def glb(document: dict[str, Any], data: bytes | bytearray) -> bytes:
    """The whole file (glTF 2.0, 4.4): a header, a chunk of JSON and, where there are data, one of them."""
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode("ascii")
    text += b" " * (-len(text) % 4)
    chunks = [struct.pack("<I4s", len(text), b"JSON"), text]
    if data:
        chunks += [struct.pack("<I4s", len(data), b"BIN\0"), data]
    return b"".join([struct.pack("<4sII", b"glTF", 2, 12 + sum(map(len, chunks))), *chunks])
