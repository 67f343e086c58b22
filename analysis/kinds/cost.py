"""Speed against error: every configuration a point, at the time of its whole run and the error that it bought. Along a
grey line error × time is equal."""

from __future__ import annotations

import math
from typing import Iterator

import matplotlib
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analysis import style
from analysis.command import MissingError
from analysis.kinds.curves import X_AXES, axis_label, axis_range, check_metric, title
from analysis.kinds.request import Drawing, Request
from analysis.load import Results
from analysis.metrics import floor_column
from analysis.points import at_the_end

FLOOR_REACH = 10  # a floor further below all points is left out, to leave them room
DIAGONAL = {"color": "0.8", "linewidth": 0.6, "zorder": 0}


def _draw(axes: Axes, points: pd.DataFrame, styles: dict[str, dict]) -> None:
    for point in points.itertuples():
        look = {**styles[point.label], "linestyle": "none"}
        axes.errorbar(point.seconds, point.mean, **_bars(point), **look, label=point.label, zorder=3,
                      markerfacecolor="white" if point.at_floor else look["color"],
                      elinewidth=0.8, capsize=1.5, capthick=0.8)


def _bars(point) -> dict[str, list]:
    """The intervals of both, where there are any."""
    bars = {}
    for key, middle, low, high in (("xerr", point.seconds, point.seconds_low, point.seconds_high),
                                   ("yerr", point.mean, point.low, point.high)):
        if not math.isnan(low):
            bars[key] = [[middle - low], [high - middle]]
    return bars


def _draw_diagonals(axes: Axes) -> None:
    """Lines of equal error × time, a factor of 10 apart, or of 2 where those would be few: an unbiased sampler moves
    along them with more samples."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    step = 10 if right * top > 1000 * left * bottom else 2
    for exponent in range(math.floor(math.log(left * bottom, step)), math.ceil(math.log(right * top, step)) + 1):
        product = float(step) ** exponent
        axes.plot([left, right], [product / left, product / right], label="_diagonal", scalex=False, scaley=False,
                  **DIAGONAL)


def _range(points: pd.DataFrame) -> tuple[float, float]:
    """Of the times, with half a step of 2 to each side at least, so that close points do not fill the axis."""
    low, high = axis_range(points.assign(mean=points.seconds, low=points.seconds_low, high=points.seconds_high), [])
    return low / math.sqrt(2), high * math.sqrt(2)


def _floors(results: Results, metric: str, scene: str, lowest: float) -> list[float]:
    """The noise of the scene's references where the summary has it, without what is far below all points."""
    column = floor_column(metric)
    runs = results.finished[results.finished.scene == scene]
    known = sorted(runs[column].dropna().unique()) if column in runs else []
    return [floor for floor in known if floor >= lowest / FLOOR_REACH]


def cost_figure(results: Results, metric: str, scene: str, look: style.Look = style.COLUMN) -> Figure:
    """Raises MissingError where nothing can be drawn on logarithmic axes."""
    check_metric(results, metric)
    points = at_the_end(results, metric)
    styles = style.line_styles(points.label)  # of all scenes, so that all figures agree
    points = points[(points.scene == scene) & (points["mean"] > 0)]
    if points.empty:
        raise MissingError(f"{results.folder}: no {metric} of {scene} is above zero, so there is nothing to draw")
    floors = _floors(results, metric, scene, points["mean"].min())
    with matplotlib.rc_context(look.rc):
        figure = Figure(figsize=(look.width, look.row_height * 1.15), layout="constrained")
        if look.words:
            figure.suptitle(title(results, points), fontsize=13)
        axes = figure.subplots()
        _draw(axes, points, styles)
        axes.set(xscale="log", yscale="log", xlabel=X_AXES["seconds"], ylabel=axis_label(results, metric))
        axes.set_xlim(_range(points))
        axes.set_ylim(axis_range(points, floors))
        for floor in floors:
            axes.axhline(floor, label="_floor", zorder=1, **style.FLOOR)
        style.format_log_axis(axes.xaxis, *axes.get_xlim())
        style.format_log_axis(axes.yaxis, *axes.get_ylim())
        _draw_diagonals(axes)
        axes.set_title(scene, loc="left", fontweight="bold")
        style.fix_layout(figure, style.legend_below(figure, _entries(points, styles, bool(floors)), look))
    return figure


def _entries(points: pd.DataFrame, styles: dict[str, dict], has_floor: bool) -> list[Line2D]:
    entries = [Line2D([], [], label=label, **{**styles[label], "linestyle": "none"})
               for label in dict.fromkeys(points.label)]
    entries.append(Line2D([], [], label="equal error × time", **DIAGONAL))
    if has_floor:
        entries.append(Line2D([], [], label="reference's own noise", **style.FLOOR))
    if points.at_floor.any():
        entries.append(Line2D([], [], color="0.2", marker="o", linestyle="none", markerfacecolor="white",
                              label="at the reference's noise"))
    return entries


def draw(request: Request, medium: style.Medium) -> Iterator[Drawing]:
    for scene in dict.fromkeys(request.results.configurations.scene):
        figure = cost_figure(request.results, request.metric, scene, medium.column)
        yield Drawing(f"cost_{request.metric}_{scene}", figure)
