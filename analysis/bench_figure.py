#!/usr/bin/python3
"""Draws what `./dev bench` has measured on one page: ray queries beside Embree's, milliseconds per frame, the steps of
learning, and how the time of a frame grows. Bars and points are medians over rounds, whiskers their quartiles."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.ticker import EngFormatter, NullLocator

from analysis import command, style
from analysis.csv_file import read_csv

# By the clock, and by processor time: on a software device the one that other programs disturb less.
RATIOS = {"rays": "speed_over_embree", "frames": "over_plain", "steps": "share", "growth": "over_first"}
KEYS = {"rays": ["scene", "kind", "tracer"], "frames": ["scene", "method"], "steps": ["scene", "method", "step"],
        "growth": ["axis", "method"]}
FIGURES = {"rays": ["mrays_per_s"], "frames": ["wall_ms", "size"], "steps": [], "growth": ["value", "wall_ms"]}
WIDTH = 14.0  # inches
ROW_HEIGHT = 3.6
DPI = 130
WHOLE = "whole frame"
ENGINEERING = EngFormatter(sep="")  # 5M


def load_parts(folder: Path) -> dict[str, pd.DataFrame]:
    """The parts that are there. Raises AnalysisError for a folder without any."""
    parts = {}
    for name in KEYS:
        needed = [*KEYS[name], *FIGURES[name], RATIOS[name], f"cpu_{RATIOS[name]}"]
        if (folder / f"{name}.csv").is_file():
            parts[name] = read_csv(folder / f"{name}.csv", needed, [*KEYS[name], "measured"])
    if not parts:
        raise command.AnalysisError(f"{folder}: holds none of {', '.join(f'{name}.csv' for name in KEYS)}; "
                                    "`./dev bench` writes them")
    if is_software(folder):
        for name, rows in parts.items():
            rows[RATIOS[name]] = rows[f"cpu_{RATIOS[name]}"]
            rows.attrs["clock"] = " by CPU time"
    return parts


def is_software(folder: Path) -> bool:
    file = folder / "manifest.json"
    try:
        return bool(json.loads(file.read_text(encoding="utf-8"))["device"]["software"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise command.AnalysisError(f"{file}: does not say what was measured on: {error}") from error


def _whiskers(rows: pd.DataFrame, name: str) -> np.ndarray:
    return np.array([rows[name] - rows[f"{name}_low"], rows[f"{name}_high"] - rows[name]])


def _grouped_bars(axes: Axes, rows: pd.DataFrame, group: str, series: str, name: str, labels: list[str]) -> None:
    """A bar per series in every group, with the label of its row above it."""
    groups, kinds = list(dict.fromkeys(rows[group])), list(dict.fromkeys(rows[series]))
    width = 0.8 / len(kinds)
    for i, kind in enumerate(kinds):
        some = (rows[series] == kind).to_numpy()
        bars = rows[some]
        places = [groups.index(value) + (i - (len(kinds) - 1) / 2) * width for value in bars[group]]
        axes.bar(places, bars[name], width, yerr=_whiskers(bars, name), label=kind, color=style.COLOURS[i],
                 error_kw={"elinewidth": 0.8, "ecolor": "0.3"})
        for place, top, label in zip(places, bars[f"{name}_high"], np.array(labels, dtype=object)[some]):
            axes.annotate(label, (place, top), (0, 2), textcoords="offset points", ha="center", fontsize=6.5)
    axes.set_xticks(range(len(groups)), groups)
    axes.grid(axis="x", visible=False)
    axes.legend(fontsize=7, frameon=False, ncols=3, loc="lower right", bbox_to_anchor=(1, 1))


def _draw_rays(figure: Figure, place: SubplotSpec, rays: pd.DataFrame) -> None:
    scenes = list(dict.fromkeys(rays.scene))
    for part, scene in zip(place.subgridspec(1, len(scenes)), scenes):
        axes = figure.add_subplot(part)
        rows = rays[rays.scene == scene]
        labels = ["" if row.tracer == "Embree" else f"{row.speed_over_embree:.2f}" for row in rows.itertuples()]
        _grouped_bars(axes, rows, "kind", "tracer", "mrays_per_s", labels)
        axes.set_title(scene, loc="left")
        axes.set_ylabel(f"Mrays/s\n(above: over Embree{rays.attrs.get('clock', '')})")


def _draw_frames(figure: Figure, place: SubplotSpec, frames: pd.DataFrame) -> None:
    axes = figure.add_subplot(place)
    _grouped_bars(axes, frames, "scene", "method", "wall_ms", [f"{value:.2f}" for value in frames.over_plain])
    axes.set_ylabel(f"ms per frame\n(above: over BSDF{frames.attrs.get('clock', '')})")
    axes.set_title(f"The table of Goswami 2020, {frames['size'].iloc[0]}²", loc="left")


def _draw_steps(figure: Figure, place: SubplotSpec, steps: pd.DataFrame) -> None:
    axes = figure.add_subplot(place)
    parts = steps[steps.step != WHOLE]
    bars = list(dict.fromkeys(zip(parts.scene, parts.method)))
    for line, (scene, method) in enumerate(bars):
        left = 0.0
        some = parts[(parts.scene == scene) & (parts.method == method)]
        for i, row in enumerate(some.itertuples()):
            share = max(100 * row.share, 0)  # a difference may be lost in noise
            axes.barh(line, share, left=left, color=style.COLOURS[i], label=row.step if line == 0 else None)
            if share > 3:
                axes.annotate(f"{share:.0f}", (left + share / 2, line), ha="center", va="center", fontsize=7,
                              color="white")
            left += share
    axes.set_yticks(range(len(bars)), [f"{scene}\n{method}" for scene, method in bars], fontsize=8)
    axes.set_ylim(len(bars) - 0.5, -0.5)
    axes.set_xlabel(f"% of the frame{steps.attrs.get('clock', '')}")
    axes.grid(axis="y", visible=False)
    axes.legend(fontsize=7, ncols=3, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0))


def _short(value: float) -> str:
    return f"{value:g}" if value < 10_000 else ENGINEERING.format_eng(float(f"{value:.2g}"))


def _draw_growth(figure: Figure, place: SubplotSpec, growth: pd.DataFrame) -> None:
    names = list(dict.fromkeys(growth.axis))
    looks = style.line_styles(dict.fromkeys(growth.method))
    for part, name in zip(place.subgridspec(1, len(names)), names):
        axes = figure.add_subplot(part)
        for method, rows in growth[growth.axis == name].groupby("method", sort=False):
            axes.errorbar(rows.value, rows.wall_ms, yerr=_whiskers(rows, "wall_ms"), label=method, **looks[method])
        axes.set_xscale("log")
        axes.set_yscale("log")
        style.format_log_axis(axes.yaxis, *axes.get_ylim())
        values = sorted(set(growth[growth.axis == name].value))
        axes.set_xticks(values, [_short(value) for value in values], fontsize=7.5)
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_xlabel(name)
        axes.set_ylabel("ms per frame")
        axes.legend(fontsize=7, frameon=False)


def bench_figure(parts: dict[str, pd.DataFrame]) -> Figure:
    rows = [names for names in (["rays"], ["frames", "steps"], ["growth"]) if any(name in parts for name in names)]
    draw = {"rays": _draw_rays, "frames": _draw_frames, "steps": _draw_steps, "growth": _draw_growth}
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(WIDTH, ROW_HEIGHT * len(rows)), layout="constrained")
        grid = figure.add_gridspec(len(rows), 1)
        for place, names in zip(grid, rows):
            there = [name for name in names if name in parts]
            for part, name in zip(place.subgridspec(1, len(there)), there):
                draw[name](figure, part, parts[name])
    return figure


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="results/bench")
    folder = parser.parse_args(arguments).folder
    figure = bench_figure(load_parts(folder))
    file = folder / "bench.png"
    command.write_whole(file, lambda target: figure.savefig(target, format="png", dpi=DPI))
    print(file)


if __name__ == "__main__":
    sys.exit(command.run(main))
