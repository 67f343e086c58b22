#!/usr/bin/python3
"""Writes report.html into a results folder: one page, without network, about everything that `qtrace run` has left
there, failures first."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

from analysis import command
from analysis.report.page import render
from analysis.report.sweep import read_sweep


def _arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="report", description=__doc__)
    parser.add_argument("results", metavar="RESULTS", type=Path, help="results/<experiment>")
    parser.add_argument("--out", metavar="FILE", type=Path, help="the page (default: RESULTS/report.html)")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> None:
    options = _arguments(arguments)
    text = render(read_sweep(options.results))
    file = options.out or options.results / "report.html"
    command.write_whole(file, lambda target: target.write_text(text, encoding="utf-8"))
    print(file)


if __name__ == "__main__":
    sys.exit(command.run(main))
