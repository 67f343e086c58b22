"""What configurations.csv, ratios.csv and the slopes of summary.csv hold, computed again from the files of the runs with the
formulas of experiments/records/curve.h and experiments/records/ratios.h: a second implementation, for tests alone."""

from __future__ import annotations

import math
from typing import Callable, Sequence

import numpy as np
import pandas as pd

from analysis.statistics import Estimate, estimate, t_quantile
from analysis.welch import Comparison, Side, welch

FEWEST_POINTS = 3  # of a slope
FEWEST_PAIRED_SEEDS = 5  # from so many on, a ratio of curves leaves out the same seed of both
ENDS = ("", "_sd", "_low", "_high")


def signed_estimate(values: Sequence[float]) -> Estimate:
    """Mean of values of either sign, as a bias or a slope, with Student's symmetric interval m +- t s / sqrt(n)."""
    x = np.asarray(values, dtype=float)
    mean = float(x.mean())
    if x.size == 1:
        return Estimate(mean, math.nan, math.nan, 1)
    half_width = t_quantile(x.size - 1) * float(x.std(ddof=1)) / math.sqrt(x.size)
    return Estimate(mean, mean - half_width, mean + half_width, x.size)


def figure_ends(values: pd.Series, is_signed: bool) -> dict[str, float]:
    """Of the finished seeds of a configuration, by the endings of its columns."""
    values = values.dropna()
    if values.empty:
        return dict.fromkeys(ENDS, math.nan)
    result = (signed_estimate if is_signed else estimate)(values)
    return dict(zip(ENDS, (result.mean, values.std(ddof=1), result.low, result.high)))


def slope(curve: pd.DataFrame, metric: str) -> float:
    """The exponent b of error = a spp^b, by least squares above the reference's floor; NaN for too few points."""
    used = curve[~curve.at_reference_floor & (curve[metric] > 0)]
    if len(used) < FEWEST_POINTS:
        return math.nan
    x, y = np.log(used.spp), np.log(used[metric])
    return float(((x - x.mean()) * (y - y.mean())).sum() / ((x - x.mean()) ** 2).sum())


Curve = np.ndarray  # a row per snapshot: seconds, error


def curves_of(convergence: pd.DataFrame, metric: str) -> list[Curve]:
    """One per run."""
    return [run[["elapsed_s", metric]].to_numpy(float) for _, run in convergence.groupby("run", sort=False)]


def _mean(curves: Sequence[Curve], without: int | None = None) -> Curve:
    return np.mean([curve for i, curve in enumerate(curves) if i != without], axis=0)


def time_to_error(curve: Curve, target: float) -> float:
    """Seconds until the error first reaches the target, linearly in the logarithms; NaN where it never does, or before
    the first snapshot."""
    reached = np.flatnonzero(curve[:, 1] <= target)
    if reached.size == 0 or reached[0] == 0:
        return math.nan
    (before_s, before), (after_s, after) = curve[reached[0] - 1], curve[reached[0]]
    if after in (target, 0):
        return float(after_s)
    share = math.log(before / target) / math.log(before / after)
    return float(before_s * (after_s / before_s) ** share)


def jackknife(value: float, *left_out: Sequence[float]) -> Comparison:
    """exp(value) with the interval by leaving out one seed after the other of each side: Efron and Stein 1981."""
    sides = []
    for values in left_out:
        x = np.asarray(values)
        if not np.isfinite(x).all() or x.size < 2:
            return Comparison(math.exp(value))
        sides.append(Side(float(((x - x.mean()) ** 2).sum() * (x.size - 1) / x.size), x.size))
    return welch(value, *sides)


def curve_ratio(baseline: Sequence[Curve], configuration: Sequence[Curve],
                log_ratio: Callable[[Curve, Curve], float]) -> Comparison | None:
    """Of the mean curves of both sides; None where these have no ratio."""
    value = log_ratio(_mean(baseline), _mean(configuration))
    if math.isnan(value):
        return None
    seeds, others = range(len(baseline)), range(len(configuration))
    if len(baseline) == len(configuration) >= FEWEST_PAIRED_SEEDS:  # the tests' sides have the same seeds
        return jackknife(value, [log_ratio(_mean(baseline, i), _mean(configuration, i)) for i in seeds])
    return jackknife(value, [log_ratio(_mean(baseline, i), _mean(configuration)) for i in seeds if len(baseline) > 1],
                     [log_ratio(_mean(baseline), _mean(configuration, i)) for i in others if len(configuration) > 1])


def log_time_ratio(baseline: Curve, configuration: Curve) -> float:
    """The baseline's seconds over the configuration's until it has the baseline's last error; NaN where it never has."""
    time = time_to_error(configuration, baseline[-1, 1])
    return math.log(baseline[-1, 0] / time) if time > 0 else math.nan


def log_error_ratio(baseline: Curve, configuration: Curve) -> float:
    """The baseline's error over the configuration's after the seconds of whichever ends first."""
    log_seconds = math.log(min(baseline[-1, 0], configuration[-1, 0]))
    if min(baseline[:, 1].min(), configuration[:, 1].min()) <= 0:
        return math.nan
    above, below = (float(np.interp(log_seconds, np.log(curve[:, 0]), np.log(curve[:, 1]), left=math.nan))
                    for curve in (baseline, configuration))
    return above - below


def time_until(configuration: Sequence[Curve], target: float) -> Comparison | None:
    """Seconds of the configuration's mean curve until the target; None where it never is reached."""
    time = time_to_error(_mean(configuration), target)
    if math.isnan(time):
        return None
    log: Callable[[float], float] = lambda t: math.log(t) if t > 0 else math.nan
    return jackknife(math.log(time), [log(time_to_error(_mean(configuration, i), target)) for i in range(len(configuration))]
                     if len(configuration) > 1 else [])
