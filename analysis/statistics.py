"""Means over seeds with 95 % confidence intervals.

The mean is arithmetic: relMSE and its like estimate an expected error, which the mean over seeds estimates
without bias (and which falls as 1/spp), while a geometric mean or a median would flatter samplers with rare,
bright outliers. The tables of `qtrace run` have the same mean.

The interval is Student's t, symmetric about the logarithm of the mean: with m the mean, s the standard
deviation and n seeds, log m has the standard error s / (m sqrt(n)) to first order (delta method), hence
m * exp(+-t s / (m sqrt(n))). For small errors that is m +- t s / sqrt(n); for large ones it stays
above zero, as errors do and logarithmic axes need, and is skewed upwards, as errors are. cells.csv, written by
`qtrace run`, has the same intervals: experiments/statistics.h.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Iterable

import numpy as np
import pandas as pd

CONFIDENCE = 0.95
POINT_COLUMNS = ["scene", "label", "cell", "frame", "spp", "seconds", "mean", "low", "high", "seeds", "at_floor"]


@dataclass(frozen=True)
class Estimate:
    mean: float
    low: float  # NaN for one value alone: no interval
    high: float
    count: int


def t_probability(t: float, degrees: int) -> float:
    """P(|T| < t) of Student's t distribution; Abramowitz and Stegun 1964, 26.7.3 (odd) and 26.7.4 (even)."""
    angle = math.atan(t / math.sqrt(degrees))
    odd = degrees % 2
    term = math.cos(angle) if odd else 1.0
    total = term if degrees > 1 else 0.0
    for k in range(3 if odd else 2, degrees - 1, 2):
        term *= (k - 1) / k * math.cos(angle) ** 2
        total += term
    return 2 / math.pi * (angle + math.sin(angle) * total) if odd else math.sin(angle) * total


@lru_cache(maxsize=None)
def t_quantile(degrees: int, confidence: float = CONFIDENCE) -> float:
    """The t with P(|T| < t) = confidence: the half width of an interval in standard errors."""
    low, high = 0.0, 1.0
    while t_probability(high, degrees) < confidence:
        high *= 2
    for _ in range(100):  # bisection to the last bit
        middle = (low + high) / 2
        low, high = (middle, high) if t_probability(middle, degrees) < confidence else (low, middle)
    return (low + high) / 2


def estimate(values: Iterable[float]) -> Estimate:
    """Mean of values >= 0 and its interval, see above. A NaN among them makes everything NaN: no seed is
    left out silently."""
    x = np.asarray(list(values), dtype=float)
    if x.size == 0 or (x < 0).any():
        raise ValueError("an error needs at least one value and none below zero")
    mean = float(x.mean())
    if x.size == 1:
        return Estimate(mean, math.nan, math.nan, 1)
    if mean == 0:
        return Estimate(0.0, 0.0, 0.0, x.size)
    relative = t_quantile(x.size - 1) * float(x.std(ddof=1)) / math.sqrt(x.size) / mean
    return Estimate(mean, mean * math.exp(-relative), mean * math.exp(relative), x.size)


def signed_estimate(values: Iterable[float]) -> Estimate:
    """Mean of values of either sign, as a bias or a slope, with Student's symmetric interval m +- t s / sqrt(n)."""
    x = np.asarray(list(values), dtype=float)
    mean = float(x.mean())
    if x.size == 1:
        return Estimate(mean, math.nan, math.nan, 1)
    half_width = t_quantile(x.size - 1) * float(x.std(ddof=1)) / math.sqrt(x.size)
    return Estimate(mean, mean - half_width, mean + half_width, x.size)


def over_seeds(convergence: pd.DataFrame, metric: str) -> pd.DataFrame:
    """A row per cell and snapshot, in the order of the runs: mean, low and high of the metric, mean seconds,
    the number of seeds, and whether any seed's error is flagged as at the reference's noise floor."""
    rows = []
    for (scene, label, cell, frame), group in convergence.groupby(["scene", "label", "cell", "frame"], sort=False):
        error = estimate(group[metric])
        rows.append((scene, label, cell, frame, group.spp.iloc[0], group.elapsed_s.mean(), error.mean, error.low,
                     error.high, error.count, bool(group.at_reference_floor.any())))
    return pd.DataFrame(rows, columns=POINT_COLUMNS)


def final_over_seeds(convergence: pd.DataFrame, metric: str) -> pd.DataFrame:
    """A row per cell: `over_seeds` of the last snapshot of each run. The metric `relmse_x_s` is the run's relMSE
    times its own seconds, as in the tables of `qtrace run`."""
    last = convergence[convergence.frame == convergence.groupby("run").frame.transform("max")]
    return over_seeds(last.assign(relmse_x_s=last.relmse * last.elapsed_s), metric)


def cost_points(convergence: pd.DataFrame, metric: str) -> pd.DataFrame:
    """`final_over_seeds` with the interval of the seconds, too: `seconds_low` and `seconds_high`."""
    seconds = final_over_seeds(convergence.assign(elapsed=convergence.elapsed_s), "elapsed")
    return final_over_seeds(convergence, metric).assign(seconds_low=seconds.low, seconds_high=seconds.high)
