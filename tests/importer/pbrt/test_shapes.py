"""pbrt's shapes: where they lie, how large they are, which side shines, and where an image lies on them."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from importer.scene import Mesh, Part  # noqa: E402
from pbrt_scene import HEAD_V3, TRIANGLE, said, world, world_problem  # noqa: E402

NORMALS_UP = ' "normal N" [0 0 1 0 0 1 0 0 1]'
NORMALS_DOWN = ' "normal N" [0 0 -1 0 0 -1 0 0 -1]'


def fronts(part: Part) -> np.ndarray:
    """Unit normals of the side from which light leaves, in the world, by glTF's rule: a node that mirrors turns the
    corners' order over (glTF 2.0, 3.7.4)."""
    mesh, matrix = part.mesh, part.to_world[:3, :3]
    a, b, c = (mesh.positions[mesh.triangles[:, k]] @ matrix.T for k in range(3))
    normals = np.cross(b - a, c - a) * np.sign(np.linalg.det(matrix))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def area(mesh: Mesh) -> float:
    a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def part(text: str, head: str | None = None) -> Part:
    return world(text, **({} if head is None else {"head": head}))[0].parts[0]


class Fronts(unittest.TestCase):
    """The triangle (0,0,0), (1,0,0), (0,1,0) has its normal along +z."""

    def check(self, text: str, sign: int, shape: str = TRIANGLE) -> None:
        np.testing.assert_allclose(fronts(part(f"{text}\n{shape}")), [(0, 0, sign)], atol=1e-12, err_msg=text)

    def test_by_the_order_of_corners(self) -> None:
        self.check("", 1)
        self.check("ReverseOrientation", -1)
        self.check("ReverseOrientation\nReverseOrientation", 1)

    def test_a_mirror_moves_the_front_along_with_the_object(self) -> None:
        """Triangle::Intersect: the normal by the corners in world space, turned over where the transformation mirrors or
        the orientation is reversed, but not where both. Mirrored in x the corners run clockwise from +z: -z, turned over."""
        self.check("Scale -1 1 1", 1)
        self.check("Scale -1 1 1\nReverseOrientation", -1)
        self.check("Scale 1 1 -1", -1)
        self.check("Scale -1 -1 1", 1)

    def test_vertex_normals_say_which_side_it_is(self) -> None:
        shape = TRIANGLE.strip()
        self.check("", 1, shape + NORMALS_UP)
        self.check("", -1, shape + NORMALS_DOWN)
        self.check("ReverseOrientation", 1, shape + NORMALS_DOWN)
        self.check("Scale -1 1 1", -1, shape + NORMALS_DOWN)
        self.check("Scale 1 1 -1", 1, shape + NORMALS_DOWN)

    def test_reversed_normals_are_turned_over_with_the_front(self) -> None:
        mesh = part("ReverseOrientation\n" + TRIANGLE.strip() + NORMALS_UP).mesh
        np.testing.assert_array_equal(mesh.normals, [(0, 0, -1)] * 3)

    def test_quadrics_have_their_front_outside_or_up(self) -> None:
        for text, sign in (("", 1), ("ReverseOrientation", -1), ("Scale 1 1 -1", 1)):
            for shape in ("sphere", "cylinder"):
                found = part(f'{text}\nShape "{shape}"')
                centres = found.mesh.positions[found.mesh.triangles].mean(axis=1) @ found.to_world[:3, :3].T
                if shape == "cylinder":
                    centres[:, 2] = 0
                self.assertTrue((sign * (fronts(found) * centres).sum(axis=1) > 0.5).all(), (text, shape))
        self.assertTrue((fronts(part('Shape "disk"'))[:, 2] > 0.99).all())
        self.assertTrue((fronts(part('ReverseOrientation\nShape "disk"'))[:, 2] < -0.99).all())

    def test_a_bubble_is_glass_turned_inside_out(self) -> None:
        """A ball whose inside has the smaller index: a volume of 1.5 about it, seen from within."""
        found = part('Material "dielectric" "float eta" 0.6666667\nShape "sphere"')
        self.assertAlmostEqual(found.material.ior, 1.5, 5)
        centres = found.mesh.positions[found.mesh.triangles].mean(axis=1)
        self.assertTrue(((fronts(found) * centres).sum(axis=1) < 0).all())


