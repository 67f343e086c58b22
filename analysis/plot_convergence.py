#!/usr/bin/python3
"""Draws error against samples per pixel and against seconds for the folder of one experiment."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import matplotlib

from analysis import command, style
from analysis.convergence_figure import METRICS, convergence_figure
from analysis.load import load

FORMATS = ("png", "pdf", "svg")
DPI = 160


def _arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", metavar="RESULTS", type=Path, help="results/<experiment>")
    parser.add_argument("--metric", default="relmse", help=f"{', '.join(METRICS)} (default: relmse)")
    parser.add_argument("--out", metavar="FOLDER", type=Path, help="where to write (default: RESULTS)")
    parser.add_argument("--format", default="png", help=f"one or more of {','.join(FORMATS)} (default: png)")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> None:
    options = _arguments(arguments)
    formats = options.format.split(",")
    command.check_one_of("metric", options.metric, METRICS)
    for name in formats:
        command.check_one_of("format", name, FORMATS)
    figure = convergence_figure(load(options.results), options.metric)
    for name in formats:
        file = (options.out or options.results) / f"convergence_{options.metric}.{name}"
        # Without a date the same results give the same bytes.
        metadata = {"png": {}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}[name]
        with matplotlib.rc_context(style.RC):
            command.write_whole(file, lambda target: figure.savefig(
                target, format=name, dpi=DPI, bbox_inches="tight", pad_inches=0.12, metadata=metadata))
        print(file)


if __name__ == "__main__":
    sys.exit(command.run(main))
