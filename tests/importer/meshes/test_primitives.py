"""Shapes without a file against the formulas in the documentation of Mitsuba and pbrt."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.meshes import primitives  # noqa: E402
from importer.meshes.orient import area_vectors, unit  # noqa: E402
from importer.problems import ImportProblem  # noqa: E402
from importer.scene import Mesh  # noqa: E402


def area(mesh: Mesh) -> float:
    return float(np.linalg.norm(area_vectors(mesh), axis=1).sum() / 2)


def at(mesh: Mesh, point: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Texture coordinates and normal of the surface nearest to the point, between the corners of its triangle."""
    p = np.asarray(point, float)
    a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
    n = area_vectors(mesh)
    square = np.einsum("ij,ij->i", n, n)
    weights = np.stack([np.einsum("ij,ij->i", np.cross(c - b, p - b), n), np.einsum("ij,ij->i", np.cross(a - c, p - c), n),
                        np.einsum("ij,ij->i", np.cross(b - a, p - a), n)], axis=1) / square[:, None]
    distance = np.abs(np.einsum("ij,ij->i", p - a, n)) / np.sqrt(square) + 1e3 * np.maximum(-weights.min(axis=1) - 1e-9, 0)
    k = int(distance.argmin())
    corners = mesh.triangles[k]
    return weights[k] @ mesh.uvs[corners], unit(weights[k] @ mesh.normals[corners])


