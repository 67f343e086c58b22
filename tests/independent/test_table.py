"""The table of ./dev independent grows row by row, keeps other scenes, and never mixes devices."""

from __future__ import annotations

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from table import SCENES

HERE = Path(__file__).resolve().parent
# Stands in for the comparison: rows of the scene that the filter names, and the exit code of FAIL for that scene.
PROGRAM = """#!/bin/sh
scene=${1##*/}
echo 'device: DEVICE'
echo "| $scene | bsdf | none | VALUE ± 0.010 | 1.000 ± 0.050 | 1.00000 ± 0.00100 | 512 | 1024 | agrees |"
[ $scene != FAIL ] || kill -9 $$
echo "| $scene | bsdf | one_ray | VALUE ± 0.010 | 1.000 ± 0.050 | 1.00000 ± 0.00100 | 512 | 1024 | agrees |"
"""


class TableTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_it(self, *scenes: str, value: str = "1.000", device: str = "a card",
               fail: str = "none") -> subprocess.CompletedProcess[str]:
        program = self.folder / "program"
        program.write_text(PROGRAM.replace("VALUE", value).replace("DEVICE", device).replace("FAIL", fail))
        program.chmod(0o755)
        return subprocess.run(["/usr/bin/python3", str(HERE / "run.py"), *scenes, "--out", str(self.folder / "out"),
                               "--program", str(program)], capture_output=True, text=True)

    def text(self) -> str:
        return (self.folder / "out" / "table.md").read_text()

    def rows(self) -> list[tuple[str, ...]]:
        """Scene, sampler, nee, chi2 of each."""
        cells = [tuple(c.strip() for c in line.split("|")[1:5]) for line in self.text().splitlines()
                 if line.startswith("| ")]
        return [(scene, sampler, nee, chi2.split()[0]) for scene, sampler, nee, chi2 in cells[1:]]

    def test_scenes_one_at_a_time_make_one_table_in_the_scenes_order(self) -> None:
        self.assertEqual(self.run_it("furnace").returncode, 0)
        self.assertEqual(self.run_it("simple", value="1.010").returncode, 0)
        self.assertEqual(self.rows(), [("simple", "bsdf", "none", "1.010"), ("simple", "bsdf", "one_ray", "1.010"),
                                       ("furnace", "bsdf", "none", "1.000"), ("furnace", "bsdf", "one_ray", "1.000")])
        self.assertIn("Measured on a card.", self.text())

    def test_a_scene_measured_again_replaces_its_rows_alone(self) -> None:
        self.run_it("simple", "glossy")
        self.run_it("simple", value="0.990")
        self.assertEqual([(r[0], r[3]) for r in self.rows()],
                         [("simple", "0.990"), ("simple", "0.990"), ("glossy", "1.000"), ("glossy", "1.000")])

    def test_rows_are_there_when_the_comparison_dies_and_other_scenes_are_measured_all_the_same(self) -> None:
        done = self.run_it("occluded", "glossy", fail="occluded")
        self.assertEqual(done.returncode, 1)
        self.assertIn("failed: occluded", done.stderr)
        self.assertEqual([r[0] for r in self.rows()], ["occluded", "glossy", "glossy"])

    def test_a_table_of_another_device_is_refused_and_stays(self) -> None:
        self.run_it("simple")
        before = self.text()
        done = self.run_it("glossy", device="another card")
        self.assertEqual(done.returncode, 1)
        self.assertIn("was measured on a card, but this is another card; move it away", done.stderr)
        self.assertEqual(self.text(), before)

    def test_a_file_comes_after_the_shipped_scenes(self) -> None:
        (self.folder / "attic.glb").touch()
        self.assertEqual(self.run_it(str(self.folder / "attic.glb"), "glossy").returncode, 0)
        self.assertEqual([r[0] for r in self.rows()], ["glossy", "glossy", "attic", "attic"])
        self.run_it("simple")
        self.assertEqual([r[0] for r in self.rows()], ["simple", "simple", "glossy", "glossy", "attic", "attic"])

    def test_a_file_with_the_name_of_a_shipped_scene_is_refused(self) -> None:
        (self.folder / "simple.glb").touch()
        done = self.run_it(str(self.folder / "simple.glb"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("has the name of a shipped scene; another name would be right", done.stderr)

    def test_scenes_are_those_of_the_comparison(self) -> None:
        listed = re.search(r"kScenes\{(.*?)\}", (HERE / "comparison.h").read_text(), re.DOTALL)
        self.assertEqual([name.split(".")[0] for name in re.findall(r'"(.*?)"', listed[1])], SCENES)

    def test_an_unknown_scene_and_a_foreign_file_are_refused(self) -> None:
        self.assertEqual(self.run_it("smple").returncode, 2)
        (self.folder / "out").mkdir()
        (self.folder / "out" / "table.md").write_text("| a | b |\n")
        done = self.run_it("simple")
        self.assertEqual(done.returncode, 1)
        self.assertIn("is not a table of this comparison; move it away", done.stderr)
        self.assertEqual(self.text(), "| a | b |\n")


if __name__ == "__main__":
    unittest.main()
