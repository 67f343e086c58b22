"""A sweep of RL and non-RL runs, and what must be the same however it was interrupted."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BINARY = os.environ.get("QTRACE_BINARY", str(ROOT / "build/release/qtrace"))
CHECKPOINT_S = 0.05
# Columns that hold times, or depend on them.
TIMES = re.compile(r"(_ms|_s)(_|$)|^(started|noisy|warmup_detected)$|relmse_x_s")


def config(name: str, **more: object) -> dict[str, object]:
    return {"name": name, "scene": str(ROOT / "configs/scenes/cornell_box.glb"), "width": 48, "height": 48, "frames": 48,
            "checkpoint_s": CHECKPOINT_S, "save_table": "last", "snapshots": [8, 24], "reference": {"frames": 32},
            "rl": {"sites_per_object": 20, "bins_theta": 4, "bins_phi": 4},
            "sweep": [{"method": {"NEE": {"sampler": "bsdf", "nee": "one_ray"}, "RL": {"sampler": "rl"},
                                  "lights": {"sampler": "rl", "nee": "one_ray", "lights": "learned"}}},
                      {"seed": [1, 2]}], **more}


def write_config(folder: Path, name: str, **more: object) -> None:
    (folder / f"{name}.json").write_text(json.dumps(config(name, **more)), encoding="utf-8")


def command(name: str, *more: str) -> list[str]:
    return [BINARY, "run", f"{name}.json", *more]


def run(folder: Path, name: str, *more: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(name, *more), cwd=folder, capture_output=True, text=True)


def run_whole(folder: Path) -> float:
    """The undisturbed sweep that others are compared with, in results/whole; seconds that it took."""
    write_config(folder, "whole")
    start = time.monotonic()
    done = run(folder, "whole")
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return time.monotonic() - start


def final_files(folder: Path) -> dict[str, bytes]:
    """Images and tables by their place in the folder."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*"))
            if file.suffix in (".exr", ".npy")}


def rows_without_times(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return [{k: v for k, v in row.items() if not TIMES.search(k)} for row in csv.DictReader(stream, strict=True)]


def differences(whole: Path, other: Path) -> list[str]:
    """What of two finished sweeps is not the same, times aside."""
    found = []
    before, after = final_files(whole), final_files(other)
    for name in sorted(before.keys() | after.keys()):
        if before.get(name) != after.get(name):
            found.append(name)
    for file in sorted(whole.rglob("*.csv")):
        name = file.relative_to(whole)
        if name.name in ("configurations.csv", "ratios.csv"):
            continue  # made of summary.csv
        if rows_without_times(file) != rows_without_times(other / name):
            found.append(str(name))
    return found


def unreadable(folder: Path) -> list[str]:
    """Files that a reader would stumble over: JSON and CSV are read, images and tables looked at their ends."""
    found = []
    for file in folder.rglob("*"):
        if file.name.startswith(".") or not file.is_file():
            continue
        try:
            if file.suffix == ".json":
                json.loads(file.read_text(encoding="utf-8"))
            elif file.suffix == ".csv":
                rows_without_times(file)
            elif file.suffix == ".exr":
                check_exr(file)
            elif file.suffix in (".npy", ".state") and file.stat().st_size == 0:
                raise ValueError("empty")
        except (ValueError, csv.Error) as error:
            found.append(f"{file}: {error}")
    return found


def check_exr(file: Path) -> None:
    done = subprocess.run([BINARY, "compare", str(file), str(file)] + (["--layer", "albedo"] if
                          file.name == "first_hit.exr" else []), capture_output=True, text=True)
    if done.returncode != 0:
        raise ValueError(done.stderr.strip())
