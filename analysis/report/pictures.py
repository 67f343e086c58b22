"""Images for the page: one per configuration and one reference per scene, as half floats, reduced where they would be too many.

An image is stored as a browser unpacks it without a library: planes R, G, B of half floats, all low bytes before all
high bytes, each byte as its difference from the one before, zlib, base64. Bytes that differ little pack well; OpenEXR's ZIP
does the same.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from analysis.command import AnalysisError
from analysis.exr import read_exr
from analysis.images import reference_file, shown_run, snapshots
from analysis.report import number
from analysis.report.sweep import Row, Sweep

BOUND_MB = 24             # of unpacked half floats of the whole page
BYTES_PER_PIXEL = 6
LARGEST_HALF = 65504.0
MAX_FIREFLIES = 64

Size = tuple[int, int]  # width and height


@dataclass
class Picture:
    """`source` says which run's which snapshot it is."""

    configuration: str   # empty: a reference
    name: str
    source: str
    file: Path
    reference: Path | None = None  # what its error is measured against, if that is there
    fireflies: list[dict[str, Any]] = field(default_factory=list)
    size: Size = (0, 0)       # in the page
    clipped: int = 0                # values beyond the largest half float
    packed: str = ""


@dataclass
class Gallery:
    """The pictures of one scene that have one size, references first."""

    name: str
    pictures: list[Picture]
    size: Size            # of the renders
    factor: int            # each pixel of the page is the mean of factor x factor of them


def pack(image: np.ndarray) -> tuple[str, int]:
    """height x width x 3 floats; and how many values were too large for a half float."""
    clipped = int((np.abs(image) > LARGEST_HALF)[np.isfinite(image)].sum())
    halves = np.where(np.isfinite(image), np.clip(image, -LARGEST_HALF, LARGEST_HALF), image).astype("<f2")
    split = np.moveaxis(halves, -1, 0).copy().view(np.uint8).reshape(-1, 2).T  # low bytes, then high ones
    deltas = np.diff(split.ravel(), prepend=np.uint8(0))
    return base64.b64encode(zlib.compress(deltas.tobytes(), 6)).decode(), clipped


def reduce(image: np.ndarray, factor: int) -> np.ndarray:
    """Means of blocks; those at the right and lower edge may be smaller."""
    rows = np.arange(0, image.shape[0], factor)
    columns = np.arange(0, image.shape[1], factor)
    sums = np.add.reduceat(np.add.reduceat(image.astype(np.float64), rows, axis=0), columns, axis=1)
    counts = np.outer(np.diff([*rows, image.shape[0]]), np.diff([*columns, image.shape[1]]))
    return sums / counts[..., None]


def _snapshot(sweep: Sweep, configuration: Row) -> Picture | None:
    """The last image of the seed that is shown."""
    runs = {run["run"]: run for run in sweep.members[configuration["configuration"]]}
    shown = shown_run(sweep.folder, runs)
    if shown is None:
        return None
    images = snapshots(sweep.folder / shown)
    frame = max(images)
    fireflies = (sweep.manifests.get(shown, {}).get("brightest_fireflies") or [])[:MAX_FIREFLIES]
    error = f", relMSE {number.short(runs[shown]['relmse'])}" if runs[shown]["frames"] == str(frame) else ""
    return Picture(configuration["configuration"], configuration["label"], f"{shown}, frame {frame}{error}", images[frame],
                   fireflies=fireflies)


def _size(manifest: dict[str, Any]) -> Size:
    """From the manifest, so that how far to reduce is known before anything is read."""
    config = manifest.get("config", {})
    return int(config.get("width") or 0), int(config.get("height") or 0)


def _groups(sweep: Sweep) -> dict[tuple[str, Size], list[Picture]]:
    """By scene and size, in the order of the configurations."""
    groups: dict[tuple[str, Size], list[Picture]] = {}
    if not sweep.manifests:  # then one gap says so for all
        return groups
    for row in (row for row in sweep.configurations if sweep.members[row["configuration"]]):
        name, manifest = row["configuration"], sweep.run_manifest(row["configuration"])
        picture = _snapshot(sweep, row)
        if picture is None or _size(manifest) == (0, 0):
            what = "image frame_NNNNNN.exr" if picture is None else "readable manifest that says its images' size"
            sweep.gaps.append(f"{sweep.folder}: no run of '{name}' has an image on this page, as none has a {what}")
            continue
        group = groups.setdefault((row["scene"], _size(manifest)), [])
        picture.reference = reference_file(sweep.folder, manifest)
        if picture.reference is None:
            sweep.gaps.append(f"{sweep.folder}: the reference image of '{name}' is not found, so it has no error map")
        elif not any(other.file == picture.reference for other in group):
            several = any(other.configuration == "" for other in group)
            group.append(Picture("", f"reference {picture.reference.stem[:8]}" if several else "reference",
                                 f"{picture.reference.name}, {(manifest.get('reference') or {}).get('samples', '?')} spp",
                                 picture.reference))
        group.append(picture)
    return groups


def reduction(pixels: int, bound_mb: float) -> int:
    """The smallest whole factor by which images of so many pixels in all come below the bound."""
    factor = 1
    while pixels * BYTES_PER_PIXEL > bound_mb * 1e6 * factor * factor:
        factor += 1
    return factor


def _fill(picture: Picture, size: Size, factor: int) -> None:
    image = read_exr(picture.file).rgb(picture.file)
    if image.shape[:2] != size[::-1]:
        raise AnalysisError(f"{picture.file}: has {image.shape[1]}x{image.shape[0]} pixels where its run has {size[0]}x{size[1]}")
    reduced = reduce(image, factor) if factor > 1 else image
    picture.size = (reduced.shape[1], reduced.shape[0])
    picture.packed, picture.clipped = pack(reduced)


def galleries(sweep: Sweep) -> list[Gallery]:
    """Images that cannot be read are gaps."""
    groups = _groups(sweep)
    factor = reduction(sum(size[0] * size[1] * len(pictures) for (_, size), pictures in groups.items()), BOUND_MB)
    several = {scene for scene, _ in groups if sum(scene == other for other, _ in groups) > 1}
    result = []
    for (scene, size), pictures in groups.items():
        readable = []
        for picture in sorted(pictures, key=lambda picture: picture.configuration != ""):
            try:
                _fill(picture, size, factor)
                readable.append(picture)
            except AnalysisError as error:
                sweep.gaps.append(str(error))
        name = f"{scene}, {size[0]}×{size[1]}" if scene in several else scene
        if readable:
            result.append(Gallery(name, readable, size, factor))
    return result


def gallery_data(gallery: Gallery) -> dict[str, Any]:
    """What the viewer reads besides the pixels. `reference` is an index into the pictures, or null."""
    files = [picture.file for picture in gallery.pictures]
    return {"name": gallery.name, "size": gallery.size, "factor": gallery.factor, "pictures": [
        {"configuration": p.configuration, "name": p.name, "source": p.source, "size": p.size, "fireflies": p.fireflies,
         "reference": files.index(p.reference) if p.reference in files else None} for p in gallery.pictures]}
