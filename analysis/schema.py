"""The contract of a results folder: which names its files, columns and keys have. Older results are read through one map
of their names to those of today."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from analysis.command import LoadError

SCHEMA = 2  # of the manifest's "schema": kResultsSchema of experiments/runtime/manifest.h


@dataclass(frozen=True)
class Names:
    """Of one schema; empty where it has the names of today."""

    files: dict[str, str] = field(default_factory=dict)  # by today's name
    columns: dict[str, str] = field(default_factory=dict)  # today's name by theirs; keys of a run's manifest, too


# In the results of schema 1, a cell was what is now a configuration.
NAMES = {1: Names({"configurations.csv": "cells.csv", "summary.md": "table.md"}, {"cell": "configuration"}),
         SCHEMA: Names()}


def schema_of(folder: Path, manifest: dict[str, Any]) -> int:
    """Raises LoadError for a contract that is not known here. A manifest that does not say has the names of schema 1; its
    folder may lack files and columns that came later, and says so where they are asked for."""
    schema = manifest.get("schema", 1)
    if not isinstance(schema, int) or schema < 1:
        raise LoadError(f"{folder / 'manifest.json'}: schema is {schema!r} but must be a whole number from 1 on")
    if schema > SCHEMA:
        raise LoadError(f"{folder}: has schema {schema}, but this analysis reads {SCHEMA} and older: use the analysis "
                        "of the qtrace that wrote it")
    return schema


def file_of(folder: Path, schema: int, name: str) -> Path:
    """Where the file that is called `name` today stands."""
    return folder / NAMES[schema].files.get(name, name)


def columns_of(schema: int) -> dict[str, str]:
    return NAMES[schema].columns


def keys_of_today(manifest: dict[str, Any]) -> dict[str, Any]:
    """The manifest of a run or an experiment with its keys as they are called today."""
    schema = manifest.get("schema", 1)
    names = NAMES[schema].columns if schema in NAMES else {}
    return {names.get(key, key): value for key, value in manifest.items()}
