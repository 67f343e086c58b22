"""What the page's tables are made of. Every field holds the CSV's own text beside what is shown."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable

from analysis.report import number
from analysis.report.sweep import Row


@dataclass(frozen=True)
class Field:
    shown: str
    value: str          # what it is sorted by: the CSV's text
    low: str = ""       # of the 95 % interval, the CSV's text
    high: str = ""
    flag: bool = False  # worth a look
    note: str = ""      # said beside the digits

    @property
    def interval(self) -> str:
        return f"[{number.short(self.low)}, {number.short(self.high)}]" if self.low else ""

    @property
    def full(self) -> str:
        """For whoever points at it: every digit."""
        digits = f"{self.value} [{self.low}, {self.high}]" if self.low else self.value
        return f"{digits}\n{self.note}" if self.note else digits


@dataclass(frozen=True)
class Column:
    name: str
    help: str
    numeric: bool = True
    strip: bool = False  # drawn on a scale besides


@dataclass(frozen=True)
class Span:
    """Where a value and its interval stand on a column's logarithmic scale, in percent of its width."""

    middle: float
    low: float
    width: float | None  # None without an interval


@dataclass(frozen=True)
class Table:
    columns: list[Column]
    rows: list[tuple[Row, list[Field]]]
    key: int = 0  # the column that names the row

    @property
    def scales(self) -> dict[str, Callable[[Field], Span | None]]:
        """By column, for those that are drawn as strips."""
        return {column.name: _scale([fields[i] for _, fields in self.rows])
                for i, column in enumerate(self.columns) if column.strip}


def _scale(fields: list[Field]) -> Callable[[Field], Span | None]:
    values = [float(field.value) for field in fields if field.value and float(field.value) > 0]
    bottom, top = (math.log(min(values)), math.log(max(values))) if values else (0.0, 0.0)

    def place(text: str) -> float:
        return min(100.0, max(0.0, 100 * (math.log(float(text)) - bottom) / (top - bottom)))

    def span(field: Field) -> Span | None:
        if not field.value or not float(field.value) > 0 or not top > bottom:
            return None
        if not field.low or not float(field.low) > 0:
            return Span(round(place(field.value), 2), 0, None)
        low = place(field.low)
        return Span(round(place(field.value), 2), round(low, 2), round(place(field.high) - low, 2))

    return span


def plain(text: str, flag: bool = False) -> Field:
    return Field(text or number.NOTHING, text, flag=flag)


def figure(row: Row, name: str) -> Field:
    mean, low, high = number.estimate(row, name)
    return Field(number.short(mean), mean, low, high)
