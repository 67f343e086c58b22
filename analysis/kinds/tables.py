"""The tables of a paper: time and error of every configuration with their intervals, and ratios to the baseline; as CSV,
Markdown and LaTeX."""

from __future__ import annotations

import math
from typing import Iterator

import pandas as pd

from analysis import style
from analysis.kinds.request import Request, Text
from analysis.load import Results
from analysis.metrics import errors
from analysis.table_file import WRITERS, Field, Table, Value

# Columns of configurations.csv besides the metrics, and what is read above them: a page has no room for the others, which
# the CSV has.
TIMES = ("host_ms_median", "gpu_ms_median", "elapsed_s")
PRODUCT = "relmse_x_s"
READ = ("host_ms_median", "mse", "relmse", "flip", PRODUCT)
# Of ratios.csv.
READ_RATIOS = ("ratio_host_ms_median", "ratio_relmse", "ratio_relmse_x_s", "ratio_equal_s_relmse_corrected", "ratio_time_to_relmse")


def _figures(results: Results) -> dict[str, str]:
    """Columns of the table of configurations, and their headings."""
    names = [*TIMES, *(metric.name for metric in errors(results.metrics.values())), PRODUCT]
    return {name: results.metrics[name].label if name in READ else "" for name in names if name in results.metrics}


def _ratio_heading(results: Results, name: str) -> str:
    """Of a column of ratios.csv; empty where it is not read."""
    if name not in READ_RATIOS:
        return ""
    figure = name.removeprefix("ratio_").removeprefix("time_to_").removeprefix("equal_s_")
    label = results.metrics[figure].label if figure in results.metrics else figure
    if name.startswith("ratio_equal_s_"):
        return f"{label} at equal seconds"
    return f"time to its {label}" if name.startswith("ratio_time_to_") else label


def _value(row: pd.Series, name: str) -> Value:
    ends = (float(row.get(name + end, math.nan)) for end in ("", "_low", "_high"))
    return Value(*ends)


def _is_measured(frame: pd.DataFrame, name: str) -> bool:
    return name in frame and not frame[name].isna().all()


def _one(rows: list[list[Field]], column: int) -> str | None:
    """What all rows have in this column, which then needs no room; None where they differ."""
    values = {str(row[column]) for row in rows}
    return values.pop() if len(values) == 1 else None


def configuration_table(results: Results) -> Table:
    configurations = results.configurations
    figures = {name: heading for name, heading in _figures(results).items() if _is_measured(configurations, name)}
    rows: list[list[Field]] = [[row.scene, row.label, int(row.frames), int(row.seeds),
                                *(_value(row, name) for name in figures)] for _, row in configurations.iterrows()]
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
    names = [name for name in ratios.columns if f"{name}_low" in ratios and name.startswith("ratio_")]
    figures = {name: _ratio_heading(results, name) for name in names if _is_measured(ratios, name)}
    rows: list[list[Field]] = [[row.scene, row.label, row.baseline_label, *(_value(row, name) for name in figures)]
                               for _, row in ratios.iterrows()]
    baseline = _one(rows, 2)
    return Table(["scene", "method", "baseline", *figures],
                 ["scene", "method", "" if baseline else "baseline", *figures.values()], rows,
                 caption=f"{results.name}{f', baseline: {baseline}' if baseline else ''}. The baseline's figure divided by the method's [95 % confidence interval]; "
                         "above 1, the baseline needs more; time to its relMSE: until the method has the baseline's.")


def draw(request: Request, medium: style.Medium) -> Iterator[Text]:
    for name, table in (("table", configuration_table(request.results)), ("ratios", ratio_table(request.results))):
        for ending, text in WRITERS.items() if table is not None else ():
            yield Text(f"{name}.{ending}", text(table))
