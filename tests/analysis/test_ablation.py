"""The figure holds what the runs ended with: points, bars, their order and words."""

from support import FolderTest, METHODS, SECONDS, SNAPSHOTS, relmse, write_results

import numpy as np
from matplotlib.text import Text

from analysis.command import MissingError
from analysis.figures import main
from analysis.kinds.ablation import ablation_figure
from analysis.load import load
from analysis.statistics import estimate

LAST = SNAPSHOTS[-1]


def products(method: str, scene: str) -> list[float]:
    return [relmse(method, seed, LAST, scene) * (SECONDS[method] * LAST + 0.01 * seed) for seed in (1, 2, 3)]


def errors(method: str, scene: str) -> list[float]:
    return [relmse(method, seed, LAST, scene) for seed in (1, 2, 3)]


def points(axes) -> dict[int, float]:
    """The drawn means by line, filled and hollow ones."""
    drawn = {}
    for line in axes.lines:
        if line.get_marker() == "o":
            drawn.update(zip(line.get_ydata().tolist(), line.get_xdata().tolist()))
    return drawn


def texts(figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(Text) if text.get_visible())


class FigureTest(FolderTest):
    def test_points_and_bars_in_the_order_of_the_sweep(self) -> None:
        results = load(write_results(self.results))
        for scene in ("simple", "occluded"):
            left, right = ablation_figure(results, scene).axes
            self.assertEqual([label.get_text() for label in left.get_yticklabels()], list(METHODS))
            bottom, top = left.get_ylim()
            self.assertGreater(bottom, top)  # line 0 on top
            for axes, values in ((left, errors), (right, products)):
                self.assertEqual(axes.get_xscale(), "log")
                bars = axes.collections[0].get_segments()
                for i, method in enumerate(METHODS):
                    wanted = estimate(values(method, scene))
                    self.assertAlmostEqual(points(axes)[i], wanted.mean, places=12)
                    np.testing.assert_allclose(bars[i], [(wanted.low, i), (wanted.high, i)], rtol=1e-12)

    def test_all_means_lie_inside_the_axes_whatever_the_bars(self) -> None:
        results = load(write_results(self.results, seeds=(1, 2)))
        results.configurations["relmse_high"] *= 1e4  # two seeds: bars of decades
        results.configurations["relmse_low"] /= 1e4
        for axes in ablation_figure(results, "simple").axes:
            low, high = axes.get_xlim()
            means = points(axes).values()
            self.assertTrue(low < min(means) and max(means) < high)
            self.assertLess(high / low, 1e6)

    def test_configurations_at_the_floor_are_hollow(self) -> None:
        results = load(write_results(self.results))
        results.configurations.loc[results.configurations.configuration == "simple / BSDF", "seeds_at_reference_floor"] = 1
        figure = ablation_figure(results, "simple")
        for axes in figure.axes:
            dots = [line for line in axes.lines if line.get_marker() == "o"]
            lines = {line.get_markerfacecolor() == "white": list(line.get_ydata()) for line in dots}
            self.assertEqual(lines, {True: [1], False: [0, 2]})
        self.assertIn("Hollow", texts(figure))
        self.assertNotIn("Hollow", texts(ablation_figure(results, "occluded")))

    def test_words(self) -> None:
        words = texts(ablation_figure(load(write_results(self.results)), "occluded"))
        for part in ("study: 3 seeds, 8 frames", "occluded", "relMSE at the last frame", "relMSE × s",
                     "95 % confidence", *METHODS):
            self.assertIn(part, words)

    def test_one_seed_has_no_bar_and_says_so(self) -> None:
        figure = ablation_figure(load(write_results(self.results, seeds=(2,))), "simple")
        self.assertIn("One seed per configuration: there is no confidence interval.", texts(figure))
        self.assertFalse(any(axes.collections for axes in figure.axes))
        self.assertEqual(points(figure.axes[0]), {i: relmse(method, 2, LAST) for i, method in enumerate(METHODS)})


class CommandTest(FolderTest):
    def test_writes_a_figure_per_scene_and_says_which(self) -> None:
        write_results(self.results)
        code, out, err = self.run_script(main, self.results, "--only", "ablation")
        files = [self.results / "figures" / f"ablation_{scene}.png" for scene in ("simple", "occluded")]
        self.assertEqual((code, out, err), (0, "".join(f"ablation: {file}\n" for file in files), ""))
        for file in files:
            self.assertTrue(file.read_bytes().startswith(b"\x89PNG"))

    def test_needs_no_files_of_runs(self) -> None:
        write_results(self.results)
        for file in self.results.glob("*/*.csv"):
            file.unlink()
        self.assertEqual(self.run_script(main, self.results, "--only", "ablation")[0], 0)

    def test_failures(self) -> None:
        results = load(write_results(self.results))
        results.configurations["relmse"] = 0.0
        with self.assertRaisesRegex(MissingError, "no relMSE of simple is above zero"):
            ablation_figure(results, "simple")
        (self.results / "configurations.csv").unlink()
        code, out, err = self.run_script(main, self.results, "--only", "ablation", "--out", self.folder / "figures")
        self.assertEqual((code, out), (1, ""))
        self.assertRegex(err, "^error: ablation: .*configurations.csv: no such file\n$")
