"""Loads the folder of one experiment as tidy pandas frames.

    from analysis.load import load
    results = load("results/convergence")
    results.convergence.groupby(["cell", "spp"]).relmse.mean()
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.csv_file import LoadError, read_csv
from analysis.ratios import cells_of

__all__ = ["LoadError", "Results", "load", "read_manifest"]

# Of the manifest's "schema": the newest that is understood. 0 are results from before it was written; they may lack
# cells.csv, ratios.csv and whichever columns are newer than those named below.
SCHEMA = 1
METRICS = ["mse", "relmse", "relmse_trimmed", "mape"]
SUMMARY_COLUMNS = ["run", "cell", "scene", "seed", "status", "frames"]
CONVERGENCE_COLUMNS = ["frame", "spp", "elapsed_s", *METRICS, "reference_mse", "reference_relmse",
                       "at_reference_floor"]
FRAMES_COLUMNS = ["frame", "is_warmup", "host_ms", "gpu_ms"]
CELLS_COLUMNS = ["cell", "scene", "seeds"]
RATIOS_COLUMNS = ["cell", "baseline"]


@dataclass(frozen=True)
class Results:
    """`summary` has a row per run, failed ones included; the other frames have finished runs only."""

    folder: Path
    experiment: dict[str, Any]  # manifest.json of the experiment
    summary: pd.DataFrame
    convergence: pd.DataFrame  # a row per run and snapshot

    @property
    def name(self) -> str:
        return str(self.experiment.get("experiment", self.folder.name))

    @property
    def schema(self) -> int:
        return int(self.experiment.get("schema", 0))

    @property
    def finished(self) -> pd.DataFrame:
        return self.summary[self.summary.status == "finished"]

    @property
    def planned_runs(self) -> int:
        return len(self.experiment.get("runs", self.summary))

    @cached_property
    def frames(self) -> pd.DataFrame:
        """A row per run and frame; read on first use, as it is by far the largest."""
        return _stack(self.folder, self.finished, "frames.csv", FRAMES_COLUMNS)

    @cached_property
    def cells(self) -> pd.DataFrame:
        """A row per cell: mean, standard deviation and 95 % interval over its seeds, as the program has them."""
        file = self.folder / "cells.csv"
        # Results of schema 0 may be older than that file.
        is_old = self.schema == 0 and not file.is_file()
        cells = cells_of(self.summary) if is_old else read_csv(file, CELLS_COLUMNS)
        cells.insert(1, "label", labels_of(cells))
        return cells

    @property
    def has_ratios(self) -> bool:
        return (self.folder / "ratios.csv").is_file()

    @cached_property
    def ratios(self) -> pd.DataFrame:
        """A row per cell and figure: how it compares with the config's baseline. LoadError if that names none."""
        if not self.has_ratios:
            raise LoadError(f"{self.folder}: has no ratios.csv: its config names no baseline, see `qtrace keys`")
        ratios = read_csv(self.folder / "ratios.csv", RATIOS_COLUMNS)
        labels = dict(zip(self.summary.cell, self.summary.label))
        ratios.insert(1, "label", ratios.cell.map(labels))
        ratios.insert(3, "baseline_label", ratios.baseline.map(labels))
        return ratios


def axis_columns(summary: pd.DataFrame) -> list[str]:
    return [column for column in summary.columns if column.startswith("axis:")]


def _part(axis: str, label: str) -> str:
    """A bare number or truth value says nothing without its key: sites_per_object=100."""
    try:
        float(label)
    except ValueError:
        if label not in ("true", "false"):
            return label
    return f"{axis.rpartition('.')[2]}={label}"


def labels_of(summary: pd.DataFrame) -> list[str]:
    """The cell without its scene: what tells the curves of one panel apart."""
    axes = [a for a in axis_columns(summary) if a not in ("axis:scene", "axis:seed")]
    if not axes:
        return ["all"] * len(summary)
    rows = summary[axes].itertuples(index=False)
    return [" / ".join(_part(a.removeprefix("axis:"), value) for a, value in zip(axes, row)) for row in rows]


def _stack(folder: Path, runs: pd.DataFrame, name: str, needed: list[str]) -> pd.DataFrame:
    """One file of each run below the other, each row with the run's id, cell, axes, scene and seed."""
    keys = ["run", "cell", "label", *axis_columns(runs), "scene", "seed"]
    parts = []
    for _, run in runs.iterrows():
        part = read_csv(folder / run["run"] / name, needed)
        for position, key in enumerate(keys):
            part.insert(position, key, run[key])
        parts.append(part)
    return pd.concat(parts, ignore_index=True)


def read_manifest(file: Path) -> dict[str, Any]:
    try:
        manifest = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise LoadError(f"{file}: cannot be read as JSON: {error}") from error
    if not isinstance(manifest, dict):
        raise LoadError(f"{file}: must hold a JSON object")
    return manifest


def check_schema(folder: Path, manifest: dict[str, Any]) -> None:
    schema = manifest.get("schema", 0)
    if not isinstance(schema, int) or schema < 0:
        raise LoadError(f"{folder / 'manifest.json'}: schema is {schema!r} but must be a whole number")
    if schema > SCHEMA:
        raise LoadError(f"{folder}: has schema {schema}, but this analysis reads {SCHEMA} and older: use the analysis "
                        "of the qtrace that wrote it")


def load(results: str | os.PathLike[str]) -> Results:
    """Reads results/<experiment>. Raises LoadError: no such folder, no finished run, an unreadable file."""
    folder = Path(results)
    if not folder.is_dir():
        raise LoadError(f"{folder}: no such folder; the folder of an experiment is needed, like results/convergence")
    if not (folder / "summary.csv").is_file():
        raise LoadError(f"{folder}: has no summary.csv, so it is not the folder of an experiment")
    experiment = read_manifest(folder / "manifest.json")
    check_schema(folder, experiment)
    summary = read_csv(folder / "summary.csv", SUMMARY_COLUMNS)
    summary.insert(2, "label", labels_of(summary))
    finished = summary[summary.status == "finished"]
    if finished.empty:
        raise LoadError(f"{folder}: none of its {len(summary)} runs is finished")
    return Results(folder, experiment, summary, _stack(folder, finished, "convergence.csv", CONVERGENCE_COLUMNS))
