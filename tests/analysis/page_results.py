"""Results folders for the tests of the page: `support.write_results` and all that a page reads besides."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
from support import SECONDS, SNAPSHOTS, relmse, write_csv, write_exr_channels, write_results

from analysis.statistics import estimate

FIREFLY = {"x": 5, "y": 2, "frame": 3, "radiance": 21.5, "multiple": 118.25}
COUNTS = {"paths": 1000, "rays": 4321, "cell_lookups": 50, "cell_fallbacks": 2, "table_updates": 0,
          "saturated_updates": 0, "non_finite": 0, "fireflies": 1, "clamped_samples": 0, "clamp_bias": 0}


def read_fields(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def _figures(name: str, values: list[float]) -> dict[str, Any]:
    found = estimate(values)
    if found.count == 1:
        return {name: found.mean, f"{name}_sd": "", f"{name}_low": "", f"{name}_high": ""}
    return {name: found.mean, f"{name}_sd": float(np.std(values)), f"{name}_low": found.low, f"{name}_high": found.high}


def write_configurations(folder: Path, slopes: dict[str, tuple[float, float, float]] = {}, at_floor: dict[str, int] = {}) -> None:
    """configurations.csv from the finished runs of summary.csv; slopes are -1 and no seed is at the floor unless given."""
    groups: dict[str, list[dict[str, str]]] = {}
    for row in read_fields(folder / "summary.csv"):
        groups.setdefault(row["configuration"], []).append(row)
    rows = []
    for name, runs in groups.items():
        done = [run for run in runs if run["status"] == "finished"] or runs
        axes = {key: value for key, value in done[0].items() if key.startswith("axis:") and key != "axis:seed"}
        errors = [float(run["relmse"]) for run in done]
        seconds = [float(run["elapsed_s"]) for run in done]
        slope, low, high = slopes.get(name, (-1, -1.05, -0.95))
        rows.append({"configuration": name, **axes, "scene": done[0]["scene"], "frames": done[0]["frames"], "runs": len(runs),
                     "seeds": len(done), "seeds_at_reference_floor": at_floor.get(name, 0),
                     **_figures("host_ms_median", [float(run["host_ms_median"]) for run in done]),
                     **_figures("relmse", errors), **_figures("elapsed_s", seconds),
                     **_figures("relmse_x_s", [a * b for a, b in zip(errors, seconds)]),
                     "slope_relmse": slope, "slope_relmse_low": low, "slope_relmse_high": high,
                     "mean_path_length": 2.5, "zero_path_fraction": 0.1234567891234})
    write_csv(folder / "configurations.csv", rows)


def _widen_summary(folder: Path) -> None:
    rows = []
    for row in read_fields(folder / "summary.csv"):
        method, seed = row["axis:method"], int(row["seed"])
        rows.append({**row, "host_ms_median": SECONDS[method] * 1000 + seed / 7, "noisy": 0, "warmup_detected": 0,
                     "elapsed_s": SECONDS[method] * SNAPSHOTS[-1] + 0.01 * seed, **COUNTS})
    write_csv(folder / "summary.csv", rows)


def picture(side: int, seed: int, noise: float) -> dict[str, np.ndarray]:
    """A slope from dark to bright, 2, 1 and 0.5 times as bright in R, G and B, with noise of its own in each."""
    grey = np.linspace(0.05, 4, side * side).reshape(side, side)
    factors = 1 + noise * np.random.default_rng(seed).standard_normal((3, side, side))
    return {name: share * grey * factor for name, share, factor in zip("RGB", (2, 1, 0.5), factors)}


def write_pictures(folder: Path, side: int) -> None:
    """The last snapshot of each run, its manifest with a firefly, and one reference per scene."""
    for row in read_fields(folder / "summary.csv"):
        reference = folder.parent / "references" / f"{row['scene']}.exr"
        if not reference.is_file():
            write_exr_channels(reference, picture(side, 0, 0), {"spp": "1024"})
        noise = relmse(row["axis:method"], int(row["seed"]), SNAPSHOTS[-1], row["scene"]) ** 0.5 / 4
        write_exr_channels(folder / row["run"] / f"frame_{SNAPSHOTS[-1]:06d}.exr",
                           picture(side, int(row["seed"]), noise), {"spp": str(SNAPSHOTS[-1])})
        manifest = {"run": row["run"], "config": {"width": side, "height": side, "warmup_frames": 1}, "warnings": [],
                    "reference": {"hash": row["scene"], "file": f"results/references/{row['scene']}.exr", "samples": 1024,
                                  "meets_wish": True},
                    "brightest_fireflies": [FIREFLY], "scene": {"file": f"{row['scene']}.glb", "warnings": []}}
        (folder / row["run"] / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")


def write_page_results(folder: Path, side: int = 8, **options: Any) -> Path:
    """A finished experiment with everything that its page shows."""
    write_results(folder, **options)
    _widen_summary(folder)
    write_configurations(folder)
    write_pictures(folder, side)
    return folder


def fail_run(folder: Path, run: str, status: str, reason: str, frames: int) -> None:
    """Turns a finished run of summary.csv into one that is not."""
    rows = read_fields(folder / "summary.csv")
    for row in rows:
        if row["run"] == run:
            row.update(status=status, reason=reason, frames=str(frames))
    write_csv(folder / "summary.csv", rows)
