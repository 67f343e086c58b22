#!/usr/bin/env python3
"""Checks the geometry and UV maps of .glb files from generate.py.

Complements the Khronos validator (validate.mjs), which does not look at whether
triangles face outwards, parts are closed or UV islands overlap. Exits 1 if an
object fails. Usage: check.py FILE.glb...
"""

from __future__ import annotations

import json
import struct
import sys
from pathlib import Path
from typing import Any

import numpy as np

RASTER = 1024  # UV texels per side for the overlap count
DTYPES = {5126: "<f4", 5123: "<u2", 5125: "<u4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


def load(path: Path) -> tuple[dict[str, Any], bytes]:
    """Splits a .glb file into its JSON document and its binary chunk."""
    raw = path.read_bytes()
    length = struct.unpack_from("<I", raw, 12)[0]
    return json.loads(raw[20:20 + length]), raw[28 + length:]


def accessor(document: dict[str, Any], data: bytes, index: int) -> np.ndarray:
    entry = document["accessors"][index]
    width = WIDTHS[entry["type"]]
    start = document["bufferViews"][entry["bufferView"]]["byteOffset"]
    flat = np.frombuffer(data, DTYPES[entry["componentType"]], entry["count"] * width, start)
    return flat.reshape(-1, width) if width > 1 else flat


def uv_coverage(uv: np.ndarray) -> np.ndarray:
    """How many UV triangles (m, 3, 2) hold each texel centre, edges excluded."""
    count = np.zeros((RASTER, RASTER), int)
    for a, b, c in uv.astype(float) * RASTER:
        low = np.maximum(np.floor(np.minimum(np.minimum(a, b), c) - 0.5), 0).astype(int)
        high = np.ceil(np.maximum(np.maximum(a, b), c) + 0.5).astype(int)
        x, y = np.meshgrid(np.arange(low[0], min(high[0], RASTER)) + 0.5,
                           np.arange(low[1], min(high[1], RASTER)) + 0.5)
        inside = np.ones(x.shape, bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) > 1e-3
        count[low[1]:low[1] + x.shape[0], low[0]:low[0] + x.shape[1]] += inside
    return count


def open_edges(positions: np.ndarray, triangles: np.ndarray) -> int:
    """Directed edges without their opposite, after welding equal positions."""
    weld = np.unique(positions, axis=0, return_inverse=True)[1].reshape(-1)
    t = weld[triangles]
    edges = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    seen, times = np.unique(edges, axis=0, return_counts=True)
    paired = set(map(tuple, seen[times == 1].tolist()))
    return sum((b, a) not in paired for a, b in paired) + int((times > 1).sum())


def check(name: str, p: np.ndarray, n: np.ndarray, uv: np.ndarray, t: np.ndarray) -> bool:
    """Prints one line on an object; true if nothing is wrong with it."""
    a, b, c = (p[t[:, i]].astype(float) for i in range(3))
    cross = np.cross(b - a, c - a)
    length = np.linalg.norm(cross, axis=1)
    facing = min((cross / length[:, None] * n[t[:, i]]).sum(axis=1).min() for i in range(3))
    e, f = uv[t[:, 1]] - uv[t[:, 0]], uv[t[:, 2]] - uv[t[:, 0]]
    flat = e[:, 0].astype(float) * f[:, 1] - e[:, 1].astype(float) * f[:, 0]
    density = np.sqrt(flat / length)
    density /= np.sqrt(flat.sum() / length.sum())
    coverage = uv_coverage(uv[t])
    closed = open_edges(p, t)
    faults = {
        "degenerate": length.min() < 1e-9 or flat.min() < 1e-9,
        "winding": facing <= 0,
        "unit normals": abs(np.linalg.norm(n, axis=1) - 1).max() > 1e-5,
        "uv range": uv.min() < 0 or uv.max() > 1,
        "uv overlap": (coverage > 1).any(),
        "open": len(t) > 2 and closed > 0,
    }
    wrong = [fault for fault, found in faults.items() if found]
    print(f"  {name:12} {len(t):5} triangles, normal*face >= {facing:.2f}, "
          f"uv fill {(coverage > 0).mean():.0%}, overlaps {(coverage > 1).sum()}, "
          f"texel density {density.min():.2f}-{density.max():.2f}, "
          f"open edges {closed}{': WRONG ' + ', '.join(wrong) if wrong else ''}")
    return not wrong


def check_file(path: Path) -> bool:
    document, data = load(path)
    print(path.name)
    good = True
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            attributes = primitive["attributes"]
            arrays = [accessor(document, data, attributes[key])
                      for key in ("POSITION", "NORMAL", "TEXCOORD_0")]
            indices = accessor(document, data, primitive["indices"]).reshape(-1, 3)
            good &= check(mesh["name"], *arrays, indices)
    return good


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("usage: check.py FILE.glb...")
    sys.exit(0 if all([check_file(Path(argument)) for argument in sys.argv[1:]]) else 1)
