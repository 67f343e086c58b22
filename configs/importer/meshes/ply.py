"""Stanford .ply files, text and binary: triangles, quads and polygons with normals and texture coordinates.

Names of texture coordinates are those that pbrt-v4 knows (TriQuadMesh::ReadPLY), Mitsuba's among them. Elements and
properties of other names, such as colours or pbrt's face_indices, have no meaning for a mesh here and are passed over.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from importer.meshes.assemble import check_indices, fans, finished
from importer.meshes.files import read_bytes
from importer.meshes.ply_data import Body, Lists
from importer.meshes.ply_header import Element, read_header
from importer.problems import ImportProblem
from importer.scene import Mesh

_UV_NAMES = (("u", "v"), ("s", "t"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))
_INDEX_NAMES = ("vertex_indices", "vertex_index")


def read_ply(path: Path) -> Mesh:
    """Texture coordinates as they are in the file. Quads become two triangles; pbrt has bilinear patches there,
    which are the same where the quad is flat."""
    data = read_bytes(path)
    header = read_header(path, data)
    body = Body(path, data, header)
    vertices: dict[str, np.ndarray] | None = None
    faces: Lists | None = None
    for element in header.elements:
        if element.name == "vertex" and vertices is None:
            vertices = body.columns(element)
        elif element.name == "face" and faces is None:
            faces = body.lists(element, _index_property(path, element))
        elif vertices is None or faces is None:  # what follows the last one of use does not have to be read
            body.skip(element)
    if vertices is None or faces is None:
        raise ImportProblem(f"{path}: the .ply needs an element 'vertex' and an element 'face'; "
                            f"it has {', '.join(ascii(e.name) for e in header.elements) or 'none'}")
    return finished(path, _mesh(path, vertices, faces))


def _index_property(path: Path, element: Element) -> str:
    for prop in element.properties:
        if prop.name in _INDEX_NAMES and prop.count_kind:
            return prop.name
    raise ImportProblem(f"{path}: the .ply's faces have no list 'vertex_indices'")


def _mesh(path: Path, vertices: dict[str, np.ndarray], faces: Lists) -> Mesh:
    positions = _stacked(vertices, ("x", "y", "z"))
    if positions is None:
        raise ImportProblem(f"{path}: the .ply's vertices have no x, y and z")
    check_indices(path, "vertex", faces.values, len(positions))
    uvs = next((uv for names in _UV_NAMES if (uv := _stacked(vertices, names)) is not None), None)
    triangles = faces.values[fans(faces.counts)]
    return Mesh(positions, triangles, _stacked(vertices, ("nx", "ny", "nz")), uvs, path.name.split(".")[0])


def _stacked(columns: dict[str, np.ndarray], names: tuple[str, ...]) -> np.ndarray | None:
    if any(name not in columns for name in names):
        return None
    return np.stack([columns[name] for name in names], axis=1).astype(np.float64)
