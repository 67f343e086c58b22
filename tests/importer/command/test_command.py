"""./dev import as its user runs it: files, exit codes, what the terminal says."""

from __future__ import annotations

import hashlib
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path
from unittest import mock

import jsonschema
import numpy as np
from PIL import Image as Picture

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from glb_reading import Glb
from importer import __main__ as command
from importer.output import terminal
from importer.problems import ImportProblem, Notes

VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "docs/config.schema.json").read_text()))

# A triangle and a lamp.
MITSUBA = """<?xml version="1.0"?>
<scene version="3.0.0">
  <default name="depth" value="4"/>
  <integrator type="path"><integer name="max_depth" value="$depth"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="60"/><string name="fov_axis" value="y"/>
    <transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="32"/><rfilter type="box"/></film>
  </sensor>
  <bsdf type="diffuse" id="red"><rgb name="reflectance" value="0.8, 0.1, 0.1"/></bsdf>
  <shape type="obj" id="sail"><string name="filename" value="meshes/sail.obj"/><ref id="red"/></shape>
  <shape type="rectangle" id="lamp"><emitter type="area"><rgb name="radiance" value="4, 2, 1"/></emitter></shape>
</scene>
"""
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
PBRT = """LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 60
Film "rgb" "integer xresolution" 64 "integer yresolution" 32 "string filename" "a.exr"
PixelFilter "box"
Integrator "path" "integer maxdepth" 3
WorldBegin
LightSource "infinite" "rgb L" [1 2 3]
Material "diffuse" "rgb reflectance" [0.8 0.1 0.1]
Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0] "integer indices" [0 1 2]
"""


def before_camera(glb: Glb, point: np.ndarray) -> np.ndarray:
    return np.linalg.inv(glb.matrix("camera"))[:3] @ [*point, 1]


class CommandTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "meshes").mkdir()
        (self.folder / "meshes/sail.obj").write_text(OBJ)
        self.scene = self.folder / "scene.xml"
        self.scene.write_text(MITSUBA)
        self.out = self.folder / "out"
        self.out.mkdir()

    def run_import(self, *arguments: object, program: Path = ROOT / "configs") -> subprocess.CompletedProcess:
        return subprocess.run(["/usr/bin/python3", "-m", "importer", *map(str, arguments)], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(program)})

    def refused(self, *arguments: object, code: int = 1) -> str:
        """One line, and nothing written."""
        result = self.run_import(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        if code == 1:
            self.assertRegex(result.stderr, r"\Aimport: [^\n]+\n\Z")
        self.assertEqual((result.stdout, list(self.out.iterdir())), ("", []))
        return result.stderr

    def config(self, name: str) -> dict:
        text = re.sub(r"^//.*\n", "", (self.out / name).read_text(), flags=re.MULTILINE)
        config = json.loads(text)
        VALIDATOR.validate(config)
        return config

    def test_a_scene_of_mitsuba(self) -> None:
        result = self.run_import(self.scene, self.out / "room.glb")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(sorted(file.name for file in self.out.iterdir()), ["room.glb", "room.json"])
        glb = Glb.read(self.out / "room.glb")
        source = glb.document["asset"]["extras"]["source"]
        self.assertEqual((source["file"], source["format"], source["version"]), ("scene.xml", "Mitsuba", "3.0.0"))
        # The camera at z = 5 looks at the origin: +x is on the right, and both shapes turn their fronts to it.
        for name in ("sail", "lamp"):
            np.testing.assert_allclose(glb.fronts(name)[0], (0, 0, 1), atol=1e-6)
        np.testing.assert_allclose(before_camera(glb, glb.corners("sail")[0].max(axis=0)), (1, 1, -5), atol=1e-6)
        self.assertEqual(source["sha256"], hashlib.sha256(MITSUBA.encode()).hexdigest())
        self.assertEqual(source["files"], [{"name": "meshes/sail.obj", "sha256": hashlib.sha256(OBJ.encode()).hexdigest()},
                                           {"name": "scene.xml", "sha256": source["sha256"]}])
        config = self.config("room.json")
        self.assertEqual((config["width"], config["height"], config["max_bounces"]), (64, 32, 3))
        self.assertEqual(config["scene"], "room.glb")
        for line in (r"source +scene\.xml, Mitsuba 3\.0\.0", "shapes +2 of 2 meshes", "triangles +3", "light +1 lamp",
                     "picture +64 x 32", "path length +3 scattering events", r"written +\S+room\.glb, \S+room\.json"):
            self.assertRegex(result.stdout, rf"(?m)^{line}$")

    def test_a_scene_of_pbrt(self) -> None:
        scene = self.folder / "scene.pbrt"
        scene.write_text(PBRT)
        result = self.run_import(scene, self.out / "room.glb")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        glb = Glb.read(self.out / "room.glb")
        source = glb.document["asset"]["extras"]["source"]
        self.assertEqual((source["format"], source["version"]), ("pbrt", "4"))
        # pbrt's world is left-handed: its camera at z = 5 that looks at the origin has +x on its *left* (LookAt's right is
        # up x direction = -x), and the triangle still turns its front to it.
        name = glb.document["nodes"][0]["name"]
        found = {tuple(before_camera(glb, corner).round(5)) for corner in glb.corners(name)[0]}
        self.assertEqual(found, {(0, 0, -5), (-1, 0, -5), (0, 1, -5)})
        back = np.linalg.inv(glb.matrix("camera"))[:3, :3]
        np.testing.assert_allclose(back @ glb.fronts(name)[0], (0, 0, 1), atol=1e-6)
        config = self.config("room.json")
        self.assertEqual((config["max_bounces"], config["environment"]), (3, [1, 2, 3]))
        self.assertRegex(result.stdout, "(?m)^light +a sky of one radiance$")
        self.assertIn("for Mitsuba's XML", self.run_import(scene, self.out / "b.glb", "--define", "a=1").stderr)

    def test_all_files_are_named(self) -> None:
        """Whoever opens them: XML that is included, an image, and none of what lies beside them."""
        (self.folder / "lamp.xml").write_text('<scene version="3.0.0"><emitter type="constant"/></scene>')
        (self.folder / "other.xml").write_text(MITSUBA)
        Picture.new("RGB", (2, 2), (9, 8, 7)).save(self.folder / "a.png")
        # The program itself may lie below the scene's folder.
        shutil.copytree(ROOT / "configs/importer", self.folder / "importer")
        shutil.copytree(ROOT / "configs/scenes", self.folder / "scenes", ignore=lambda _, names: [
            name for name in names if not name.endswith("_file.py")])
        texture = '<texture type="bitmap" name="reflectance"><string name="filename" value="a.png"/></texture>'
        self.scene.write_text(MITSUBA.replace('<rgb name="reflectance" value="0.8, 0.1, 0.1"/>', texture)
                              .replace("<bsdf", '<include filename="lamp.xml"/><bsdf', 1))
        self.assertEqual(self.run_import(self.scene, self.out / "room.glb", program=self.folder).stderr, "")
        source = Glb.read(self.out / "room.glb").document["asset"]["extras"]["source"]
        self.assertEqual([file["name"] for file in source["files"]], ["a.png", "lamp.xml", "meshes/sail.obj", "scene.xml"])

    def test_definitions(self) -> None:
        self.assertEqual(self.run_import(self.scene, self.out / "room.glb", "--define", "depth=9").returncode, 0)
        self.assertEqual(self.config("room.json")["max_bounces"], 8)

    def test_nothing_is_written_over(self) -> None:
        config = self.out / "room.json"
        config.write_text("mine")
        result = self.run_import(self.scene, self.out / "room.glb")
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertRegex(result.stderr, r"\Aimport: \S+room\.json: it is there already; --force writes over it\n\Z")
        self.assertEqual(([file.name for file in self.out.iterdir()], config.read_text()), (["room.json"], "mine"))
        self.assertEqual(self.run_import(self.scene, self.out / "room.glb", "--force").returncode, 0)
        self.assertNotEqual(config.read_text(), "mine")

    def test_errors_leave_nothing(self) -> None:
        (self.folder / "meshes/sail.obj").write_text(OBJ.replace("1 2 3", "1 2 9"))
        self.assertIn("sail.obj", self.refused(self.scene, self.out / "a.glb"))
        self.scene.write_text(MITSUBA[:300])
        self.refused(self.scene, self.out / "a.glb")
        none = self.folder / "none.xml"
        self.assertIn("cannot be read (No such file or directory)", self.refused(none, self.out / "a.glb"))
        (self.folder / "scene").write_text("hello")
        self.assertIn("neither XML nor pbrt", self.refused(self.folder / "scene", self.out / "a.glb"))
        self.assertIn("no such folder", self.refused(self.scene, self.out / "none/a.glb"))
        self.assertIn("meshes: it is no file", self.refused(self.folder / "meshes", self.out / "a.glb"))
        self.scene.write_text(re.sub('"obj"(.*)<string.*?/>', r'"rectangle"\1', MITSUBA))
        self.assertIn("cannot be written there", self.refused(self.scene, "/proc/a.glb"))

    def test_usage(self) -> None:
        self.assertIn("a name that ends in .glb would be right", self.refused(self.scene, self.out / "a.gltf", code=2))
        self.assertIn("NAME=VALUE would be right", self.refused(self.scene, self.out / "a.glb", "--define", "x", code=2))
        self.assertIn("OUT_sky.exr", self.run_import("--help").stdout)

    def test_a_failure_while_writing_leaves_what_was_there(self) -> None:
        glb = self.out / "room.glb"
        glb.write_bytes(b"old")
        with mock.patch.object(command, "write_glb", side_effect=ImportProblem("a: no")), mock.patch("sys.stderr"):
            self.assertEqual(command.main([str(self.scene), str(glb), "--force"]), 1)
        self.assertEqual(([file.name for file in self.out.iterdir()], glb.read_bytes()), (["room.glb"], b"old"))

    def test_names_of_any_kind(self) -> None:
        """Neither one without an end nor one that would steer a terminal or that its letters do not hold."""
        text = self.scene.read_text()
        self.scene.write_text(text.replace("meshes/sail.obj", "long" * 2000))
        self.assertLess(len(self.refused(self.scene, self.out / "a.glb")), 800)
        self.scene.with_suffix(".pbrt").write_text("\x1bc\0World")
        self.assertIn("\ufffdc\ufffdWorld", self.refused(self.scene.with_suffix(".pbrt"), self.out / "a.glb"))
        self.scene.write_text(text)
        no_text = os.fsdecode(b"\xe4")
        self.assertIn("its name is no UTF-8", self.refused(self.folder / f"{no_text}.xml", self.out / "a.glb"))
        self.assertIn("its name is no UTF-8", self.refused(self.scene, self.out / f"{no_text}.glb"))
        (self.folder / no_text).mkdir()
        result = subprocess.run(["/usr/bin/python3", "-m", "importer", self.scene, self.folder / no_text / "\xe4.glb"],
                                capture_output=True, env={**os.environ, "PYTHONPATH": str(ROOT / "configs"),
                                                          "PYTHONIOENCODING": "ascii"})
        self.assertEqual((result.returncode, result.stderr), (0, b""))

    def test_who_stops_it_finds_nothing(self) -> None:
        """At SIGINT as at SIGTERM, one line and no file, were it in the middle of writing. A shell lets what runs in its
        background ignore SIGINT, and so these tests, too; the program is to hear it all the same."""
        waits = ("import importer.output.glb as g, runpy, sys, time\n"
                 "g.glb = lambda *a: (print(flush=True), time.sleep(60))\n"
                 f"sys.argv = ['import', {str(self.scene)!r}, {str(self.out / 'a.glb')!r}]\n"
                 "runpy.run_module('importer', run_name='__main__')")
        for number in (signal.SIGINT, signal.SIGTERM):
            program = subprocess.Popen(["/usr/bin/python3", "-c", waits], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       text=True, env={**os.environ, "PYTHONPATH": str(ROOT / "configs")},
                                       preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
            program.stdout.readline()
            self.assertEqual(len(list(self.out.iterdir())), 1)  # the folder that it writes into
            program.send_signal(number)
            self.assertEqual((program.communicate()[1], program.returncode), ("import: stopped\n", 130))
            self.assertEqual(list(self.out.iterdir()), [])

    def test_progress(self) -> None:
        """On a terminal one line after a few seconds, which is gone at the end; elsewhere nothing."""
        shown = io.StringIO()
        is_over = mock.Mock(wait=mock.Mock(side_effect=[False, False, False, True]))
        with mock.patch("sys.stderr", shown), mock.patch("time.monotonic", side_effect=[0, 1, 3.5, 4.5]):
            terminal._show(lambda: "57 files, sail.obj", is_over)
        self.assertEqual(shown.getvalue(), 2 * "\r\033[Kimport: 4 s, 57 files, sail.obj" + "\r\033[K")
        with mock.patch("sys.stderr", io.StringIO()) as silent, terminal.progress(lambda: "x"):
            self.assertEqual(threading.active_count(), 1)
        self.assertEqual(silent.getvalue(), "")

    def test_what_changed_is_a_table(self) -> None:
        notes = Notes(is_lenient=True)
        for line in (3, 8):
            notes.approximated("Beckmann's microfacets as GGX's", f"a.xml:{line}")
        notes.refuse("hair", "a.xml:9")
        self.assertEqual(terminal.changes(notes.rows()), [
            "", "approximated", "  Beckmann's microfacets as GGX's  2 times      a.xml:3",
            "", "left out", "  hair                             once         a.xml:9"])


if __name__ == "__main__":
    unittest.main()
