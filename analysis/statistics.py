"""Means over seeds with 95 % confidence intervals.

The mean is arithmetic: relMSE and its like estimate an expected error, which the mean over seeds estimates
without bias (and which falls as 1/spp), while a geometric mean or a median would flatter samplers with rare,
bright outliers. The tables of `qtrace run` have the same mean.

The interval is Student's t, symmetric about the logarithm of the mean: with m the mean, s the standard
deviation and n seeds, log m has the standard error s / (m sqrt(n)) to first order (delta method), hence
m * exp(+-t s / (m sqrt(n))). For small errors that is m +- t s / sqrt(n); for large ones it stays
above zero, as errors do and logarithmic axes need, and is skewed upwards, as errors are. It is the interval of
configurations.csv (experiments/measure/statistics.h), here for the points of the curves, which the program does not write.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Iterable

import numpy as np
from scipy.special import betainc, betaincinv

from analysis.tolerances import CONFIDENCE


@dataclass(frozen=True)
class Estimate:
    mean: float
    low: float  # NaN for one value alone: no interval
    high: float
    count: int


def t_tail(t: float, degrees: float) -> float:
    """P(|T| > t) of Student's t distribution, whose degrees need not be whole: Abramowitz and Stegun 1964, 26.7.1. By way
    of the incomplete beta function, which scipy has to the last digits; its `stdtrit` has eleven."""
    return float(betainc(degrees / 2, 0.5, degrees / (degrees + t * t)))


@lru_cache(maxsize=None)
def t_quantile(degrees: float, confidence: float = CONFIDENCE) -> float:
    """The t with P(|T| < t) = confidence: the half width of an interval in standard errors."""
    return math.sqrt(degrees * (1 / float(betaincinv(degrees / 2, 0.5, 1 - confidence)) - 1))


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