class Sizes(unittest.TestCase):
    def test_balls(self) -> None:
        mesh = part('Shape "sphere" "float radius" 2').mesh
        np.testing.assert_allclose(mesh.positions.min(0), (-2, -2, -2), atol=1e-9)
        np.testing.assert_allclose(mesh.positions.max(0), (2, 2, 2), atol=1e-9)
        self.assertAlmostEqual(area(mesh) / (16 * math.pi), 1, 2)
        np.testing.assert_allclose(np.linalg.norm(mesh.positions, axis=1), 2)

    def test_parts_of_balls(self) -> None:
        """A zone of a sphere has the area phi r (zmax - zmin)."""
        mesh = part('Shape "sphere" "float radius" 2 "float zmin" -1 "float zmax" 1.5 "float phimax" 90').mesh
        self.assertAlmostEqual(area(mesh) / (math.pi / 2 * 2 * 2.5), 1, 2)
        self.assertAlmostEqual(mesh.positions[:, 2].min(), -1)
        self.assertAlmostEqual(mesh.positions[:, 2].max(), 1.5)
        self.assertGreaterEqual(mesh.positions[:, :2].min(), -1e-9)

    def test_disks_and_cylinders(self) -> None:
        mesh = part('Shape "disk" "float radius" 3 "float innerradius" 1 "float height" 5').mesh
        self.assertAlmostEqual(area(mesh) / (8 * math.pi), 1, 2)
        np.testing.assert_allclose(mesh.positions[:, 2], 5)
        mesh = part('Shape "cylinder" "float radius" 2 "float zmin" -3 "float zmax" 4 "float phimax" 180').mesh
        self.assertAlmostEqual(area(mesh) / (math.pi * 2 * 7), 1, 2)
        self.assertGreaterEqual(mesh.positions[:, 1].min(), -1e-9)

    def test_patches(self) -> None:
        """P is p00, p10, p01, p11; without indices one patch."""
        found = part('Shape "bilinearmesh" "point3 P" [0 0 0  2 0 0  0 3 0  2 3 0]')
        self.assertAlmostEqual(area(found.mesh), 6)
        np.testing.assert_allclose(fronts(found), [(0, 0, 1)] * 2, atol=1e-12)
        two = part('Shape "bilinearmesh" "point3 P" [0 0 0  2 0 0  0 3 0  2 3 0  4 0 0  4 3 0]'
                   ' "integer indices" [0 1 2 3  1 4 3 5]')
        self.assertAlmostEqual(area(two.mesh), 12)

    def test_equal_shapes_share_their_mesh(self) -> None:
        scene, _ = world('Shape "sphere"\nTranslate 5 0 0\nShape "sphere"\nReverseOrientation\nShape "sphere"')
        self.assertIs(scene.parts[0].mesh, scene.parts[1].mesh)
        self.assertIsNot(scene.parts[0].mesh, scene.parts[2].mesh)


