"""The figure of gains over the baseline holds the ratios of ratios.csv: points, bars, their lines and words."""

from support import FolderTest, write_csv, write_results

import numpy as np
from matplotlib.container import ErrorbarContainer

from analysis.figures import main
from analysis.kinds.gains import AT_EQUAL_SECONDS, PANELS, gain_figure, read_gains
from analysis.load import load

GAINS = {("simple", "RL"): 1.5, ("simple", "BSDF"): 0.25, ("occluded", "RL"): 3.0, ("occluded", "BSDF"): 0.5}


def ratios(gain: float, reaches: bool) -> dict[str, object]:
    row = {}
    for place, column in enumerate(PANELS):
        value = gain * (1 + place)
        is_there = reaches or column != "ratio_time_to_mse"
        for end, factor in (("", 1), ("_low", 0.8), ("_high", 1.25)):
            row[column + end] = value * factor if is_there else ""
    return row


class GainFigureTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        write_results(self.results)
        write_csv(self.results / "ratios.csv",
                  [{"configuration": f"{scene} / {method}", "baseline": f"{scene} / NEE, two rays", "scene": scene, "target_mse": 0.1,
                    "target_relmse": 0.1, "ratio_time_to_relmse": "", **ratios(gain, method == "RL")}
                   for (scene, method), gain in GAINS.items()])

    def drawn(self, *methods: str) -> list[dict[str, ErrorbarContainer]]:
        figure = gain_figure(read_gains(load(self.results), list(methods)), "study")
        return [{bars.get_label(): bars for bars in axes.containers} for axes in figure.axes]

    def test_points_and_bars_are_those_of_the_file(self) -> None:
        for place, panel in enumerate(self.drawn()):
            for method in ("RL", "BSDF"):
                expected = [GAINS[scene, method] * (1 + place) for scene in ("simple", "occluded")]
                points, _, (bars,) = panel[method]
                if method == "BSDF" and place == 2:  # that error it never reached
                    self.assertEqual(len(points.get_xdata()), 0)
                    continue
                np.testing.assert_allclose(np.array(points.get_xdata(), float), expected)
                ends = [[segment[0][0], segment[1][0]] for segment in bars.get_segments()]
                np.testing.assert_allclose(ends, [[0.8 * value, 1.25 * value] for value in expected])
                np.testing.assert_array_equal(np.round(np.array(points.get_ydata(), float)), [0, 1])

    def test_only_the_methods_that_are_wanted(self) -> None:
        self.assertEqual([list(panel) for panel in self.drawn("RL")], [["RL"]] * 3)
        code, _, err = self.run_script(main, self.results, "--only", "gains", "--method", "RL + NEE")
        self.assertEqual((code, err), (1, "error: gains: unknown method 'RL + NEE'; known are RL, BSDF\n"))

    def test_results_of_earlier_programs(self) -> None:
        """They have relMSE x seconds in place of errors after equal seconds."""
        file = self.results / "ratios.csv"
        file.write_text(file.read_text().replace(AT_EQUAL_SECONDS, "ratio_relmse_x_s"))
        figure = gain_figure(read_gains(load(self.results), []), "study")
        self.assertEqual([axes.get_xlabel() for axes in figure.axes],
                         ["relMSE at equal samples", "relMSE × s (learning included)", "time to the baseline's MSE"])

    def test_a_picture(self) -> None:
        code, out, err = self.run_script(main, self.results, "--only", "gains", "--out", self.folder / "figures")
        self.assertEqual((code, err), (0, ""))
        self.assertEqual(out, f"gains: {self.folder / 'figures' / 'gains.png'}\n")
        self.assertTrue((self.folder / "figures" / "gains.png").read_bytes().startswith(b"\x89PNG"))

    def test_no_baseline(self) -> None:
        (self.results / "ratios.csv").unlink()
        code, _, err = self.run_script(main, self.results, "--only", "gains")
        self.assertEqual(code, 1)
        self.assertRegex(err, "^error: gains: .*has no ratios.csv: its config names no baseline")
