"""The one door: what is drawn of a folder and what is not; in print: widths, glyphs, the same bytes again, and points and
tables that hold what the files hold."""

import csv
import os
import re
import subprocess
import sys
import unittest

from support import METHODS, ROOT, SECONDS, FolderTest, relmse, write_csv, write_results

import numpy as np

from analysis import style
from analysis.figures import KINDS, main
from analysis.kinds.cost import cost_figure
from analysis.load import load
from analysis.statistics import estimate, t_quantile

NAMES = ["curves_relmse", "curves_relmse_simple_spp", "curves_relmse_simple_seconds", "cost_relmse_simple",
         "ablation_simple"]


def width_points(pdf: bytes) -> float:
    return float(re.search(rb"/MediaBox \[ 0 0 ([\d.]+)", pdf)[1])


class CostTest(FolderTest):
    def points(self, **options) -> dict:
        figure = cost_figure(load(write_results(self.results, **options)), "relmse", "simple")
        return {bars.get_label(): bars for bars in figure.axes[0].containers}

    def test_points_and_intervals(self) -> None:
        points = self.points()
        self.assertEqual(list(points), list(METHODS))
        for method, bars in points.items():
            line, _, (across, along) = bars.lines
            seconds = SECONDS[method] * 8 + 0.02
            self.assertAlmostEqual(line.get_xdata()[0], seconds, places=12)
            self.assertAlmostEqual(line.get_ydata()[0], METHODS[method] / 8, places=12)
            np.testing.assert_allclose(along.get_segments()[0][:, 1],
                                       METHODS[method] / 8 * np.exp([-t_quantile(2) * 0.1 / 3 ** 0.5,
                                                                     t_quantile(2) * 0.1 / 3 ** 0.5]), rtol=1e-12)
            time = estimate([SECONDS[method] * 8 + 0.01 * seed for seed in (1, 2, 3)])
            np.testing.assert_allclose(across.get_segments()[0][:, 0], [time.low, time.high], rtol=1e-12)

    def test_one_seed_has_no_bars(self) -> None:
        for bars in self.points(seeds=(2,)).values():
            self.assertEqual((bars.has_xerr, bars.has_yerr), (False, False))

    def test_diagonals_are_of_equal_error_times_time(self) -> None:
        results = load(write_results(self.results))
        for spread, step in ((1, 2), (1e4, 10)):
            results.configurations.loc[results.configurations.label == "RL", ["relmse", "relmse_low", "relmse_high"]] *= spread
            axes = cost_figure(results, "relmse", "simple").axes[0]
            products = [line.get_xdata() * line.get_ydata() for line in axes.lines if line.get_label() == "_diagonal"]
            self.assertGreater(len(products), 3)
            for before, product in zip(products, products[1:]):
                self.assertAlmostEqual(product[0] / product[1], 1, places=12)
                self.assertAlmostEqual(product[0] / before[0], step, places=9)


class PrintTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        write_results(self.results, scenes=("simple",))
        self.out = self.folder / "figures"

    def test_files(self) -> None:
        code, printed, err = self.run_script(main, self.results, "--out", self.out, "--format", "pdf,svg")
        self.assertEqual((code, err), (0, ""))
        expected = [f"{name}.{kind}" for name in NAMES for kind in ("pdf", "svg")] + \
                   [f"table.{kind}" for kind in ("csv", "md", "tex")]
        written = [line.rpartition("/")[2] for line in printed.splitlines() if "not drawn" not in line]
        self.assertEqual(written, expected)
        for name in NAMES:
            pdf = (self.out / f"{name}.pdf").read_bytes()
            look = style.PAGE if name in (NAMES[0], NAMES[4]) else style.COLUMN
            self.assertAlmostEqual(width_points(pdf), look.width * 72, delta=0.01)
            # Each font is in the file.
            self.assertEqual(pdf.count(b"/Type /FontDescriptor"), pdf.count(b"/FontFile2"))
            self.assertGreater(pdf.count(b"/FontFile2"), 0)
            self.assertNotIn(b"CreationDate", pdf)
            svg = (self.out / f"{name}.svg").read_text()
            self.assertNotIn("<text", svg)  # outlines: no font is needed
            self.assertNotIn("<dc:date>", svg)
        first = {file.name: file.read_bytes() for file in self.out.iterdir()}
        again = self.folder / "again"  # in another process, with other hashes
        subprocess.run([sys.executable, ROOT / "analysis/figures.py", self.results, "--out", again, "--format", "pdf,svg"], check=True,
                       stdout=subprocess.DEVNULL, env={**os.environ, "PYTHONHASHSEED": "7"})
        self.assertEqual(first, {file.name: file.read_bytes() for file in again.iterdir()})

    def test_table_and_ratios(self) -> None:
        write_csv(self.results / "ratios.csv",
                  [{"configuration": "simple / RL", "baseline": "simple / BSDF", "scene": "simple", "ratio_relmse": 2.5,
                    "ratio_relmse_low": 2.25, "ratio_relmse_high": 2.75}])
        self.assertEqual(self.run_script(main, self.results, "--out", self.out, "--only", "tables")[0], 0)
        with (self.out / "table.csv").open(newline="") as stream:
            rows = {row["method"]: row for row in csv.DictReader(stream)}
        self.assertEqual(list(rows), list(METHODS))
        expected = estimate([relmse("RL", seed, 8) for seed in (1, 2, 3)])
        for name, value in (("relmse", expected.mean), ("relmse_low", expected.low), ("relmse_high", expected.high)):
            self.assertEqual(float(rows["RL"][name]), value)
        self.assertIn("study, a device", (self.out / "table.md").read_text())
        ratios = (self.out / "ratios.tex").read_text()
        self.assertIn(r"simple & RL & $2.50$ {\scriptsize$[2.25,\,2.75]$} \\", ratios)
        self.assertIn("% study, baseline: BSDF. ", ratios)  # the same in all rows

    def test_failures(self) -> None:
        for arguments, words in ((("--metric", "bias"), "unknown metric 'bias'"),
                                 (("--format", "gif"), "unknown format 'gif'"),
                                 (("--only", "curves,plot"), "unknown kind 'plot'; known are curves, cost")):
            code, _, err = self.run_script(main, self.results, *arguments, "--out", self.out)
            self.assertEqual(code, 1)
            self.assertIn(words, err)
        self.assertEqual(self.run_script(main, self.folder / "nowhere")[::2],
                         (1, f"error: {self.folder / 'nowhere'}: no such folder; the folder of an experiment is needed, like "
                             "results/convergence\n"))


class DoorTest(FolderTest):
    """Whatever can be drawn is, and of the rest one line says why not."""

    def setUp(self) -> None:
        super().setUp()
        write_results(self.results, scenes=("simple",))

    def drawn(self, *arguments: object) -> tuple[int, dict[str, str], str]:
        """The first line about each kind."""
        code, out, err = self.run_script(main, self.results, *arguments)
        lines = [line.partition(": ")[::2] for line in out.splitlines()]
        return code, {kind: text for kind, text in reversed(lines)}, err

    def test_every_kind_is_spoken_of(self) -> None:
        code, lines, err = self.drawn()
        self.assertEqual((code, err, set(lines)), (0, "", set(KINDS)))
        for kind, reason in (("gains", "has no ratios.csv: its config names no baseline"),
                             ("sheets", "no run of simple has images"), ("inspect", "no run was inspected"),
                             ("learning_curve", "no run has saved its table")):
            self.assertRegex(lines[kind], f"^not drawn: .*{reason}")
        for kind in ("curves", "cost", "ablation", "tables"):
            self.assertTrue((self.results / "figures").samefile(lines[kind].rpartition("/")[0]), kind)

    def test_what_was_asked_for_by_name_must_be_drawn(self) -> None:
        code, lines, err = self.drawn("--only", "gains,ablation")
        self.assertEqual((code, set(lines)), (1, {"ablation"}))
        self.assertRegex(err, "^error: gains: .*names no baseline.*\n$")

    def test_published_results_have_no_files_of_runs(self) -> None:
        for run in self.results.glob("*/*.csv"):
            run.unlink()
        code, lines, err = self.drawn()
        self.assertEqual((code, err), (0, ""))
        self.assertIn("not drawn", lines["curves"])
        self.assertIn("cost_relmse_simple.png", lines["cost"])

    def test_what_is_damaged_is_an_error_in_any_case(self) -> None:
        file = self.results / "scene=simple,method=nee-two-rays,seed=1" / "convergence.csv"
        file.write_text(file.read_text().replace("0.9", "much", 1))
        code, lines, err = self.drawn()
        self.assertEqual(code, 1)
        self.assertRegex(err, "^error: curves: .*convergence.csv: column '.*' holds something that is not a number")
        self.assertIn("ablation_simple.png", lines["ablation"])

    def test_a_folder_of_which_nothing_can_be_drawn(self) -> None:
        self.results = self.folder / "empty"
        self.results.mkdir()
        code, lines, err = self.drawn()
        self.assertEqual(code, 1)
        self.assertIn("has no summary.csv, so it is not the folder of an experiment", err)


if __name__ == "__main__":
    unittest.main()