class Coordinates(unittest.TestCase):
    def test_v_goes_downwards(self) -> None:
        text = TRIANGLE.strip() + ' "{} uv" [0 0  1 0  0.25 0.75]'
        for kind, head in (("point2", None), ("float", HEAD_V3)):
            np.testing.assert_allclose(part(text.format(kind), head).mesh.uvs, [(0, 1), (1, 1), (0.25, 0.25)])
        np.testing.assert_allclose(part(text.format("float").replace("uv", "st"), HEAD_V3).mesh.uvs[2], (0.25, 0.25))

    def test_balls(self) -> None:
        """u = phi / 2 pi from +x towards +y, v from 0 at the bottom to 1 at the top (Sphere::Intersect)."""
        mesh = part('Shape "sphere"').mesh
        for point, uv in (((0, 1, 0), (0.25, 0.5)), ((-1, 0, 0), (0.5, 0.5)), ((0, -1, 0), (0.75, 0.5))):
            vertex = np.linalg.norm(mesh.positions - point, axis=1).argmin()
            np.testing.assert_allclose(mesh.uvs[vertex], (uv[0], 1 - uv[1]), atol=1e-6)
        np.testing.assert_allclose(mesh.uvs[mesh.positions[:, 2].argmax(), 1], 0, atol=1e-9)

    def test_textured_triangles_without_coordinates(self) -> None:
        """Triangle::GetUVs: (0,0), (1,0), (1,1)."""
        scene, _ = world('Texture "t" "spectrum" "checkerboard"\nMaterial "diffuse" "texture reflectance" "t"\n' + TRIANGLE)
        np.testing.assert_allclose(scene.parts[0].mesh.uvs, [(0, 1), (1, 1), (1, 0)])
        self.assertIsNone(part(TRIANGLE).mesh.uvs)


class Meshes(unittest.TestCase):
    PLY = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "property float u\nproperty float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0 0 0\n2 0 0 1 0\n2 2 0 1 1\n0 2 0 0 1\n4 0 1 2 3\n")

    def test_files(self) -> None:
        scene, _ = world('Shape "plymesh" "string filename" "m/a.ply"\nReverseOrientation\n'
                         'Shape "plymesh" "string filename" "m/a.ply"', files={"m/a.ply": self.PLY})
        first, second = scene.parts
        self.assertEqual(first.name, "a")
        self.assertAlmostEqual(area(first.mesh), 4)
        np.testing.assert_allclose(fronts(first), [(0, 0, 1)] * 2, atol=1e-12)
        np.testing.assert_allclose(fronts(second), [(0, 0, -1)] * 2, atol=1e-12)
        corner = np.linalg.norm(first.mesh.positions - (2, 2, 0), axis=1).argmin()
        np.testing.assert_allclose(first.mesh.uvs[corner], (1, 0))

    def test_instances(self) -> None:
        """Each part of an object: the instance's transformation times the one it was defined with."""
        scene, notes = world('Translate 0 0 7\nObjectBegin "a"\nScale 2 2 2\nAreaLightSource "diffuse"\n' + TRIANGLE
                             + 'ObjectEnd\nIdentity\nTranslate 1 0 0\nObjectInstance "a"\nTranslate 0 1 0\n'
                             'ObjectInstance "a"')
        self.assertEqual(len(scene.parts), 2)
        np.testing.assert_allclose(scene.parts[0].to_world @ [1, 0, 0, 1], (3, 0, 7, 1))
        np.testing.assert_allclose(scene.parts[1].to_world @ [1, 0, 0, 1], (3, 1, 7, 1))
        self.assertIs(scene.parts[0].mesh, scene.parts[1].mesh)
        np.testing.assert_array_equal(scene.parts[0].material.radiance, (0, 0, 0))
        self.assertIn("leaves out of instances", " ".join(said(notes)))

    def test_what_is_left_out_is_said(self) -> None:
        _, notes = world(TRIANGLE.strip() + ' "vector S" [1 0 0 1 0 0 1 0 0]')
        self.assertIn("the tangents of a mesh", said(notes))

    def test_problems(self) -> None:
        corners = 'Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0] '
        for text in (corners + '"integer indices" [0 1 3]', corners + '"integer indices" [0 1 -1]',
                     corners + '"integer indices" [0 1 1e300]', corners + '"integer indices" [0 1 2 0]',
                     corners + '"integer indices" [0 1 1]', corners + '"normal N" [0 0 1]', corners + '"point2 uv" [0 0]',
                     'Shape "trianglemesh"', 'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1]',
                     'Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0]', 'Shape "sphere" "float radius" 0',
                     'Shape "sphere" "float zmin" 2', 'Shape "sphere" "float phimax" 0',
                     'Shape "disk" "float innerradius" 1',
                     'Shape "cylinder" "float zmin" 1'):
            self.assertRegex(world_problem(text), r"^scene\.pbrt:4: ", text)


if __name__ == "__main__":
    unittest.main()
