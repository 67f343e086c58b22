"""Reads the folder of one experiment for its page. What the page cannot do without is an error; a file that a run has
lost is a gap that the page names. Fields stay the text of the CSV files, so that the page shows every digit of them."""

from __future__ import annotations

import csv
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from analysis import load
from analysis.csv_file import LoadError, read_csv

Row = dict[str, str]


@dataclass
class Sweep:
    folder: Path
    manifest: dict[str, Any]        # of the experiment
    summary: list[Row]              # a row per run that was begun, failed ones too; with "label"
    cells: list[Row]                # a row per cell of the sweep; with "label"
    ratios: dict[str, Row]          # by cell; empty without a baseline
    members: dict[str, list[Row]]   # by cell: the runs that count, as in cells.csv
    convergence: pd.DataFrame       # a row per snapshot of the runs that count
    manifests: dict[str, dict[str, Any]] = field(default_factory=dict)  # by run, of those that count
    gaps: list[str] = field(default_factory=list)                       # what could not be read

    @property
    def name(self) -> str:
        return str(self.manifest.get("experiment", self.folder.name))

    @property
    def scenes(self) -> list[str]:
        return list(dict.fromkeys(cell["scene"] for cell in self.cells))

    @property
    def planned(self) -> list[dict[str, Any]]:
        return self.manifest.get("runs") or [{"run": row["run"], "status": row["status"]} for row in self.summary]

    def run_manifest(self, cell: str) -> dict[str, Any]:
        """Of the first run of the cell that has one; empty where none has."""
        return next((self.manifests[row["run"]] for row in self.members[cell] if row["run"] in self.manifests), {})


def read_rows(file: Path, needed: list[str]) -> list[Row]:
    """All fields as their text; that numbers are numbers is checked."""
    read_csv(file, needed)
    try:
        with file.open(encoding="utf-8", newline="") as stream:
            header = next(csv.reader(stream), [])
    except (OSError, ValueError, csv.Error) as error:
        raise LoadError(f"{file}: cannot be read as CSV: {error}") from error
    return read_csv(file, needed, labels=header).to_dict("records")


def _label(rows: list[Row]) -> None:
    """Adds what tells the cells of one scene apart, as the curves of `./dev plot` are labelled."""
    for row, label in zip(rows, load.labels_of(pd.DataFrame(rows)) if rows else []):
        row["label"] = label


def _members(rows: list[Row]) -> list[Row]:
    """The finished seeds of a cell; where none is finished, the partial ones that came furthest. As cells.cpp has it."""
    rows = [row for row in rows if row.get("relmse")]
    finished = [row for row in rows if row["status"] == "finished"]
    if finished:
        return finished
    partial = [row for row in rows if row["status"] == "partial"]
    furthest = max((int(row["frames"] or 0) for row in partial), default=0)
    return [row for row in partial if int(row["frames"] or 0) == furthest]


def _convergence(folder: Path, runs: list[Row], gaps: list[str]) -> pd.DataFrame:
    parts = []
    for run in runs:
        try:
            part = read_csv(folder / run["run"] / "convergence.csv", load.CONVERGENCE_COLUMNS)
        except LoadError as error:
            gaps.append(str(error))
            continue
        parts.append(part.assign(**{key: run[key] for key in ("run", "cell", "label", "scene", "seed")}))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=load.CONVERGENCE_COLUMNS)


def _manifests(folder: Path, runs: list[Row], gaps: list[str]) -> dict[str, dict[str, Any]]:
    manifests = {}
    for run in runs:
        try:
            manifests[run["run"]] = load.read_manifest(folder / run["run"] / "manifest.json")
        except LoadError as error:
            gaps.append(str(error))
    return manifests


def _cells(folder: Path, manifest: dict[str, Any], gaps: list[str]) -> list[Row]:
    file = folder / "cells.csv"
    if file.is_file():
        return read_rows(file, load.CELLS_COLUMNS)
    if manifest.get("schema", 0) == 0:  # older than that file
        gaps.append(f"{file}: no such file, as in results of early versions: means over seeds come from summary.csv")
        cells = load.cells_of(read_csv(folder / "summary.csv", load.SUMMARY_COLUMNS))
        return [{key: "" if pd.isna(value) else str(value) for key, value in row.items()}
                for row in cells.to_dict("records")]
    gaps.append(f"{file}: no such file, so there are no means over seeds; `qtrace run` writes it")
    return []


def read_sweep(folder: Path) -> Sweep:
    """Raises LoadError where there is no experiment, or its tables cannot be read."""
    if not folder.is_dir():
        raise LoadError(f"{folder}: no such folder; the folder of an experiment is needed, like results/convergence")
    if not (folder / "summary.csv").is_file():
        raise LoadError(f"{folder}: has no summary.csv, so it is not the folder of an experiment")
    manifest = load.read_manifest(folder / "manifest.json")
    load.check_schema(folder, manifest)
    summary = read_rows(folder / "summary.csv", load.SUMMARY_COLUMNS)
    gaps: list[str] = []
    cells = _cells(folder, manifest, gaps)
    file = folder / "ratios.csv"
    ratios = read_rows(file, load.RATIOS_COLUMNS) if file.is_file() else []
    for rows in (summary, cells):
        _label(rows)
    members = {cell["cell"]: _members([row for row in summary if row["cell"] == cell["cell"]]) for cell in cells}
    counting = [row for rows in members.values() for row in rows]
    return Sweep(folder, manifest, summary, cells, {row["cell"]: row for row in ratios},
                 members, _convergence(folder, counting, gaps), _manifests(folder, counting, gaps), gaps)
