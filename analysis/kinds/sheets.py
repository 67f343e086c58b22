"""A labelled sheet of images per scene: a row per method, a column per chosen frame, and the reference image last; all at
one exposure, each with its samples and its relMSE. At equal seconds, methods stand side by side instead."""

from __future__ import annotations

import sys
from typing import Iterator

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis import style
from analysis.command import AnalysisError, MissingError
from analysis.images import reference_file, shown_run
from analysis.kinds.request import Drawing, Request
from analysis.load import Results, read_manifest
from analysis.tonemap import read_picture, sheet

Panel = tuple[np.ndarray, str]  # picture and label


def shown_runs(results: Results, scene: str) -> pd.DataFrame:
    """A finished run of each method, in the order of the sweep. MissingError where none has an image."""
    runs = results.finished[results.finished.scene == scene]
    shown = [shown_run(results.folder, group.run) for _, group in runs.groupby("label", sort=False)]
    if not any(shown):
        raise MissingError(f"{results.folder}: no run of {scene} has images (frame_NNNNNN.exr)")
    return runs[runs.run.isin([run for run in shown if run])]


def _snapshots(results: Results, run: str) -> pd.DataFrame:
    """The run's errors by frame."""
    return results.convergence[results.convergence.run == run].set_index("frame")


def _shared_frames(results: Results, runs: pd.DataFrame) -> list[int]:
    """The snapshots that all runs have."""
    frames = [set(_snapshots(results, run).index) for run in runs.run]
    shared = sorted(set.intersection(*frames))
    if not shared:
        raise MissingError(f"{results.folder}: the runs of {runs.scene.iloc[0]} share no snapshot")
    return shared


def _panel(results: Results, run: pd.Series, frame: int, exposure: float) -> Panel:
    snapshots = _snapshots(results, run.run)
    if frame not in snapshots.index:
        known = ", ".join(map(str, snapshots.index))
        raise AnalysisError(f"{results.folder / run.run}: has no snapshot of frame {frame}, only of {known}")
    row = snapshots.loc[frame]
    picture, _ = read_picture(results.folder / run.run / f"frame_{frame:06d}.exr", exposure)
    return picture, f"{run.label}\n{int(row.spp)} spp, relMSE {row.relmse:.3g}"


def _references(results: Results, runs: pd.DataFrame, exposure: float) -> list[Panel] | None:
    """The last column: each reference once, beside the first of the rows that share it; None if one is missing."""
    panels: list[Panel] = []
    previous = None
    for run in runs.run:
        file = reference_file(results.folder, read_manifest(results.folder / run / "manifest.json"))
        if file is None:
            print(f"warning: {results.folder / run}: its reference image is not found, so the sheet has none",
                  file=sys.stderr)
            return None
        if file == previous:
            panels.append((np.full_like(panels[-1][0], 255), ""))
        else:
            panels.append(read_picture(file, exposure))
        previous = file
    return panels


def scene_sheet(results: Results, scene: str, frames: list[int] | None, exposure: float) -> Figure:
    """The sheet of one scene; without `frames`, all snapshots that its runs share."""
    runs = shown_runs(results, scene)
    columns = frames or _shared_frames(results, runs)
    references = _references(results, runs, exposure)
    panels: list[Panel] = []
    for i, (_, run) in enumerate(runs.iterrows()):
        panels += [_panel(results, run, frame, exposure) for frame in columns]
        panels += references[i:i + 1] if references else []
    pictures, labels = zip(*panels)
    return sheet(list(pictures), list(labels), len(columns) + (references is not None), exposure)


def equal_time_sheet(results: Results, scene: str, seconds: float, exposure: float) -> Figure:
    """What each method has after these seconds of rendering, learning included, side by side, and the reference."""
    runs = shown_runs(results, scene)
    panels: list[Panel] = []
    for _, run in runs.iterrows():
        snapshots = _snapshots(results, run.run)
        reached = snapshots[snapshots.elapsed_s <= seconds]
        if reached.empty:
            raise AnalysisError(f"{results.folder / run.run}: its first snapshot is at {snapshots.elapsed_s.min():.3g} s, "
                                f"after the {seconds:g} s that are asked for")
        picture, label = _panel(results, run, int(reached.index.max()), exposure)
        panels.append((picture, f"{label}, {reached.elapsed_s.max():.3g} s"))
    references = _references(results, runs, exposure)
    panels += [panel for panel in references or [] if panel[1]]
    pictures, labels = zip(*panels)
    return sheet(list(pictures), list(labels), len(panels), exposure)


def draw(request: Request, medium: style.Medium) -> Iterator[Drawing]:
    for scene in dict.fromkeys(request.results.finished.scene):
        figure = (scene_sheet(request.results, scene, request.frames, request.exposure) if request.seconds is None else
                  equal_time_sheet(request.results, scene, request.seconds, request.exposure))
        yield Drawing(f"sheet_{scene}", figure, dpi=figure.dpi)
