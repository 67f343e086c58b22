"""The figure holds what the files hold: lines, bands, floors, marks and words."""

import json

from support import FolderTest, METHODS, REFERENCE_NOISE, SECONDS, SNAPSHOTS, relmse, write_results

import numpy as np

from analysis.figures import main
from analysis.kinds.curves import convergence_figure
from analysis.load import load
from analysis.statistics import t_quantile


def labelled(artists: list, ending: str = "") -> dict:
    return {artist.get_label(): artist for artist in artists if str(artist.get_label()).endswith(ending)}


def texts(figure) -> str:
    """Every word that the figure shows."""
    from matplotlib.text import Text
    return "\n".join(text.get_text() for text in figure.findobj(Text) if text.get_visible())


class FigureTest(FolderTest):
    def figure(self, metric: str = "relmse", **options):
        return convergence_figure(load(write_results(self.results, **options)), metric)

    def test_a_row_per_scene_and_a_line_and_band_per_configuration(self) -> None:
        figure = self.figure()
        self.assertEqual(len(figure.axes), 2 * 2)
        for axes in figure.axes:
            lines = [line.get_label() for line in axes.lines if not line.get_label().startswith("_")]
            self.assertEqual(lines, list(METHODS))
            self.assertEqual(set(labelled(axes.collections)), {f"_{method} band" for method in METHODS})
            self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))
        self.assertEqual([axes.get_title(loc="left") for axes in figure.axes], ["simple", "", "occluded", ""])

    def test_drawn_values_are_those_of_the_files(self) -> None:
        figure = self.figure()
        for scene, row in zip(("simple", "occluded"), (figure.axes[:2], figure.axes[2:])):
            for method in METHODS:
                mean = [np.mean([relmse(method, seed, frame, scene) for seed in (1, 2, 3)]) for frame in SNAPSHOTS]
                seconds = [SECONDS[method] * frame + 0.02 for frame in SNAPSHOTS]
                for axes, x in zip(row, (SNAPSHOTS, seconds)):
                    line = labelled(axes.lines)[method]
                    np.testing.assert_allclose(line.get_xdata(), x, rtol=1e-14)
                    np.testing.assert_allclose(line.get_ydata(), mean, rtol=1e-14)

    def test_band_is_the_interval(self) -> None:
        for axes in self.figure().axes[:2]:
            corners = labelled(axes.collections)["_RL band"].get_paths()[0].vertices
            factor = np.exp(t_quantile(2) * 0.1 / np.sqrt(3))
            self.assertAlmostEqual(corners[:, 1].max(), 4 * factor, places=9)
            self.assertAlmostEqual(corners[:, 1].min(), 4 / 8 / factor, places=9)

    def test_floor_and_points_at_it(self) -> None:
        results = load(write_results(self.results))
        results.convergence.loc[(results.convergence.label == "RL") & (results.convergence.frame == 8),
                                "at_reference_floor"] = True
        for axes in convergence_figure(results, "relmse").axes:
            self.assertEqual(set(labelled(axes.lines)["_floor"].get_ydata()), {REFERENCE_NOISE["reference_relmse"]})
            filled, hollow = labelled(axes.lines)["RL"], labelled(axes.lines)["_RL at floor"]
            self.assertEqual(list(filled.get_markevery()), [True, True, True, False])
            self.assertEqual(list(hollow.get_markevery()), [False, False, False, True])
            self.assertEqual(hollow.get_markerfacecolor(), "white")
            self.assertNotIn("_BSDF at floor", labelled(axes.lines))

    def test_floor_follows_the_metric(self) -> None:
        axes = self.figure("mse").axes[0]
        self.assertEqual(axes.lines[-1].get_ydata()[0], REFERENCE_NOISE["reference_mse"])
        figure = convergence_figure(load(self.results), "mape")
        self.assertNotIn("_floor", labelled(figure.axes[0].lines))
        self.assertIn("not known in this metric", texts(figure))

    def test_errors_that_only_some_runs_have(self) -> None:
        results = load(write_results(self.results))
        results.convergence.loc[results.convergence.label == "RL", "flip"] = 0.25
        lines = labelled(convergence_figure(results, "flip").axes[0].lines)
        self.assertEqual(list(lines["RL"].get_ydata()), [0.25] * 4)
        self.assertTrue(np.isnan(lines["BSDF"].get_ydata()).all())

    def test_distant_floor_is_named_rather_than_drawn(self) -> None:
        results = load(write_results(self.results))
        results.convergence["reference_relmse"] = 1e-9
        figure = convergence_figure(results, "relmse")
        self.assertNotIn("_floor", labelled(figure.axes[0].lines))
        self.assertIn("1e-09, below this axis", texts(figure))
        self.assertGreater(figure.axes[0].get_ylim()[0], 0.01)

    def test_words(self) -> None:
        words = texts(self.figure())
        for part in ("study: 3 seeds, 8 frames", "samples per pixel (spp)", "render time (s)", "relMSE", "a device",
                     "reference's own noise: 0.01", "95 % confidence", *METHODS):
            self.assertIn(part, words)

    def test_one_seed_has_no_band_and_says_so(self) -> None:
        figure = self.figure(seeds=(2,))
        self.assertFalse(any(axes.collections for axes in figure.axes))
        self.assertIn("1 seed,", texts(figure))
        self.assertIn("One seed per line: there is no confidence band.", texts(figure))
        self.assertNotIn("95 % confidence of", texts(figure))

    def test_unfinished_experiment_says_so(self) -> None:
        write_results(self.results)
        self.edit("summary.csv", lambda text: text.replace("simple,1,finished", "simple,1,failed"))
        words = texts(convergence_figure(load(self.results), "relmse"))
        self.assertIn("study: 2 to 3 seeds, 8 frames, 15 of 18 runs", words)

    def test_styles_differ_and_agree_between_panels(self) -> None:
        figure = self.figure()
        looks = [[(line.get_color(), line.get_marker()) for line in axes.lines if line.get_label() in METHODS]
                 for axes in figure.axes]
        self.assertEqual(len(set(looks[0])), 3)
        self.assertTrue(all(look == looks[0] for look in looks))

    def test_a_seed_that_is_not_a_number_leaves_a_gap(self) -> None:
        results = load(write_results(self.results))
        results.convergence.loc[0, "relmse"] = np.nan
        line = labelled(convergence_figure(results, "relmse").axes[0].lines)["NEE, two rays"]
        self.assertEqual(list(np.isnan(line.get_ydata())), [True, False, False, False])


class CommandTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        write_results(self.results)

    def test_writes_into_the_results_and_says_what(self) -> None:
        code, out, err = self.run_script(main, self.results, "--only", "curves")
        file = self.results / "figures" / "curves_relmse.png"
        self.assertEqual((code, out, err), (0, f"curves: {file}\n", ""))
        self.assertTrue(file.read_bytes().startswith(b"\x89PNG"))

    def test_out_metric_and_formats(self) -> None:
        out = self.folder / "new" / "figures"
        only = ("--only", "curves", "--metric", "mse", "--out", out)
        code, printed, _ = self.run_script(main, self.results, *only, "--format", "png,svg")
        names = ["curves_mse.png", "curves_mse.svg",
                 *(f"curves_mse_{scene}_{x}.svg" for scene in ("simple", "occluded") for x in ("spp", "seconds"))]
        self.assertEqual((code, [line.rpartition("/")[2] for line in printed.splitlines()]), (0, names))
        self.assertEqual(sorted(file.name for file in out.iterdir()), sorted(names))
        first = (out / "curves_mse.svg").read_bytes()
        self.run_script(main, self.results, *only, "--format", "svg")
        self.assertEqual(first, (out / "curves_mse.svg").read_bytes())

    def test_a_metric_that_only_the_manifest_knows(self) -> None:
        """Label and unit are its; nothing in Python names it."""
        entry = {"name": "gpu_elapsed_s", "label": "a new metric", "unit": "furlongs", "signed": False,
                 "per_configuration": True, "error": True, "formula": "f", "source": "s"}
        self.edit("manifest.json", lambda text: text.replace('"metrics": [', f'"metrics": [{json.dumps(entry)}, '))
        figure = convergence_figure(load(self.results), "gpu_elapsed_s")
        self.assertEqual(figure.axes[0].get_ylabel(), "a new metric (furlongs)")

    def check_fails(self, words: str, *arguments: object) -> None:
        code, out, err = self.run_script(main, *arguments, "--only", "curves")
        self.assertEqual((code, out), (1, ""))
        self.assertRegex(err, f"^error: .*{words}.*\n$")

    def test_failures(self) -> None:
        self.check_fails("no such folder", self.folder / "nowhere")
        self.check_fails("curves: unknown metric 'bias'; known are mse, relmse", self.results, "--metric", "bias")
        self.check_fails('no flip was measured: "flip": true in the config', self.results, "--metric", "flip")
        self.check_fails("unknown format 'gif'", self.results, "--format", "png,gif")
        (self.folder / "file").write_text("")
        self.check_fails("cannot be written", self.results, "--out", self.folder / "file")
        for file in self.results.glob("*/convergence.csv"):
            file.write_text(file.read_text().splitlines()[0] + "\n")
        self.check_fails("nothing to draw", self.results)
