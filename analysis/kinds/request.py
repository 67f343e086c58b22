"""What a kind of figure is asked for, and what it hands out."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from analysis.load import Results, load


@dataclass(frozen=True)
class Request:
    """Of one folder; what it holds is read once for all kinds."""

    folder: Path
    metric: str = "relmse"
    frames: list[int] | None = None      # of sheets; None: all that the runs share
    seconds: float | None = None         # of sheets, in place of frames: what each method has after this time
    exposure: float = 0.0                # of sheets, in stops
    methods: list[str] = field(default_factory=list)  # of gains; empty: all
    truth: float | None = None           # of learning curves: the radiance that the tables should have

    @cached_property
    def results(self) -> Results:
        return load(self.folder)


@dataclass(frozen=True)
class Drawing:
    name: str  # of its file, without the ending
    figure: Figure
    home: Path | None = None  # where it belongs, without the ending, if that is not beside the others
    dpi: float | None = None  # of images whose pixels shall be whole pixels of the file
    rc: dict[str, Any] = field(default_factory=dict)  # besides those of its look, while it is written


@dataclass(frozen=True)
class Text:
    """A file of text; the same in all formats of pictures."""

    name: str
    text: str
