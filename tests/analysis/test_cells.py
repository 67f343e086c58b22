"""cells.csv and ratios.csv of a real run, computed again from the files of its runs: the program and analysis agree."""

import json
import math
import os
import subprocess
import unittest

from support import ROOT, FolderTest

from analysis.csv_file import read_csv
from analysis.load import SCHEMA, LoadError, load
from analysis.ratios import (FIGURES, cells_of, curves_of, ratio_of_means, slope, time_ratio, time_until)

BINARY = os.environ.get("QTRACE_BINARY")  # ctest sets it
ENDS = ("", "_sd", "_low", "_high")
RATIO_FIGURES = ("host_ms_median", "gpu_ms_median", "mse", "relmse", "relmse_trimmed", "relmse_x_s")


@unittest.skipUnless(BINARY, "needs QTRACE_BINARY, the program; ctest names it")
class CellsTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        config = {"name": "cells", "scene": str(ROOT / "configs/scenes/simple.glb"), "width": 8, "height": 8,
                  "frames": 16, "flip": True, "reference": {"frames": 256}, "baseline": "uniform",
                  "sweep": [{"sampler": ["uniform", "bsdf"]}, {"seed": [1, 2, 3, 4]}]}
        (self.folder / "cells.json").write_text(json.dumps(config), encoding="utf-8")
        subprocess.run([BINARY, "run", "cells.json"], cwd=self.folder, check=True, capture_output=True)
        self.results = self.folder / "results" / "cells"
        self.loaded = load(self.results)
        self.compared = 0

    def agree(self, found: float, expected: float, scale: float, what: str) -> None:
        """To 12 digits of the larger of the value and what it was computed from: an end near zero has the rounding of
        the mean."""
        if math.isnan(expected):
            self.assertTrue(math.isnan(found), what)
            return
        self.assertLessEqual(abs(found - expected), 1e-12 * max(abs(expected), abs(scale)), what)
        self.compared += 1

    def test_cells(self) -> None:
        written = read_csv(self.results / "cells.csv", ["cell"])
        figures = {name.removesuffix("_sd") for name in written.columns if name.endswith("_sd")}
        self.assertEqual(figures, set(FIGURES))
        computed = cells_of(self.loaded.summary)
        self.assertEqual(list(computed.cell), list(written.cell))
        for (_, cell), (_, expected) in zip(written.iterrows(), computed.iterrows()):
            self.assertEqual([cell[name] for name in ("scene", "frames", "runs", "seeds")],
                             [expected[name] for name in ("scene", "frames", "runs", "seeds")])
            for figure in FIGURES:
                for end in ENDS:
                    self.agree(cell[figure + end], expected[figure + end], expected[figure], figure + end)
        self.assertGreater(self.compared, 2 * 4 * 17)

    def test_runs(self) -> None:
        """What the summary takes from the frames and the snapshots."""
        for run in self.loaded.finished.itertuples():
            frames = self.loaded.frames[self.loaded.frames.run == run.run]
            curve = self.loaded.convergence[self.loaded.convergence.run == run.run]
            for metric in ("mse", "relmse"):
                self.agree(getattr(run, f"slope_{metric}"), slope(curve, metric), 1, f"slope_{metric}")
            self.agree(run.host_ms_median, frames[~frames.is_warmup].host_ms.median(), 0, "host_ms_median")
            self.agree(run.relmse_x_s, curve.relmse.iloc[-1] * curve.elapsed_s.iloc[-1], 0, "relmse_x_s")
        self.assertEqual(self.compared, 8 * 4)

    def test_ratios(self) -> None:
        (_, row), = self.loaded.ratios.iterrows()
        self.assertEqual((row.cell, row.baseline, row.label, row.baseline_label),
                         ("bsdf", "uniform", "bsdf", "uniform"))
        runs = self.loaded.finished
        baseline, cell = runs[runs.cell == "uniform"], runs[runs.cell == "bsdf"]
        expected = {f"ratio_{name}": ratio_of_means(baseline[name], cell[name]) for name in RATIO_FIGURES}
        convergence = self.loaded.convergence
        for metric in ("mse", "relmse"):
            sides = [curves_of(convergence[convergence.cell == name], metric) for name in ("uniform", "bsdf")]
            target = baseline[metric].mean()
            self.agree(row[f"target_{metric}"], target, 0, "target")
            expected[f"time_to_{metric}_s"] = time_until(sides[1], target)
            expected[f"ratio_time_to_{metric}"] = time_ratio(*sides)
        for name, comparison in expected.items():
            self.assertIsNotNone(comparison, name)
            for end, value in (("", comparison.ratio), ("_low", comparison.low), ("_high", comparison.high)):
                self.agree(row[name + end], value, 0, name + end)
        self.assertGreater(self.compared, 2 + 3 * 8)
        (self.results / "ratios.csv").unlink()
        with self.assertRaisesRegex(LoadError, "names no baseline"):
            load(self.results).ratios

    def test_schema(self) -> None:
        """Every manifest says by which contract the files are to be read."""
        self.assertEqual(self.loaded.schema, SCHEMA)
        for manifest in self.results.glob("*/manifest.json"):
            self.assertEqual(json.loads(manifest.read_text())["schema"], SCHEMA)


if __name__ == "__main__":
    unittest.main()
