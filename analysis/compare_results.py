#!/usr/bin/python3
"""Compares two results folders (another device, another version) configuration by configuration: prints a table and writes a page that
needs nothing else, compare.html."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import jinja2

from analysis import command
from analysis.comparison import Row, SideBySide, compare, some
from analysis.load import Results, load
from analysis.tolerances import LEVEL

TEMPLATE = Path(__file__).with_name("compare_page.html.j2")
HEADER = ("configuration", "figure", "A", "B", "B/A [95 %]", "p", "verdict")
PLOT = {"width": 160, "height": 14}  # pixels, of the page's little plots


def _ratio(row: Row) -> str:
    c = row.comparison
    return f"{c.ratio:.4g}" + ("" if math.isnan(c.low) else f" [{c.low:.4g}, {c.high:.4g}]")


def _p(row: Row) -> str:
    return "-" if math.isnan(row.p) else f"{row.p:.2g}"


def fields(row: Row) -> tuple[str, ...]:
    return (row.configuration, row.figure, f"{row.means[0]:.4g}", f"{row.means[1]:.4g}", _ratio(row), _p(row), row.verdict)


def headline(result: SideBySide) -> str:
    configurations = len(dict.fromkeys(row.configuration for row in result.rows))
    words = {"changed": "changed", "unclear": "unclear", "noise": "noise", "same": "the same in every seed",
             "one seed": "of one seed alone, which has no interval"}
    counts = ", ".join(f"{result.count(verdict)} {text}" for verdict, text in words.items() if result.count(verdict))
    return f"{len(result.rows)} comparisons in {configurations} configurations: {counts or 'nothing to compare'}."


def explanation() -> str:
    return ("B/A: ratio of the means over seeds with its 95 % interval, by Welch's test on their logarithms. p: "
            "corrected for the number of comparisons (Benjamini and Hochberg). "
            f"changed: p below {LEVEL}, so that at most {LEVEL * 100:g} % of the changes named here are expected to be "
            "none. unclear: the interval leaves out 1, but among so many comparisons that may be chance: more seeds "
            "would tell. noise: no change was shown; the interval says how large it could be. Errors are those of the "
            "last snapshot that both sides have.")


def missing(result: SideBySide) -> list[str]:
    return [f"only in {side}: {'; '.join(names)}" for side, names in zip("AB", result.only) if names]


def plain_text(a: Results, b: Results, result: SideBySide) -> str:
    rows = [HEADER, *map(fields, result.rows)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEADER))]
    lines = [f"A: {a.folder}", f"B: {b.folder}", *missing(result),
             *(f"differs: {name}: {here} | {there}" for name, here, there in result.facts),
             *(f"warning: {warning}" for warning in result.warnings), ""]
    lines += ["  ".join(field.ljust(width) for field, width in zip(row, widths)).rstrip() for row in rows]
    return "\n".join([*lines, "", headline(result), explanation()]) + "\n"


def _reach(rows: list[Row]) -> float:
    """The largest ratio, or one over the least, that the plots show: all of them, but not the ends of wide bars."""
    return 1.25 * math.exp(max(abs(math.log(row.comparison.ratio)) for row in rows))


def _x(ratio: float, reach: float) -> float:
    """Place on the plots' logarithmic axis from 1/reach to reach; what is outside stands at its end."""
    share = (math.log(ratio) / math.log(reach) + 1) / 2 if ratio > 0 else 0
    return round(min(1.0, max(0.0, share)) * PLOT["width"], 2)


def _bar(row: Row, reach: float) -> dict[str, float | None]:
    ends = (row.comparison.low, row.comparison.high)
    low, high = (None if math.isnan(end) else _x(end, reach) for end in ends)
    return {"middle": _x(row.comparison.ratio, reach), "low": low, "high": high}


def page(a: Results, b: Results, result: SideBySide) -> str:
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True,
                                     lstrip_blocks=True)
    reach = _reach(result.rows)
    rows = [{"fields": fields(row), "verdict": row.verdict, "scene": row.scene, **_bar(row, reach)}
            for row in result.rows]
    return environment.from_string(TEMPLATE.read_text(encoding="utf-8")).render(
        a=a, b=b, rows=rows, result=result, header=HEADER, headline=headline(result), explanation=explanation(),
        missing=missing(result), plot=PLOT, reach=f"{reach:.2g}") + "\n"


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("a", metavar="A", type=Path, help="results/<experiment>")
    parser.add_argument("b", metavar="B", type=Path, help="another such folder, which is divided by A")
    parser.add_argument("--out", metavar="FOLDER", type=Path, help="where to write compare.html (default: B)")
    options = parser.parse_args(arguments)
    a, b = load(options.a), load(options.b)
    result = compare(a, b)
    if not result.rows:
        raise command.AnalysisError(f"{options.a} and {options.b}: share no finished configuration that could be compared; the "
                                    f"first has {some(result.only[0])}, the second {some(result.only[1])}")
    print(plain_text(a, b, result), end="")
    file = (options.out or options.b) / "compare.html"
    command.write_whole(file, lambda target: target.write_text(page(a, b, result), encoding="utf-8"))
    print(file)


if __name__ == "__main__":
    sys.exit(command.run(main))
