"""Which images of an experiment are shown, and where: one seed of each configuration, and the reference."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Iterable


def snapshots(run: Path) -> dict[int, Path]:
    """The images of a run by frame."""
    return {int(file.stem[-6:]): file for file in sorted(run.glob("frame_??????.exr"))}


def shown_run(folder: Path, runs: Iterable[str]) -> str | None:
    """Of the runs of a configuration, in the order of the sweep: the first that has left an image."""
    return next((run for run in runs if snapshots(folder / run)), None)


def reference_file(folder: Path, manifest: dict[str, Any]) -> Path | None:
    """The reference of a run of the experiment in `folder`: beside the experiment, as results that were moved have it, too;
    else where the run's manifest says. Its name is the hash of what defines it, so that both are the same image."""
    reference = manifest.get("reference")
    name = reference.get("file") if isinstance(reference, dict) else None
    if not isinstance(name, str):
        return None
    places = (folder.resolve().parent / "references" / Path(name).name, Path(name))
    return next((place for place in places if place.is_file()), None)
