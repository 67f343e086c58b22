"""Feeds the importer with scenes that are made up of small ones: ./dev fuzz --only import.

    import_fuzz.py SECONDS [--seed N] [--corpus FOLDER] --findings FOLDER

A right answer is a scene written whole, or exit code 1 with one line and nothing written; within 10 s of processor time and
1 GB. Each try has a process of its own, which is a copy of this one, so that it need not load the importer. What answers in
a way that was not seen before is changed further (as libFuzzer does with what reaches code that was not reached before).
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import re
import resource
import signal
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # a copy of a process has none of its threads

from import_mutations import Mutator  # noqa: E402
from import_seeds import Case, seeds, words  # noqa: E402

from importer import __main__ as command  # noqa: E402
from importer.mitsuba import read as _mitsuba  # noqa: E402,F401  (what the command loads when it needs it)
from importer.pbrt import read as _pbrt  # noqa: E402,F401

CPU_SECONDS = 10
WALL_SECONDS = 60  # for what waits and does not count
MEMORY = 1 << 30
_MORE_THAN_ALLOWED = 4 << 30  # where the system says no, so that a runaway does not end other programs
_OPTIONS: tuple[list[str], ...] = ([], ["--lenient"], ["--define", "grey=2", "--lenient"])
_NEWS = re.compile(r"\d+|\"[^\"]*\"|[\w./-]*\.\w+:?")  # of an answer, what is another one in every try


class Answer:
    """How a try ended, and what is wrong with that; nothing: it is right."""

    def __init__(self, status: int, peak: int, out: str, err: str, written: dict[str, bytes]) -> None:
        self.code = os.waitstatus_to_exitcode(status)
        self.out, self.err = out, err
        self.problem = self._problem(peak, written)

    def _problem(self, peak: int, written: dict[str, bytes]) -> str:
        if -self.code in (signal.SIGXCPU, signal.SIGALRM):
            return f"takes more than {CPU_SECONDS} s"
        if self.code not in (0, 1):
            return f"ends with the code {self.code}"
        if peak > MEMORY or "needs more memory than there is" in self.err:
            return f"takes {peak >> 20} MB"
        if self.code == 1:
            is_right = re.fullmatch(r"import: [^\n]+\n", self.err) and not written and not self.out
            return "" if is_right else "ends with more than one line, or has written files"
        return "says what is no result to standard error" if self.err else _problem_of(written)

    def kind(self) -> str:
        lines = self.out.splitlines()
        what = self.err if self.code == 1 else "\n".join(line for line in lines if line.startswith("  "))
        return _NEWS.sub("", what)[:400]


def _problem_of(written: dict[str, bytes]) -> str:
    """Whether a reader of glTF and of configs gets what it can read."""
    try:
        glb = written["out.glb"]
        size = int.from_bytes(glb[12:16], "little")
        json.loads(glb[20:20 + size], parse_constant=_no_number)
        json.loads(re.sub(r"(?m)^//.*\n", "", written["out.json"].decode()), parse_constant=_no_number)
    except (KeyError, ValueError) as error:
        return f"writes what cannot be read ({error!r})"
    return "" if int.from_bytes(glb[8:12], "little") == len(glb) else "writes a .glb of another length than it says"


def _no_number(text: str) -> None:
    raise ValueError(f"{text} is no number of JSON")


def attempt(case: Case, options: list[str], folder: Path) -> Answer:
    """In a copy of this process."""
    for file in folder.iterdir():
        file.unlink()
    for name, content in case.items():
        (folder / name).write_bytes(content)
    scene = next(name for name in case if name.startswith("scene"))
    process = os.fork()
    if process == 0:
        _be_the_command([scene, "out.glb", *options], folder)
    _, status, usage = os.wait4(process, 0)
    out, err = ((folder / name).read_text(errors="replace") for name in (".stdout", ".stderr"))
    written = {file.name: file.read_bytes() for file in folder.iterdir() if file.name not in (*case, ".stdout", ".stderr")}
    return Answer(status, usage.ru_maxrss << 10, out, err, written)


def _be_the_command(arguments: list[str], folder: Path) -> None:
    """Does not return."""
    code = 2
    try:
        os.chdir(folder)
        for number, name in ((1, ".stdout"), (2, ".stderr")):
            os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), number)
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS + 1))
        resource.setrlimit(resource.RLIMIT_AS, (_MORE_THAN_ALLOWED, _MORE_THAN_ALLOWED))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        signal.alarm(WALL_SECONDS)
        code = command.main(arguments)
        sys.stdout.flush()
    except BaseException:  # noqa: BLE001  whatever it is, it is a finding
        sys.excepthook(*sys.exc_info())
    finally:
        os._exit(code)


def _keep(case: Case, folder: Path, said: str = "") -> Path:
    name = hashlib.sha256(b"".join(name.encode() + content for name, content in sorted(case.items()))).hexdigest()[:12]
    kept = folder / name
    kept.mkdir(parents=True, exist_ok=True)
    for file, content in case.items():
        (kept / file).write_bytes(content)
    if said:
        (kept / "what.txt").write_text(said)
    return kept


def _report(case: Case, options: list[str], answer: Answer, findings: Path) -> None:
    said = f"{answer.problem}, with the options {options}\n{answer.err[-4000:]}"
    print(f"fuzz: import: {_keep(case, findings, said)}: {said}", flush=True)


def _search(cases: list[Case], mutator: Mutator, arguments: argparse.Namespace) -> tuple[int, int, int]:
    """How many tries there were, kinds of answers, and findings. What it starts from is tried as it is first."""
    end, tries, found, seen = time.monotonic() + arguments.seconds, 0, 0, set()
    unchanged = list(cases)
    with tempfile.TemporaryDirectory() as folder:
        while time.monotonic() < end:
            case = unchanged.pop() if unchanged else mutator.changed(cases)
            options = mutator.source.choice(_OPTIONS)
            answer = attempt(case, options, Path(folder))
            tries += 1
            kind = f"{answer.problem}{answer.kind()}"
            if kind in seen:
                continue
            seen.add(kind)
            if answer.problem:
                found += 1
                _report(case, options, answer, arguments.findings)
                continue
            cases.append(case)
            if arguments.corpus:
                _keep(case, arguments.corpus)
    return tries, len(seen), found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seconds", type=int)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--findings", type=Path, required=True)
    arguments = parser.parse_args()
    cases = seeds()
    for folder in sorted(arguments.corpus.iterdir()) if arguments.corpus and arguments.corpus.is_dir() else []:
        cases.append({file.name: file.read_bytes() for file in sorted(folder.iterdir())})
    print(f"fuzz: import: {arguments.seconds} s from {len(cases)} scenes", flush=True)
    tries, kinds, found = _search(cases, Mutator(random.Random(arguments.seed or None), words()), arguments)
    print(f"fuzz: import: {tries} tries, {kinds} kinds of answers, {found} findings", flush=True)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
