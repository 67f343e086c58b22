#!/usr/bin/python3
"""Draws the error map of `qtrace compare --heat FILE.exr` with a labelled scale: the one that the PNG has."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import matplotlib
import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from analysis import command, style
from analysis.exr import ExrImage, read_exr

DPI = 160
SIDE = 5.0  # inches of the longer side
NOT_FINITE = "#00ff00"


def heat_figure(image: ExrImage, file: Path) -> Figure:
    """Raises AnalysisError unless the file is a heat map."""
    try:
        errors, metric = image.channels["Y"], image.metadata["metric"]
        bottom, top = float(image.metadata["heatBottom"]), float(image.metadata["heatTop"])
    except (KeyError, ValueError) as error:
        raise command.AnalysisError(f"{file}: is no heat map; `qtrace compare --heat FILE.exr` writes them") from error
    norm = LogNorm(bottom, top, clip=True) if bottom > 0 else Normalize(bottom, top, clip=True)
    colours = matplotlib.colormaps["magma"].with_extremes(bad=NOT_FINITE)
    finite = np.isfinite(errors)
    height, width = errors.shape
    scale = SIDE / max(height, width)
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(width * scale + 1.3, height * scale + 0.6), layout="constrained")
        axes = figure.subplots()
        shown = axes.imshow(np.ma.masked_array(errors, ~finite), norm=norm, cmap=colours, interpolation="nearest")
        axes.set_axis_off()
        bar = figure.colorbar(shown, ax=axes, extend="max" if (errors[finite] > top).any() else "neither")
        bar.set_label(f"{metric} per pixel")
        mean = f"mean {errors[finite].mean(dtype=float):.4g}" if finite.any() else "no pixel is finite"
        axes.set_title(mean if finite.all() else f"{mean}; not finite (green): {(~finite).sum()}", fontsize=9)
    return figure


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("heat", metavar="HEAT.exr", type=Path, help="made by qtrace compare --heat HEAT.exr")
    parser.add_argument("out", metavar="OUT.png", type=Path)
    options = parser.parse_args(arguments)
    if options.out.suffix.lower() != ".png":
        raise command.AnalysisError(f"{options.out}: the figure is written as .png")
    figure = heat_figure(read_exr(options.heat), options.heat)
    command.write_whole(options.out, lambda target: figure.savefig(target, format="png", dpi=DPI))
    print(options.out)


if __name__ == "__main__":
    sys.exit(command.run(main))
