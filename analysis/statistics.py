"""Means over seeds with 95 % confidence intervals.

The mean is arithmetic: relMSE and its like estimate an expected error, which the mean over seeds estimates
without bias (and which falls as 1/spp), while a geometric mean or a median would flatter samplers with rare,
bright outliers. The tables of `qtrace run` have the same mean.

The interval is Student's t, symmetric about the logarithm of the mean: with m the mean, s the standard
deviation and n seeds, log m has the standard error s / (m sqrt(n)) to first order (delta method), hence
m * exp(+-t s / (m sqrt(n))). For small errors that is m +- t s / sqrt(n); for large ones it stays
above zero, as errors do and logarithmic axes need, and is skewed upwards, as errors are. cells.csv, written by
`qtrace run`, has the same intervals: experiments/measure/statistics.h.
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


def _beta_fraction(a: float, b: float, x: float) -> float:
    """The continued fraction of the incomplete beta function, Abramowitz and Stegun 1964, 26.5.8, by Lentz's method."""
    c, d = 1.0, 1 / (1 - (a + b) * x / (a + 1))
    result = d
    for m in range(1, 10000):
        before = result
        for term in (m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                     -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))):
            d = 1 / (1 + term * d)
            c = 1 + term / c
            result *= c * d
        if result == before or abs(result / before - 1) < 1e-16:
            break
    return result


def incomplete_beta(a: float, b: float, x: float) -> float:
    """The regularised I_x(a, b)."""
    if x <= 0 or x >= 1:
        return float(x >= 1)
    front = math.exp(math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x))
    if x < (a + 1) / (a + b + 2):
        return front * _beta_fraction(a, b, x) / a
    return 1 - front * _beta_fraction(b, a, 1 - x) / b


def t_tail(t: float, degrees: float) -> float:
    """P(|T| > t) of Student's t distribution, whose degrees need not be whole; 26.7.1."""
    return incomplete_beta(degrees / 2, 0.5, degrees / (degrees + t * t))


def t_probability(t: float, degrees: float) -> float:
    """P(|T| < t); the other side of the same, so that small ones are exact, too."""
    return incomplete_beta(0.5, degrees / 2, t * t / (degrees + t * t))


@lru_cache(maxsize=None)
def t_quantile(degrees: float, confidence: float = CONFIDENCE) -> float:
    """The t with P(|T| < t) = confidence: the half width of an interval in standard errors."""
    low, high = 0.0, 1.0
    while t_tail(high, degrees) > 1 - confidence:
        high *= 2
    for _ in range(100):  # bisection to the last bit
        middle = (low + high) / 2
        low, high = (middle, high) if t_tail(middle, degrees) > 1 - confidence else (low, middle)
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
