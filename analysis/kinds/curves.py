"""Error against samples and against seconds: a row of panels per scene, a line per configuration."""

from __future__ import annotations

import textwrap
from typing import Iterator, Sequence

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter

from analysis import style
from analysis.command import MissingError, check_one_of
from analysis.kinds.request import Drawing, Request
from analysis.load import Results
from analysis.metrics import errors, floor_column
from analysis.points import over_seeds

X_AXES = {"spp": "samples per pixel (spp)", "seconds": "render time (s), learning included"}
LABEL_WIDTH = 34   # letters of an axis' label before its line is broken


def axis_range(points: pd.DataFrame, floors: list[float]) -> tuple[float, float]:
    """Of a logarithmic axis: all means and near floors, and of the bands what leaves the means room."""
    means = points["mean"][points["mean"] > 0]
    lowest, highest = means.min(), means.max()
    bottom = np.nanmin([lowest, max(points.low.min(), lowest / style.BAND_REACH)])
    top = np.nanmax([highest, min(points.high.max(), highest * style.BAND_REACH)])
    bottom = min([bottom, *(floor for floor in floors if floor >= lowest / style.FLOOR_REACH)])
    margin = (top / bottom) ** 0.06 * 1.02
    return bottom / margin, top * margin


def draw_lines(axes: Axes, points: pd.DataFrame, x: str, styles: dict[str, dict]) -> None:
    faint = min(1, 8 / len(styles))  # many bands over each other shall not hide the lines
    for label, line in points.groupby("label", sort=False):
        look = styles[label]
        at_floor = line.at_floor.to_numpy()
        axes.plot(line[x], line["mean"], label=label, markevery=~at_floor, zorder=3, **look)
        if at_floor.any():
            axes.plot(line[x], line["mean"], label=f"_{label} at floor", markevery=at_floor, zorder=4,
                      **{**look, "linestyle": "none", "markerfacecolor": "white"})
        if line.low.notna().any():
            axes.fill_between(line[x], line.low, line.high, label=f"_{label} band", linewidth=0.7, zorder=2,
                              facecolor=to_rgba(look["color"], 0.16 * faint),
                              edgecolor=to_rgba(look["color"], 0.45 * faint))


def _floor_values(convergence: pd.DataFrame, column: str) -> list[float]:
    """Each reference's noise once; none where it is not known in this metric."""
    return sorted(convergence[column].dropna().unique()) if column in convergence else []


