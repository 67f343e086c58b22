"""What `qtrace inspect` found of a run: its cells and their visits as the camera sees them, and for one pixel the
hemisphere of incident radiance as the table has learned it, as it is on average over each bin, and as it is."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Iterator

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize, PowerNorm
from matplotlib.figure import Figure, SubFigure

from analysis import style
from analysis.command import MissingError
from analysis.exr import ExrError, ExrImage, read_exr
from analysis.kinds.request import Drawing, Request
from analysis.load import read_manifest
from analysis.tonemap import tonemap

CELL_CHANNELS = ["cell", "visits", "R", "G", "B"]
HEMISPHERE_CHANNELS = ["bin", "learned", "true.R", "true.G", "true.B", "true_bin"]
# Radiance spans decades between a light and a wall: shown by its cube root, so that both can be read.
GAMMA = 1 / 3
WIDTH = 11.0  # inches
RC = {"axes.grid": False}


def _read(file: Path, channels: list[str]) -> ExrImage:
    if not file.is_file():
        raise ExrError(f"{file}: no such file; `qtrace inspect` writes it")
    image = read_exr(file)
    missing = [name for name in channels if name not in image.channels]
    if missing:
        raise ExrError(f"{file}: has no channel '{missing[0]}'")
    return image


def read_inspection(run: Path) -> tuple[ExrImage, ExrImage, tuple[int, int]]:
    """The cells, and the hemisphere of the pixel that was inspected last."""
    file = run / "inspect" / "cells.exr"
    cells = _read(file, CELL_CHANNELS)
    place = re.fullmatch(r"(\d+),(\d+)", cells.metadata.get("pixel", ""))
    if place is None:
        raise ExrError(f"{file}: does not say which pixel was inspected")
    x, y = int(place[1]), int(place[2])
    hemisphere = _read(run / "inspect" / f"hemisphere_{x}_{y}.exr", HEMISPHERE_CHANNELS)
    return cells, hemisphere, (x, y)


def _mark(axes: Axes, pixel: tuple[int, int]) -> None:
    for colour, width in (("black", 4.0), ("white", 1.8)):
        axes.plot(*pixel, "o", markersize=13, markerfacecolor="none", markeredgecolor=colour, markeredgewidth=width)


def _draw_cells(part: SubFigure, cells: ExrImage, pixel: tuple[int, int]) -> None:
    colours, visits = part.subplots(1, 2)
    colours.imshow(tonemap(np.stack([cells.channels[name] for name in "RGB"], axis=-1)), interpolation="nearest")
    shown = len(np.unique(cells.channels["cell"][cells.channels["cell"] >= 0]))
    colours.set_title(f"cells in false colour: {shown} in view")
    counts = np.ma.masked_less_equal(cells.channels["visits"], 0)
    norm = LogNorm(counts.min(), max(counts.max(), 2 * counts.min())) if counts.count() else LogNorm(1, 2)
    colour_map = matplotlib.colormaps["viridis"].with_extremes(bad="0.85")
    image = visits.imshow(counts, norm=norm, cmap=colour_map, interpolation="nearest")
    visits.set_title("visits per cell (grey: none)")
    part.colorbar(image, ax=visits, label="targets so far")
    for axes in (colours, visits):
        _mark(axes, pixel)
        axes.set_axis_off()


def hemisphere_panels(hemisphere: ExrImage) -> dict[str, np.ndarray]:
    """By title; masked outside the disk. Channels are averaged, as the table does."""
    channels = hemisphere.channels
    outside = channels["bin"] < 0
    full = (channels["true.R"] + channels["true.G"] + channels["true.B"]) / 3
    return {title: np.ma.masked_where(outside | ~np.isfinite(plane), plane)
            for title, plane in (("learned", channels["learned"]), ("true, averaged over bins", channels["true_bin"]),
                                 ("true", full))}


def radiance_scale(panels: dict[str, np.ndarray]) -> Normalize:
    """From zero to the brightest bin; a light that is smaller than its bin is brighter than that, and clipped."""
    brightest = max(float(panels[title].max() or 0) for title in ("learned", "true, averaged over bins"))
    return PowerNorm(GAMMA, vmin=0, vmax=brightest if brightest > 0 else 1, clip=True)


def _draw_hemispheres(part: SubFigure, hemisphere: ExrImage) -> None:
    panels = hemisphere_panels(hemisphere)
    norm = radiance_scale(panels)
    row = part.subplots(1, len(panels))
    for axes, (title, plane) in zip(row, panels.items()):
        image = axes.imshow(plane, norm=norm, cmap="inferno", interpolation="nearest")
        axes.set_title(title)
        axes.set_axis_off()
    clipped = bool(panels["true"].max() > norm.vmax)
    ticks = norm.inverse(np.linspace(0, 1, 6))  # evenly spaced on the page
    part.colorbar(image, ax=list(row), label="incident radiance, mean of R, G, B", ticks=ticks, format="%.2g",
                  extend="max" if clipped else "neither")


def table_note(config: dict[str, Any]) -> str:
    """What a reader must know before comparing learned with true; empty where both show the same."""
    learns_rest = config.get("rl", {}).get("learns", "all") == "beyond_nee" and config.get("nee", "none") != "none"
    return " Learned: what next event estimation leaves of it to the path's own rays." if learns_rest else ""


def inspection_figure(cells: ExrImage, hemisphere: ExrImage, pixel: tuple[int, int], name: str,
                      note: str = "") -> Figure:
    facts = hemisphere.metadata
    height, width = cells.channels["cell"].shape
    with matplotlib.rc_context({**style.RC, **RC}):
        pictures = min(0.45 * WIDTH * height / width, 0.7 * WIDTH) + 0.5
        hemispheres = 0.31 * WIDTH
        figure = Figure(figsize=(WIDTH, pictures + hemispheres + 0.9), layout="constrained")
        figure.suptitle(f"{name}: what the table holds after frame {facts.get('frame', '?')}", fontsize=13)
        top, bottom = figure.subfigures(2, 1, height_ratios=[pictures, hemispheres + 0.4])
        _draw_cells(top, cells, pixel)
        bottom.suptitle(f"pixel {pixel[0]}, {pixel[1]} (circle above), cell {facts.get('cell', '?')}: "
                        "radiance from the hemisphere about the normal", fontsize=11)
        _draw_hemispheres(bottom, hemisphere)
        figure.supxlabel("Lambert's equal-area projection, the horizon outside. True: path traced from that point, "
                         f"{facts.get('samples', '?')} paths per pixel.{note}", fontsize=8.5, color="0.25")
    return figure


def _draw_run(run: Path) -> Drawing:
    """Beside the files that it is of, where the report page looks for it, too."""
    cells, hemisphere, pixel = read_inspection(run)
    resolved = run.resolve()
    manifest = run / "manifest.json"
    config = read_manifest(manifest).get("config", {}) if manifest.is_file() else {}
    figure = inspection_figure(cells, hemisphere, pixel, f"{resolved.parent.name}/{resolved.name}", table_note(config))
    return Drawing(f"inspect_{resolved.name}", figure, run / "inspect" / "inspect", rc=RC)


def draw(request: Request, medium: style.Medium) -> Iterator[Drawing]:
    """Of every run of an experiment that was inspected, or of the one run whose folder it is."""
    files = sorted(request.folder.glob("*/inspect/cells.exr"))
    runs = [request.folder] if (request.folder / "inspect").is_dir() else [file.parent.parent for file in files]
    if not runs:
        raise MissingError(f"{request.folder}: no run was inspected; `./dev inspect RUN_FOLDER` does it")
    for run in runs:
        yield _draw_run(run)
