"""Stanford .ply files, packed here byte by byte."""

from __future__ import annotations

import gzip
import struct
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.meshes.ply import read_ply  # noqa: E402
from importer.problems import ImportProblem  # noqa: E402
from importer.scene import Mesh  # noqa: E402

POINTS = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (1, 3, 0)]
FORMATS = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}


def header(order: str, *lines: str) -> bytes:
    return "\n".join(["ply", f"format {FORMATS[order]} 1.0", "comment made by a test", *lines, "end_header", ""]).encode()


def row(order: str, form: str, *values: float) -> bytes:
    return struct.pack(order + form, *values) if order else (" ".join(str(v) for v in values) + "\n").encode()


def usual(order: str, faces: list[tuple[int, ...]], count: str = "uchar", index: str = "int") -> bytes:
    """Points and faces alone."""
    codes = {"uchar": "B", "ushort": "H", "int": "i", "uint": "I", "short": "h", "char": "b"}
    data = header(order, "element vertex 5", "property float x", "property float y", "property float z",
                  f"element face {len(faces)}", f"property list {count} {index} vertex_indices")
    data += b"".join(row(order, "3f", *point) for point in POINTS)
    return data + b"".join(row(order, f"{codes[count]}{len(f)}{codes[index]}", len(f), *f) for f in faces)


def corners(mesh: Mesh) -> list[list[int]]:
    """Each triangle's corners by their place in POINTS."""
    return [[POINTS.index(tuple(mesh.positions[i])) for i in triangle] for triangle in mesh.triangles]


class PlyTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "shape.ply"

    def read(self, data: bytes) -> Mesh:
        self.path.write_bytes(data)
        return read_ply(self.path)

    def refused(self, data: bytes) -> str:
        with self.assertRaises(ImportProblem) as caught:
            self.read(data)
        self.assertIn(str(self.path), str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        return str(caught.exception)

    def test_faces_of_all_formats(self) -> None:
        for order in FORMATS:
            for count, index in (("uchar", "int"), ("int", "uint"), ("ushort", "short"), ("char", "uchar")):
                for faces, wanted in (([(0, 1, 2), (0, 2, 3)], [[0, 1, 2], [0, 2, 3]]),
                                      ([(0, 1, 2, 3)], [[0, 1, 2], [0, 2, 3]]),
                                      ([(0, 1, 2, 4, 3), (1, 2, 3)], [[0, 1, 2], [0, 2, 4], [0, 4, 3], [1, 2, 3]]),
                                      ([(0, 1), (2, 3, 0), (1,)], [[2, 3, 0]])):
                    with self.subTest(order=order, count=count, faces=faces):
                        mesh = self.read(usual(order, faces, count, index))
                        self.assertEqual(corners(mesh), wanted)
                        self.assertIsNone(mesh.normals)
                        self.assertIsNone(mesh.uvs)

    def test_other_elements_and_properties_are_passed_over(self) -> None:
        for order in FORMATS:
            data = header(order, "element camera 2", "property uchar flag", "property list uchar short values",
                          "element vertex 3", "property uchar red", "property double x", "property float s",
                          "property double y", "property float t", "property double z", "property short nx",
                          "property short ny", "property short nz", "element face 2", "property uchar kind",
                          "property list uchar float weights", "property list uchar int vertex_index",
                          "property int face_indices",
                          "element edge 1", "property int a")
            data += row(order, "BB2h", 7, 2, 300, 301) + row(order, "BB", 7, 0)
            for k, (x, y, z) in enumerate([(1, 2, 3), (4, 5, 7), (-1, 0, 2.5)]):
                data += row(order, "Bdfdfd3h", 255, x, k / 4, y, k / 8, z, 0, 3, 4)
            data += row(order, "BB2fB3ii", 1, 2, 0.5, 0.25, 3, 0, 1, 2, 9) + row(order, "BBB3ii", 1, 0, 3, 2, 1, 0, 9)
            mesh = self.read(data + row(order, "i", 5))
            np.testing.assert_array_equal(mesh.positions, [(1, 2, 3), (4, 5, 7), (-1, 0, 2.5)])
            np.testing.assert_array_equal(mesh.uvs, [(0, 0), (0.25, 0.125), (0.5, 0.25)])  # as in the file
            np.testing.assert_allclose(mesh.normals, np.tile((0, 0.6, 0.8), (3, 1)))
            np.testing.assert_array_equal(mesh.triangles, [(0, 1, 2), (2, 1, 0)])

    def test_vertices_with_lists(self) -> None:
        for order in FORMATS:
            data = header(order, "element vertex 3", "property float x", "property list uchar uchar bones",
                          "property float y", "property float z", "element face 1", "property list uchar int vertex_indices")
            data += row(order, "fB2B2f", 0, 2, 8, 9, 0, 0) + row(order, "fB2f", 1, 0, 0, 0)
            data += row(order, "fBB2f", 0, 1, 7, 1, 0.5)
            mesh = self.read(data + row(order, "B3i", 3, 0, 1, 2))
            np.testing.assert_array_equal(mesh.positions, [(0, 0, 0), (1, 0, 0), (0, 1, 0.5)])

    def test_names_of_texture_coordinates(self) -> None:
        for u, v in (("u", "v"), ("s", "t"), ("texture_u", "texture_v"), ("texture_s", "texture_t")):
            data = header("<", "element vertex 3", "property float x", "property float y", "property float z",
                          f"property float {u}", f"property float {v}", "element face 1",
                          "property list uchar int vertex_indices")
            data += struct.pack("<15f", 0, 0, 0, 0.1, 0.2, 1, 0, 0, 0.3, 0.4, 0, 1, 0, 0.5, 0.6)
            data += struct.pack("<B3i", 3, 0, 1, 2)
            np.testing.assert_allclose(self.read(data).uvs, [(0.1, 0.2), (0.3, 0.4), (0.5, 0.6)], atol=1e-7)

    def test_gzip_and_line_ends(self) -> None:
        data = usual("<", [(0, 1, 2)])
        self.assertEqual(corners(self.read(gzip.compress(data))), [[0, 1, 2]])
        head, body = data.split(b"end_header\n")
        # A body that begins with the byte of a line end must not lose it.
        body = struct.pack("<f", 0) + body[4:]
        self.assertEqual(corners(self.read(head.replace(b"\n", b"\r\n") + b"end_header\r\n" + body)), [[0, 1, 2]])

    def test_many_faces_of_two_kinds(self) -> None:
        rng = np.random.default_rng(3)
        faces = [tuple(int(i) for i in rng.permutation(5)[:n]) for n in rng.integers(3, 5, 300)]
        wanted = [t for f in faces for t in ([list(f)] if len(f) == 3 else [[f[0], f[1], f[2]], [f[0], f[2], f[3]]])]
        for order in FORMATS:
            self.assertEqual(corners(self.read(usual(order, faces))), wanted)

    def test_faults_are_one_sentence(self) -> None:
        good = usual("<", [(0, 1, 2)])
        for data, part in (
                (b"plx\n", "not a .ply"),
                (good[:60], "no 'end_header'"),
                (good[:-5], "ends within its 1 elements 'face'"),
                (good[:200], "ends within its 5 elements 'vertex'"),
                (good.replace(b"vertex 5", b"vertex 999999999999999"), "ends within its 999999999999999 elements"),
                (good.replace(b"face 1", b"face 88888888888888888"), "ends within its 88888888888888888 elements"),
                (good.replace(b"vertex 5", b"vertex -5"), "line 4"),
                (good.replace(b"vertex 5", b"vertex five"), "line 4"),
                (good.replace(b"property float y", b"property real y"), "line 6"),
                (good.replace(b"property float y", b"property float x"), "line 6"),
                (good.replace(b"binary_little_endian", b"binary"), "line 2"),
                (good.replace(b"format binary_little_endian 1.0\n", b""), "no 'format'"),
                (good.replace(b"list uchar int", b"list float int"), "line 9"),
                (good.replace(b"vertex_indices", b"corner_indices"), "no list 'vertex_indices'"),
                (good.replace(b"element face", b"element fase"), "an element 'face'; it has 'vertex', 'fase'"),
                (good.replace(b"float x", b"float a"), "no x, y and z"),
                (usual("<", [(0, 1, 5)]), "vertex 5, and there are 5"),
                (usual("<", [(0, 1, -1)]), "vertex -1"),
                (usual("<", []), "no triangle"),
                (usual("<", [(0, 1, 2)], "int")[:-16] + struct.pack("<4i", -3, 0, 1, 2), "list of -3 values"),
                (usual("", [(0, 1, 2)]).replace(b"3 0 1", b"nan 0 1"), "list of nan values"),
                (usual("", [(0, 1, 2)]).replace(b"3 0 1", b"3 nan 1"), "not a whole number"),
                (usual("", [(0, 1, 2)]).replace(b"2 1 0", b"2 one 0"), "not a number"),
                (usual("", [(0, 1, 2)]).replace(b"2 1 0", b"2 inf 0"), "position of vertex 3"),
                (usual("", [(0, 1, 2)])[:-4], "ends within"),
        ):
            with self.subTest(part=part):
                self.assertIn(part, self.refused(data))

    def test_damage_anywhere_is_a_problem_or_a_mesh(self) -> None:
        rng = np.random.default_rng(5)
        for order in FORMATS:
            good = usual(order, [(0, 1, 2), (1, 2, 3, 4)])
            for _ in range(300):
                data = bytearray(good)
                for at in rng.integers(0, len(data), 3):
                    data[at] = rng.integers(0, 256)
                try:
                    self.read(bytes(data[:rng.integers(1, len(data) + 1)]))
                except ImportProblem:
                    pass


if __name__ == "__main__":
    unittest.main()
