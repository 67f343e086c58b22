"""Loads the folder of one experiment as tidy pandas frames.

    from analysis.load import load
    results = load("results/convergence")
    results.convergence.groupby(["configuration", "spp"]).relmse.mean()

The files of single runs are read when they are asked for: published results are kept without them.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from analysis import schema
from analysis.command import LoadError, MissingError
from analysis.csv_file import read_csv
from analysis.metrics import Metric, metrics_of

__all__ = ["LoadError", "MissingError", "Results", "load", "read_manifest"]

METRICS = ["mse", "relmse", "relmse_trimmed", "mape"]
SUMMARY_COLUMNS = ["run", "configuration", "scene", "seed", "status", "frames"]
CONVERGENCE_COLUMNS = ["frame", "spp", "elapsed_s", *METRICS, "reference_mse", "reference_relmse",
                       "at_reference_floor"]
FRAMES_COLUMNS = ["frame", "is_warmup", "host_ms", "gpu_ms"]
CONFIGURATIONS_COLUMNS = ["configuration", "scene", "seeds"]
RATIOS_COLUMNS = ["configuration", "baseline"]


@dataclass(frozen=True)
class Results:
    """`summary` has a row per run, failed ones included; the other frames have finished runs only."""

    folder: Path
    experiment: dict[str, Any]  # manifest.json of the experiment
    summary: pd.DataFrame

    @property
    def name(self) -> str:
        return str(self.experiment.get("experiment", self.folder.name))

    @property
    def schema(self) -> int:
        return schema.schema_of(self.folder, self.experiment)

    @property
    def finished(self) -> pd.DataFrame:
        return self.summary[self.summary.status == "finished"]

    @property
    def planned_runs(self) -> int:
        return len(self.experiment.get("runs", self.summary))

    @cached_property
    def metrics(self) -> dict[str, Metric]:
        """What the errors are called, by the names of their columns."""
        return metrics_of(self.experiment)

    @cached_property
    def convergence(self) -> pd.DataFrame:
        """A row per run and snapshot; read on first use. MissingError where the folder is kept without its runs' files."""
        return self._stack("convergence.csv", CONVERGENCE_COLUMNS)

    @cached_property
    def frames(self) -> pd.DataFrame:
        """A row per run and frame; read on first use, as it is by far the largest."""
        return self._stack("frames.csv", FRAMES_COLUMNS)

    @cached_property
    def configurations(self) -> pd.DataFrame:
        """A row per configuration: mean, standard deviation and 95 % interval over its seeds, as the program has them."""
        table = self._read("configurations.csv", CONFIGURATIONS_COLUMNS)
        table.insert(1, "label", labels_of(table))
        return table

    @property
    def has_ratios(self) -> bool:
        return schema.file_of(self.folder, self.schema, "ratios.csv").is_file()

    @cached_property
    def ratios(self) -> pd.DataFrame:
        """A row per configuration and figure: how it compares with the config's baseline. MissingError if that names
        none."""
        if not self.has_ratios:
            raise MissingError(f"{self.folder}: has no ratios.csv: its config names no baseline, see `qtrace keys`")
        ratios = self._read("ratios.csv", RATIOS_COLUMNS)
        labels = dict(zip(self.summary.configuration, self.summary.label))
        ratios.insert(1, "label", ratios.configuration.map(labels))
        ratios.insert(3, "baseline_label", ratios.baseline.map(labels))
        return ratios

    def _read(self, name: str, needed: list[str]) -> pd.DataFrame:
        file = schema.file_of(self.folder, self.schema, name)
        return read_csv(file, needed, renamed=schema.columns_of(self.schema))

    def _stack(self, name: str, needed: list[str]) -> pd.DataFrame:
        """One file of each finished run below the other, each row with the run's id, configuration, axes, scene and
        seed."""
        runs = self.finished
        if runs.empty:
            raise LoadError(f"{self.folder}: none of its {len(self.summary)} runs is finished")
        if not any((self.folder / run / name).is_file() for run in runs.run):
            raise MissingError(f"{self.folder}: no run's {name} is here; this folder was kept without the files of its runs")
        keys = ["run", "configuration", "label", *axis_columns(runs), "scene", "seed"]
        parts = []
        for _, run in runs.iterrows():
            part = read_csv(self.folder / run["run"] / name, needed, renamed=schema.columns_of(self.schema))
            for position, key in enumerate(keys):
                part.insert(position, key, run[key])
            parts.append(part)
        return pd.concat(parts, ignore_index=True)


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
    """The configuration without its scene: what tells the curves of one panel apart."""
    axes = [a for a in axis_columns(summary) if a not in ("axis:scene", "axis:seed")]
    if not axes:
        return ["all"] * len(summary)
    rows = summary[axes].itertuples(index=False)
    return [" / ".join(_part(a.removeprefix("axis:"), value) for a, value in zip(axes, row)) for row in rows]


def read_manifest(file: Path) -> dict[str, Any]:
    """Of an experiment or a run, with the keys of today."""
    try:
        manifest = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise MissingError(f"{file}: no such file") from error
    except (OSError, ValueError) as error:
        raise LoadError(f"{file}: cannot be read as JSON: {error}") from error
    if not isinstance(manifest, dict):
        raise LoadError(f"{file}: must hold a JSON object")
    return schema.keys_of_today(manifest)


def read_experiment(folder: Path) -> dict[str, Any]:
    """The manifest of an experiment's folder. Raises LoadError where there is none that can be read here."""
    if not folder.is_dir():
        raise LoadError(f"{folder}: no such folder; the folder of an experiment is needed, like results/convergence")
    if not (folder / "summary.csv").is_file():
        raise LoadError(f"{folder}: has no summary.csv, so it is not the folder of an experiment")
    manifest = read_manifest(folder / "manifest.json")
    schema.schema_of(folder, manifest)
    return manifest


def load(results: str | os.PathLike[str]) -> Results:
    """Reads results/<experiment>. Raises LoadError: no such folder, an unreadable file. What single runs have left is read
    later, when it is asked for."""
    folder = Path(results)
    experiment = read_experiment(folder)
    renamed = schema.columns_of(schema.schema_of(folder, experiment))
    summary = read_csv(folder / "summary.csv", SUMMARY_COLUMNS, renamed=renamed)
    summary.insert(2, "label", labels_of(summary))
    return Results(folder, experiment, summary)
