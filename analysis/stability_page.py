#!/usr/bin/python3
"""Writes a page about the hard cases: what is hard, what was expected, what was measured, and the verdict. Exits with 1
if a case fails. The renders are those of configs/stability.json, the others the tests that recorded their figures."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import Any

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import pandas as pd

from analysis import command
from analysis.command import LoadError
from analysis.csv_file import read_csv
from analysis.load import read_manifest

HEADER = ("case", "what is hard", "expected", "measured", "verdict")
COLUMNS = ["run", "axis:case", "axis:method", "status", "reason", "verdict", "verdict_reason", "mean", "mean_error",
           "expected_mean", "worst_z", "non_finite"]
Row = tuple[str, str, str, str, str]


def _verdict(runs: pd.DataFrame) -> str:
    """A run without a verdict has failed: it did not finish, or nothing was expected of it."""
    words = runs.verdict.where(runs.verdict != "", "fail")
    counts = [f"{word} {count}" for word, count in words.value_counts(sort=False).items()]
    return ", ".join(counts)


def _z(value: float) -> str:
    return "∞" if math.isinf(value) else f"{value:.2g}"


def _measured(runs: pd.DataFrame) -> str:
    """The method that is furthest from what was expected, of those that saw anything."""
    judged = runs[runs.verdict.isin(["pass", "fail"])]
    text = [f"{run['axis:method']}: {run.reason}" for _, run in runs[runs.status != "finished"].iterrows()]
    if not judged.empty:
        worst = judged.loc[judged.worst_z.idxmax()]
        text.append(f"furthest: {worst['axis:method']}, {worst['mean']:.6g} ± {worst.mean_error:.2g}, "
                    f"z {_z(worst.worst_z)}")
    text.append(f"non-finite {int(runs.non_finite.sum())}")
    return "; ".join(text)


def _expected(runs: pd.DataFrame) -> str:
    known = runs.expected_mean.dropna()
    return f"mean {known.iloc[0]:.6g}" if not known.empty else "-"


def _note(run_folder: Path) -> str:
    try:
        return str(read_manifest(run_folder / "manifest.json")["config"]["expect"]["note"])
    except KeyError as error:
        raise LoadError(f"{run_folder / 'manifest.json'}: does not say what was expected of the run") from error


def rendered_rows(folder: Path) -> list[Row]:
    summary = read_csv(folder / "summary.csv", COLUMNS)
    rows = []
    for case, runs in summary.groupby("axis:case", sort=False):
        rows.append((str(case), _note(folder / runs.run.iloc[0]), _expected(runs), _measured(runs), _verdict(runs)))
    return rows


def tested_rows(file: Path) -> list[Row]:
    """Of a file that GoogleTest wrote with --gtest_output=json."""
    run = read_manifest(file)
    tests: list[dict[str, Any]] = [t for suite in run.get("testsuites", []) for t in suite.get("testsuite", [])]
    if not tests:
        raise LoadError(f"{file}: holds no tests")
    rows = []
    for test in tests:
        passed = test.get("result") == "COMPLETED" and not test.get("failures")
        rows.append((str(test["name"]), *(str(test.get(key, "-")) for key in ("hard", "expected", "measured")),
                     "pass 1" if passed else "fail 1"))
    return rows


def _table(rows: list[Row]) -> str:
    lines = ["| " + " | ".join(HEADER) + " |", "|" + "---|" * len(HEADER)]
    lines += ["| " + " | ".join(field.replace("|", "\\|") for field in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def page(renders: list[Row], tests: list[Row]) -> str:
    failed = [row[0] for row in (*renders, *tests) if "fail" in row[4]]
    outcome = f"**Failed: {', '.join(failed)}.**" if failed else f"All {len(renders) + len(tests)} cases pass."
    text = f"# Hard cases\n\n{outcome}\n\n## Renders\n\n{_table(renders)}\n"
    text += ("Each method is a run of its own; the number stands for runs. A run passes where its whole image and all "
             "of its 4 × 4 blocks agree with the reference, and its mean with the known one, within 5 standard errors "
             "(and 1e-4 of the value), and no sample was NaN or infinite. Unseen: the sampler cannot find the light, "
             "and its image is black.\n")
    return text + (f"\n## Others\n\n{_table(tests)}" if tests else "")


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", metavar="RESULTS", type=Path, nargs="+", help="results/stability, and more such")
    parser.add_argument("--tests", metavar="FILE", type=Path, help="figures of the cases that are no renders")
    options = parser.parse_args(arguments)
    renders = [row for folder in options.results for row in rendered_rows(folder)]
    tests = tested_rows(options.tests) if options.tests else []
    text = page(renders, tests)
    file = options.results[0] / "stability.md"
    command.write_whole(file, lambda target: target.write_text(text, encoding="utf-8"))
    print(file)
    if "**Failed" in text:
        raise command.AnalysisError(f"{file}: not all cases pass")


if __name__ == "__main__":
    sys.exit(command.run(main))
