"""What the scripts of this folder share: one kind of error, and files that are written whole or not at all."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Callable, Iterable


class AnalysisError(Exception):
    """Something about the user's files or arguments; the text is one sentence that names the culprit."""


class LoadError(AnalysisError):
    """Results that are missing, unfinished or unreadable."""


class MissingError(LoadError):
    """What a folder does not hold, and need not: a figure of it cannot be drawn, and nothing is wrong."""


def run(main: Callable[[], None]) -> int:
    """The exit code of `main`; an AnalysisError becomes a line on stderr instead of a traceback."""
    try:
        main()
    except AnalysisError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


def write_whole(file: Path, write: Callable[[Path], None]) -> None:
    """Lets `write` make a file beside the target and renames it, so that no half-written file is ever seen."""
    temporary = file.with_name(f".{file.name}.{os.getpid()}.tmp")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            write(temporary)
            os.replace(temporary, file)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise AnalysisError(f"{file}: cannot be written: {error.strerror or error}") from error


def check_one_of(what: str, value: str, allowed: Iterable[str]) -> None:
    if value not in allowed:
        raise AnalysisError(f"unknown {what} '{value}'; known are {', '.join(allowed)}")
