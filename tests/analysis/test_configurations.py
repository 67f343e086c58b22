"""configurations.csv and ratios.csv of a real run, computed again from the files of its runs: the program and the oracle
agree. Its manifest says what the metrics are called."""

import json
import math
import os
import subprocess
import unittest

from support import ROOT, FolderTest

from analysis.csv_file import read_csv
from analysis.load import LoadError, load
from analysis.metrics import errors
from analysis.schema import SCHEMA
from analysis.welch import ratio_of_means
from records_oracle import ENDS, curve_ratio, curves_of, figure_ends, log_error_ratio, log_time_ratio, slope, time_until

BINARY = os.environ.get("QTRACE_BINARY")  # ctest sets it
RATIO_FIGURES = ("host_ms_median", "gpu_ms_median", "mse", "relmse", "relmse_trimmed", "relmse_x_s")


@unittest.skipUnless(BINARY, "needs QTRACE_BINARY, the program; ctest names it")
class ConfigurationsTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        config = {"name": "study", "scene": str(ROOT / "configs/scenes/simple.glb"), "width": 8, "height": 8,
                  "frames": 16, "flip": True, "reference": {"frames": 256}, "baseline": "uniform",
                  "sweep": [{"sampler": ["uniform", "bsdf"]}, {"seed": [1, 2, 3, 4, 5]}]}
        (self.folder / "study.json").write_text(json.dumps(config), encoding="utf-8")
        subprocess.run([BINARY, "run", "study.json"], cwd=self.folder, check=True, capture_output=True)
        self.results = self.folder / "results" / "study"
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

    def test_configurations(self) -> None:
        written = read_csv(self.results / "configurations.csv", ["configuration"])
        figures = [name.removesuffix("_sd") for name in written.columns if name.endswith("_sd")]
        self.assertGreater(len(figures), 20)
        signed = {metric.name for metric in self.loaded.metrics.values() if metric.is_signed}
        runs = self.loaded.finished
        self.assertEqual(list(written.configuration), list(runs.configuration.unique()))
        for _, row in written.iterrows():
            group = runs[runs.configuration == row.configuration]
            self.assertEqual([row.frames, row.runs, row.seeds], [16, 5, 5])
            for figure in figures:
                expected = figure_ends(group[figure], figure in signed)
                for end in ENDS:
                    self.agree(row[figure + end], expected[end], expected[""], figure + end)
        self.assertGreater(self.compared, 2 * 4 * 17)

    def test_the_manifest_names_every_figure(self) -> None:
        convergence, table = self.loaded.convergence, self.loaded.configurations
        metrics = self.loaded.metrics
        averaged = {name.removesuffix("_sd") for name in table.columns if name.endswith("_sd")}
        self.assertEqual({metric.name for metric in metrics.values() if metric.per_configuration}, averaged)
        self.assertTrue(all(metric.label for metric in metrics.values()))
        self.assertTrue(all(metric.formula for metric in metrics.values()))
        found = {metric.name for metric in errors(metrics.values())}
        self.assertTrue({"mse", "relmse", "relmse_trimmed", "mape", "smape", "flip"} <= found, found)
        self.assertTrue(found <= set(convergence.columns), found)

    def test_runs(self) -> None:
        """What the summary takes from the frames and the snapshots."""
        for run in self.loaded.finished.itertuples():
            frames = self.loaded.frames[self.loaded.frames.run == run.run]
            curve = self.loaded.convergence[self.loaded.convergence.run == run.run]
            for metric in ("mse", "relmse"):
                self.agree(getattr(run, f"slope_{metric}"), slope(curve, metric), 1, f"slope_{metric}")
            self.agree(run.host_ms_median, frames[~frames.is_warmup].host_ms.median(), 0, "host_ms_median")
            self.agree(run.relmse_x_s, curve.relmse.iloc[-1] * curve.elapsed_s.iloc[-1], 0, "relmse_x_s")
        self.assertEqual(self.compared, 10 * 4)

    def test_ratios(self) -> None:
        (_, row), = self.loaded.ratios.iterrows()
        self.assertEqual((row.configuration, row.baseline, row.label, row.baseline_label),
                         ("bsdf", "uniform", "bsdf", "uniform"))
        runs = self.loaded.finished
        baseline, other = runs[runs.configuration == "uniform"], runs[runs.configuration == "bsdf"]
        expected = {f"ratio_{name}": ratio_of_means(baseline[name], other[name]) for name in RATIO_FIGURES}
        convergence = self.loaded.convergence
        for metric in ("mse", "relmse"):
            sides = [curves_of(convergence[convergence.configuration == name], metric) for name in ("uniform", "bsdf")]
            target = baseline[metric].mean()
            self.agree(row[f"target_{metric}"], target, 0, "target")
            expected[f"time_to_{metric}_s"] = time_until(sides[1], target)
            expected[f"ratio_time_to_{metric}"] = curve_ratio(*sides, log_time_ratio)
            corrected = [curves_of(convergence[convergence.configuration == name], f"{metric}_corrected")
                         for name in ("uniform", "bsdf")]
            expected[f"ratio_equal_s_{metric}_corrected"] = curve_ratio(*corrected, log_error_ratio)
        for name, comparison in expected.items():
            self.assertIsNotNone(comparison, name)
            for end, value in (("", comparison.ratio), ("_low", comparison.low), ("_high", comparison.high)):
                self.agree(row[name + end], value, 0, name + end)
        self.assertGreater(self.compared, 2 + 3 * 10)
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
