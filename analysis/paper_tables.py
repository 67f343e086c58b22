"""The tables of a paper: time and error of every cell with their intervals, and ratios to the baseline."""

from __future__ import annotations

import math

import pandas as pd

from analysis.load import Results
from analysis.table_file import Field, Table, Value

# Columns of cells.csv and what is read above them: a page has no room for the others, which the CSV has.
FIGURES = {"host_ms_median": "ms/frame", "gpu_ms_median": "", "elapsed_s": "", "mse": "MSE", "relmse": "relMSE",
           "relmse_trimmed": "", "mape": "", "smape": "", "flip": "FLIP", "relmse_x_s": "relMSE × s"}
# Of ratios.csv.
RATIOS = {"ratio_host_ms_median": "ms/frame", "ratio_gpu_ms_median": "", "ratio_mse": "", "ratio_relmse": "relMSE",
          "ratio_relmse_trimmed": "", "ratio_relmse_x_s": "relMSE × s", "ratio_time_to_relmse": "time to its relMSE"}


def _value(row: pd.Series, name: str) -> Value:
    ends = (float(row.get(name + end, math.nan)) for end in ("", "_low", "_high"))
    return Value(*ends)


def _is_measured(frame: pd.DataFrame, name: str) -> bool:
    return name in frame and not frame[name].isna().all()


def _one(rows: list[list[Field]], column: int) -> str | None:
    """What all rows have in this column, which then needs no room; None where they differ."""
    values = {str(row[column]) for row in rows}
    return values.pop() if len(values) == 1 else None


def cell_table(results: Results) -> Table:
    cells = results.cells
    figures = {name: heading for name, heading in FIGURES.items() if _is_measured(cells, name)}
    rows: list[list[Field]] = [[row.scene, row.label, int(row.frames), int(row.seeds),
                                *(_value(row, name) for name in figures)] for _, row in cells.iterrows()]
    frames, seeds = _one(rows, 2), _one(rows, 3)
    counts = "".join(f", {name}: {value}" for name, value in (("frames", frames), ("seeds", seeds)) if value)
    device = results.experiment.get("device", {}).get("renderer", "an unnamed device")
    return Table(["scene", "method", "frames", "seeds", *figures],
                 ["scene", "method", "" if frames else "frames", "" if seeds else "seeds", *figures.values()], rows,
                 caption=f"{results.name}, {device}{counts}. Means over seeds [95 % confidence interval]; ms/frame: median of "
                         "a run's frames after its warm-up, by the host's clock; s: all frames; both with learning; "
                         "errors: at the last frame.")


def ratio_table(results: Results) -> Table | None:
    """None where the config names no baseline."""
    if not results.has_ratios:
        return None
    ratios = results.ratios
    figures = {name: heading for name, heading in RATIOS.items() if _is_measured(ratios, name)}
    rows: list[list[Field]] = [[row.scene, row.label, row.baseline_label, *(_value(row, name) for name in figures)]
                               for _, row in ratios.iterrows()]
    baseline = _one(rows, 2)
    return Table(["scene", "method", "baseline", *figures],
                 ["scene", "method", "" if baseline else "baseline", *figures.values()], rows,
                 caption=f"{results.name}{f', baseline: {baseline}' if baseline else ''}. The baseline's figure divided by the method's [95 % confidence interval]; "
                         "above 1, the baseline needs more; time to its relMSE: until the method has the baseline's.")
