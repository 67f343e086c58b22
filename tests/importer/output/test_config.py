"""The config and the sky beside the .glb."""

from __future__ import annotations

import json
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

import jsonschema
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "configs"))

from importer.images.exr_file import read_exr
from importer.output import sky as sky_file
from importer.output.config import UNLIMITED, config_of, write_config
from importer.output.world import World
from importer.problems import ImportProblem, Notes
from importer.scene import Camera, Scene, Sky

VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "docs/config.schema.json").read_text()))
STRAIGHT = World(np.eye(3), 0.0, False)


def scene(max_bounces: int | None = 7, **camera: int) -> Scene:
    return Scene("a", Camera(np.eye(4), 40.0, **camera), max_bounces=max_bounces)


class ConfigTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder, self.notes = Path(temporary.name), Notes()

    def written(self, environment: Any, source: Scene) -> dict[str, Any]:
        write_config(config_of(source, "room.glb", environment, self.notes), self.folder / "room.json", "a\n room.xml")
        lines = (self.folder / "room.json").read_text().splitlines()
        comments = [line for line in lines if line.startswith("//")]
        self.assertEqual(lines[:len(comments)], comments)
        self.assertIn("a room.xml", comments[0])
        config = json.loads("\n".join(lines[len(comments):]))
        VALIDATOR.validate(config)
        return config

    def test_what_the_source_says(self) -> None:
        config = self.written([1.0, 2.0, 3.0], scene(width=640, height=360))
        self.assertEqual({key: config[key] for key in ("name", "scene", "width", "height", "max_bounces", "environment")},
                         {"name": "room", "scene": "room.glb", "width": 640, "height": 360, "max_bounces": 7,
                          "environment": [1, 2, 3]})
        self.assertEqual([method["nee"] for method in config["sweep"][0]["method"].values()], ["one_ray"] * 2)
        self.assertIn(config["baseline"], config["sweep"][0]["method"])
        self.assertEqual(self.notes.rows(), [])
        self.assertNotIn("environment", self.written([0.0, 0.0, 0.0], scene()))
        self.written({"file": "room_sky.exr", "scale": [1.0, 2.0, 3.0], "rotation": -40.0}, scene())

    def test_lengths_of_paths(self) -> None:
        self.assertEqual(self.written([0.0] * 3, scene(None))["max_bounces"], UNLIMITED)
        self.assertEqual(self.written([0.0] * 3, scene(5000))["max_bounces"], 1024)
        self.assertEqual([row["kind"] for row in self.notes.rows()], ["approximated"] * 2)
        self.assertIn(f"at most {UNLIMITED}", self.notes.rows()[0]["what"])
        self.assertEqual(self.written([0.0] * 3, scene(0))["max_bounces"], 0)

    def test_a_picture_that_is_too_large(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "20000 x 512"):
            config_of(scene(width=20000), "a.glb", [0.0] * 3, self.notes)


class SkyTest(unittest.TestCase):
    def setUp(self) -> None:
        self.notes = Notes()
        self.image = np.arange(24, dtype=np.float32).reshape(2, 4, 3)

    def said(self, sky: Sky, world: World = STRAIGHT) -> tuple[Any, np.ndarray | None]:
        """What the config says, and the image that was written."""
        with mock.patch.object(sky_file.exr_file, "write_exr", create=True) as write:
            said = sky_file.write_sky(sky, world, Path("/x/room_sky.exr"), "room_sky.exr", self.notes)
        return said, write.call_args.args[1] if write.called else None

    def test_one_radiance(self) -> None:
        self.assertEqual(self.said(Sky((1, 2, 3))), ([1, 2, 3], None))

    def test_texels_go_on_unchanged(self) -> None:
        said, image = self.said(Sky(image=self.image))
        self.assertEqual(said, {"file": "room_sky.exr"})
        np.testing.assert_array_equal(image, self.image)
        said, image = self.said(Sky(image=self.image, scale=(2, 2, 2)), World(np.eye(3), 30.0, True))
        self.assertEqual(said, {"file": "room_sky.exr", "scale": 2, "rotation": 30})
        np.testing.assert_array_equal(image, self.image[:, ::-1])
        self.assertEqual(self.said(Sky(image=self.image, scale=(1, 2, 3)))[0]["scale"], [1, 2, 3])
        self.assertEqual(self.notes.rows(), [])

    def test_the_file(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.exr"
            sky_file.write_sky(Sky(image=self.image / 7), World(np.eye(3), 0.0, True), path, "a.exr", self.notes)
            np.testing.assert_array_equal(read_exr(path), self.image[:, ::-1] / 7)

    def test_impossible_skies(self) -> None:
        for sky, said in ((Sky((1, -1, 1)), "radiance is -1"), (Sky((1, float("nan"), 1)), "radiance is nan"),
                          (Sky(image=self.image, scale=(1, 1, 1e9)), "scale is 1e"),
                          (Sky(image=self.image + np.inf), "finite"),
                          (Sky(image=self.image[..., 0]), r"\(2, 4\) numbers")):
            with self.subTest(said), self.assertRaisesRegex(ImportProblem, said):
                self.said(sky)
        _, image = self.said(Sky(image=self.image - 1))
        self.assertEqual(image[0, 0].tolist(), [0, 0, 1])
        self.assertEqual([row["what"] for row in self.notes.rows()], ["texels below 0 in the sky's image as 0"])


if __name__ == "__main__":
    unittest.main()
