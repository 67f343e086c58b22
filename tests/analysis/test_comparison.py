"""Side by side: what is called changed, how often chance is, and that nothing is left out silently."""

import json
import math
import unittest

from support import METHODS, ROOT, FolderTest, write_results

import numpy as np

from analysis.compare_results import main
from analysis.comparison import compare, false_discovery
from analysis.load import load
from analysis.welch import ratio_of_means


class StatisticsTest(unittest.TestCase):
    def test_correction_by_hand(self) -> None:
        """p m / rank, never above that of a larger p; NaN are not counted."""
        corrected = false_discovery([0.01, 0.04, math.nan, 0.03, 0.005])
        np.testing.assert_allclose(corrected, [0.02, 0.04, math.nan, 0.04, 0.02], rtol=1e-15)
        self.assertEqual(false_discovery([0.9, 0.8]), [0.9, 0.9])

    def test_welch_by_hand(self) -> None:
        """Means 2 and 4, deviations 1 and 1: relative deviations 1/2 and 1/4, variances 1/12 and 1/48 of the logarithms'
        means, 50/17 degrees of freedom; interval and p lie between those of a table of t for 2 and 3."""
        result = ratio_of_means([1, 2, 3], [3, 4, 5])
        variance = (1 / 4 + 1 / 16) / 3
        degrees = variance ** 2 / ((1 / 12) ** 2 / 2 + (1 / 48) ** 2 / 2)
        self.assertAlmostEqual(degrees, 50 / 17, places=12)
        self.assertAlmostEqual(result.ratio, 0.5, places=15)
        # t of 95 % between those of 2 and 3 degrees, 4.303 and 3.182
        reach = math.log(result.high / 0.5) / math.sqrt(variance)
        self.assertTrue(3.182 < reach < 3.3, reach)
        self.assertAlmostEqual(result.low * result.high, 0.25, places=12)
        # |t| is 2.148; of P(|T| > t) tables have 0.165 for 2 degrees and 0.121 for 3
        self.assertTrue(0.119 < result.p < 0.13, result.p)

    def test_false_alarms(self) -> None:
        """5 % of comparisons of the same thing, of 4000: 5 standard errors are 1.7 %. The delta method makes it less
        for skewed values, so that only the upper end is tight."""
        draw = np.random.default_rng(3)
        p = [ratio_of_means(*draw.lognormal(0, 0.1, (2, 6))).p for _ in range(4000)]
        self.assertTrue(0.033 < np.mean(np.array(p) < 0.05) < 0.067)

    def test_one_seed_or_nothing(self) -> None:
        self.assertTrue(math.isnan(ratio_of_means([1], [2, 3]).p))
        self.assertIsNone(ratio_of_means([0, 0], [2, 3]))


class CompareTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        self.a = write_results(self.folder / "a")
        self.b = write_results(self.folder / "b")

    def verdicts(self, a, b) -> dict:
        return {(row.configuration, row.figure): row.verdict for row in compare(a, b).rows}

    def test_itself_is_the_same(self) -> None:
        verdicts = self.verdicts(load(self.a), load(self.b))
        self.assertEqual(len(verdicts), 2 * 3 * 7)  # GL times are not in these files
        self.assertEqual(set(verdicts.values()), {"same"})

    def test_a_change_is_found_and_noise_is_not(self) -> None:
        a, b = load(self.a), load(self.b)
        rl = b.summary.configuration == "simple / RL"
        b.summary.loc[rl, "host_ms_median"] *= 1.5  # the seeds differ by 0.1 %
        b.convergence.loc[b.convergence.configuration == "occluded / BSDF", "relmse"] *= 1.02  # and by 10 %
        result = compare(a, b)
        verdicts = {(row.configuration, row.figure): row.verdict for row in result.rows}
        self.assertEqual(verdicts["simple / RL", "host ms/frame"], "changed")
        self.assertEqual(verdicts["occluded / BSDF", "relMSE"], "noise")
        self.assertEqual(verdicts["occluded / BSDF", "relMSE × s"], "noise")
        self.assertEqual((result.count("changed"), result.count("noise"), result.count("same")), (1, 2, 39))
        row = next(row for row in result.rows if row.verdict == "changed")
        self.assertAlmostEqual(row.comparison.ratio, 1.5, places=12)
        self.assertLess(row.comparison.low, 1.5)

    def test_many_comparisons_are_corrected(self) -> None:
        """One change of p about 0.02 alone is a change; among 41 others that are noise it is unclear."""
        a, b = load(self.a), load(self.b)
        at = (b.convergence.configuration == "simple / RL")
        b.convergence.loc[at, "relmse"] *= 1.35
        alone = compare(a, b)
        row = next(row for row in alone.rows if (row.configuration, row.figure) == ("simple / RL", "relMSE"))
        self.assertTrue(0.01 < row.comparison.p < 0.05, row.comparison.p)
        b.convergence.loc[~at, ["mse", "relmse", "relmse_trimmed", "mape", "smape"]] *= 1.001
        b.summary.host_ms_median *= 1.00001
        among = self.verdicts(a, b)
        self.assertEqual(among["simple / RL", "relMSE"], "unclear")
        self.assertEqual(among["simple / BSDF", "MSE"], "noise")

    def test_one_seed(self) -> None:
        one = load(write_results(self.folder / "one", seeds=(2,)))
        self.assertEqual(set(self.verdicts(load(self.a), one).values()), {"one seed"})

    def test_shorter_runs_are_compared_where_both_have_been(self) -> None:
        a, b = load(self.a), load(self.b)
        b.__dict__["convergence"] = b.convergence[b.convergence.frame <= 4]
        result = compare(a, b)
        self.assertEqual({row.verdict for row in result.rows}, {"same"})
        self.assertIn("the runs differ in length; errors are those after frame 4: simple / NEE, two rays; simple / BS",
                      result.warnings[0])

    def test_folders_without_the_files_of_their_runs(self) -> None:
        """Published ones: the summary has each run's last errors."""
        folder = ROOT / "results/published/time_to_error"
        result = compare(load(folder), load(folder))
        self.assertEqual({row.verdict for row in result.rows}, {"same"})
        self.assertEqual(len({row.configuration for row in result.rows}), 70)
        self.assertTrue({"MSE", "relMSE × s", "host ms/frame"} <= {row.figure for row in result.rows})

    def test_a_metric_that_only_the_manifest_knows(self) -> None:
        for side in (self.a, self.b):
            manifest = json.loads((side / "manifest.json").read_text())
            manifest["metrics"].append({"name": "gpu_elapsed_s", "label": "a new one", "unit": "x", "signed": False,
                                        "per_configuration": True, "error": True, "formula": "f", "source": "s"})
            (side / "manifest.json").write_text(json.dumps(manifest))
        self.assertIn(("simple / RL", "a new one"), self.verdicts(load(self.a), load(self.b)))

    def test_command(self) -> None:
        self.results = self.b
        for name in ("summary.csv", "configurations.csv"):
            self.edit(name, lambda text: text.replace("occluded / RL", "occluded / <b>new</b>"))
        manifest = json.loads((self.b / "manifest.json").read_text())
        manifest["device"]["renderer"] = "another & device"
        (self.b / "manifest.json").write_text(json.dumps(manifest))
        out = self.folder / "page"
        code, printed, err = self.run_script(main, self.a, self.b, "--out", out)
        self.assertEqual((code, err), (0, ""))
        for words in ("only in A: occluded / RL\n", "only in B: occluded / <b>new</b>\n",
                      "differs: device.renderer: a device | another & device", "35 comparisons in 5 configurations: 35 the same",
                      "Benjamini and Hochberg", f"{out / 'compare.html'}\n"):
            self.assertIn(words, printed)
        page = (out / "compare.html").read_text()
        self.assertIn("occluded / &lt;b&gt;new&lt;/b&gt;", page)
        self.assertIn("another &amp; device", page)
        self.assertIn("<p>only in A: occluded / RL</p>", page)
        self.assertNotIn("<b>new", page)
        self.assertEqual(page.count("<circle"), 35)
        self.assertNotRegex(page, r"(?:src|href)=|https?://|@import|url\(")  # it needs nothing else
        for method in METHODS:
            self.assertIn(f"simple / {method}", page)

    def test_nothing_in_common(self) -> None:
        other = write_results(self.folder / "other", scenes=("elsewhere",))
        code, out, err = self.run_script(main, self.a, other)
        self.assertEqual((code, out), (1, ""))
        self.assertIn("share no finished configuration", err)
        self.assertIn("elsewhere / BSDF", err)
        self.assertFalse((other / "compare.html").exists())


if __name__ == "__main__":
    unittest.main()