class PrimitivesTest(unittest.TestCase):
    def check(self, mesh: Mesh) -> None:
        """What holds for all: no useless vertex, unit normals, and fronts where they point."""
        self.assertEqual(len(np.unique(mesh.triangles)), len(mesh.positions))
        self.assertGreater(np.linalg.norm(area_vectors(mesh), axis=1).min(), 1e-9)
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-12)
        fronts = unit(area_vectors(mesh))
        self.assertGreater(np.einsum("ij,ikj->ik", fronts, mesh.normals[mesh.triangles]).min(), 0.99)

    def is_closed(self, mesh: Mesh) -> bool:
        """Whether each edge has its counterpart, by position and to the last bit."""
        _, point = np.unique(mesh.positions, axis=0, return_inverse=True)
        edges = point.reshape(-1)[mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)]
        return sorted(map(tuple, edges)) == sorted(map(tuple, edges[:, ::-1]))

    def test_sphere(self) -> None:
        mesh = primitives.sphere((1, 2, 3), 2.0)
        self.check(mesh)
        self.assertTrue(self.is_closed(primitives.sphere()))
        np.testing.assert_allclose(np.linalg.norm(mesh.positions - (1, 2, 3), axis=1), 2, atol=1e-12)
        np.testing.assert_allclose(mesh.normals, (mesh.positions - (1, 2, 3)) / 2, atol=1e-12)
        self.assertAlmostEqual(area(mesh) / (16 * math.pi), 1, delta=5.1e-4)  # as its docstring has it
        self.assertLess(area(mesh), 16 * math.pi)
        # theta and phi of 60 and 250 degrees: u = 250 / 360, v = 60 / 180.
        theta, phi = math.radians(60), math.radians(250)
        d = np.array((math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)))
        uv, normal = at(mesh, 2 * d + (1, 2, 3))
        np.testing.assert_allclose(uv, (250 / 360, 1 / 3), atol=1e-3)
        np.testing.assert_allclose(normal, d, atol=1e-3)

    def test_sphere_at_its_seam_and_poles(self) -> None:
        mesh = primitives.sphere()
        for u, sign in ((0.002, 1), (0.998, -1)):
            uv, _ = at(mesh, (1, sign * 0.01, 0.001))
            self.assertAlmostEqual(uv[0], u, delta=0.002)
        poles = np.abs(mesh.positions[:, 2]) == 1
        self.assertEqual(int(poles.sum()), 256)  # one for each segment
        np.testing.assert_array_equal(np.unique(mesh.uvs[poles, 1]), (0, 1))
        u = mesh.uvs[mesh.triangles, 0]
        self.assertLess((u.max(axis=1) - u.min(axis=1)).max(), 1 / 128 + 1e-9)  # no triangle runs back over the seam

    def test_sphere_is_shared_and_safe(self) -> None:
        self.assertIs(primitives.sphere((0, 0, 1), 2), primitives.sphere(np.array((0, 0, 1)), 2.0))
        with self.assertRaises(ValueError):
            primitives.sphere().uvs[0] = 0

    def test_rectangle(self) -> None:
        mesh = primitives.rectangle()
        self.check(mesh)
        self.assertEqual(area(mesh), 4)
        for x, y in ((-1, -1), (1, -1), (1, 1), (-0.5, 0.25)):
            uv, normal = at(mesh, (x, y, 0))
            np.testing.assert_allclose(uv, ((x + 1) / 2, (y + 1) / 2))
            np.testing.assert_array_equal(normal, (0, 0, 1))

    def test_cube(self) -> None:
        mesh = primitives.cube()
        self.check(mesh)
        self.assertEqual(area(mesh), 24)
        self.assertEqual(len(mesh.positions), 24)
        self.assertTrue(self.is_closed(mesh))
        np.testing.assert_array_equal(np.abs(mesh.positions), 1)
        # From the table in cube.cpp: on the face +z, (1, -1) has uv (0, 1) and (-1, 1) has (1, 0).
        for point, uv in (((1, -1, 1.0), (0, 1)), ((-1, 1, 1.0), (1, 0)), ((0.5, 0.5, 1.0), (0.75, 0.75))):
            found, normal = at(mesh, np.array(point) * (0.999, 0.999, 1))
            np.testing.assert_allclose(found, uv, atol=1e-3)
            np.testing.assert_array_equal(normal, (0, 0, 1))
        for face in range(6):
            np.testing.assert_array_equal(np.sort(mesh.uvs[4 * face:4 * face + 4], axis=0), [(0, 0), (0, 0), (1, 1), (1, 1)])

    def test_disk(self) -> None:
        mesh = primitives.disk()
        self.check(mesh)
        self.assertAlmostEqual(area(mesh) / math.pi, 1, delta=4.1e-4)
        self.assertEqual(np.abs(mesh.positions[:, 2]).max(), 0)
        uv, normal = at(mesh, (0.3 * math.cos(4), 0.3 * math.sin(4), 0))  # r and phi / 2 pi
        np.testing.assert_allclose(uv, (0.3, 4 / (2 * math.pi)), atol=2e-3)
        np.testing.assert_array_equal(normal, (0, 0, 1))

    def test_cylinder(self) -> None:
        for way in ((1, 2, 2), (1, 2, -2), (-2, 1, -2)):  # 3 long
            mesh = primitives.cylinder((1, 1, 1), np.array(way) + 1, 0.5)
            self.check(mesh)
            self.assertAlmostEqual(area(mesh) / (3 * math.pi), 1, delta=1.1e-4)
            axis = np.array(way) / 3
            along = (mesh.positions - (1, 1, 1)) @ axis
            np.testing.assert_allclose(along, 3 * mesh.uvs[:, 1], atol=1e-12)
            radial = mesh.positions - (1, 1, 1) - along[:, None] * axis
            np.testing.assert_allclose(radial, 0.5 * mesh.normals, atol=1e-12)
            np.testing.assert_array_equal(np.unique(mesh.uvs[:, 1]), (0, 1))

    def test_cylinder_along_z_begins_at_x(self) -> None:
        mesh = primitives.cylinder()
        for degrees in (90, 200):
            phi = math.radians(degrees)
            uv, normal = at(mesh, (math.cos(phi), math.sin(phi), 0.25))
            np.testing.assert_allclose(uv, (degrees / 360, 0.25), atol=1e-3)
            np.testing.assert_allclose(normal, (math.cos(phi), math.sin(phi), 0), atol=1e-3)

    def test_cylinder_downwards(self) -> None:
        mesh = primitives.cylinder((0, 0, 1), (0, 0, -1), 2)
        self.check(mesh)
        np.testing.assert_allclose(mesh.positions[:, 2], 1 - 2 * mesh.uvs[:, 1], atol=1e-12)

    def test_pbrt_sphere(self) -> None:
        # Radius 2, z from -1 to sqrt 2, a quarter turn: theta from 120 to 45 degrees.
        mesh = primitives.pbrt_sphere(2, -1, 2**0.5, 90)
        self.check(mesh)
        self.assertAlmostEqual(area(mesh) / (math.pi * (1 + 2**0.5)), 1, delta=5e-4)  # radius * phimax * height
        self.assertAlmostEqual(mesh.positions[:, 2].min(), -1)
        self.assertAlmostEqual(mesh.positions[:, 2].max(), 2**0.5)
        uv, _ = at(mesh, (2 * math.cos(math.radians(30)), 2 * math.sin(math.radians(30)), 0))
        np.testing.assert_allclose(uv, (30 / 90, (90 - 120) / (45 - 120)), atol=1e-3)
        whole = primitives.pbrt_sphere(3)
        self.check(whole)
        self.assertTrue(self.is_closed(whole))
        uv, _ = at(whole, (0, 2.25**0.5 * 3**0.5, 1.5))  # theta of 60 degrees: v counts from the lower pole
        np.testing.assert_allclose(uv, (0.25, (60 - 180) / (0 - 180)), atol=1e-3)
        np.testing.assert_array_equal(primitives.pbrt_sphere(1, 0.5, -0.5).uvs, primitives.pbrt_sphere(1, -0.5, 0.5).uvs)

    def test_pbrt_disk(self) -> None:
        mesh = primitives.pbrt_disk(1.5, 2, 1, 180)
        self.check(mesh)
        self.assertAlmostEqual(area(mesh) / (1.5 * math.pi), 1, delta=4e-4)
        np.testing.assert_array_equal(np.unique(mesh.positions[:, 2]), (1.5,))
        uv, normal = at(mesh, (0, 1.75, 1.5))  # v = (radius - r) / (radius - innerradius)
        np.testing.assert_allclose(uv, (0.5, 0.25), atol=2e-3)
        np.testing.assert_array_equal(normal, (0, 0, 1))
        self.check(primitives.pbrt_disk())

    def test_pbrt_cylinder(self) -> None:
        mesh = primitives.pbrt_cylinder(2, -1, 3, 270)
        self.check(mesh)
        self.assertAlmostEqual(area(mesh) / (2 * 4 * 1.5 * math.pi), 1, delta=1e-4)
        uv, normal = at(mesh, (-2, 0, 0))
        np.testing.assert_allclose(uv, (180 / 270, 0.25), atol=1e-3)
        np.testing.assert_allclose(normal, (-1, 0, 0), atol=1e-3)

    def test_impossible_sizes(self) -> None:
        for make in (lambda: primitives.sphere((0, 0, 0), 0), lambda: primitives.sphere((0, 0, 0), math.nan),
                     lambda: primitives.cylinder((1, 1, 1), (1, 1, 1), 1),
                     lambda: primitives.cylinder((0, 0, 0), (0, 0, 1), -1),
                     lambda: primitives.pbrt_sphere(1, 2, 3), lambda: primitives.pbrt_disk(0, 1, 1),
                     lambda: primitives.pbrt_cylinder(1, 0, 0), lambda: primitives.pbrt_cylinder(1, 0, 1, 0),
                     lambda: primitives.pbrt_sphere(math.inf)):
            with self.assertRaisesRegex(ImportProblem, "it has to be above 0"):
                make()


