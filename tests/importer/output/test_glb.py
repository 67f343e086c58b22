"""The .glb as a whole: arrays, cameras, lights, what it says of its source, and what it refuses."""

from __future__ import annotations

import dataclasses
import math
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from glb_reading import Glb
from importer.output.glb import write_glb
from importer.problems import ImportProblem, Notes
from importer.scene import Camera, Light, LightKind, Material, Mesh, Part, Scene

TRIANGLE = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
GREY = Material("grey")


def strip(count: int) -> Mesh:
    """`count` vertices, each in a triangle."""
    positions = np.stack([np.arange(count) / 2, np.arange(count) % 2, np.zeros(count)], axis=1)
    return Mesh(positions, np.arange(count)[:, None][:-2] + [0, 1, 2])


class GlbTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.path, self.notes = Path(temporary.name) / "a.glb", Notes()

    def glb(self, *parts: Part, camera: Camera = Camera(np.eye(4), 40.0), lights: tuple[Light, ...] = ()) -> Glb:
        scene = Scene("the scene", camera, list(parts) or [Part("part", TRIANGLE, GREY)], list(lights))
        self.totals = write_glb(scene, self.path, self.notes, {"file": "a.xml", "sha256": "0" * 64})
        return Glb.read(self.path)

    def test_what_it_says_of_its_source(self) -> None:
        self.notes.approximated("Beckmann's microfacets as GGX's", "a.xml:3")
        document = self.glb().document
        self.assertEqual(document["asset"]["version"], "2.0")
        self.assertEqual(document["asset"]["generator"], "qtrace importer")
        self.assertEqual(document["asset"]["extras"], {
            "source": {"file": "a.xml", "sha256": "0" * 64},
            "approximations": [{"kind": "approximated", "what": "Beckmann's microfacets as GGX's", "count": 1,
                                "first": "a.xml:3"}]})
        self.assertEqual(document["scenes"][0]["name"], "the scene")

    def test_what_is_found_while_writing_is_said_too(self) -> None:
        flat = dataclasses.replace(TRIANGLE, triangles=np.array([[0, 1, 2], [0, 1, 1]]))
        glb = self.glb(Part("ball", flat, GREY))
        self.assertEqual(glb.document["asset"]["extras"]["approximations"],
                         [{"kind": "left out", "what": "triangles without an area", "count": 1, "first": "shape ball"}])
        self.assertEqual(len(glb.corners("ball")), 1)

    def test_shared_meshes(self) -> None:
        """Of a mesh with one material that many parts show there is one, and triangles count as often as they are seen."""
        place = np.eye(4)
        place[:3, 3] = 5, 0, 0
        glb = self.glb(Part("a", TRIANGLE, GREY), Part("b", TRIANGLE, GREY, place),
                       Part("c", TRIANGLE, Material("white", (1, 1, 1))))
        document = glb.document
        self.assertEqual((len(document["meshes"]), len(document["nodes"])), (2, 4))
        self.assertEqual(len(document["accessors"]), 2)
        self.assertEqual((self.totals.parts, self.totals.meshes, self.totals.triangles), (3, 2, 3))
        np.testing.assert_allclose(glb.corners("b")[0], TRIANGLE.positions + (5, 0, 0))

    def test_index_sizes_and_bounds(self) -> None:
        """65,535 vertices are the most that 16 bits name, as the number 65,535 itself restarts a primitive (3.7.2.1)."""
        for count, component in ((65535, 5123), (65536, 5125)):
            glb = self.glb(Part("part", strip(count), GREY))
            primitive = glb.primitive("part")
            self.assertEqual(glb.document["accessors"][primitive["indices"]]["componentType"], component)
            bounds = glb.document["accessors"][primitive["attributes"]["POSITION"]]
            self.assertEqual((bounds["min"], bounds["max"]), ([0, 0, 0], [(count - 1) / 2, 1, 0]))
            self.assertEqual(glb.array(primitive["indices"]).max(), count - 1)

    def test_lone_vertices_stay_out(self) -> None:
        mesh = Mesh(np.array([[9.0, 9, 9], [0, 0, 0], [1, 0, 0], [0, 2, 0]]), np.array([[1, 2, 3]]),
                    np.array([[0.0, 1, 0]] + [[0, 0, 1]] * 3), np.array([[9.0, 9], [0, 0], [1, 0], [0, 1]]))
        glb = self.glb(Part("part", mesh, GREY))
        np.testing.assert_allclose(glb.corners("part")[0], mesh.positions[1:])
        attributes = glb.primitive("part")["attributes"]
        np.testing.assert_allclose(glb.array(attributes["NORMAL"]), [[0, 0, 1]] * 3)
        np.testing.assert_allclose(glb.array(attributes["TEXCOORD_0"]), [[0, 0], [1, 0], [0, 1]])

    def test_normals_have_a_length_of_one(self) -> None:
        mesh = dataclasses.replace(TRIANGLE, normals=np.array([[0.0, 0, 7], [0, 3, 4], [0, 0, 0]]))
        glb = self.glb(Part("part", mesh, GREY))
        np.testing.assert_allclose(glb.array(glb.primitive("part")["attributes"]["NORMAL"]),
                                   [[0, 0, 1], [0, 0.6, 0.8], [0, 0, 1]], atol=1e-6)

    def test_the_camera(self) -> None:
        """60 degrees from top to bottom; looks along -z of its node."""
        document = self.glb(camera=Camera(np.diag([2.0, 2, 2, 1]), 60.0, width=640, height=360)).document
        lens = document["cameras"][0]["perspective"]
        self.assertAlmostEqual(lens["yfov"], math.pi / 3)
        self.assertAlmostEqual(lens["aspectRatio"], 16 / 9)
        self.assertTrue(0 < lens["znear"] < 1e-4)
        self.assertEqual(document["nodes"][-1], {"name": "camera", "camera": 0})
        lens = self.glb(camera=Camera(np.eye(4), None, 1.5, 200, 100)).document["cameras"][0]["orthographic"]
        self.assertEqual((lens["xmag"], lens["ymag"]), (3, 1.5))
        self.assertGreater(lens["zfar"], 2)  # beyond the triangle's corner at (0, 2, 0)

    def test_lights(self) -> None:
        lights = (Light("bulb", LightKind.POINT, (5.0, 10, 2), (1, 2, 3)),
                  Light("sun", LightKind.DIRECTIONAL, (3.0, 3, 3), direction=(0, -5, 0)),
                  Light("spot", LightKind.SPOT, (1.0, 1, 1), (0, 1, 0), (1, 0, 0), 0.5, 0.5),
                  Light("dark", LightKind.POINT, (0.0, 0, 0)))
        glb = self.glb(lights=lights)
        said = glb.document["extensions"]["KHR_lights_punctual"]["lights"]
        self.assertEqual([light["name"] for light in said], ["bulb", "sun", "spot"])
        self.assertEqual((said[0]["color"], said[0]["intensity"], said[0]["type"]), ([0.5, 1, 0.2], 10, "point"))
        np.testing.assert_allclose(glb.matrix("bulb")[:3, 3], (1, 2, 3))
        np.testing.assert_allclose(glb.matrix("sun") @ [0, 0, -1, 0], [0, -1, 0, 0], atol=1e-12)
        np.testing.assert_allclose(glb.matrix("spot") @ [0, 0, -1, 0], [1, 0, 0, 0], atol=1e-12)
        self.assertEqual(said[2]["spot"]["outerConeAngle"], 0.5)
        self.assertLess(said[2]["spot"]["innerConeAngle"], 0.5)
        self.assertEqual(glb.document["extensionsUsed"], ["KHR_lights_punctual", "KHR_materials_specular"])
        self.assertEqual(glb.node("spot")["extensions"], {"KHR_lights_punctual": {"light": 2}})

    def refused(self, said: str, **changes: np.ndarray) -> None:
        with self.subTest(said), self.assertRaisesRegex(ImportProblem, f"^shape part: .*{said}"):
            self.glb(Part("part", dataclasses.replace(TRIANGLE, **changes), GREY))

    def test_impossible_meshes(self) -> None:
        nan = TRIANGLE.positions.copy()
        nan[1, 2] = np.nan
        self.refused("position of vertex 1", positions=nan)
        self.refused("position of vertex 0", positions=TRIANGLE.positions + 1e39)
        self.refused("texture coordinate of vertex 2", uvs=np.array([[0.0, 0], [0, 0], [np.inf, 0]]))
        self.refused("3 positions and 2 normals", normals=np.zeros((2, 3)))
        self.refused("names vertex 3", triangles=np.array([[0, 1, 3]]))
        self.refused("one below 0", triangles=np.array([[0, 1, -1]]))
        self.refused("three a vertex", positions=np.zeros((3, 2)))

    def test_what_single_precision_does_not_hold(self) -> None:
        """A .glb of numbers beyond it would be read as one of infinities."""
        far = np.eye(4)
        far[0, 3] = 1e39
        with self.assertRaisesRegex(ImportProblem, "^shape part: its transform reaches 1e.39; numbers that single"):
            self.glb(Part("part", TRIANGLE, GREY, far))
        large = dataclasses.replace(TRIANGLE, positions=TRIANGLE.positions * 1e20)
        with self.assertRaisesRegex(ImportProblem, "^shape part: what its transform makes of it reaches 2e.40"):
            self.glb(Part("part", large, GREY, np.diag([1e20, 1e20, 1e20, 1])))
        with self.assertRaisesRegex(ImportProblem, "^camera: its transform reaches"):
            self.glb(camera=Camera(far, 40.0))
        with self.assertRaisesRegex(ImportProblem, "^camera: half its picture's height"):
            self.glb(camera=Camera(np.eye(4), None, 1e39))
        with self.assertRaisesRegex(ImportProblem, "^light a: its position reaches"):
            self.glb(lights=(Light("a", LightKind.POINT, (1.0, 1, 1), (1e39, 0, 0)),))
        glb = self.glb(lights=(Light("a", LightKind.DIRECTIONAL, (1.0, 1, 1), direction=(1e300, 0, 0)),))
        np.testing.assert_allclose(glb.matrix("a") @ [0, 0, -1, 0], [1, 0, 0, 0], atol=1e-12)

    def test_impossible_cameras_and_lights(self) -> None:
        for camera, said in ((Camera(np.eye(4), 180.0), "180 degrees"), (Camera(np.eye(4), float("nan")), "nan degrees"),
                             (Camera(np.eye(4), None, 0.0), "height is 0"), (Camera(np.eye(4), 40.0, width=0), "0 x 512")):
            with self.subTest(said), self.assertRaisesRegex(ImportProblem, said):
                self.glb(camera=camera)
        point, spot = LightKind.POINT, LightKind.SPOT
        for light, said in ((Light("a", point, (-1.0, 0, 0)), "intensity"),
                            (Light("a", point, (1.0, float("inf"), 0)), "intensity"),
                            (Light("a", point, (1.0, 1, 1), (0, float("nan"), 0)), "position"),
                            (Light("a", spot, (1.0, 1, 1), direction=(0, 0, 0)), "direction"),
                            (Light("a", spot, (1.0, 1, 1), outer_cone=2.0), "cones")):
            with self.subTest(said), self.assertRaisesRegex(ImportProblem, f"light a: .*{said}"):
                self.glb(lights=(light,))

    def test_nothing_to_see(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "a.xml: it shows no surface"):
            self.glb(Part("part", TRIANGLE, Material("unseen", opacity=0.0)))
        self.assertFalse(self.path.exists())


if __name__ == "__main__":
    unittest.main()
