"""The points of the curves: means over seeds with their intervals, by `points.over_seeds`; at the end of a configuration
those that configurations.csv has."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from analysis.metrics import errors, floor_column
from analysis.points import over_seeds
from analysis.report.sweep import Row, Sweep

Point = list[Any]  # frame, spp, seconds, mean, low, high, seeds, 1 if a seed is at the reference's floor


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _exact(text: str) -> float | None:
    return _finite(float(text)) if text else None


def _points(points: pd.DataFrame, row: Row, metric: str) -> list[Point]:
    found: list[Point] = [[int(p.frame), int(p.spp), _finite(p.seconds), _finite(p.mean), _finite(p.low),
                           _finite(p.high), int(p.seeds), int(p.at_floor)]
                          for p in points.itertuples(index=False)]
    if found and found[-1][0] == int(row["frames"] or 0) and row.get(metric):
        found[-1][2:6] = [_exact(row.get(name, "")) for name in
                          ("elapsed_s", metric, f"{metric}_low", f"{metric}_high")]
    return found


def curves(sweep: Sweep) -> dict[str, dict[str, list[Point]]]:
    """By metric and configuration; metrics that were not measured are left out."""
    result = {}
    for metric in errors(sweep.metrics.values()):
        measured = sweep.convergence.get(metric.name)
        if measured is None or not (measured > 0).any():
            continue
        points = dict(iter(over_seeds(sweep.convergence, metric.name).groupby("configuration", sort=False)))
        result[metric.name] = {row["configuration"]: _points(points[row["configuration"]], row, metric.name)
                               for row in sweep.configurations if row["configuration"] in points}
    return result


def metric_names(sweep: Sweep) -> dict[str, str]:
    return {metric.name: metric.axis for metric in errors(sweep.metrics.values())}


def floors(sweep: Sweep) -> dict[str, dict[str, list[float]]]:
    """By metric and scene: the noise of each of its references, where it is known."""
    result: dict[str, dict[str, list[float]]] = {}
    for metric in errors(sweep.metrics.values()):
        column = floor_column(metric.name)
        if column not in sweep.convergence or sweep.convergence.empty:
            continue
        known = sweep.convergence.dropna(subset=[column]).groupby("scene", sort=False)[column]
        result[metric.name] = {str(scene): sorted(float(value) for value in values.unique()) for scene, values in known}
    return result
