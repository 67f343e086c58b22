"""Two results folders side by side: what changed, by how much, and what is noise.

Each figure of each configuration is compared by Welch's test on the logarithms of the two means (welch.py). Many comparisons
are made at once, so that by chance alone one in twenty would look like a change: p is corrected over all of them
(Benjamini and Hochberg 1995, Controlling the false discovery rate), so that of what is called changed 5 % or less are
expected to be none. Runs with the same seed share random numbers on both sides, which can only make the intervals too
wide."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Iterable

import pandas as pd

from analysis.command import MissingError
from analysis.load import Results
from analysis.metrics import errors
from analysis.tolerances import LEVEL
from analysis.welch import Comparison, ratio_of_means

# Of the summary: the whole run's frames. Of the snapshots: the last that both sides have.
TIMES = ("host_ms_median", "gpu_ms_median")
PRODUCT = "relmse_x_s"
NOTHING = pd.DataFrame({"run": [], "frame": []})  # of a configuration without a snapshot


@dataclass(frozen=True)
class Row:
    scene: str
    configuration: str
    figure: str
    seeds: tuple[int, int]
    means: tuple[float, float]
    comparison: Comparison
    same: bool  # every seed has the same value on both sides
    p: float = math.nan  # corrected

    @property
    def verdict(self) -> str:
        if self.same:
            return "same"
        if math.isnan(self.p):
            return "one seed"  # no interval, no verdict
        if self.p < LEVEL:
            return "changed"
        # Alone it would be a change; among so many it may well be chance.
        return "unclear" if self.comparison.p < LEVEL else "noise"


@dataclass(frozen=True)
class SideBySide:
    rows: list[Row]
    only: tuple[list[str], list[str]]  # configurations of one side alone
    facts: list[tuple[str, str, str]]  # what else differs: name, here, there
    warnings: list[str]

    def count(self, verdict: str) -> int:
        return sum(row.verdict == verdict for row in self.rows)


def false_discovery(values: Iterable[float]) -> list[float]:
    """Corrected p values in the same order: the least rate at which each would be a discovery. NaN are no tests."""
    p = list(values)
    order = sorted((i for i in range(len(p)) if not math.isnan(p[i])), key=lambda i: p[i])
    least = 1.0
    for rank, i in reversed(list(enumerate(order, start=1))):
        least = min(least, p[i] * len(order) / rank)
        p[i] = least
    return p


def _figures(a: Results, b: Results) -> dict[str, str]:
    """Columns that both sides may have, and what they are called here."""
    metrics = b.metrics | a.metrics
    names = [*TIMES, *(metric.name for metric in errors(metrics.values())), PRODUCT]
    return {name: metrics[name].label for name in names if name in metrics}


def _snapshots(results: Results) -> pd.DataFrame:
    """A row per snapshot; where the files of single runs are gone, the summary's row of each run for its last one."""
    try:
        return results.convergence
    except MissingError:
        return results.finished.assign(frame=results.finished.frames)


def _values(results: Results, snapshots: pd.DataFrame, frame: int) -> pd.DataFrame:
    """A row per seed: times of its frames, errors of that snapshot."""
    snapshots = snapshots[snapshots.frame == frame]
    snapshots = snapshots.assign(relmse_x_s=snapshots.relmse * snapshots.elapsed_s)
    runs = results.finished.set_index("run")
    times = {name: [runs[name][run] for run in snapshots.run] for name in TIMES if name in runs}
    return snapshots.assign(**times).set_index("seed")


def _compare(name: str, heading: str, scene: str, configuration: str, a: pd.DataFrame, b: pd.DataFrame) -> Row | None:
    """None where one side has not measured it or has a mean of zero."""
    if name not in a or name not in b or a[name].isna().any() or b[name].isna().any():
        return None
    comparison = ratio_of_means(list(b[name]), list(a[name]))
    if comparison is None:
        return None
    same = a[name].sort_index().equals(b[name].sort_index())
    return Row(scene, configuration, heading, (len(a), len(b)), (a[name].mean(), b[name].mean()), comparison, same,
               math.nan if same else comparison.p)


def _scenes(results: Results) -> dict[str, str]:
    """By configuration, of the finished ones."""
    return dict(zip(results.finished.configuration, results.finished.scene))


def _frames(snapshots: pd.DataFrame) -> set[int]:
    """Those that all runs have."""
    frames = [set(run.frame) for _, run in snapshots.groupby("run")]
    return set.intersection(*frames) if frames else set()


def _leaves(value: Any, path: str = "") -> dict[str, str]:
    if isinstance(value, dict) and value:
        return {leaf: text for key, part in value.items()
                for leaf, text in _leaves(part, f"{path}.{key}" if path else key).items()}
    text = str(value)
    return {path: text if len(text) <= 60 else text[:57] + "..."}


def _facts(a: Results, b: Results) -> list[tuple[str, str, str]]:
    """Device, program and config, where they differ."""
    sides = []
    for results in (a, b):
        leaves = {}
        for part in ("program", "device", "config", "scenes"):
            leaves |= _leaves({part: results.experiment.get(part, {})})
        sides.append(leaves)
    return [(name, sides[0].get(name, "-"), sides[1].get(name, "-"))
            for name in dict.fromkeys([*sides[0], *sides[1]]) if sides[0].get(name) != sides[1].get(name)]


def _references(results: Results, configuration: str) -> set[str]:
    return set(results.finished[results.finished.configuration == configuration].get("reference_hash", []))


def some(names: list[str], most: int = 3) -> str:
    return "; ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def _by_configuration(results: Results) -> dict[str, pd.DataFrame]:
    return dict(iter(_snapshots(results).groupby("configuration", sort=False)))


def compare(a: Results, b: Results) -> SideBySide:
    scenes_a, scenes_b = _scenes(a), _scenes(b)
    sides = [_by_configuration(results) for results in (a, b)]
    rows: list[Row] = []
    notes: dict[str, list[str]] = {}  # configurations by what is to be said of them
    for name, scene in scenes_a.items():
        if name not in scenes_b:
            continue
        here, there = (side.get(name, NOTHING) for side in sides)
        shared = _frames(here) & _frames(there)
        if not shared:
            notes.setdefault("the two sides share no snapshot, so nothing is compared", []).append(name)
            continue
        frame = max(shared)
        if frame < max(_frames(here) | _frames(there)):
            notes.setdefault(f"the runs differ in length; errors are those after frame {frame}", []).append(name)
        if _references(a, name) != _references(b, name):
            notes.setdefault("the references differ, and a part of a change in error may be theirs", []).append(name)
        values = (_values(a, here, frame), _values(b, there, frame))
        compared = (_compare(figure, heading, scene, name, *values) for figure, heading in _figures(a, b).items())
        rows += filter(None, compared)
    corrected = [replace(row, p=p) for row, p in zip(rows, false_discovery(row.p for row in rows))]
    only = ([name for name in scenes_a if name not in scenes_b], [name for name in scenes_b if name not in scenes_a])
    return SideBySide(corrected, only, _facts(a, b), [f"{note}: {some(names)}" for note, names in notes.items()])
