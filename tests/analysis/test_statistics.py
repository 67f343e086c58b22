"""Means and intervals against values computed by hand."""

import math
import unittest

from support import FolderTest, METHODS, SECONDS, relmse, write_results

from analysis.load import MissingError, load
from analysis.points import at_the_end, over_seeds
from analysis.statistics import estimate, t_quantile, t_tail


class StudentTest(unittest.TestCase):
    def test_published_quantiles(self) -> None:
        """Abramowitz and Stegun 1964, table 26.10, two-sided 95 %."""
        for degrees, t in {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776, 9: 2.262, 30: 2.042, 120: 1.980}.items():
            self.assertAlmostEqual(t_quantile(degrees), t, delta=0.0006)

    def test_closed_forms(self) -> None:
        """One and two degrees: to the last digits, as the program's own are compared with these to twelve."""
        self.assertAlmostEqual(t_quantile(1) / math.tan(math.pi * 0.475), 1, places=14)
        self.assertAlmostEqual(t_quantile(2) / (0.95 * math.sqrt(2 / (1 - 0.95 ** 2))), 1, places=14)
        self.assertAlmostEqual(t_tail(1.5, 2), 1 - 1.5 / math.sqrt(2 + 1.5 ** 2), places=15)
        self.assertAlmostEqual(t_tail(-1.5, 1), 1 - 2 / math.pi * math.atan(1.5), places=15)


class EstimateTest(unittest.TestCase):
    def test_by_hand(self) -> None:
        # mean 2, deviation 1, standard error 1/sqrt(3), t with two degrees 4.302653
        result = estimate([1, 2, 3])
        factor = math.exp(4.302653 / math.sqrt(3) / 2)
        self.assertEqual((result.mean, result.count), (2, 3))
        self.assertAlmostEqual(result.high, 2 * factor, places=5)
        self.assertAlmostEqual(result.low, 2 / factor, places=5)

    def test_small_spread_is_the_symmetric_interval(self) -> None:
        result = estimate([0.999, 1, 1.001])
        self.assertAlmostEqual(result.high - 1, 4.302653 * 0.001 / math.sqrt(3), delta=1e-5)

    def test_never_below_zero(self) -> None:
        result = estimate([0.001, 10])  # the symmetric interval would reach down to -58
        self.assertGreater(result.low, 0)
        self.assertLess(result.low, result.mean)

    def test_one_value_has_no_interval(self) -> None:
        result = estimate([3])
        self.assertEqual(result.mean, 3)
        self.assertTrue(math.isnan(result.low) and math.isnan(result.high))

    def test_zeros_nan_and_misuse(self) -> None:
        self.assertEqual(estimate([0, 0]).high, 0)
        self.assertTrue(math.isnan(estimate([1, math.nan]).mean))
        for values in ([], [1, -1]):
            with self.assertRaises(ValueError):
                estimate(values)

    def test_coverage(self) -> None:
        """Of many intervals about skewed errors (chi-squared, 50 degrees), 95 % hold the true mean."""
        import numpy as np
        samples = np.random.default_rng(7).chisquare(50, (2000, 5)) / 50
        hits = sum(e.low <= 1 <= e.high for e in map(estimate, samples))
        self.assertAlmostEqual(hits / 2000, 0.95, delta=0.02)


class OverSeedsTest(FolderTest):
    def test_each_configuration_and_snapshot_once(self) -> None:
        points = over_seeds(load(write_results(self.results)).convergence, "relmse")
        self.assertEqual(len(points), 2 * 3 * 4)
        for point in points.itertuples():
            middle = METHODS[point.label] * (2 if point.scene == "occluded" else 1) / point.spp
            factor = math.exp(4.302653 * 0.1 / math.sqrt(3))
            self.assertAlmostEqual(point.mean, middle, places=12)
            self.assertAlmostEqual(point.high / middle, factor, places=6)
            self.assertAlmostEqual(point.low / middle, 1 / factor, places=6)
            self.assertAlmostEqual(point.seconds, SECONDS[point.label] * point.frame + 0.02, places=12)
            self.assertEqual(point.seeds, 3)

    def test_one_flagged_seed_flags_the_point(self) -> None:
        results = load(write_results(self.results))
        results.convergence.loc[0, "at_reference_floor"] = True
        points = over_seeds(results.convergence, "relmse")
        self.assertEqual(list(points.at_floor[:2]), [True, False])

    def test_metrics_are_not_mixed_up(self) -> None:
        results = load(write_results(self.results, seeds=(2,)))
        points = over_seeds(results.convergence, "mse")
        self.assertEqual(points["mean"][0], relmse("NEE, two rays", 2, 1) / 2)


class EndTest(FolderTest):
    def test_ends_are_those_of_the_file(self) -> None:
        results = load(write_results(self.results))
        table = results.configurations
        for metric in ("relmse", "relmse_x_s"):
            points = at_the_end(results, metric)
            self.assertEqual(list(points.label), list(METHODS) * 2)
            for name, column in (("mean", metric), ("low", f"{metric}_low"), ("high", f"{metric}_high"),
                                 ("seconds", "elapsed_s"), ("seconds_low", "elapsed_s_low"), ("seeds", "seeds")):
                self.assertEqual(list(points[name]), list(table[column]))
        self.assertFalse(points.at_floor.any())

    def test_a_figure_that_is_not_there(self) -> None:
        with self.assertRaisesRegex(MissingError, "have no column 'flip'"):
            at_the_end(load(write_results(self.results)), "flip")


if __name__ == "__main__":
    unittest.main()
