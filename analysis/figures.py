#!/usr/bin/python3
"""Draws whatever can be drawn of a results folder, and says of the rest why it cannot: curves of convergence, cost against
error, what each configuration reaches, gains over the baseline, sheets of images, learned tables, and tables to print. PNG
is for the screen, with title and caption; PDF and SVG are for print: the widths of a paper's columns, every glyph in the
file, no words that a paper sets itself. The same results give the same bytes."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from types import ModuleType
from typing import Iterator

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import matplotlib

from analysis import command, style
from analysis.kinds import ablation, cost, curves, gains, inspect, learning_curve, sheets, tables
from analysis.kinds.request import Drawing, Request, Text
from analysis.tonemap import check_exposure

KINDS: dict[str, ModuleType] = {"curves": curves, "cost": cost, "ablation": ablation, "gains": gains, "sheets": sheets,
                                "inspect": inspect, "learning_curve": learning_curve, "tables": tables}
# Without a date the same results give the same bytes.
FORMATS = {"png": {}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}
DPI = {"png": 160, "pdf": 300, "svg": 300}  # of images inside, in print


def _write(made: Drawing | Text, place: Path, formats: list[str], medium: style.Medium) -> Iterator[Path]:
    """The files that were written. `place`: without the ending that a format has."""
    if isinstance(made, Text):
        command.write_whole(place, lambda target: target.write_bytes(made.text.encode()))
        yield place
        return
    for kind in formats:
        file = place.with_name(f"{place.name}.{kind}")
        with matplotlib.rc_context({**medium.page.rc, **made.rc}):
            command.write_whole(file, lambda target: made.figure.savefig(target, format=kind, dpi=made.dpi or DPI[kind],
                                                                        metadata=FORMATS[kind]))
        yield file


def draw(kind: str, request: Request, out: Path | None, formats: list[str]) -> Iterator[Path]:
    """All pictures of a kind: for the screen, in print, or both, as the formats ask for. Of a medium none is written
    before all are drawn."""
    for medium in (style.ON_SCREEN, style.IN_PRINT):
        wanted = [name for name in formats if (name != "png") == medium.is_print]
        for made in list(KINDS[kind].draw(request, medium)) if wanted else ():
            home = made.home if isinstance(made, Drawing) and out is None else None
            yield from _write(made, home or (out or request.folder / "figures") / made.name, wanted, medium)


def _chosen(text: str, what: str, known: dict) -> list[str]:
    names = list(dict.fromkeys(text.split(",")))
    for name in names:
        command.check_one_of(what, name, known)
    return names


def _frames(text: str) -> list[int]:
    try:
        frames = [int(part) for part in text.split(",")]
    except ValueError:
        frames = [0]
    if min(frames) < 1:
        raise command.AnalysisError(f"--frames must be whole numbers from 1 on, like 10,100,400, not '{text}'")
    return frames


def _request(options: argparse.Namespace) -> Request:
    check_exposure(options.exposure)
    if options.truth is not None and not (math.isfinite(options.truth) and options.truth > 0):
        raise command.AnalysisError(f"--truth is {options.truth:g} but must be a radiance above zero")
    if options.seconds is not None and not options.seconds > 0:
        raise command.AnalysisError(f"--seconds is {options.seconds:g} but must be above zero")
    if not options.results.is_dir():
        raise command.AnalysisError(f"{options.results}: no such folder; the folder of an experiment is needed, like "
                                    "results/convergence")
    frames = _frames(options.frames) if options.frames is not None else None
    return Request(options.results, metric=options.metric, frames=frames, seconds=options.seconds, exposure=options.exposure,
                   methods=options.method, truth=options.truth)


def _arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="figures", description=__doc__)
    parser.add_argument("results", metavar="RESULTS", type=Path, help="results/<experiment>; of one run for --only inspect")
    parser.add_argument("--only", metavar="KIND", help=f"some of {','.join(KINDS)} (default: all that can be drawn)")
    parser.add_argument("--format", default="png", help=f"some of {','.join(FORMATS)} (default: png)")
    parser.add_argument("--out", metavar="FOLDER", type=Path, help="where to write (default: RESULTS/figures)")
    parser.add_argument("--metric", default="relmse", help="of curves and cost: a metric of the results (default: relmse)")
    parser.add_argument("--method", metavar="LABEL", action="append", default=[], help="of gains: only this one; may be repeated")
    parser.add_argument("--frames", metavar="N,N,...", help="of sheets: columns (default: all snapshots the runs share)")
    parser.add_argument("--seconds", metavar="S", type=float, help="of sheets: what each method has after this time, side by side")
    parser.add_argument("--exposure", metavar="STOPS", type=float, default=0.0, help="of sheets: brightens by 2^STOPS")
    parser.add_argument("--truth", metavar="RADIANCE", type=float, help="of learning_curve: the true value of all entries")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> None:
    options = _arguments(arguments)
    formats = _chosen(options.format, "format", FORMATS)
    kinds = _chosen(options.only, "kind", KINDS) if options.only is not None else list(KINDS)
    request = _request(options)
    failures: list[str] = []
    drawn = False
    for kind in kinds:
        try:
            for file in dict.fromkeys(draw(kind, request, options.out, formats)):
                print(f"{kind}: {file}")
                drawn = True
        except command.AnalysisError as error:
            # What a folder does not hold is no error unless it was asked for by name; what is damaged always is one.
            if options.only is None and isinstance(error, command.MissingError):
                print(f"{kind}: not drawn: {error}")
            else:
                failures.append(f"{kind}: {error}")
    if not drawn and not failures:
        failures.append(f"{options.results}: nothing can be drawn of it")
    if failures:
        raise command.AnalysisError("\nerror: ".join(failures))


if __name__ == "__main__":
    sys.exit(command.run(main))
