#!/usr/bin/python3
"""The renderer beside the independent tracer, for every sampler and kind of next event estimation.

    ./dev independent [SCENE or FILE.glb...] [--out FOLDER]

Writes FOLDER/table.md, a row as soon as it is measured. Rows of other scenes that are there already are kept, so that
scenes can be measured one at a time. Exit code 1 if a comparison fails.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

from table import SCENES, Table

ROOT = Path(__file__).resolve().parents[2]


def commit() -> str:
    done = subprocess.run(["git", "describe", "--always", "--dirty=+", "--abbrev=12", "--match="], cwd=ROOT,
                          capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def measure(program: Path, scene: str, table: Table) -> int:
    """Exit code of the comparison. What it prints is passed on; lines that are rows go into the table. `scene`: of
    SCENES, or a file."""
    name = scene if scene in SCENES else Path(scene).stem
    words = [str(program), f"--gtest_filter=Scenes/SlowIndependent.*/{re.sub('[^A-Za-z0-9]', '_', name)}", "--gtest_brief=1"]
    file = {} if scene in SCENES else {"QTRACE_INDEPENDENT_FILE": str(Path(scene).resolve())}
    table.forget(name)
    with subprocess.Popen(words, cwd=ROOT, stdout=subprocess.PIPE, text=True, env=os.environ | file) as running:
        assert running.stdout is not None
        for line in running.stdout:
            print(line, end="", flush=True)
            try:
                if line.startswith("device: "):
                    table.device = line.removeprefix("device: ").strip()
                elif line.startswith("| "):
                    table.add(line, commit())
            except ValueError:
                running.terminate()
                raise
    return running.returncode


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", metavar="SCENE", nargs="*",
                        help=f"of {', '.join(SCENES)}, or a .glb file; none: all of these")
    parser.add_argument("--out", metavar="FOLDER", type=Path, default=ROOT / "results" / "independent")
    parser.add_argument("--program", metavar="FILE", type=Path, help=argparse.SUPPRESS,
                        default=ROOT / "build" / "release" / "tests" / "qtrace_slow_tests")
    options = parser.parse_args()
    if unknown := [scene for scene in options.scenes if scene not in SCENES and not Path(scene).is_file()]:
        parser.error(f"no scene or file is called '{unknown[0]}'; there are {', '.join(SCENES)}")
    if known := [scene for scene in options.scenes if scene not in SCENES and Path(scene).stem in SCENES]:
        parser.error(f"the file {known[0]} has the name of a shipped scene; another name would be right")
    try:
        table = Table(options.out / "table.md")
        failed = [scene for scene in options.scenes or SCENES if measure(options.program, scene, table) != 0]
    except ValueError as error:
        sys.exit(f"error: {error}")
    print(table.file)
    if failed:
        print(f"failed: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
