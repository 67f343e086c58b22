"""The points of the curves: means over seeds with their intervals, by `statistics.over_seeds`; at the end of a cell
those that cells.csv has."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from analysis.convergence_figure import METRICS
from analysis.report.sweep import Row, Sweep
from analysis.statistics import over_seeds

Point = list[Any]  # frame, spp, seconds, mean, low, high, seeds, 1 if a seed is at the reference's floor


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _exact(text: str) -> float | None:
    return _finite(float(text)) if text else None


def _points(points: pd.DataFrame, cell: Row, metric: str) -> list[Point]:
    rows: list[Point] = [[int(p.frame), int(p.spp), _finite(p.seconds), _finite(p.mean), _finite(p.low),
                          _finite(p.high), int(p.seeds), int(p.at_floor)]
                         for p in points.itertuples(index=False)]
    if rows and rows[-1][0] == int(cell["frames"] or 0) and cell.get(metric):
        rows[-1][2:6] = [_exact(cell.get(name, "")) for name in
                         ("elapsed_s", metric, f"{metric}_low", f"{metric}_high")]
    return rows


def curves(sweep: Sweep) -> dict[str, dict[str, list[Point]]]:
    """By metric and cell; metrics that were not measured are left out."""
    result = {}
    for metric in METRICS:
        measured = sweep.convergence.get(metric)
        if measured is None or not (measured > 0).any():
            continue
        cells = dict(iter(over_seeds(sweep.convergence, metric).groupby("cell", sort=False)))
        result[metric] = {cell["cell"]: _points(cells[cell["cell"]], cell, metric)
                          for cell in sweep.cells if cell["cell"] in cells}
    return result


def metric_names(metrics: list[str]) -> dict[str, str]:
    return {metric: METRICS[metric][0].replace("\n", " ") for metric in metrics}


def floors(sweep: Sweep) -> dict[str, dict[str, list[float]]]:
    """By metric and scene: the noise of each of its references, where it is known."""
    result: dict[str, dict[str, list[float]]] = {}
    for metric, (_, column) in METRICS.items():
        if column is None or column not in sweep.convergence or sweep.convergence.empty:
            continue
        known = sweep.convergence.dropna(subset=[column]).groupby("scene", sort=False)[column]
        result[metric] = {str(scene): sorted(float(value) for value in values.unique()) for scene, values in known}
    return result
