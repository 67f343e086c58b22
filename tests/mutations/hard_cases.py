#!/usr/bin/python3
"""Takes the protections of the hard cases out, one at a time, in a copy of the tree, and looks whether the cases fail.

    ./dev protections [--only WORD] [--out FILE.md]

Prints a line for each and writes a table. Exit code 1 if one of its cases does not fail without a protection.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

from protections import PROTECTIONS, Protection
from tree import ROOT, Tree, commit, copied

CONFIGS = ["configs/stability.json", "configs/stability_large.json"]
LARGE = Path("configs/scenes/hard/five_million.glb")  # is made, not kept


def experiment(cases: tuple[str, ...]) -> str:
    """That of CONFIGS which has all these cases, with them alone."""
    for file in CONFIGS:
        config = json.loads(re.sub(r"^\s*//.*$", "", (ROOT / file).read_text(), flags=re.MULTILINE))
        known = config["sweep"][0]["case"]
        if set(cases) <= set(known):
            config["sweep"][0]["case"] = {case: known[case] for case in cases}
            config["name"] = "chosen"
            return json.dumps(config)
    sys.exit(f"none of {', '.join(CONFIGS)} has the cases {', '.join(cases)}")


def with_large_scene(tree: Tree) -> None:
    if not (ROOT / LARGE).is_file():
        subprocess.run(["/usr/bin/python3", "configs/scenes/generate.py", "--five-million"], cwd=ROOT, check=True)
    (tree.folder / LARGE).symlink_to(ROOT / LARGE)


def failures_of_runs(tree: Tree, cases: tuple[str, ...]) -> list[str]:
    (tree.folder / "configs" / "chosen.json").write_text(experiment(cases))
    shutil.rmtree(tree.folder / "results" / "chosen", ignore_errors=True)
    done = tree.run("build/release/qtrace", "run", "configs/chosen.json", "--quiet")
    summary = tree.folder / "results" / "chosen" / "summary.csv"
    if not summary.is_file():
        sys.exit(f"{', '.join(cases)}: no summary: {done.stderr}")
    with summary.open() as file:
        rows = [row for row in csv.DictReader(file) if row["verdict"] not in ("pass", "unseen")]
    return [f"{row['axis:case']}, {row['axis:method']}: {row['verdict'] or row['status']}"
            + (f", {row['non_finite']} non-finite" if row["non_finite"] not in ("", "0") else "") for row in rows]


def failures_of_tests(tree: Tree, cases: tuple[str, ...]) -> list[str]:
    names = ":".join(f"HardCases.{case}" for case in cases)
    done = tree.run("build/release/tests/qtrace_gpu_tests", f"--gtest_filter={names}", "--gtest_brief=1")
    return sorted(set(re.findall(r"\[  FAILED  \] (HardCases\.\w+)", done.stdout)))


def failures(tree: Tree, protection: Protection) -> list[str]:
    return (failures_of_tests if protection.is_test else failures_of_runs)(tree, protection.cases)


def unseen(protection: Protection, failed: list[str]) -> list[str]:
    """Cases that did not fail."""
    names = [f"HardCases.{case}" if protection.is_test else f"{case}, " for case in protection.cases]
    return [case for case, name in zip(protection.cases, names) if not any(line.startswith(name) for line in failed)]


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
        with_large_scene(tree)
        # The references that this leaves serve what follows, too: an error must not stand in both images.
        for protection in chosen:
            if failed := failures(tree, protection):
                sys.exit(f"with everything in place: {'; '.join(failed)}")
        for number, protection in enumerate(chosen, start=1):
            with tree.edited(protection.name, *protection.edits):
                failed = failures(tree, protection)
            found.append((protection, failed))
            print(f"{number}/{len(chosen)} {protection.name}: {'; '.join(failed) or 'NOTHING FAILED'}", flush=True)
            if missing := unseen(protection, failed):
                print(f"  not seen to fail: {', '.join(missing)}", flush=True)
            options.out.parent.mkdir(parents=True, exist_ok=True)
            options.out.write_text(table(found))
    print(options.out)
    return 1 if any(unseen(protection, failed) for protection, failed in found) else 0


if __name__ == "__main__":
    sys.exit(main())
