#!/usr/bin/python3
"""Writes the figures of a paper (PDF and SVG, at the widths of its columns, glyphs embedded) and its tables (CSV,
Markdown, LaTeX) from the folder of one experiment. The same results give the same bytes."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Iterator

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import matplotlib
from matplotlib.figure import Figure

from analysis import command, style
from analysis.ablation_figure import ablation_figure
from analysis.convergence_figure import METRICS, X_AXES, convergence_figure, metric_points
from analysis.cost_figure import cost_figure
from analysis.load import Results, load
from analysis.paper_tables import cell_table, ratio_table
from analysis.table_file import WRITERS, Table

# Without a date the same results give the same bytes.
FORMATS = {"pdf": {"CreationDate": None}, "svg": {"Date": None}, "png": {}}
DPI = 300  # of png, for a look


def figures(results: Results, metric: str) -> Iterator[tuple[str, Figure]]:
    """Name and figure: those of a column for each scene, and one of the page's width with all."""
    yield f"convergence_{metric}", convergence_figure(results, metric, style.PAGE)
    for scene in dict.fromkeys(metric_points(results, metric).scene):
        for x in X_AXES:
            yield f"convergence_{metric}_{scene}_{x}", convergence_figure(results, metric, style.COLUMN, [scene], [x])
        yield f"cost_{metric}_{scene}", cost_figure(results, metric, scene)
        yield f"cells_{scene}", ablation_figure(results, scene, style.PAGE)


def write_figure(figure: Figure, folder: Path, name: str, formats: list[str]) -> None:
    for kind in formats:
        file = folder / f"{name}.{kind}"
        with matplotlib.rc_context(style.PRINT_RC):
            command.write_whole(file, lambda target: figure.savefig(target, format=kind, dpi=DPI,
                                                                    metadata=FORMATS[kind]))
        print(file)


def write_tables(tables: dict[str, Table | None], folder: Path) -> None:
    for name, table in tables.items():
        for kind, text in WRITERS.items() if table is not None else ():
            file = folder / f"{name}.{kind}"
            command.write_whole(file, lambda target: target.write_bytes(text(table).encode()))
            print(file)


def _arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", metavar="RESULTS", type=Path, help="results/<experiment>")
    parser.add_argument("--out", metavar="FOLDER", type=Path, help="where to write (default: RESULTS/figures)")
    parser.add_argument("--metric", default="relmse", help=f"{', '.join(METRICS)} (default: relmse)")
    parser.add_argument("--format", default="pdf,svg", help=f"some of {','.join(FORMATS)} (default: pdf,svg)")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> None:
    options = _arguments(arguments)
    formats = options.format.split(",")
    command.check_one_of("metric", options.metric, METRICS)
    for kind in formats:
        command.check_one_of("format", kind, FORMATS)
    results = load(options.results)
    folder = options.out or options.results / "figures"
    tables = {"table": cell_table(results), "ratios": ratio_table(results)}  # before anything is written
    for name, figure in figures(results, options.metric):
        write_figure(figure, folder, name, formats)
    write_tables(tables, folder)


if __name__ == "__main__":
    sys.exit(command.run(main))
