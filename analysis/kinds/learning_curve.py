"""How a table approaches the truth where that is known: in a closed scene whose incident radiance is the same
everywhere and from everywhere. The error of a table is the root mean square of value / truth - 1 over its visited
entries; the figure has a line per configuration over the frames, with the mean over seeds and its 95 % interval."""

from __future__ import annotations

import math
import textwrap
from pathlib import Path
from typing import Iterator

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator

from analysis import style
from analysis.command import AnalysisError, LoadError, MissingError
from analysis.kinds.curves import axis_range, draw_lines, title
from analysis.kinds.request import Drawing, Request
from analysis.load import Results, read_manifest
from analysis.points import over_seeds


def _read_table(file: Path) -> np.ndarray:
    try:
        table = np.load(file, allow_pickle=False)
    except FileNotFoundError as error:
        raise MissingError(f"{file}: no such file; the config needs \"save_table\": \"snapshots\"") from error
    except (OSError, ValueError) as error:
        raise LoadError(f"{file}: cannot be read as a NumPy array: {error}") from error
    if table.ndim != 2:
        raise LoadError(f"{file}: has {table.ndim} dimensions where rows and columns are needed")
    return table


def _direction_bins(run: Path) -> int:
    """The first columns of a row; learned lights come after them."""
    file = run / "manifest.json"
    try:
        config = read_manifest(file)["config"]
        if config["sampler"] != "rl":
            raise MissingError(f"{run}: has learned no directions, because its sampler is {config['sampler']}")
        return int(config["rl"]["bins_theta"]) * int(config["rl"]["bins_phi"])
    except (KeyError, TypeError, ValueError) as error:
        raise LoadError(f"{file}: does not say how many direction bins the run had") from error


def table_error(run: Path, frame: int, truth: float) -> float:
    """NaN where nothing was visited."""
    bins = _direction_bins(run)
    values, visits = (_read_table(run / f"{kind}_{frame:06}.npy")[:, :bins] for kind in ("q_values", "q_visits"))
    if values.shape != visits.shape:
        raise LoadError(f"{run}: values and visits of frame {frame} have different sizes")
    visited = values[visits > 0].astype(float)
    return float(np.sqrt(np.mean((visited / truth - 1) ** 2))) if visited.size else math.nan


def table_errors(results: Results, truth: float) -> pd.DataFrame:
    """The rows of `convergence` with the table's `error` in place of the image's."""
    rows = results.convergence
    errors = [table_error(results.folder / row.run, row.frame, truth) for row in rows.itertuples()]
    return rows.assign(error=errors, at_reference_floor=False)


def learning_figure(results: Results, truth: float, look: style.Look = style.NARROW) -> Figure:
    """Raises MissingError where nothing can be drawn on logarithmic axes."""
    points = over_seeds(table_errors(results, truth), "error")
    if not (points["mean"] > 0).any():
        raise MissingError(f"{results.folder}: no table's error is above zero, so there is nothing to draw")
    scenes = list(dict.fromkeys(points.scene))
    if len(scenes) > 1:
        raise AnalysisError(f"{results.folder}: has scenes {', '.join(scenes)}, but one truth fits only one")
    styles = style.line_styles(points.label)
    sentences = [f"Over entries visited so far, whose true value is {truth:g}."]
    sentences.append("One seed per line: there is no confidence band." if (points.seeds == 1).all() else
                     "Lines: mean over seeds. Bands: 95 % confidence interval of that mean (Student's t).")
    with matplotlib.rc_context(look.rc):
        figure = Figure(figsize=(look.width, 1.35 * look.row_height), layout="constrained")
        if look.words:
            figure.suptitle(title(results, points), fontsize=13)
            figure.supxlabel(textwrap.fill(" ".join(sentences), 105), fontsize=look.note_size, color="0.25")
        axes = figure.subplots()
        draw_lines(axes, points, "frame", styles)
        axes.set_xscale("log", base=2)  # snapshots are at powers of two
        axes.xaxis.set_major_locator(LogLocator(2, numticks=21))
        axes.set_yscale("log")
        axes.set_ylim(axis_range(points, []))
        style.format_log_axis(axes.yaxis, *axes.get_ylim())
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.set_xlabel("frames")
        axes.set_ylabel("error of the table: rms of value / truth - 1")
        axes.set_title(scenes[0], loc="left", fontweight="bold")
        axes.legend(frameon=False, handlelength=3)
    return figure


def draw(request: Request, medium: style.Medium) -> Iterator[Drawing]:
    if not any(request.folder.glob("*/q_values_*.npy")):
        raise MissingError(f"{request.folder}: no run has saved its table; the config needs \"save_table\": \"snapshots\"")
    if request.truth is None:
        raise MissingError("needs --truth RADIANCE, the value that all entries of a table should have")
    yield Drawing("learning_curve", learning_figure(request.results, request.truth, medium.column))
