#!/usr/bin/python3
"""Applies deliberate errors to the shaders, one at a time, in a copy of the tree, and looks whether the tests notice.

    ./dev mutations [--only WORD] [--out FILE.md]

Prints a line for each and writes a table. Exit code 1 if an error survives, or if its text is not found exactly once.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from mutations import MUTATIONS, Mutation

ROOT = Path(__file__).resolve().parents[2]
SUITES = ["gpu", "independent", "render"]  # the quickest first
TIMEOUT = 600  # seconds for a suite: an endless loop is noticed as well
NOT_A_PROGRAM = re.compile(r"does not (?:compile|link)[^\n]*(?:\n[^\n]+){0,3}")  # as engine/gpu/program.cpp says it


@dataclass(frozen=True)
class Outcome:
    mutation: Mutation
    caught_by: str  # empty: survived
    seconds: float


class NotAProgram(Exception):
    """The shader that the error stands in does not compile, which would be noticed without any test."""


def copy_tree(target: Path) -> None:
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    for name in filter(None, files):
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_file():
            shutil.copyfile(ROOT / name, target / name)


def build(tree: Path) -> bool:
    targets = [f"qtrace_{suite}_tests" for suite in SUITES]
    return subprocess.run(["ninja", "-C", "build/release", *targets], cwd=tree, capture_output=True).returncode == 0


def first_failure(tree: Path) -> str:
    """The name of a test that fails, empty if none does."""
    for suite in SUITES:
        command = [f"build/release/tests/qtrace_{suite}_tests", "--gtest_fail_fast", "--gtest_brief=1"]
        try:
            done = subprocess.run(command, cwd=tree, capture_output=True, text=True, timeout=TIMEOUT, errors="replace")
        except subprocess.TimeoutExpired:
            return f"{suite}: did not end in {TIMEOUT} s"
        if done.returncode != 0:
            if broken := NOT_A_PROGRAM.search(done.stdout + done.stderr):
                raise NotAProgram(broken[0])
            named = re.search(r"\[  FAILED  \] (\S+?)(,| \(|$)", done.stdout, re.MULTILINE)
            return f"{suite}: {named[1]}" if named else f"{suite}: ended with {done.returncode}"
    return ""


def try_one(tree: Path, mutation: Mutation) -> Outcome:
    file = tree / "shaders" / mutation.file
    text = file.read_text()
    if text.count(mutation.find) != 1:
        sys.exit(f"{mutation.file}: '{mutation.find}' stands there {text.count(mutation.find)} times, not once; "
                 f"mend the error '{mutation.name}' in {Path(__file__).with_name('mutations.py')}")
    start = time.monotonic()
    file.write_text(text.replace(mutation.find, mutation.replace))
    try:
        if not build(tree):
            sys.exit(f"the tree does not build with the error '{mutation.name}'")
        caught = first_failure(tree)
    except NotAProgram as error:
        sys.exit(f"{mutation.file}: with the error '{mutation.name}' it is no program, which proves nothing: {error}")
    finally:
        file.write_text(text)
    return Outcome(mutation, caught, time.monotonic() - start)


def table(outcomes: list[Outcome]) -> str:
    commit = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    lines = ["# Deliberate errors in shaders", "",
             f"Of {len(outcomes)}, applied one at a time to commit {commit.strip()}, "
             f"{sum(bool(o.caught_by) for o in outcomes)} were noticed. `./dev mutations` does it again.", "",
             "| error | shader | noticed first by |", "|---|---|---|"]
    lines += [f"| {o.mutation.name} | `{o.mutation.file}` | {o.caught_by or '**nothing**'} |" for o in outcomes]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--only", metavar="WORD", default="", help="errors whose name holds this")
    parser.add_argument("--out", metavar="FILE", type=Path, default=ROOT / "results" / "mutations.md")
    options = parser.parse_args()
    chosen = [m for m in MUTATIONS if options.only in m.name]
    if not chosen:
        sys.exit(f"--only {options.only}: no error's name holds that")
    outcomes: list[Outcome] = []
    with tempfile.TemporaryDirectory(prefix="qtrace-mutations-") as folder:
        tree = Path(folder)
        copy_tree(tree)
        subprocess.run(["cmake", "--preset", "release"], cwd=tree, check=True, capture_output=True)
        if not build(tree):
            sys.exit("the tree does not build without any error")
        if failure := first_failure(tree):
            sys.exit(f"the tests fail without any error: {failure}")
        for number, mutation in enumerate(chosen, start=1):
            outcome = try_one(tree, mutation)
            outcomes.append(outcome)
            print(f"{number}/{len(chosen)} {mutation.name}: {outcome.caught_by or 'SURVIVED'} ({outcome.seconds:.0f} s)",
                  flush=True)
            options.out.parent.mkdir(parents=True, exist_ok=True)
            options.out.write_text(table(outcomes))
    print(options.out)
    return 0 if all(o.caught_by for o in outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