def _draw_floors(axes: Axes, floors: list[float], note_size: float | None) -> None:
    """`note_size`: of the words; None: a line alone."""
    bottom = axes.get_ylim()[0]
    inside = [floor for floor in floors if floor >= bottom]
    for floor in inside:
        axes.axhline(floor, label="_floor", zorder=1, **style.FLOOR)
    if note_size is None or not floors:
        return
    note = {"xytext": (4, 3), "textcoords": "offset points", "fontsize": note_size, "color": "0.25", "zorder": 5,
            "bbox": {"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.8}}
    values = " to ".join(f"{floor:.2g}" for floor in dict.fromkeys((floors[0], floors[-1])))
    if inside:
        axes.annotate(f"reference's own noise: {values}", (0, inside[-1]), xycoords=("axes fraction", "data"), **note)
    else:
        axes.annotate(f"reference's own noise: {values}, below this axis ↓", (0, 0), xycoords="axes fraction", **note)


def _format_panel(axes: Axes, points: pd.DataFrame, x: str, y_range: tuple[float, float]) -> None:
    base = 2 if x == "spp" else 10  # snapshots are at powers of two
    axes.set_xscale("log", base=base)
    axes.set_yscale("log")
    axes.set_ylim(y_range)
    style.format_log_axis(axes.yaxis, *y_range)
    if x == "spp":
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    else:
        style.format_log_axis(axes.xaxis, points[x].min(), points[x].max())
    axes.set_xlabel(X_AXES[x])


def _legend(figure: Figure, points: pd.DataFrame, styles: dict[str, dict], has_floor: bool,
            look: style.Look) -> float:
    entries = [Line2D([], [], label=label, **look) for label, look in styles.items()]
    if points.low.notna().any():
        entries.append(Patch(color="0.5", alpha=0.3, linewidth=0, label="95 % confidence of the mean"))
    if has_floor:
        entries.append(Line2D([], [], label="reference's own noise", **style.FLOOR))
    if points.at_floor.any():
        entries.append(Line2D([], [], color="0.2", marker="o", linestyle="none", markerfacecolor="white",
                              label="at the reference's noise"))
    return style.legend_below(figure, entries, look)


def _span(values: pd.Series, unit: str) -> str:
    low, high = int(values.min()), int(values.max())
    count = str(low) if low == high else f"{low} to {high}"
    return f"{count} {unit}" + ("" if count == "1" else "s")


def title(results: Results, points: pd.DataFrame) -> str:
    """What was run: the experiment's name, and how many seeds and frames."""
    text = f"{results.name}: {_span(points.seeds, 'seed')}, {_span(results.finished.frames, 'frame')}"
    finished = len(results.finished)
    return text if finished == results.planned_runs else f"{text}, {finished} of {results.planned_runs} runs"


def _caption(results: Results, points: pd.DataFrame, has_floor: bool) -> str:
    single = points.seeds == 1
    sentences = ["One seed per line: there is no confidence band." if single.all() else
                 "Lines: mean over seeds. Bands: 95 % confidence interval of that mean (Student's t)."]
    if single.any() and not single.all():
        sentences.append("Lines of one seed have no band.")
    if not has_floor:
        sentences.append("The reference's own noise is not known in this metric.")
    device = results.experiment.get("device", {}).get("renderer")
    sentences.append(f"Time: host clock, setup left out{f', on {device}' if device else ''}.")
    return textwrap.fill(" ".join(sentences), 155)


def check_metric(results: Results, metric: str) -> None:
    check_one_of("metric", metric, [one.name for one in errors(results.metrics.values())])


def axis_label(results: Results, metric: str) -> str:
    return textwrap.fill(results.metrics[metric].axis, LABEL_WIDTH)


def metric_points(results: Results, metric: str) -> pd.DataFrame:
    """Means over seeds. Raises MissingError where nothing can be drawn on logarithmic axes."""
    check_metric(results, metric)
    measured = results.convergence.get(metric)
    if measured is None or (len(measured) and measured.isna().all()):
        hint = ': "flip": true in the config asks for it' if metric == "flip" else ""
        raise MissingError(f"{results.folder}: no {metric} was measured{hint}")
    points = over_seeds(results.convergence, metric)
    if not (points["mean"] > 0).any():
        raise MissingError(f"{results.folder}: no {metric} is above zero, so there is nothing to draw")
    return points


def convergence_figure(results: Results, metric: str, look: style.Look = style.SCREEN,
                       scenes: Sequence[str] | None = None, x_axes: Sequence[str] = tuple(X_AXES)) -> Figure:
    """A row per scene (default: all) and a column per axis. Raises MissingError where nothing can be drawn."""
    points = metric_points(results, metric)
    styles = style.line_styles(points.label)  # of all scenes, so that all figures agree
    points = points[points.scene.isin(scenes or points.scene)]
    styles = {name: styles[name] for name in dict.fromkeys(points.label)}
    shown = list(dict.fromkeys(points.scene))
    floor = floor_column(metric)
    with matplotlib.rc_context(look.rc):
        figure = Figure(figsize=(look.width, look.row_height * len(shown) + (0.8 if look.words else 0)),
                        layout="constrained")
        if look.words:
            figure.suptitle(title(results, points), fontsize=13)
            figure.supxlabel(_caption(results, points, floor in results.convergence), fontsize=look.note_size, color="0.25")
        grid = figure.subplots(len(shown), len(x_axes), squeeze=False)
        any_floor = False
        for scene, row in zip(shown, grid):
            here = points[points.scene == scene]
            floors = _floor_values(results.convergence[results.convergence.scene == scene], floor)
            y_range = axis_range(here, floors)
            for x, axes in zip(x_axes, row):
                draw_lines(axes, here, x, styles)
                _format_panel(axes, here, x, y_range)
                _draw_floors(axes, floors, look.note_size if x == x_axes[0] else None)
            row[0].set_ylabel(axis_label(results, metric))
            row[0].set_title(scene, loc="left", fontweight="bold")
            any_floor = any_floor or any(value >= y_range[0] for value in floors)
        style.fix_layout(figure, _legend(figure, points, styles, any_floor, look))
    return figure


def draw(request: Request, medium: style.Medium) -> Iterator[Drawing]:
    """All scenes in one figure; in print, a figure for each scene and axis besides, for a column of its own."""
    results, metric = request.results, request.metric
    yield Drawing(f"curves_{metric}", convergence_figure(results, metric, medium.page))
    for scene in dict.fromkeys(results.convergence.scene) if medium.is_print else ():
        for x in X_AXES:
            yield Drawing(f"curves_{metric}_{scene}_{x}", convergence_figure(results, metric, medium.column, [scene], [x]))
