"""Reads one CSV file of results, strictly: a short row or a word among numbers is an error, never a NaN."""

from __future__ import annotations

import csv
from pathlib import Path
from types import MappingProxyType
from typing import Iterable, Mapping

import pandas as pd

from analysis.command import LoadError, MissingError

TEXT = {"run", "configuration", "scene", "status", "reason", "verdict", "verdict_reason", "started", "baseline",
        "reference_hash", "config_hash"}
BOOLEAN = {"is_warmup", "at_reference_floor"}


def _is_text(name: str) -> bool:
    return name in TEXT or name.startswith("axis:")


def _column(name: str, fields: list[str], file: Path, labels: Iterable[str]) -> pd.Series:
    if _is_text(name) or name in labels:
        return pd.Series(fields, dtype=object)
    try:
        # Through int where possible: seeds and counts may be larger than a double can hold exactly.
        values = [int(field) for field in fields]
    except ValueError:
        try:
            values = [float(field or "nan") for field in fields]
        except ValueError as error:
            raise LoadError(f"{file}: column '{name}' holds something that is not a number: {error}") from error
    if name in BOOLEAN and all(value == value for value in values):  # NaN: a failed run has none
        return pd.Series(values, dtype=bool)
    return pd.Series(values, dtype=None if values else float)


def read_csv(file: Path, needed: Iterable[str], labels: Iterable[str] = (),
             renamed: Mapping[str, str] = MappingProxyType({})) -> pd.DataFrame:
    """All columns: labels (those given, too) as text, numbers with every digit. Empty numbers are NaN. `renamed`: the
    names that are wanted, by those of the file."""
    try:
        with file.open(encoding="utf-8", newline="") as stream:
            rows = list(csv.reader(stream, strict=True))
    except FileNotFoundError as error:
        raise MissingError(f"{file}: no such file") from error
    except (OSError, ValueError, csv.Error) as error:
        raise LoadError(f"{file}: cannot be read as CSV: {error}") from error
    if not rows:
        raise LoadError(f"{file}: is empty")
    header, *body = rows
    header = [renamed.get(name, name) for name in header]
    missing = [name for name in needed if name not in header]
    if missing:
        raise LoadError(f"{file}: has no column '{missing[0]}'")
    for number, row in enumerate(body, start=2):
        if len(row) != len(header):
            raise LoadError(f"{file}: record {number} has {len(row)} fields, but the header has {len(header)}")
    fields = list(zip(*body)) or [()] * len(header)
    return pd.DataFrame({name: _column(name, list(fields[i]), file, labels) for i, name in enumerate(header)})
