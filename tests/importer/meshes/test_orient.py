"""Fronts and vertex normals, on two triangles that meet at a right angle."""

from __future__ import annotations

import sys
import unittest
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.meshes import orient  # noqa: E402
from importer.scene import Mesh  # noqa: E402

# In the plane z = 0 with its front along +z, and in the plane x = 0 with its front along +x; they share the edge on y.
CORNER = Mesh(np.array([(0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 3)], float), np.array([(0, 2, 1), (0, 1, 3)]))


class OrientTest(unittest.TestCase):
    def test_smooth_normals_weigh_by_angle(self) -> None:
        normals = orient.smooth(CORNER).normals
        # At the origin both triangles have 90 degrees. At (0, 1, 0) the first has 45, the second atan 3 = 71.565.
        np.testing.assert_allclose(normals[0], np.array((1, 0, 1)) / 2**0.5, atol=1e-12)
        weights = np.array((71.56505117707799, 0, 45.0))
        np.testing.assert_allclose(normals[1], weights / np.linalg.norm(weights), atol=1e-12)
        np.testing.assert_allclose(normals[2:], [(0, 0, 1), (1, 0, 0)], atol=1e-12)

    def test_smooth_normals_that_cancel_out(self) -> None:
        both = replace(CORNER, triangles=np.array([(0, 2, 1), (0, 1, 2)]))
        np.testing.assert_array_equal(orient.smooth(both).normals, np.tile((1, 0, 0), (4, 1)))

    def test_smooth_normals_of_narrow_triangles(self) -> None:
        # Two slivers of the angles 1e-9 and 3e-9 at the origin, square to each other.
        narrow = Mesh(np.array([(0, 0, 0), (1, 0, 0), (1, 1e-9, 0), (1, 0, 3e-9)]), np.array([(0, 1, 2), (0, 1, 3)]))
        np.testing.assert_allclose(orient.smooth(narrow).normals[0], np.array((0, -3, 1)) / 10**0.5, atol=1e-6)

    def test_flipped(self) -> None:
        mesh = orient.flipped(orient.smooth(CORNER))
        np.testing.assert_allclose(orient.unit(orient.area_vectors(mesh)), [(0, 0, -1), (-1, 0, 0)], atol=1e-12)
        np.testing.assert_allclose(mesh.normals[0], -np.array((1, 0, 1)) / 2**0.5, atol=1e-12)
        np.testing.assert_array_equal(orient.smooth(CORNER).normals, -mesh.normals)

    def test_fronts_by_normals(self) -> None:
        normals = np.array([(0, 0, -1), (0, 0, -1), (0, 0, -1), (9, 0, 1)], float)
        mesh = orient.fronts_by_normals(replace(CORNER, normals=normals))
        # The first triangle's normals are behind it; of the second, two have nothing of x, and one is in front.
        np.testing.assert_allclose(orient.unit(orient.area_vectors(mesh)), [(0, 0, -1), (1, 0, 0)], atol=1e-12)
        np.testing.assert_array_equal(mesh.normals, normals)
        self.assertIs(orient.fronts_by_normals(CORNER), CORNER)

    def test_flat(self) -> None:
        self.assertIsNone(orient.flat(orient.smooth(CORNER)).normals)

    def test_face_normals(self) -> None:
        mesh = orient.with_face_normals(replace(CORNER, uvs=np.arange(8.0).reshape(4, 2)))
        np.testing.assert_allclose(mesh.normals, np.repeat([(0, 0, 1), (1, 0, 0)], 3, axis=0), atol=1e-12)
        np.testing.assert_array_equal(mesh.uvs[mesh.triangles[1]], [(0, 1), (2, 3), (6, 7)])

    def test_arguments_stay_as_they_are(self) -> None:
        before = CORNER.positions.copy(), CORNER.triangles.copy()
        for function in (orient.smooth, orient.flipped, orient.flat, orient.with_face_normals):
            function(CORNER)
        np.testing.assert_array_equal(CORNER.positions, before[0])
        np.testing.assert_array_equal(CORNER.triangles, before[1])
        self.assertIsNone(CORNER.normals)


if __name__ == "__main__":
    unittest.main()
