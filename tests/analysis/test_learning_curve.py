"""The learning curve shows the tables' own errors: known values, visited entries and direction bins alone."""

import json
from pathlib import Path

from support import FolderTest, METHODS, SNAPSHOTS, write_results

import numpy as np

from analysis.figures import main
from analysis.kinds.learning_curve import learning_figure, table_error, table_errors
from analysis.load import load

TRUTH = 2.0
BINS = 4


def error(method: str, seed: int, frame: int) -> float:
    return METHODS[method] * (0.8 + 0.1 * seed) / frame


class LearningTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        write_results(self.results, scenes=("simple",))
        for run in self.runs():
            manifest = {"config": {"sampler": "rl", "rl": {"bins_theta": 2, "bins_phi": 2}}}
            (run / "manifest.json").write_text(json.dumps(manifest))
            method = next(m for m in METHODS if m.lower().replace(", ", "-").replace(" ", "-") in run.name)
            for frame in SNAPSHOTS:
                self.write_table(run, frame, error(method, int(run.name[-1]), frame))

    def runs(self) -> list[Path]:
        return sorted(file.parent for file in self.results.glob("*/convergence.csv"))

    def write_table(self, run: Path, frame: int, relative: float) -> None:
        """Visited: two entries off by +-`relative`. Beside them unvisited ones, and learned lights."""
        values = np.full((3, BINS + 2), 999, np.float32)
        visits = np.zeros_like(values, dtype=np.uint32)
        values[0, 1], values[2, 3] = TRUTH * (1 + relative), TRUTH * (1 - relative)
        visits[0, 1], visits[2, 3] = 1, 70000
        visits[:, BINS:] = 5
        np.save(run / f"q_values_{frame:06}.npy", values)
        np.save(run / f"q_visits_{frame:06}.npy", visits)

    def test_errors_of_the_tables(self) -> None:
        for row in table_errors(load(self.results), TRUTH).itertuples():
            self.assertAlmostEqual(row.error / error(row.label, row.seed, row.frame), 1, places=5)

    def test_a_table_without_visits_has_no_error(self) -> None:
        run = self.runs()[0]
        np.save(run / "q_visits_000001.npy", np.zeros((3, BINS + 2), np.uint32))
        self.assertTrue(np.isnan(table_error(run, 1, TRUTH)))

    def test_a_line_per_configuration_over_frames(self) -> None:
        (axes,) = learning_figure(load(self.results), TRUTH).axes
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))
        lines = {line.get_label(): line for line in axes.lines}
        self.assertEqual(list(lines), list(METHODS))
        for method, line in lines.items():
            self.assertEqual(list(line.get_xdata()), SNAPSHOTS)
            wanted = [error(method, 2, frame) for frame in SNAPSHOTS]  # the seed in the middle
            np.testing.assert_allclose(line.get_ydata(), wanted, rtol=1e-5)
        self.assertEqual(len(axes.collections), len(METHODS))
        self.assertEqual(axes.get_title(loc="left"), "simple")

    def test_writes_a_figure(self) -> None:
        code, out, err = self.run_script(main, self.results, "--only", "learning_curve", "--truth", "2")
        file = self.results / "figures" / "learning_curve.png"
        self.assertEqual((code, out, err), (0, f"learning_curve: {file}\n", ""))
        self.assertTrue(file.read_bytes().startswith(b"\x89PNG"))

    def test_needs_the_truth_and_tables(self) -> None:
        self.check_fails("learning_curve: needs --truth RADIANCE", "--metric", "relmse")
        for file in self.results.glob("*/q_values_*.npy"):
            file.unlink()
        self.check_fails("no run has saved its table")

    def check_fails(self, words: str, *more: object) -> None:
        code, out, err = self.run_script(main, self.results, "--only", "learning_curve", *(more or ("--truth", "2")))
        self.assertEqual((code, out), (1, ""))
        self.assertRegex(err, f"^error: .*{words}.*\n$")

    def test_failures(self) -> None:
        self.check_fails("--truth is -1 but must be a radiance above zero", "--truth", "-1")
        run = self.runs()[0]
        (run / "q_visits_000001.npy").write_bytes(b"no array")
        self.check_fails("q_visits_000001.npy: cannot be read as a NumPy array")
        np.save(run / "q_visits_000001.npy", np.zeros(6, np.uint32))
        self.check_fails("q_visits_000001.npy: has 1 dimensions")
        np.save(run / "q_visits_000001.npy", np.zeros((2, 6), np.uint32))
        self.check_fails("values and visits of frame 1 have different sizes")
        (run / "q_values_000001.npy").unlink()
        self.check_fails("q_values_000001.npy: no such file; the config needs \"save_table\": \"snapshots\"")
        (run / "manifest.json").write_text('{"config": {"sampler": "bsdf"}}')
        self.check_fails("has learned no directions, because its sampler is bsdf")
        (run / "manifest.json").write_text("{}")
        self.check_fails("manifest.json: does not say how many direction bins")
