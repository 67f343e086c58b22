#!/usr/bin/python3
"""Draws what each cell of an ablation reaches in the end: a figure per scene with a line per cell, in the order of the
sweep; relMSE at the left, relMSE times seconds at the right, each the mean over seeds with its 95 % interval."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis import command, style
from analysis.convergence_figure import axis_range, title
from analysis.load import Results, load
from analysis.statistics import final_over_seeds

PANELS = {"relmse": "relMSE at the last frame", "relmse_x_s": "relMSE × s (seconds, learning included)"}
DPI = 160


def _draw(axes: Axes, points: pd.DataFrame) -> None:
    lines = np.arange(len(points))
    barred = points.low.notna().to_numpy()
    if barred.any():
        bars = points[barred]
        axes.errorbar(bars["mean"], lines[barred], xerr=[bars["mean"] - bars.low, bars.high - bars["mean"]],
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
    sentences = ["One seed per cell: there is no confidence interval." if single.all() else
                 "Points: mean over seeds. Bars: 95 % confidence interval of that mean (Student's t)."]
    if single.any() and not single.all():
        sentences.append("Cells of one seed have no bar.")
    if points.at_floor.any():
        sentences.append("Hollow: at the reference's own noise.")
    return " ".join(sentences)


def ablation_figure(results: Results, scene: str, look: style.Look = style.SCREEN) -> Figure:
    """Raises AnalysisError where nothing can be drawn on logarithmic axes."""
    runs = results.convergence[results.convergence.scene == scene]
    columns = {metric: final_over_seeds(runs, metric) for metric in PANELS}
    points = columns["relmse"]
    if not (points["mean"] > 0).any():
        raise command.AnalysisError(f"{results.folder}: no relMSE of {scene} is above zero, so nothing can be drawn")
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
        row[0].set_ylim(len(points) - 0.5, -0.5)  # the sweep's first cell on top
        style.fix_layout(figure)
    return figure


def _arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", metavar="RESULTS", type=Path, help="results/<experiment>")
    parser.add_argument("--out", metavar="FOLDER", type=Path, help="where to write (default: RESULTS)")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> None:
    options = _arguments(arguments)
    results = load(options.results)
    for scene in dict.fromkeys(results.finished.scene):
        figure = ablation_figure(results, scene)
        file = (options.out or options.results) / f"ablation_{scene}.png"
        command.write_whole(file, lambda target: figure.savefig(target, format="png", dpi=DPI))
        print(file)


if __name__ == "__main__":
    sys.exit(command.run(main))
