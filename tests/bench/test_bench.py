"""The benchmark as its user runs it, at tiny sizes: its files, their figures, and whether it notices wrong answers."""

from __future__ import annotations

import csv
import json
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DEV = ROOT / "dev"
# Turns the signs of ray directions around in the box tests.
WRONG = "wrong:lessThan=greaterThan"


def rows_of(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream, strict=True))


class BenchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = tempfile.TemporaryDirectory()
        cls.out = Path(cls.temporary.name) / "bench"
        cls.done = subprocess.run([DEV, "bench", "--quick", "--size", "32", "--rounds", "3", "--scenes",
                                   "room:2000,configs/scenes/simple.glb", "--variant", WRONG, "--out", cls.out],
                                  cwd=ROOT, capture_output=True, text=True, timeout=1200)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.temporary.cleanup()

    def setUp(self) -> None:
        self.assertEqual(self.done.returncode, 0, self.done.stderr)

    def test_rays_of_every_kind_beside_embree(self) -> None:
        rows = rows_of(self.out / "rays.csv")
        kinds = ["primary", "diffuse bounce", "shadow"]
        tracers = ["Embree", "qtrace", "threaded", "wrong"]
        self.assertEqual([(row["scene"], row["kind"], row["tracer"]) for row in rows],
                         [(scene, kind, tracer) for scene in ("room:2000", "simple") for kind in kinds for tracer in tracers])
        for row in rows:
            self.assertEqual(row["rounds"], "3")
            # In closed rooms every ray of the camera meets something; not everything faces the light.
            (self.assertEqual if row["kind"] != "shadow" else self.assertGreater)(1024, int(row["rays"]))
            self.assertGreater(float(row["mrays_per_s"]), 0)
            self.assertLessEqual(float(row["speed_over_embree_low"]), float(row["speed_over_embree_high"]))
            if row["tracer"] == "Embree":
                self.assertEqual((float(row["speed_over_embree"]), row["disagreements"]), (1, "0"))
            elif row["tracer"] == "wrong":
                self.assertGreater(int(row["disagreements"]), 20, row)
            else:
                self.assertLess(int(row["disagreements"]), 3, row)
        self.assertEqual(len(rows_of(self.out / "ray_rounds.csv")), 3 * len(rows))

    def test_rays_against_the_limits_of_the_device(self) -> None:
        rows = rows_of(self.out / "limits.csv")
        self.assertEqual(len(rows), 6)
        for row in rows:
            # Every walk meets the root; a leaf has four triangles at most.
            self.assertGreaterEqual(float(row["nodes_per_ray"]), 1)
            self.assertLess(float(row["nodes_per_ray"]), 200)
            self.assertLess(float(row["triangles_per_ray"]), 4 * float(row["nodes_per_ray"]))
            for share in ("arithmetic_share", "memory_share"):
                self.assertTrue(0 < float(row[share]) < 1, row)
            rate, operations = 1e6 * float(row["mrays_per_s"]), 1e9 * float(row["limit_goperations_per_s"])
            self.assertAlmostEqual(float(row["arithmetic_share"]) / (rate / operations), 62 * float(row["nodes_per_ray"]) +
                                   45 * float(row["triangles_per_ray"]), delta=0.5 * 62 * float(row["nodes_per_ray"]))

    def test_every_cell_of_the_table(self) -> None:
        rows = rows_of(self.out / "frames.csv")
        self.assertEqual(len(rows), 12)
        for row in rows:
            # The host hands work over; on a software device it would be the whole frame if it computed itself.
            self.assertLess(float(row["host_ms"]), 0.5 * float(row["wall_ms"]), row)
            if row["method"] == "BSDF":
                self.assertEqual(float(row["over_plain"]), 1)
            if row["method"] == "NEE, two rays":
                self.assertGreater(float(row["cpu_over_plain"]), 1.3, row)

    def test_steps_make_up_the_frame(self) -> None:
        rows = rows_of(self.out / "steps.csv")
        cells = {(row["scene"], row["method"]) for row in rows}
        self.assertEqual(len(cells), 4)
        for cell in cells:
            shares = {row["step"]: float(row["cpu_share"]) for row in rows if (row["scene"], row["method"]) == cell}
            self.assertEqual(shares.pop("whole frame"), 1)
            self.assertEqual(len(shares), 6)
            self.assertAlmostEqual(sum(shares.values()), 1, delta=0.3)

    def test_designs_beside_the_frame(self) -> None:
        rows = rows_of(self.out / "designs.csv")
        for scene in ("simple", "room:200000"):
            over = {row["design"]: float(row["cpu_over_frame"]) for row in rows if row["scene"] == scene}
            self.assertEqual(over.pop("the frame: one kernel"), 1)
            self.assertEqual(len(over), 7)
            self.assertGreater(min(over.values()), 0)
            queries, states, both = (over[f"wavefront: {what}"] for what in
                                     ("its ray queries", "its path states", "both, without shading"))
            # Medians of ratios, by so few rounds, add up nearly.
            self.assertAlmostEqual(queries + states, both, delta=0.3 * both)

    def test_features_beside_the_plain_frame(self) -> None:
        rows = rows_of(self.out / "features.csv")
        self.assertEqual(float(rows[0]["cpu_over_plain"]), 1)
        self.assertEqual(len(rows), 11)
        self.assertGreater(min(float(row["over_plain_low"]) for row in rows), 0.3)

    def test_texels_in_every_way(self) -> None:
        rows = rows_of(self.out / "texels.csv")
        self.assertEqual(len(rows), 8)
        self.assertEqual(float(rows[0]["over_first"]), 1)
        self.assertGreater(min(float(row["cpu_ns_low"]) for row in rows), 0)

    def test_growth_along_every_axis(self) -> None:
        rows = rows_of(self.out / "growth.csv")
        values = {}
        for row in rows:
            values.setdefault((row["axis"], row["method"]), []).append((float(row["value"]), float(row["cpu_over_first"])))
        self.assertEqual({axis for axis, _ in values}, {"triangles", "sites per object", "bins", "bounces", "pixels"})
        for (axis, method), points in values.items():
            self.assertEqual(points[0][1], 1)
            self.assertEqual([value for value, _ in points], sorted({value for value, _ in points}))
        self.assertGreater(values["pixels", "BSDF"][-1][1], 4)  # for 16 times the pixels
        self.assertGreater(values["bounces", "BSDF"][-1][1], 1.5)

    def test_the_page_and_what_was_measured_on(self) -> None:
        self.assertTrue((self.out / "bench.png").read_bytes().startswith(b"\x89PNG"))
        manifest = json.loads((self.out / "manifest.json").read_text())
        self.assertIn(manifest["embree"][:2], ("3.", "4."))

    def test_what_is_wrong_is_said_before_the_work(self) -> None:
        for arguments, words in {("--scenes", "room:7"): "room: is followed by a number of triangles",
                                 ("--scenes", "room:500,absent.glb"): "absent.glb': no such file",
                                 ("--variant", ":A=1"): "starts with a name"}.items():
            out = Path(self.temporary.name) / "unused"
            done = subprocess.run([DEV, "bench", *arguments, "--only", "rays", "--out", out], cwd=ROOT,
                                  capture_output=True, text=True, timeout=600)
            self.assertEqual(done.returncode, 1)
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
