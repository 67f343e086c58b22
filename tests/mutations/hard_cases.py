#!/usr/bin/python3
"""Takes the protections of the hard cases out, one at a time, in a copy of the tree, and looks whether the cases fail.

    ./dev protections [--only WORD] [--out FILE.md]

Prints a line for each and writes a table. Exit code 1 if nothing fails without a protection.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
import sys
from pathlib import Path

from protections import PROTECTIONS, Protection
from tree import ROOT, Tree, commit, copied

CONFIG = "configs/stability.json"


def experiment(cases: tuple[str, ...]) -> str:
    """stability.json with these cases alone."""
    config = json.loads(re.sub(r"^\s*//.*$", "", (ROOT / CONFIG).read_text(), flags=re.MULTILINE))
    known = config["sweep"][0]["case"]
    if missing := [case for case in cases if case not in known]:
        sys.exit(f"{CONFIG} has no case {missing}; its cases are {list(known)}")
    config["sweep"][0]["case"] = {case: known[case] for case in cases}
    return json.dumps(config)


def failures_of_runs(tree: Tree, cases: tuple[str, ...]) -> list[str]:
    (tree.folder / "configs" / "chosen.json").write_text(experiment(cases))
    done = tree.run("build/release/qtrace", "run", "configs/chosen.json", "--quiet", "--out", "results/chosen")
    summary = tree.folder / "results" / "chosen" / "stability" / "summary.csv"
    if not summary.is_file():
        sys.exit(f"{', '.join(cases)}: no summary: {done.stderr}")
    with summary.open() as file:
        rows = [row for row in csv.DictReader(file) if row["verdict"] not in ("pass", "unseen")]
    summary.unlink()
    return [f"{row['axis:case']}, {row['axis:method']}: {row['verdict'] or row['status']}"
            + (f", {row['non_finite']} non-finite" if row["non_finite"] not in ("", "0") else "") for row in rows]


def failures_of_tests(tree: Tree, cases: tuple[str, ...]) -> list[str]:
    names = ":".join(f"HardCases.{case}" for case in cases)
    done = tree.run("build/release/tests/qtrace_gpu_tests", f"--gtest_filter={names}", "--gtest_brief=1")
    return sorted(set(re.findall(r"\[  FAILED  \] (HardCases\.\w+)", done.stdout)))


def failures(tree: Tree, protection: Protection) -> list[str]:
    return (failures_of_tests if protection.is_test else failures_of_runs)(tree, protection.cases)


def table(found: list[tuple[Protection, list[str]]]) -> str:
    lines = ["# Hard cases without their protections", "",
             f"Taken out one at a time at commit {commit()}; `./dev protections` does it again.", "",
             "| protection | hard cases | what failed without it |", "|---|---|---|"]
    lines += [f"| {p.name} | {'; '.join(p.cases)} | {'; '.join(failed) or '**nothing**'} |" for p, failed in found]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--only", metavar="WORD", default="", help="protections whose name holds this")
    parser.add_argument("--out", metavar="FILE", type=Path, default=ROOT / "results" / "protections.md")
    options = parser.parse_args()
    chosen = [p for p in PROTECTIONS if options.only in p.name]
    if not chosen:
        sys.exit(f"--only {options.only}: no protection's name holds that")
    found: list[tuple[Protection, list[str]]] = []
    with copied("qtrace", "qtrace_gpu_tests") as tree:
        for number, protection in enumerate(chosen, start=1):
            with tree.edited(protection.name, *protection.edits):
                failed = failures(tree, protection)
            found.append((protection, failed))
            print(f"{number}/{len(chosen)} {protection.name}: {'; '.join(failed) or 'NOTHING FAILED'}", flush=True)
            options.out.parent.mkdir(parents=True, exist_ok=True)
            options.out.write_text(table(found))
    print(options.out)
    return 0 if all(failed for _, failed in found) else 1


if __name__ == "__main__":
    sys.exit(main())
