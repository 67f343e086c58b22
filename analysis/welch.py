"""The ratio of two means with its interval, for comparisons that the program does not make: of two folders."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence

import numpy as np

from analysis.statistics import t_quantile, t_tail


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
    """The variance of a logarithm's mean, and the seeds behind it."""

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
    """By the logarithms of the two means (delta method), as ratios.csv has it. None unless both are positive."""
    if not (len(above) and len(below) and np.mean(above) > 0 and np.mean(below) > 0):
        return None
    return welch(math.log(np.mean(above) / np.mean(below)), relative_error(above), relative_error(below))
