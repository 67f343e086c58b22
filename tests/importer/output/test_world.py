"""Where things are in the .glb: the picture of the source stays, whatever is mirrored, turned, sheared or flattened."""

from __future__ import annotations

import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from glb_reading import Glb
from importer.output.glb import write_glb
from importer.output.world import world_of
from importer.problems import ImportProblem, Notes
from importer.scene import Camera, Light, LightKind, Material, Mesh, Part, Scene, Sky

# One triangle whose front is +z.
TRIANGLE = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0]]), np.array([[0, 1, 2]]),
                normals=np.array([[0.0, 0, 1]] * 3))
GREY = Material("grey")


def rotation(axis: list[float], degrees: float) -> np.ndarray:
    """Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def affine(turn: np.ndarray, at: tuple[float, float, float] = (0, 0, 0)) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, at
    return matrix


class WorldTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.path, self.notes = Path(temporary.name) / "a.glb", Notes()

    def written(self, scene: Scene) -> Glb:
        write_glb(scene, self.path, self.notes, {"file": "a.xml"})
        return Glb.read(self.path)

    def with_part(self, to_world: np.ndarray, mesh: Mesh = TRIANGLE) -> Glb:
        return self.written(Scene("a", Camera(np.eye(4), 40.0), [Part("part", mesh, GREY, to_world)]))

    def test_a_part_keeps_place_and_front(self) -> None:
        glb = self.with_part(affine(rotation([1, 2, 3], 50) * 2, (5, 6, 7)))
        np.testing.assert_allclose(glb.corners("part")[0], TRIANGLE.positions @ (2 * rotation([1, 2, 3], 50)).T + (5, 6, 7),
                                   atol=1e-6)
        np.testing.assert_allclose(glb.fronts("part")[0], rotation([1, 2, 3], 50)[:, 2], atol=1e-6)

    def test_a_mirrored_part_keeps_its_front(self) -> None:
        """What faces +z still does after x has changed its sign; a mirroring along z turns it to -z."""
        for scale, front in (((-1, 1, 1), 1), ((1, 1, -1), -1)):
            for shear in (0.0, 0.5):  # in a node's matrix, and in the vertices
                turn = np.diag(scale).astype(float)
                turn[0, 1] = shear
                glb = self.with_part(affine(turn))
                self.assertEqual("matrix" in glb.node("part"), shear == 0)
                np.testing.assert_allclose(glb.fronts("part")[0], (0, 0, front), atol=1e-6)
                if shear:  # else the reader turns normals with the node
                    normals = glb.array(glb.primitive("part")["attributes"]["NORMAL"])
                    np.testing.assert_allclose(normals, [[0, 0, front]] * 3, atol=1e-6)

    def test_a_shear_moves_vertices_and_normals(self) -> None:
        """x += y: a plane x = 0, whose normal is +x, becomes x = y with the normal (1, -1, 0) / sqrt 2."""
        shear = np.eye(4)
        shear[0, 1] = 1
        wall = Mesh(np.array([[0.0, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 1, 2]]), np.array([[1.0, 0, 0]] * 3))
        glb = self.with_part(shear, wall)
        self.assertNotIn("matrix", glb.node("part"))
        np.testing.assert_allclose(glb.corners("part")[0], [[0, 0, 0], [1, 1, 0], [0, 0, 1]])
        normals = glb.array(glb.primitive("part")["attributes"]["NORMAL"])
        np.testing.assert_allclose(normals, [[0.5**0.5, -(0.5**0.5), 0]] * 3, atol=1e-6)

    def test_a_flattened_part_has_its_faces_normals(self) -> None:
        glb = self.with_part(np.diag([1.0, 1, 0, 1]))
        np.testing.assert_allclose(glb.fronts("part"), [[0, 0, 1]])
        self.assertNotIn("NORMAL", glb.primitive("part")["attributes"])
        with self.assertRaisesRegex(ImportProblem, "no surface"):
            self.with_part(np.diag([0.0, 1, 0, 1]))

    def test_a_mirroring_camera_mirrors_the_world(self) -> None:
        """A point, a lamp's direction and the front of a face stand before the camera as they did: the same in its
        coordinates; and the camera no longer mirrors."""
        to_world = affine(rotation([3, 1, 2], 70) @ np.diag([-3.0, 3, 3]), (1, 2, 3))
        spot = Light("spot", LightKind.SPOT, (1, 2, 4), position=(4, 5, 6), direction=(1, 2, -1), inner_cone=0.1)
        place = affine(rotation([0, 1, 1], 20), (1, 0, -4))
        glb = self.written(Scene("a", Camera(to_world, 40.0), [Part("part", TRIANGLE, GREY, place)], [spot]))
        camera, back = glb.matrix("camera"), np.linalg.inv(to_world)
        self.assertGreater(np.linalg.det(camera[:3, :3]), 0)
        np.testing.assert_allclose(camera[:3, :3] @ camera[:3, :3].T, np.eye(3), atol=1e-12)

        def seen(point: np.ndarray) -> np.ndarray:
            return np.linalg.inv(camera)[:3] @ [*point, 1]

        def seen_in_source(point: np.ndarray) -> np.ndarray:
            return 3 * (back[:3] @ [*point, 1])  # the scale is no part of the picture

        for i, corner in enumerate(TRIANGLE.positions):
            found = [seen(point) for point in glb.corners("part")[0]]
            wanted = seen_in_source((place @ [*corner, 1])[:3])
            self.assertLess(min(np.linalg.norm(point - wanted) for point in found), 1e-5)
        # The front: a step along it ends at the same place before the camera.
        centre, front = glb.corners("part")[0].mean(axis=0), glb.fronts("part")[0]
        source_centre = place[:3, :3] @ TRIANGLE.positions.mean(axis=0) + place[:3, 3]
        np.testing.assert_allclose(seen(centre + front), seen_in_source(source_centre + place[:3, 2]), atol=1e-5)
        node = glb.matrix("spot")
        np.testing.assert_allclose(seen(node[:3, 3]), seen_in_source(np.array([4, 5, 6])), atol=1e-6)
        along = np.array([1, 2, -1]) / 6**0.5
        np.testing.assert_allclose(seen(node[:3, 3] - node[:3, 2]), seen_in_source(np.array([4, 5, 6]) + along), atol=1e-6)

    def test_the_sky_before_the_camera(self) -> None:
        """Of any direction before the camera, source and file name the same texel, by the convention that scene.py and
        engine/scene/lights.h have."""
        width, height = 64, 32

        def texel(local: np.ndarray) -> tuple[int, int]:
            x, y, z = local / np.linalg.norm(local)
            column = (0.5 + np.arctan2(x, -z) / (2 * np.pi)) * width
            return int(column) % width, int(np.arccos(np.clip(y, -1, 1)) / np.pi * height)

        random = np.random.default_rng(7)
        mirror = np.diag([-1.0, 1, 1])
        turns = [np.eye(3), rotation([0, 1, 0], 30), mirror, rotation([1, 0, 0], 90), rotation([1, 2, 3], 100) @ mirror,
                 np.diag([1.0, -1, -1])]
        for sky_turn in turns:
            for camera_turn in (np.eye(3), rotation([1, 0, 2], 40) @ mirror):
                camera = Camera(affine(camera_turn, (1, 2, 3)), 40.0)
                image = np.ones((height, width, 3), np.float32)
                scene = Scene("a", camera, [Part("part", TRIANGLE, GREY)], sky=Sky(image=image, to_world=sky_turn))
                world, glb = world_of(scene), self.written(scene)
                for direction in random.normal(size=(50, 3)):
                    wanted = texel(sky_turn.T @ camera_turn @ direction)
                    found = texel(rotation([0, 1, 0], -world.sky_degrees) @ glb.matrix("camera")[:3, :3] @ direction)
                    if world.is_sky_flipped:
                        found = (width - 1 - found[0], found[1])
                    self.assertEqual(found, wanted)

    def test_a_sky_about_y_leaves_the_world(self) -> None:
        sky = Sky(image=np.ones((2, 4, 3), np.float32), to_world=rotation([0, 1, 0], -50))
        world = world_of(Scene("a", Camera(np.eye(4), 40.0), sky=sky))
        np.testing.assert_array_equal(world.turn, np.eye(3))
        self.assertAlmostEqual(world.sky_degrees, -50)

    def test_impossible_transforms(self) -> None:
        for camera, sky, said in ((np.diag([1.0, 0, 1, 1]), np.eye(3), "singular"),
                                  (np.full((4, 4), np.nan), np.eye(3), "finite"),
                                  (np.eye(4), np.diag([2.0, 1, 1]), "a rotation would be right")):
            scene = Scene("a", Camera(camera, 40.0), sky=Sky(image=np.ones((2, 4, 3), np.float32), to_world=sky))
            with self.assertRaisesRegex(ImportProblem, said):
                world_of(scene)
        with self.assertRaisesRegex(ImportProblem, "finite"):
            self.with_part(np.full((4, 4), np.inf))
        perspective = np.eye(4)
        perspective[3, 2] = 1
        with self.assertRaisesRegex(ImportProblem, "shape part: .*last row"):
            self.with_part(perspective)


if __name__ == "__main__":
    unittest.main()
