"""What each configuration reaches in the end: a figure per scene with a line per configuration, in the order of the sweep;
relMSE at the left, relMSE times seconds at the right, each the mean over seeds with its 95 % interval, as
configurations.csv has them."""

from __future__ import annotations

from typing import Iterator

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis import style
from analysis.command import MissingError
from analysis.kinds.curves import axis_range, title
from analysis.kinds.request import Drawing, Request
from analysis.load import Results
from analysis.points import at_the_end

PANELS = {"relmse": "relMSE at the last frame", "relmse_x_s": "relMSE × s (seconds, learning included)"}


def _draw(axes: Axes, points: pd.DataFrame) -> None:
    lines = np.arange(len(points))
    barred = points.low.notna().to_numpy()
    if barred.any():
        bars = points[barred]
        axes.errorbar(bars["mean"], lines[barred], xerr=np.array([bars["mean"] - bars.low, bars.high - bars["mean"]]),
                      fmt="none", ecolor="0.45", capsize=2.5, zorder=2)
    for floor, face in ((False, style.COLOURS[0]), (True, "white")):
        some = (points.at_floor == floor).to_numpy()
        axes.plot(points["mean"][some], lines[some], "o", color=style.COLOURS[0], markerfacecolor=face, zorder=3)
    axes.set_xscale("log")
    axes.set_xlim(axis_range(points, []))
    style.format_log_axis(axes.xaxis, *axes.get_xlim())
    axes.grid(axis="y", visible=False)


def _caption(points: pd.DataFrame) -> str:
    single = points.seeds == 1
    sentences = ["One seed per configuration: there is no confidence interval." if single.all() else
                 "Points: mean over seeds. Bars: 95 % confidence interval of that mean (Student's t)."]
    if single.any() and not single.all():
        sentences.append("Configurations of one seed have no bar.")
    if points.at_floor.any():
        sentences.append("Hollow: at the reference's own noise.")
    return " ".join(sentences)


def ablation_figure(results: Results, scene: str, look: style.Look = style.SCREEN) -> Figure:
    """Raises MissingError where nothing can be drawn on logarithmic axes."""
    columns = {}
    for metric in PANELS:
        points = at_the_end(results, metric)
        columns[metric] = points[points.scene == scene]
    points = columns["relmse"]
    if not (points["mean"] > 0).any():
        raise MissingError(f"{results.folder}: no relMSE of {scene} is above zero, so nothing can be drawn")
    with matplotlib.rc_context(look.rc):
        figure = Figure(figsize=(look.width, look.line_height * len(points) + (1.7 if look.words else 0.6)),
                        layout="constrained")
        if look.words:
            figure.suptitle(title(results, points), fontsize=13)
            figure.supxlabel(_caption(points), fontsize=look.note_size, color="0.25")
        row = figure.subplots(1, len(PANELS), sharey=True)
        for axes, (metric, label) in zip(row, PANELS.items()):
            _draw(axes, columns[metric])
            axes.set_xlabel(label)
        row[0].set_title(scene, loc="left", fontweight="bold")
        row[0].set_yticks(np.arange(len(points)), points.label)
        row[0].set_ylim(len(points) - 0.5, -0.5)  # the sweep's first configuration on top
        style.fix_layout(figure)
    return figure


def draw(request: Request, medium: style.Medium) -> Iterator[Drawing]:
    for scene in dict.fromkeys(request.results.configurations.scene):
        yield Drawing(f"ablation_{scene}", ablation_figure(request.results, scene, medium.page))
