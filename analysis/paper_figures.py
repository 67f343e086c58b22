#!/usr/bin/python3
"""Makes a labelled sheet of pictures per scene of an experiment: a row per method, a column per chosen frame, and
the reference image last; all at one exposure, each with its samples and its relMSE."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

if not __package__:  # run as a script: import from the repository, and keep this folder from hiding `statistics`
    sys.path[0] = str(Path(__file__).resolve().parents[1])

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis import command
from analysis.load import Results, load, read_manifest
from analysis.tonemap import check_exposure, read_picture, sheet

Panel = tuple[np.ndarray, str]  # picture and label


def first_seeds(results: Results, scene: str) -> pd.DataFrame:
    """The first finished run of each method, in the order of the sweep."""
    runs = results.finished
    return runs[runs.scene == scene].drop_duplicates("label")


def _snapshots(results: Results, run: str) -> pd.DataFrame:
    """The run's errors by frame."""
    return results.convergence[results.convergence.run == run].set_index("frame")


def _shared_frames(results: Results, runs: pd.DataFrame) -> list[int]:
    """The snapshots that all runs have."""
    frames = [set(_snapshots(results, run).index) for run in runs.run]
    shared = sorted(set.intersection(*frames))
    if not shared:
        raise command.AnalysisError(f"{results.folder}: the runs of {runs.scene.iloc[0]} share no snapshot")
    return shared


def _panel(results: Results, run: pd.Series, frame: int, exposure: float) -> Panel:
    snapshots = _snapshots(results, run.run)
    if frame not in snapshots.index:
        known = ", ".join(map(str, snapshots.index))
        raise command.AnalysisError(f"{results.folder / run.run}: has no snapshot of frame {frame}, only of {known}")
    row = snapshots.loc[frame]
    picture, _ = read_picture(results.folder / run.run / f"frame_{frame:06d}.exr", exposure)
    return picture, f"{run.label}\n{int(row.spp)} spp, relMSE {row.relmse:.3g}"


def reference_file(results: Results, run: str) -> Path | None:
    """The reference of a run: where its manifest says, or, in results that were moved, beside the experiment."""
    reference = read_manifest(results.folder / run / "manifest.json").get("reference")
    name = reference.get("file") if isinstance(reference, dict) else None
    if not isinstance(name, str):
        return None
    places = (Path(name), results.folder.parent / "references" / Path(name).name)
    return next((place for place in places if place.is_file()), None)


def _references(results: Results, runs: pd.DataFrame, exposure: float) -> list[Panel] | None:
    """The last column: each reference once, beside the first of the rows that share it; None if one is missing."""
    panels: list[Panel] = []
    previous = None
    for run in runs.run:
        file = reference_file(results, run)
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
    runs = first_seeds(results, scene)
    columns = frames or _shared_frames(results, runs)
    references = _references(results, runs, exposure)
    panels: list[Panel] = []
    for i, (_, run) in enumerate(runs.iterrows()):
        panels += [_panel(results, run, frame, exposure) for frame in columns]
        panels += references[i:i + 1] if references else []
    pictures, labels = zip(*panels)
    return sheet(list(pictures), list(labels), len(columns) + (references is not None), exposure)


def _frames(text: str) -> list[int]:
    try:
        frames = [int(part) for part in text.split(",")]
    except ValueError:
        frames = [0]
    if min(frames) < 1:
        raise command.AnalysisError(f"--frames must be whole numbers from 1 on, like 10,100,400, not '{text}'")
    return frames


def _arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", metavar="RESULTS", type=Path, help="results/<experiment>")
    parser.add_argument("--frames", metavar="N,N,...", help="columns (default: all snapshots the runs share)")
    parser.add_argument("--exposure", metavar="STOPS", type=float, default=0.0, help="brightens by 2^STOPS")
    parser.add_argument("--out", metavar="FOLDER", type=Path, help="where to write (default: RESULTS)")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> None:
    options = _arguments(arguments)
    check_exposure(options.exposure)
    frames = _frames(options.frames) if options.frames is not None else None
    results = load(options.results)
    for scene in dict.fromkeys(results.finished.scene):
        figure = scene_sheet(results, scene, frames, options.exposure)
        file = (options.out or options.results) / f"sheet_{scene}.png"
        command.write_whole(file, lambda target: figure.savefig(target, format="png"))
        print(file)


if __name__ == "__main__":
    sys.exit(command.run(main))
