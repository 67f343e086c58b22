"""A copy of the source tree in which errors are tried."""

from __future__ import annotations

import contextlib
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Edit:
    """`find` must stand exactly once in the file, so that lists of edits cannot rot."""

    file: str  # from the root
    find: str
    replace: str


class Tree:
    def __init__(self, folder: Path, targets: list[str]) -> None:
        self.folder = folder
        self._targets = targets
        files = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        for name in filter(None, files.split("\n")):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            if (ROOT / name).is_file():
                shutil.copyfile(ROOT / name, folder / name)
        subprocess.run(["cmake", "--preset", "release"], cwd=folder, check=True, capture_output=True)
        self.build("without any error")

    def build(self, what: str) -> None:
        done = subprocess.run(["ninja", "-C", "build/release", *self._targets], cwd=self.folder, capture_output=True,
                              text=True)
        if done.returncode != 0:
            sys.exit(f"the tree does not build {what}:\n{done.stdout[-2000:]}")

    def run(self, *command: str, timeout: float | None = None) -> subprocess.CompletedProcess[str]:
        """`command` is relative to the tree; TimeoutExpired where it takes longer."""
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=timeout,
                              errors="replace")

    @contextlib.contextmanager
    def edited(self, name: str, *edits: Edit) -> Iterator[None]:
        """The tree, built, with these edits; they are taken back at the end."""
        before = {edit.file: (self.folder / edit.file).read_text() for edit in edits}
        try:
            for edit in edits:
                text = (self.folder / edit.file).read_text()
                if text.count(edit.find) != 1:
                    sys.exit(f"{edit.file}: '{edit.find}' stands there {text.count(edit.find)} times, not once; "
                             f"mend '{name}' in {Path(__file__).parent.relative_to(ROOT)}")
                (self.folder / edit.file).write_text(text.replace(edit.find, edit.replace))
            self.build(f"with '{name}'")
            yield
        finally:
            for file, text in before.items():
                (self.folder / file).write_text(text)


@contextlib.contextmanager
def copied(*targets: str) -> Iterator[Tree]:
    with tempfile.TemporaryDirectory(prefix="qtrace-mutations-") as folder:
        yield Tree(Path(folder), list(targets))


def commit() -> str:
    done = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip()
