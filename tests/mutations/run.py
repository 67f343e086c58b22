#!/usr/bin/python3
"""Applies deliberate errors to the sources, one at a time, in a copy of the tree, and looks whether the tests notice.

    ./dev mutations [--only WORD] [--out FILE.md]

Prints a line for each and writes a table. Exit code 1 if an error survives; it stops where an error's text is not found
exactly once, or where a shader with it is no program.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from importer import IMPORTER_MUTATIONS
from light_paths import LIGHT_PATH_MUTATIONS
from mutation import Mutation
from mutations import MUTATIONS
from tree import ROOT, Edit, Tree, commit, copied

SUITES = ["unit", "gpu", "independent", "render"]  # of the program; the quickest first
IMPORTER = ["/usr/bin/python3", "-m", "unittest", "discover", "--failfast", "-s", "tests/importer", "-t", "tests/importer"]
TIMEOUT = 600  # seconds for a suite: an endless loop is noticed as well
NOT_A_PROGRAM = re.compile(r"does not (?:compile|link)[^\n]*(?:\n[^\n]+){0,3}")  # as engine/gpu/program.cpp says it


@dataclass(frozen=True)
class Outcome:
    mutation: Mutation
    caught_by: str  # empty: survived
    seconds: float


class NotAProgram(Exception):
    """The shader that the error stands in does not compile, which would be noticed without any test."""


def first_failure(tree: Tree, is_of_importer: bool) -> str:
    """The name of a test that fails, empty if none does: of the importer's, or of the program's."""
    return first_of_importer(tree) if is_of_importer else first_of_program(tree)


def first_of_importer(tree: Tree) -> str:
    try:
        done = tree.run(*IMPORTER, timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return f"importer: did not end in {TIMEOUT} s"
    if done.returncode == 0:
        return ""
    named = re.search(r"^(?:FAIL|ERROR): (\S+)", done.stderr, re.MULTILINE)
    return f"importer: {named[1]}" if named else f"importer: ended with {done.returncode}"


def first_of_program(tree: Tree) -> str:
    for suite in SUITES:
        try:
            done = tree.run(f"build/release/tests/qtrace_{suite}_tests", "--gtest_fail_fast", "--gtest_brief=1",
                            timeout=TIMEOUT)
        except subprocess.TimeoutExpired:
            return f"{suite}: did not end in {TIMEOUT} s"
        if done.returncode != 0:
            if broken := NOT_A_PROGRAM.search(done.stdout + done.stderr):
                raise NotAProgram(broken[0])
            named = re.search(r"\[  FAILED  \] (\S+?)(,| \(|$)", done.stdout, re.MULTILINE)
            return f"{suite}: {named[1]}" if named else f"{suite}: ended with {done.returncode}"
    return ""


def try_one(tree: Tree, mutation: Mutation) -> Outcome:
    start = time.monotonic()
    with tree.edited(mutation.name, Edit(mutation.path, mutation.find, mutation.replace)):
        try:
            caught = first_failure(tree, mutation in IMPORTER_MUTATIONS)
        except NotAProgram as error:
            sys.exit(f"{mutation.file}: with '{mutation.name}' it is no program, which proves nothing: {error}")
    return Outcome(mutation, caught, time.monotonic() - start)


def table(outcomes: list[Outcome]) -> str:
    lines = ["# Deliberate errors", "",
             f"Of {len(outcomes)}, applied one at a time to commit {commit()}, "
             f"{sum(bool(o.caught_by) for o in outcomes)} were noticed. `./dev mutations` does it again.", "",
             "| error | file | noticed first by |", "|---|---|---|"]
    lines += [f"| {o.mutation.name} | `{o.mutation.file}` | {o.caught_by or '**nothing**'} |" for o in outcomes]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--only", metavar="WORD", default="", help="errors whose name holds this, or whose file begins with it")
    parser.add_argument("--out", metavar="FILE", type=Path, default=ROOT / "results" / "mutations.md")
    options = parser.parse_args()
    chosen = [m for m in (*MUTATIONS, *LIGHT_PATH_MUTATIONS, *IMPORTER_MUTATIONS) if options.only in m.name or m.path.startswith(options.only)]
    if not chosen:
        sys.exit(f"--only {options.only}: no error's name holds that, and no file begins with it")
    outcomes: list[Outcome] = []
    sides = {mutation in IMPORTER_MUTATIONS for mutation in chosen}
    programs = [f"qtrace_{suite}_tests" for suite in SUITES] if False in sides else []
    with copied("qtrace", *programs) as tree:
        for side in sides:
            if failure := first_failure(tree, side):
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
