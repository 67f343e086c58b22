"""Reads the folder of one experiment for its page. What the page cannot do without is an error; a file that a run has
lost is a gap that the page names. Fields stay the text of the CSV files, so that the page shows every digit of them."""

from __future__ import annotations

import csv
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Mapping

import pandas as pd

from analysis import load, schema
from analysis.command import LoadError
from analysis.csv_file import read_csv
from analysis.metrics import Metric, metrics_of

Row = dict[str, str]


@dataclass
class Sweep:
    folder: Path
    manifest: dict[str, Any]        # of the experiment
    summary: list[Row]              # a row per run that was begun, failed ones too; with "label"
    configurations: list[Row]       # a row per configuration of the sweep; with "label"
    ratios: dict[str, Row]          # by configuration; empty without a baseline
    members: dict[str, list[Row]]   # by configuration: the runs that count, as in configurations.csv
    convergence: pd.DataFrame       # a row per snapshot of the runs that count
    manifests: dict[str, dict[str, Any]] = field(default_factory=dict)  # by run, of those that count
    gaps: list[str] = field(default_factory=list)                       # what could not be read

    @property
    def name(self) -> str:
        return str(self.manifest.get("experiment", self.folder.name))

    @property
    def scenes(self) -> list[str]:
        return list(dict.fromkeys(row["scene"] for row in self.configurations))

    @property
    def planned(self) -> list[dict[str, Any]]:
        return self.manifest.get("runs") or [{"run": row["run"], "status": row["status"]} for row in self.summary]

    @cached_property
    def metrics(self) -> dict[str, Metric]:
        return metrics_of(self.manifest)

    def run_manifest(self, configuration: str) -> dict[str, Any]:
        """Of the first run of the configuration that has one; empty where none has."""
        return next((self.manifests[row["run"]] for row in self.members[configuration] if row["run"] in self.manifests), {})


def read_rows(file: Path, needed: list[str], renamed: Mapping[str, str]) -> list[Row]:
    """All fields as their text; that numbers are numbers is checked."""
    read_csv(file, needed, renamed=renamed)
    try:
        with file.open(encoding="utf-8", newline="") as stream:
            header = [renamed.get(name, name) for name in next(csv.reader(stream), [])]
    except (OSError, ValueError, csv.Error) as error:
        raise LoadError(f"{file}: cannot be read as CSV: {error}") from error
    return read_csv(file, needed, labels=header, renamed=renamed).to_dict("records")


def _label(rows: list[Row]) -> None:
    """Adds what tells the configurations of one scene apart, as the curves of `./dev figures` are labelled."""
    for row, label in zip(rows, load.labels_of(pd.DataFrame(rows)) if rows else []):
        row["label"] = label


def _members(rows: list[Row]) -> list[Row]:
    """The finished seeds of a configuration; where none is finished, the partial ones that came furthest: those that
    configurations.csv has the means of."""
    rows = [row for row in rows if row.get("relmse")]
    finished = [row for row in rows if row["status"] == "finished"]
    if finished:
        return finished
    partial = [row for row in rows if row["status"] == "partial"]
    furthest = max((int(row["frames"] or 0) for row in partial), default=0)
    return [row for row in partial if int(row["frames"] or 0) == furthest]


def _convergence(folder: Path, runs: list[Row], renamed: Mapping[str, str], gaps: list[str]) -> pd.DataFrame:
    parts = []
    for run in runs:
        try:
            part = read_csv(folder / run["run"] / "convergence.csv", load.CONVERGENCE_COLUMNS, renamed=renamed)
        except LoadError as error:
            gaps.append(str(error))
            continue
        parts.append(part.assign(**{key: run[key] for key in ("run", "configuration", "label", "scene", "seed")}))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=load.CONVERGENCE_COLUMNS)


def _manifests(folder: Path, runs: list[Row], gaps: list[str]) -> dict[str, dict[str, Any]]:
    manifests = {}
    for run in runs:
        try:
            manifests[run["run"]] = load.read_manifest(folder / run["run"] / "manifest.json")
        except LoadError as error:
            gaps.append(str(error))
    return manifests


def read_sweep(folder: Path) -> Sweep:
    """Raises LoadError where there is no experiment, or its tables cannot be read."""
    manifest = load.read_experiment(folder)
    contract = schema.schema_of(folder, manifest)
    renamed = schema.columns_of(contract)
    summary = read_rows(folder / "summary.csv", load.SUMMARY_COLUMNS, renamed)
    gaps: list[str] = []
    means, against = (schema.file_of(folder, contract, name) for name in ("configurations.csv", "ratios.csv"))
    configurations = read_rows(means, load.CONFIGURATIONS_COLUMNS, renamed) if means.is_file() else []
    if not means.is_file():
        gaps.append(f"{means}: no such file, so there are no means over seeds; `qtrace run` writes it")
    ratios = read_rows(against, load.RATIOS_COLUMNS, renamed) if against.is_file() else []
    for rows in (summary, configurations):
        _label(rows)
    names = [row["configuration"] for row in configurations]
    members = {name: _members([row for row in summary if row["configuration"] == name]) for name in names}
    counting = [row for rows in members.values() for row in rows]
    convergence, manifests = pd.DataFrame(columns=load.CONVERGENCE_COLUMNS), {}
    if counting and not any((folder / row["run"]).is_dir() for row in counting):
        gaps.append(f"{folder}: it was kept without the folders of its runs, so that there are no curves and no images")
    else:
        convergence, manifests = _convergence(folder, counting, renamed, gaps), _manifests(folder, counting, gaps)
    return Sweep(folder, manifest, summary, configurations, {row["configuration"]: row for row in ratios}, members,
                 convergence, manifests, gaps)
