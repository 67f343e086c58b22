#!/usr/bin/python3
"""Draws how every cell compares with the config's baseline: a line per scene, a point per method, from `ratios.csv`. At
the left the baseline's relMSE over the cell's after as many samples, in the middle that of relMSE × seconds, at the right
how much sooner the cell has the MSE that the baseline ends with. Right of 1 the cell is better. Needs no files of runs."""

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

from analysis import command, load, style
from analysis.csv_file import read_csv

PANELS = {"ratio_relmse": "relMSE at equal samples", "ratio_relmse_x_s": "relMSE × s (learning included)",
          "ratio_time_to_mse": "time to the baseline's MSE"}
DPI = 160
SPREAD = 0.5  # of a scene's line, over which its methods are laid out


def read_gains(folder: Path, methods: list[str]) -> pd.DataFrame:
    """A row per cell that is compared: `method`, `scene` and the columns of ratios.csv. `methods`: which; empty: all."""
    needed = [f"{column}{end}" for column in PANELS for end in ("", "_low", "_high")]
    ratios = read_csv(folder / "ratios.csv", [*load.RATIOS_COLUMNS, *needed])
    summary = read_csv(folder / "summary.csv", load.SUMMARY_COLUMNS)
    names = dict(zip(summary.cell, load.labels_of(summary)))
    ratios.insert(1, "method", ratios.cell.map(names))
    # As the sweep calls it, which may be a label.
    called = dict(zip(summary.cell, summary["axis:scene"])) if "axis:scene" in summary else {}
    ratios["scene"] = ratios.cell.map(called).fillna(ratios.scene)
    for method in methods:
        command.check_one_of("method", method, list(dict.fromkeys(ratios.method)))
    return ratios[ratios.method.isin(methods)] if methods else ratios


def _draw(axes: Axes, gains: pd.DataFrame, column: str) -> None:
    scenes, methods = (list(dict.fromkeys(gains[key])) for key in ("scene", "method"))
    looks = style.line_styles(methods)
    axes.axvline(1, **style.FLOOR)
    for place, method in enumerate(methods):
        own = gains[(gains.method == method) & (gains[column] > 0)]
        lines = [scenes.index(scene) + SPREAD * ((place + 0.5) / len(methods) - 0.5) for scene in own.scene]
        low, high = (own[f"{column}_{end}"].fillna(own[column]) for end in ("low", "high"))
        axes.errorbar(own[column], lines, xerr=[own[column] - low, high - own[column]], capsize=2.5, elinewidth=1,
                      label=method, **{**looks[method], "linestyle": "none"})
    axes.set_xscale("log")
    values = gains[[column, f"{column}_low", f"{column}_high"]].to_numpy(float)
    values = values[np.isfinite(values) & (values > 0)]
    axes.set_xlim(min(values.min(initial=1), 1) / 1.15, max(values.max(initial=1), 1) * 1.15)
    style.format_log_axis(axes.xaxis, *axes.get_xlim())
    axes.grid(axis="y", visible=False)


def gain_figure(gains: pd.DataFrame, name: str, look: style.Look = style.SCREEN) -> Figure:
    scenes = list(dict.fromkeys(gains.scene))
    lines = len(scenes) * max(2, 0.6 * gains.method.nunique())
    with matplotlib.rc_context(look.rc):
        figure = Figure(figsize=(look.width, look.line_height * lines + 1.3), layout="constrained")
        baselines = sorted({cell.rpartition(" / ")[2] for cell in gains.baseline})
        figure.suptitle(f"{name}: times better than {', '.join(baselines)}", fontsize=13)
        row = figure.subplots(1, len(PANELS), sharey=True)
        for axes, (column, label) in zip(row, PANELS.items()):
            _draw(axes, gains, column)
            axes.set_xlabel(label)
        row[0].set_yticks(np.arange(len(scenes)), scenes)
        row[0].set_ylim(len(scenes) - 0.5, -0.5)  # the sweep's first scene on top
        figure.supxlabel("Bars: 95 % confidence interval over seeds. No point: the baseline's MSE was never reached.",
                         fontsize=look.note_size, color="0.25")
        share = style.legend_below(figure, row[0].get_legend_handles_labels()[0], look)
        style.fix_layout(figure, share)
    return figure


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", metavar="RESULTS", type=Path, help="results/<experiment>, whose config names a baseline")
    parser.add_argument("--method", metavar="LABEL", action="append", default=[], help="only this one; may be repeated")
    parser.add_argument("--out", metavar="FOLDER", type=Path, help="where to write (default: RESULTS)")
    options = parser.parse_args(arguments)
    gains = read_gains(options.results, options.method)
    figure = gain_figure(gains, str(load.read_manifest(options.results / "manifest.json").get("experiment", "")))
    file = (options.out or options.results) / "gains.png"
    command.write_whole(file, lambda target: figure.savefig(target, format="png", dpi=DPI))
    print(file)


if __name__ == "__main__":
    sys.exit(command.run(main))
