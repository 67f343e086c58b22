"""What ./dev fuzz starts from for the importer: the scenes in tests/fuzz/corpus/import, with files for them to name, and one
small scene for each kind of file, so that few bytes of a try are about anything else."""

from __future__ import annotations

import gzip
import io
import re
import struct
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np
from PIL import Image as Picture

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "configs"))

from importer.images.exr_file import write_exr  # noqa: E402

Case = dict[str, bytes]  # a scene's files by name; the scene is the one whose name begins with "scene"

_CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.1)])
_UVS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
_OBJ = ("# two faces\nmtllib none.mtl\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0.1\nvt 0 0\nvt 1 0\nvn 0 0 1\n"
        "g a\nusemtl red\ns 1\nf 1/1/1 2/2/1 3/1/1\nf -4//-1 3//1 \\\n4//1\nf 1 2 3 4\n")
_PLY = ("ply\nformat {} 1.0\ncomment a plate\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float u\nproperty float v\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n")
_MITSUBA = ('<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm"/></sensor>{}'
            '<shape type="cube">{}</shape></scene>')
_PBRT = 'Camera "perspective"\nFilm "rgb"\nWorldBegin\n{}\nShape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ]\n'
_TEXTURE = ('<bsdf type="diffuse"><texture name="reflectance" type="bitmap"><string name="filename" value="{}"/></texture>'
            "</bsdf>")


def _ply(is_binary: bool) -> bytes:
    rows = np.hstack([_CORNERS, _UVS])
    if is_binary:
        faces = b"".join(struct.pack("<B3i", 3, *face) for face in ((0, 1, 2), (0, 2, 3)))
        return _PLY.format("binary_little_endian").encode() + rows.astype("<f4").tobytes() + faces
    lines = [" ".join(f"{x:g}" for x in row) for row in rows] + ["3 0 1 2", "3 0 2 3"]
    return (_PLY.format("ascii") + "\n".join(lines) + "\n").encode()


def serialized(bodies: list[bytes]) -> bytes:
    meshes = [struct.pack("<HH", 0x041C, 4) + zlib.compress(body) for body in bodies]
    starts = np.cumsum([0] + [len(mesh) for mesh in meshes[:-1]])
    return b"".join(meshes) + starts.astype("<u8").tobytes() + struct.pack("<I", len(meshes))


def _mesh_body(flags: int, kind: str) -> bytes:
    normals = np.tile((0.0, 0, 1), (4, 1))
    arrays = [_CORNERS, normals, _UVS] if flags & 1 else [_CORNERS, _UVS]
    head = struct.pack("<I", flags) + b"plate\0" + struct.pack("<QQ", 4, 2)
    return head + b"".join(array.astype(kind).tobytes() for array in arrays) + np.array([0, 1, 2, 0, 2, 3], "<u4").tobytes()


def _picture(kind: str) -> bytes:
    file = io.BytesIO()
    Picture.fromarray(np.arange(6 * 5 * 3, dtype=np.uint8).reshape(6, 5, 3) * 2).save(file, kind)
    return file.getvalue()


def _pictures() -> Case:
    """Of all encodings; those of OpenEXR come from the tests of its reader."""
    found = {f"picture.{ending}": _picture(kind)
             for ending, kind in (("png", "PNG"), ("jpg", "JPEG"), ("tga", "TGA"), ("bmp", "BMP"))}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "sky.exr")
        write_exr(file, np.linspace(0, 2, 4 * 8 * 3, dtype=np.float32).reshape(4, 8, 3))
        found["sky.exr"] = file.read_bytes()
    row = bytes((2, 2, 0, 9, 137, 5, 5, 1, 2, 3, 4, 5, 132, 6, 137, 7, 137, 136))
    found["sky.hdr"] = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X 9\n" + row * 2
    for name, width, height in (("sky", 4, 2), ("square", 3, 3)):  # of Mitsuba and pbrt-v3; of pbrt-v4
        values = np.linspace(0, 2, width * height * 3).astype("<f4").tobytes()
        found[f"{name}.pfm"] = f"PF\n{width} {height}\n-1.0\n".encode() + values
    return found


def _side_files() -> Case:
    bodies = [_mesh_body(0x1003, "<f4"), _mesh_body(0x2002, "<f8")]
    return {"mesh.obj": _OBJ.encode(), "mesh_ascii.ply": _ply(False), "mesh_binary.ply": _ply(True),
            "mesh.serialized": serialized(bodies), **_pictures()}


def _around(name: str, content: bytes) -> Case:
    """A scene about one file."""
    stem, _, ending = name.rpartition(".")
    if stem.startswith("mesh"):
        shape = f'<shape type="{ending}"><string name="filename" value="{name}"/></shape>'
        return {"scene.xml": _MITSUBA.format(shape, "").encode(), name: content}
    if stem == "square":
        light = f'LightSource "infinite" "string filename" "{name}"'
        return {"scene.pbrt": _PBRT.format(light).encode(), name: content}
    if ending in ("exr", "hdr", "pfm"):
        light = f'<emitter type="envmap"><string name="filename" value="{name}"/></emitter>'
        return {"scene.xml": _MITSUBA.format(light, "").encode(), name: content}
    return {"scene.xml": _MITSUBA.format("", _TEXTURE.format(name)).encode(), name: content}


def seeds() -> list[Case]:
    side = _side_files()
    cases = []
    for folder in sorted((ROOT / "tests/fuzz/corpus/import").iterdir()):
        own = {file.name: file.read_bytes() for file in sorted(folder.iterdir())}
        text = b"".join(own.values()).decode()
        cases.append(own | {name: content for name, content in side.items() if name in text})
    cases += [_around(name, content) for name, content in side.items()]
    cases += [_around(f"sky_{file.name}", file.read_bytes()) for file in sorted((ROOT / "tests/importer/images/exr").glob("*.exr"))]
    return [*cases, {"scene.pbrt": gzip.compress(_PBRT.format('Material "diffuse"').encode())}]


def words() -> list[bytes]:
    """What the importer's sources name: elements, parameters, statements."""
    found: set[str] = set()
    for file in sorted((ROOT / "configs/importer").glob("**/*.py")):
        found |= set(re.findall(r'"([A-Za-z][\w.\-]{1,30})"', file.read_text()))
    return [word.encode() for word in sorted(found)]
