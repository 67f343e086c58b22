"""Wavefront .obj files against meshes written down by hand."""

from __future__ import annotations

import gzip
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.meshes import obj_lines  # noqa: E402
from importer.meshes.obj import read_obj  # noqa: E402
from importer.problems import ImportProblem  # noqa: E402
from importer.scene import Mesh  # noqa: E402

SQUARE = """v 0 0 0
v 2 0 0
v 2 1 0
v 0 1 0
"""


def corners(mesh: Mesh) -> list[list[tuple[float, ...]]]:
    """Each triangle's positions, independent of how vertices are numbered."""
    return [[tuple(mesh.positions[i]) for i in triangle] for triangle in mesh.triangles]


class ObjTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "shape.obj"

    def read(self, text: str | bytes, flip_v: bool = False) -> Mesh:
        self.path.write_bytes(text.encode() if isinstance(text, str) else text)
        return read_obj(self.path, flip_v)

    def refused(self, text: str | bytes) -> str:
        with self.assertRaises(ImportProblem) as caught:
            self.read(text)
        message = str(caught.exception)
        self.assertIn(str(self.path), message)
        self.assertNotIn("\n", message)
        return message

    def test_polygons_are_fans_about_their_first_corner(self) -> None:
        mesh = self.read(SQUARE + "v 1 3 0\nf 1 2 3 5 4\n")
        a, b, c, d, e = (0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 3, 0), (0, 1, 0)
        self.assertEqual(corners(mesh), [[a, b, c], [a, c, d], [a, d, e]])
        self.assertIsNone(mesh.normals)
        self.assertIsNone(mesh.uvs)
        self.assertEqual(mesh.name, "shape")

    def test_vertices_are_distinct_triples(self) -> None:
        # The diagonal's corners have one v but two vt each: six vertices.
        text = SQUARE + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0.25 0.75\nvn 0 0 2\nf 1/1/1 2/2/1 3/3/1\nf 1/2/1 3/4/1 4/4/1\n"
        mesh = self.read(text)
        self.assertEqual(len(mesh.positions), 6)
        np.testing.assert_array_equal(mesh.uvs[mesh.triangles[1]], [(1, 0), (0.25, 0.75), (0.25, 0.75)])
        np.testing.assert_array_equal(mesh.normals, np.tile((0, 0, 1), (6, 1)))  # of length 1 now

    def test_v_is_turned_over_on_demand(self) -> None:
        text = SQUARE + "vt 0.25 0.125\nf 1/1 2/1 3/1\n"
        np.testing.assert_array_equal(self.read(text).uvs[0], (0.25, 0.125))
        np.testing.assert_array_equal(self.read(text, flip_v=True).uvs[0], (0.25, 0.875))

    def test_negative_indices_count_back_from_their_line(self) -> None:
        text = SQUARE + "vn 0 0 1\nf -4//-1 -3//-1 -2//-1\nv 9 9 9\nvn 1 0 0\nf -5//-2 -3//-2 -2//-2\n"
        mesh = self.read(text)
        self.assertEqual(corners(mesh), [[(0, 0, 0), (2, 0, 0), (2, 1, 0)], [(0, 0, 0), (2, 1, 0), (0, 1, 0)]])
        np.testing.assert_array_equal(mesh.normals, np.tile((0, 0, 1), (4, 1)))

    def test_ways_of_writing(self) -> None:
        plain = corners(self.read(SQUARE + "f 1 2 3\n"))
        for text in (
                SQUARE.replace("\n", "\r\n") + "f 1 2 3\r\n",
                SQUARE.replace("\n", "\r") + "f 1 2 3\r",
                "# head\nmtllib a.mtl\no first\n" + SQUARE + "g x y\nusemtl wood\ns 1\n  f 1   2\t3   # tail\nl 1 2\n",
                SQUARE.replace("v 2 0 0", "v 2 \\\n0 0") + "f 1 2 \\\r\n3",
                SQUARE.replace("v 0 0 0", "v 0 0 0 0.5 0.25 1").replace("v 2 1 0", "v 2.0e0 +1 0. 1.0") + "f 1 2 3",
                SQUARE + "f 1/ 2/ 3/\nf 1 2\nf 1\n",
                SQUARE + "vt 0 0\n" + "f 1// 2// 3//\n",
                SQUARE + "vp 0.5 0.5\nvpn\nfoo 1 2 3\nf 1 2 3",
        ):
            with self.subTest(text=text):
                mesh = self.read(text)
                self.assertEqual(corners(mesh), plain)
                self.assertIsNone(mesh.uvs)

    def test_gzip(self) -> None:
        self.assertEqual(len(self.read(gzip.compress((SQUARE + "f 1 2 3 4\n").encode())).triangles), 2)

    def test_a_texture_coordinate_of_one_number(self) -> None:
        mesh = self.read(SQUARE + "vt 0.5\nvt 0.25 1 0\nf 1/1 2/2 3/2\n")
        np.testing.assert_array_equal(mesh.uvs[mesh.triangles[0]], [(0.5, 0), (0.25, 1), (0.25, 1)])

    def test_corners_without_normals_get_smooth_ones(self) -> None:
        mesh = self.read(SQUARE + "vn 0 1 0\nf 1//1 2//1 3\n")
        np.testing.assert_array_equal(mesh.normals[mesh.triangles[0]], [(0, 1, 0), (0, 1, 0), (0, 0, 1)])

    def test_triangles_without_area_are_left_out(self) -> None:
        mesh = self.read(SQUARE + "f 1 2 2\nf 1 2 3\nf 1 1 1\n")
        self.assertEqual(len(mesh.triangles), 1)
        self.assertIn("no triangle with an area", self.refused(SQUARE + "f 1 2 2\n"))

    def test_blocks_make_no_difference(self) -> None:
        rows = ["v %d %d %d" % (i, i * i % 17, i % 5) for i in range(60)]
        for i in range(0, 57, 3):
            rows.insert(4 * i // 3 + 3, "f -3//-1 -2//-1 -1//-1")
            rows.insert(4 * i // 3 + 3, "vn 0 %d 1" % (i % 7))
        text = "\n".join(rows)
        whole = self.read(text)
        self.addCleanup(setattr, obj_lines, "_BLOCK", obj_lines._BLOCK)
        for size in (1, 7, 64, 301):
            obj_lines._BLOCK = size
            part = self.read(text)
            self.assertEqual(corners(part), corners(whole))
            np.testing.assert_array_equal(part.normals, whole.normals)
            self.assertIn(f"line {len(rows) + 1}: ", self.refused(text + "\nv 1 2 x"))

    def test_faults_are_one_sentence_with_the_line(self) -> None:
        for text, part in (
                (SQUARE + "f 1 2 5\n", "vertex 5, and there are 4"),
                (SQUARE + "f 0 1 2\n", "vertex 0"),
                (SQUARE + "f 1/1 2/1 3/1\n", "texture coordinate 1, and there are 0"),
                (SQUARE + "f 1//2 2//1 3//1\nvn 0 0 1\n", "normal 2, and there are 1"),
                (SQUARE + "f -1 -2 -5\n", "line 5"),
                (SQUARE + "f 1 2 x\n", "line 5"),
                (SQUARE + "f 1.5 2 3\n", "line 5"),
                (SQUARE + "f 1/1/1/1 2 3\n", "line 5"),
                (SQUARE + "f /1 2 3\n", "shape.obj"),
                (SQUARE + "v 1 2\nf 1 2 3\n", "line 5: 'v' takes 3 numbers, not 2"),
                (SQUARE + "v 1 2 1e\nf 1 2 3\n", "line 5"),
                (SQUARE + "v nan 0 0\nf 1 2 5\n", "line 5: 'v' is followed by a number that is not finite"),
                (SQUARE + "v 1e300 0 0\nf 1 2 5\n", "farther out"),
                (SQUARE + "f 99999999999999999999999 1 2\n", "vertex 9223372036854775807"),
                (SQUARE, "no face"),
                ("", "no face"),
                (b"\0\xff\xfe" * 99, "no face"),
                (gzip.compress(SQUARE.encode())[:-12], "truncated"),
                (b"\x1f\x8b" + b"x" * 99, "damaged"),
        ):
            with self.subTest(text=text):
                self.assertIn(part, self.refused(text))

    def test_missing_file(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "no.obj: the mesh cannot be read: No such file"):
            read_obj(Path("no.obj"), True)


if __name__ == "__main__":
    unittest.main()
