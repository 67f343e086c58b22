#!/usr/bin/python3
"""Turns scene-linear OpenEXR images into PNGs to look at: exposure, then the sRGB transfer; what is brighter
than 1 is clipped, and pixels that are not finite are magenta. Of several images it makes one labelled sheet."""

from __future__ import annotations

import argparse
import math
import sys
import textwrap
from pathlib import Path

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import matplotlib.image
import numpy as np
from matplotlib.figure import Figure

from analysis import command
from analysis.exr import read_exr

MAGENTA = (255, 0, 255)
DPI = 100
MIN_SIDE = 240  # pixels of a panel: small images are enlarged by whole factors, so that labels have room


def tonemap(rgb: np.ndarray, exposure: float = 0.0) -> np.ndarray:
    """8-bit sRGB of radiance times 2^exposure. Transfer: IEC 61966-2-1."""
    finite = np.isfinite(rgb).all(axis=-1)
    linear = np.clip(np.where(finite[..., None], rgb, 0).astype(float) * 2.0 ** exposure, 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    pixels = np.rint(encoded * 255).astype(np.uint8)
    pixels[~finite] = MAGENTA
    return pixels


def read_picture(file: Path, exposure: float) -> tuple[np.ndarray, str]:
    """The picture and a label for it: its run's folder and its samples."""
    image = read_exr(file)
    rgb = image.rgb(file)
    strange = int((~np.isfinite(rgb).all(axis=-1)).sum())
    if strange:
        print(f"warning: {file}: {strange} pixels are not finite and drawn magenta", file=sys.stderr)
    place = file.resolve().parent.name
    place = "reference" if place == "references" else place.replace(",", ", ")
    samples = image.metadata.get("spp")
    return tonemap(rgb, exposure), f"{place}\n{samples} spp" if samples else f"{place}\n{file.name}"


def sheet(pictures: list[np.ndarray], labels: list[str], columns: int, exposure: float) -> Figure:
    """All at one scale, side by side, each below its label."""
    scale = max(1, math.ceil(MIN_SIDE / max(picture.shape[1] for picture in pictures)))
    width = max(picture.shape[1] for picture in pictures) * scale / DPI
    height = max(picture.shape[0] for picture in pictures) * scale / DPI
    columns = min(columns, len(pictures))
    rows = math.ceil(len(pictures) / columns)
    # 9-point letters are about 0.075 inches wide.
    letters = max(12, int(width / 0.075))
    texts = ["\n".join(textwrap.fill(line, letters) for line in label.split("\n")) for label in labels]
    head = 0.16 * max(text.count("\n") + 1 for text in texts) + 0.1
    gap, foot = 0.12, 0.3
    total = columns * (width + gap) + gap, rows * (height + head + gap) + foot
    figure = Figure(figsize=total, dpi=DPI)
    for i, (picture, text) in enumerate(zip(pictures, texts)):
        left = gap + i % columns * (width + gap)
        top = total[1] - head - i // columns * (height + head + gap)
        size = picture.shape[1] * scale / DPI, picture.shape[0] * scale / DPI
        axes = figure.add_axes((left / total[0], (top - size[1]) / total[1], size[0] / total[0], size[1] / total[1]))
        axes.imshow(picture, interpolation="nearest", aspect="auto")
        axes.set_axis_off()
        axes.set_title(text, fontsize=9, pad=3)
    figure.text(0.5, 0.1 / total[1], f"exposure {exposure:+g} stops, sRGB", fontsize=8, color="0.35", ha="center")
    return figure


def check_exposure(exposure: float) -> None:
    if not math.isfinite(exposure) or abs(exposure) > 100:
        raise command.AnalysisError("the exposure must be between -100 and 100 stops")


def _arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("images", metavar="IN.exr", type=Path, nargs="+", help="with channels R, G, B")
    parser.add_argument("out", metavar="OUT.png", type=Path)
    parser.add_argument("--exposure", metavar="STOPS", type=float, default=0.0, help="brightens by 2^STOPS")
    parser.add_argument("--sheet", action="store_true", help="a labelled sheet even of one image")
    parser.add_argument("--label", action="append", metavar="TEXT", help="for each image in turn, on the sheet")
    parser.add_argument("--columns", type=int, default=4, help="of the sheet (default: 4)")
    return parser.parse_args(arguments)


def _check(options: argparse.Namespace) -> None:
    if options.out.suffix.lower() != ".png":
        raise command.AnalysisError(f"{options.out}: the last file is written and must end in .png")
    if options.label and len(options.label) != len(options.images):
        raise command.AnalysisError(f"{len(options.images)} images need as many labels, not {len(options.label)}")
    if options.columns < 1:
        raise command.AnalysisError("a sheet needs one column at least")
    check_exposure(options.exposure)


def main(arguments: list[str] | None = None) -> None:
    options = _arguments(arguments)
    _check(options)
    pictures, labels = zip(*(read_picture(file, options.exposure) for file in options.images))
    if len(pictures) > 1 or options.sheet:
        figure = sheet(list(pictures), options.label or list(labels), options.columns, options.exposure)
        command.write_whole(options.out, lambda target: figure.savefig(target, format="png"))
    else:
        command.write_whole(options.out, lambda target: matplotlib.image.imsave(target, pictures[0], format="png"))
    print(options.out)


if __name__ == "__main__":
    sys.exit(command.run(main))
