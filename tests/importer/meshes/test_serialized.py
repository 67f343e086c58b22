"""Mitsuba's .serialized files, packed here as its documentation describes them."""

from __future__ import annotations

import struct
import sys
import tempfile
import time
import unittest
import zlib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.meshes.serialized import read_serialized  # noqa: E402
from importer.problems import ImportProblem  # noqa: E402

POSITIONS = np.array([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0.1)])
NORMALS = np.array([(0, 0, 1), (0, 0, 2), (0, 0.6, 0.8), (0, 0, 1)])
UVS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
TRIANGLES = [(0, 1, 2), (0, 2, 3)]


def mesh(version: int = 4, flags: int = 0x1000, name: str = "plate", shift: float = 0, counts: tuple[int, int] = (4, 2),
         triangles: list[tuple[int, ...]] = TRIANGLES) -> bytes:
    kind = "<f8" if flags & 0x2000 else "<f4"
    body = struct.pack("<I", flags)
    if version == 4:
        body += name.encode() + b"\0"
    body += struct.pack("<QQ", *counts) + (POSITIONS + (shift, 0, 0)).astype(kind).tobytes()
    if flags & 1:
        body += NORMALS.astype(kind).tobytes()
    if flags & 2:
        body += UVS.astype(kind).tobytes()
    if flags & 8:
        body += np.full((4, 3), 0.5).astype(kind).tobytes()
    body += np.array(triangles, "<u4").tobytes()
    return struct.pack("<HH", 0x041C, version) + zlib.compress(body)


def file(version: int, meshes: list[bytes]) -> bytes:
    starts = np.cumsum([0] + [len(m) for m in meshes[:-1]])
    return b"".join(meshes) + starts.astype("<u8" if version == 4 else "<u4").tobytes() + struct.pack("<I", len(meshes))


class SerializedTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "shapes.serialized"

    def read(self, data: bytes, index: int = 0):
        self.path.write_bytes(data)
        return read_serialized(self.path, index)

    def test_all_parts_in_both_precisions(self) -> None:
        for version in (3, 4):
            for precision in (0x1000, 0x2000):
                found = self.read(file(version, [mesh(version, precision | 1 | 2 | 8)]))
                np.testing.assert_allclose(found.positions, POSITIONS, atol=1e-7)
                np.testing.assert_allclose(found.normals, [(0, 0, 1), (0, 0, 1), (0, 0.6, 0.8), (0, 0, 1)], atol=1e-7)
                np.testing.assert_array_equal(found.uvs, UVS)
                np.testing.assert_array_equal(found.triangles, TRIANGLES)
                self.assertEqual(found.name, "plate" if version == 4 else "shapes_0")

    def test_several_meshes(self) -> None:
        for version in (3, 4):
            data = file(version, [mesh(version, shift=10 * k) for k in range(3)])
            for k in range(3):
                np.testing.assert_allclose(self.read(data, k).positions[0], (10 * k, 0, 0))

    def test_without_normals_and_with_those_of_faces(self) -> None:
        self.assertIsNone(self.read(mesh()).normals)
        flat = self.read(mesh(flags=0x1000 | 1 | 0x10))
        self.assertEqual(len(flat.positions), 6)
        np.testing.assert_allclose(flat.normals[:3], np.tile((0, 0, 1), (3, 1)), atol=1e-7)
        # (2, 1, 0) x (0, 1, 0.1) = (0.1, -0.2, 2)
        np.testing.assert_allclose(flat.normals[3:], np.tile(np.array((0.1, -0.2, 2)) / 4.05**0.5, (3, 1)), atol=1e-7)

    def test_what_lies_behind_a_mesh_is_not_read(self) -> None:
        """Scenes of Mitsuba 0.6 have one file of hundreds of meshes, and each shape asks it for its own."""
        with self.path.open("wb") as out:
            out.write(mesh())
            out.seek(1 << 31)
            out.write(mesh(shift=3) + np.array([0, 1 << 31], "<u8").tobytes() + struct.pack("<I", 2))
        start = time.monotonic()
        for _ in range(50):
            self.assertEqual([read_serialized(self.path, index).positions[0, 0] for index in (0, 1)], [0, 3])
        self.assertLess(time.monotonic() - start, 2)

    def test_long_meshes(self) -> None:
        """Of more than one piece of packed bytes, which numbers without an order fill."""
        count = 200_000
        values = np.random.default_rng(1).random((count, 3)).astype("<f4")
        body = struct.pack("<I", 0x1000) + b"long\0" + struct.pack("<QQ", count, 1) + values.tobytes()
        packed = struct.pack("<HH", 0x041C, 4) + zlib.compress(body + np.array([0, 1, 2], "<u4").tobytes())
        np.testing.assert_array_equal(self.read(file(4, [packed])).positions, values)
        with self.assertRaisesRegex(ImportProblem, "truncated"):
            self.read(packed[:-5000])

    def test_faults_are_one_sentence(self) -> None:
        three = file(4, [mesh()] * 3)
        for data, index, part in (
                (b"", 0, "no .serialized mesh at byte 0"),
                (b"\x1c\x04\x05\0", 0, "version 5"),
                (three, 3, "has 3 meshes"),
                (three, -1, "less than 0"),
                (three[:-1], 1, "is not there"),
                (mesh()[:30], 0, "mesh 0 is truncated"),
                (mesh()[:4] + b"\xff" * 40, 0, "mesh 0 is damaged"),
                (mesh(counts=(1 << 40, 2)), 0, "more vertices and triangles than it has bytes for"),
                (mesh(counts=(4, 1 << 63)), 0, "more vertices and triangles than it has bytes for"),
                (mesh(counts=(4, 3)), 0, "mesh 0 is truncated"),
                (mesh(name="n" * 9999), 0, "has no end"),
                (mesh(triangles=[(0, 1, 4)], counts=(4, 1)), 0, "vertex 4, and there are 4"),
        ):
            with self.subTest(part=part), self.assertRaises(ImportProblem) as caught:
                self.read(data, index)
            self.assertIn(part, str(caught.exception))
            self.assertIn(str(self.path), str(caught.exception))


if __name__ == "__main__":
    unittest.main()
