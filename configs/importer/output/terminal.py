"""What an import prints: a table of what was read, what is said in another way and what is left out; and, where it takes
long, how far it is."""

from __future__ import annotations

import sys
import textwrap
import threading
import time
from contextlib import contextmanager
from typing import Any, Callable, Iterator, Sequence

from importer.output.glb import Totals
from importer.problems import Notes

_WIDTH = 100
_LONGEST = 600  # of a sentence; a name in it may be of any length
_PATIENCE_S = 3.0  # until one wants to know what goes on
_HEADINGS = {"approximated": "approximated", "left out": "left out"}


def one_line(text: str) -> str:
    """A sentence, in which names of the scene stand, as a terminal can show it."""
    text = " ".join("".join(c if c.isprintable() or c.isspace() else "\N{REPLACEMENT CHARACTER}" for c in text).split())
    if len(text) <= _LONGEST:
        return text
    return f"{text[:_LONGEST // 2]} ... {text[-_LONGEST // 2:]}"


def _count(number: int, one: str, many: str | None = None) -> str:
    return f"{number:,} {one if number == 1 else many or one + 's'}"


def _megabytes(size: int) -> str:
    return f"{size / 1e6:.1f} MB"


def summary(totals: Totals, config: dict[str, Any], source: dict[str, Any], seconds: float) -> list[str]:
    """Two columns: what, and how much of it."""
    lights = [_count(totals.lamps, "lamp")] if totals.lamps else []
    if totals.lights:
        lights.append(_count(totals.lights, "light") + " without a surface")
    environment = config.get("environment")
    if environment is not None:
        lights.append("an image of the sky" if isinstance(environment, dict) else "a sky of one radiance")
    rows = [("source", one_line(f"{source['file']}, {source['format']} {source['version']}")),
            ("files read", f"{len(source['files']):,}"),
            ("shapes", f"{totals.parts:,} of {_count(totals.meshes, 'mesh', 'meshes')}"),
            ("triangles", f"{totals.triangles:,}"),
            ("materials", f"{totals.materials:,}"),
            ("images", f"{totals.images:,}"),
            ("light", ", ".join(lights) or "none"),
            ("picture", f"{config['width']} x {config['height']}"),
            ("path length", _count(config["max_bounces"], "scattering event")),
            ("size", _megabytes(totals.bytes)),
            ("seconds", f"{seconds:.1f}")]
    return [f"{name:<12}{value}" for name, value in rows]


def _cells(row: dict[str, str | int], width: int) -> Iterator[str]:
    """The sentence in as many lines as it needs, how often and where first beside its first one."""
    lines = textwrap.wrap(one_line(str(row["what"])), width - 2) or [""]
    times = "once" if row["count"] == 1 else f"{row['count']:,} times"
    yield f"  {lines[0]:<{width - 2}}  {times:<12} {one_line(str(row['first']))}".rstrip()
    yield from (f"  {line}" for line in lines[1:])


def changes(rows: Sequence[dict[str, str | int]]) -> list[str]:
    """The notes, kind by kind: what, how often, where first."""
    lines: list[str] = []
    longest = max((len(str(row["what"])) for row in rows), default=0)
    width = min(longest + 2, _WIDTH - 30)
    for kind, heading in _HEADINGS.items():
        those = [row for row in rows if row["kind"] == kind]
        if those:
            lines += ["", heading]
            lines += [line for row in those for line in _cells(row, width)]
    return lines


def report(totals: Totals, config: dict[str, Any], source: dict[str, Any], notes: Notes, seconds: float) -> str:
    return "\n".join([*summary(totals, config, source, seconds), *changes(notes.rows())])


@contextmanager
def progress(status: Callable[[], str]) -> Iterator[None]:
    """On a terminal, one line that is written over, from a few seconds on; `status` is asked once a second."""
    if not sys.stderr.isatty():
        yield
        return
    is_over = threading.Event()
    worker = threading.Thread(target=_show, args=(status, is_over), daemon=True)
    worker.start()
    try:
        yield
    finally:
        is_over.set()
        worker.join()


def _show(status: Callable[[], str], is_over: threading.Event) -> None:
    start, is_shown = time.monotonic(), False
    while not is_over.wait(1.0):
        elapsed = time.monotonic() - start
        if elapsed >= _PATIENCE_S:
            text = one_line(f"import: {elapsed:.0f} s, {status()}")
            sys.stderr.write(f"\r\033[K{text[:_WIDTH]}")
            sys.stderr.flush()
            is_shown = True
    if is_shown:
        sys.stderr.write("\r\033[K")
        sys.stderr.flush()
