"""The points of the figures: a row per configuration and snapshot."""

from __future__ import annotations

import math

import pandas as pd

from analysis.command import MissingError
from analysis.load import Results
from analysis.statistics import estimate

KEYS = ["scene", "label", "configuration"]
CURVE_COLUMNS = [*KEYS, "frame", "spp", "seconds", "mean", "low", "high", "seeds", "at_floor"]


def over_seeds(convergence: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Of the runs' snapshots, in the order of the runs: mean, low and high of the metric, mean seconds, the number of
    seeds, and whether any seed's error is flagged as at the reference's noise floor."""
    rows = []
    for (*keys, frame), group in convergence.groupby([*KEYS, "frame"], sort=False):
        error = estimate(group[metric])
        rows.append((*keys, frame, group.spp.iloc[0], group.elapsed_s.mean(), error.mean, error.low,
                     error.high, error.count, bool(group.at_reference_floor.any())))
    return pd.DataFrame(rows, columns=CURVE_COLUMNS)


def at_the_end(results: Results, figure: str) -> pd.DataFrame:
    """What every configuration has in the end, as configurations.csv has it: mean, low and high of the figure and, as
    `seconds`, of the time of a whole run. Raises MissingError where that file lacks the figure."""
    table = results.configurations
    for name in (figure, "elapsed_s"):
        if name not in table:
            raise MissingError(f"{results.folder}: its means over seeds have no column '{name}'")

    def ends(name: str, short: str) -> dict[str, pd.Series]:
        return {short + end: table[name + end] if name + end in table else math.nan for end in ("_low", "_high")}

    floor = table.seeds_at_reference_floor > 0 if "seeds_at_reference_floor" in table else False
    points = table[KEYS].assign(mean=table[figure], seconds=table.elapsed_s, seeds=table.seeds, at_floor=floor,
                                frame=table.frames, **ends(figure, "mean"), **ends("elapsed_s", "seconds"))
    return points.rename(columns={"mean_low": "low", "mean_high": "high"})
