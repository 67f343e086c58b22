"""What cells.csv and ratios.csv hold, computed again from the files of the runs, with the formulas of
experiments/records/curve.h and experiments/records/ratios.h: for results from before the program wrote them, for comparisons that it
does not make, and as a check of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np
import pandas as pd

from analysis.statistics import estimate, signed_estimate, t_quantile, t_tail

# Figures of summary.csv of either sign, whose intervals are symmetric.
SIGNED = ("mse_corrected", "relmse_corrected", "psnr_db", "bias", "clamp_bias", "slope_mse", "slope_relmse")
FIGURES = ("host_ms_median", "gpu_ms_median", "setup_s", "elapsed_s", "gpu_elapsed_s", "mse", "relmse",
           "relmse_trimmed", "mse_corrected", "relmse_corrected", "mape", "smape", "psnr_db", "flip", "bias",
           "relmse_x_s", "slope_mse", "slope_relmse", "filtered_relmse", "filter_ms", "mean_path_length",
           "zero_path_fraction", "clamp_bias", "fireflies_per_million")
FEWEST_POINTS = 3  # of a slope


@dataclass(frozen=True)
class Comparison:
    """A ratio with its 95 % interval and P of a ratio at least as far from 1 if the truth is 1; NaN where a side is of
    one seed alone."""

    ratio: float
    low: float = math.nan
    high: float = math.nan
    p: float = math.nan


@dataclass(frozen=True)
class Side:
    """The variance of a logarithm's mean, and the seeds behind it; none where it is known exactly."""

    variance: float
    seeds: int


def welch(log_ratio: float, *sides: Side) -> Comparison:
    """Welch 1947; degrees of freedom by Satterthwaite."""
    ratio = math.exp(log_ratio)
    variance = sum(side.variance for side in sides)
    if any(side.seeds == 1 for side in sides):
        return Comparison(ratio)
    if variance == 0:
        return Comparison(ratio, ratio, ratio, 1.0 if log_ratio == 0 else 0.0)
    degrees = 1 / sum((side.variance / variance) ** 2 / (side.seeds - 1) for side in sides if side.variance > 0)
    error = math.sqrt(variance)
    reach = t_quantile(degrees) * error
    return Comparison(ratio, ratio * math.exp(-reach), ratio * math.exp(reach), t_tail(log_ratio / error, degrees))


def relative_error(values: Sequence[float]) -> Side:
    x = np.asarray(values, dtype=float)
    spread = x.std(ddof=1) / x.mean() if x.size > 1 else 0.0
    return Side(float(spread * spread / x.size), x.size)


def ratio_of_means(above: Sequence[float], below: Sequence[float]) -> Comparison | None:
    """By the logarithms of the two means (delta method). None unless both are positive."""
    if not (len(above) and len(below) and np.mean(above) > 0 and np.mean(below) > 0):
        return None
    return welch(math.log(np.mean(above) / np.mean(below)), relative_error(above), relative_error(below))


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


def time_ratio(baseline: Sequence[Curve], cell: Sequence[Curve]) -> Comparison | None:
    """The baseline's seconds over the cell's until it has the baseline's last error; None where it never has."""

    def log_ratio(above: Curve, below: Curve) -> float:
        time = time_to_error(below, above[-1, 1])
        return math.log(above[-1, 0] / time) if time > 0 else math.nan

    value = log_ratio(_mean(baseline), _mean(cell))
    if math.isnan(value):
        return None
    return jackknife(value, [log_ratio(_mean(baseline, i), _mean(cell)) for i in range(len(baseline))]
                     if len(baseline) > 1 else [],
                     [log_ratio(_mean(baseline), _mean(cell, i)) for i in range(len(cell))] if len(cell) > 1 else [])


def time_until(cell: Sequence[Curve], target: float) -> Comparison | None:
    """Seconds of the cell's mean curve until the target; None where it never is reached."""
    time = time_to_error(_mean(cell), target)
    if math.isnan(time):
        return None
    log: Callable[[float], float] = lambda t: math.log(t) if t > 0 else math.nan
    return jackknife(math.log(time), [log(time_to_error(_mean(cell, i), target)) for i in range(len(cell))]
                     if len(cell) > 1 else [])


def cells_of(runs: pd.DataFrame) -> pd.DataFrame:
    """cells.csv of the finished runs of a summary, but for what needs the images (bias and variance)."""
    rows = []
    labels = [column for column in runs.columns if column.startswith("axis:") and column != "axis:seed"]
    for cell, group in runs[runs.status == "finished"].groupby("cell", sort=False):
        first = group.iloc[0]
        row = {"cell": cell, **{name: first[name] for name in labels}, "scene": first.scene, "frames": first.frames,
               "runs": int((runs.cell == cell).sum()), "seeds": len(group)}
        for name in FIGURES:
            values = group[name].dropna() if name in group else pd.Series(dtype=float)
            ends = {"": math.nan, "_sd": math.nan, "_low": math.nan, "_high": math.nan}
            if len(values):
                result = (signed_estimate if name in SIGNED else estimate)(values)
                ends = {"": result.mean, "_sd": values.std(ddof=1), "_low": result.low, "_high": result.high}
            row |= {name + end: value for end, value in ends.items()}
        rows.append(row)
    return pd.DataFrame(rows)