class PatchTest(unittest.TestCase):
    def test_parallelogram(self) -> None:
        mesh = primitives.bilinear(np.array([(0, 0, 0), (2, 0, 0), (1, 1, 0), (3, 1, 0)]))
        self.assertEqual(len(mesh.triangles), 2)
        self.assertEqual(area(mesh), 2)
        np.testing.assert_array_equal(mesh.normals, np.tile((0, 0, 1), (4, 1)))  # dp/du x dp/dv
        np.testing.assert_allclose(unit(area_vectors(mesh)), np.tile((0, 0, 1), (2, 1)))
        np.testing.assert_array_equal(mesh.uvs, [(0, 0), (1, 0), (0, 1), (1, 1)])

    def test_saddle(self) -> None:
        mesh = primitives.bilinear(np.array([[(0, 0, 0), (1, 0, 0)], [(0, 1, 0), (1, 1, 1)]], float))  # z = x y
        x, y, z = mesh.positions.T
        np.testing.assert_allclose(z, x * y, atol=1e-12)
        np.testing.assert_allclose(mesh.uvs, np.stack([x, y], axis=1), atol=1e-12)
        np.testing.assert_allclose(mesh.normals, unit(np.stack([-y, -x, np.ones_like(x)], axis=1)), atol=1e-12)
        a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
        for middle in ((a + b) / 2, (b + c) / 2, (c + a) / 2):
            self.assertLess(np.abs(middle[:, 2] - middle[:, 0] * middle[:, 1]).max(), 3**0.5 / 4096)

    def test_given_normals_choose_the_front(self) -> None:
        flat = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], float)
        mesh = primitives.bilinear(flat, np.tile((0, 0.6, -0.8), (4, 1)))
        np.testing.assert_allclose(unit(area_vectors(mesh)), np.tile((0, 0, -1), (2, 1)))
        np.testing.assert_allclose(mesh.normals, np.tile((0, 0.6, -0.8), (4, 1)))

    def test_uvs_are_bilinear_too(self) -> None:
        flat = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], float)
        mesh = primitives.bilinear(flat, None, np.array([(0, 0), (1, 0), (0, 1), (3, 1)]))
        x, y, _ = mesh.positions.T
        np.testing.assert_allclose(mesh.uvs, np.stack([x + 2 * x * y, y], axis=1), atol=1e-12)
        self.assertGreater(len(mesh.triangles), 100)

    def test_a_side_that_is_a_point(self) -> None:
        mesh = primitives.bilinear(np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 1, 0)], float))
        self.assertAlmostEqual(area(mesh), 0.5)
        self.assertGreater(np.linalg.norm(area_vectors(mesh), axis=1).min(), 0)
        used = mesh.normals[np.unique(mesh.triangles)]
        np.testing.assert_allclose(used, np.tile((0, 0, 1), (len(used), 1)))

    def test_no_area(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "has no area"):
            primitives.bilinear(np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)], float))


if __name__ == "__main__":
    unittest.main()
