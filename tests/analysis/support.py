"""Puts the repository on the import path, and makes result folders with known errors."""

from __future__ import annotations

import csv
import io
import json
import struct
import sys
import tempfile
import unittest
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any, Callable

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

SNAPSHOTS = [1, 2, 4, 8]
REFERENCE_NOISE = {"reference_mse": 0.002, "reference_relmse": 0.01}
# As the program's manifests have them, of schema 2.
METRICS = [{"name": name, "label": label, "unit": unit, "signed": name == "bias", "per_configuration": averaged,
            "error": is_error, "formula": f"formula of {name}", "source": "textbook"}
           for name, label, unit, averaged, is_error in (
               ("host_ms_median", "host ms/frame", "ms", True, False), ("elapsed_s", "s", "s", True, False),
               ("mse", "MSE", "squared radiance", True, True), ("relmse", "relMSE", "", True, True),
               ("relmse_trimmed", "relMSE trimmed", "", True, True), ("mape", "MAPE", "", True, True),
               ("smape", "SMAPE", "", True, True), ("flip", "FLIP", "", True, True), ("bias", "bias", "radiance", True, True),
               ("reference_mse", "reference's MSE", "squared radiance", False, False),
               ("relmse_x_s", "relMSE × s", "s", True, False), ("slope_relmse", "slope of relMSE", "", True, False))]
METHODS = {"NEE, two rays": 1.0, "BSDF": 10.0, "RL": 4.0}  # relMSE at one sample, for a seed in the middle
SECONDS = {"NEE, two rays": 0.5, "BSDF": 0.25, "RL": 1.0}  # per frame


def relmse(method: str, seed: int, frame: int, scene: str = "simple") -> float:
    """Falls as 1/spp; the seeds 1, 2, 3 lie at 0.9, 1 and 1.1 times the middle."""
    return METHODS[method] * (2 if scene == "occluded" else 1) * (0.8 + 0.1 * seed) / frame


def write_csv(file: Path, rows: list[dict[str, Any]]) -> None:
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0].keys())  # RFC 4180, as the program writes
        writer.writeheader()
        writer.writerows(rows)


def convergence_rows(scene: str, method: str, seed: int) -> list[dict[str, Any]]:
    rows = []
    for frame in SNAPSHOTS:
        error = relmse(method, seed, frame, scene)
        rows.append({"frame": frame, "spp": frame, "elapsed_s": SECONDS[method] * frame + 0.01 * seed,
                     "gpu_elapsed_s": SECONDS[method] * frame, "mse": error / 2, "relmse": error,
                     "relmse_trimmed": error * 0.9, "mape": error ** 0.5, "smape": error / 25, "flip": "",
                     "bias": -0.001, **REFERENCE_NOISE,
                     "at_reference_floor": int(error <= 3 * REFERENCE_NOISE["reference_relmse"]),
                     "non_finite_pixels": 0, "non_finite": 0})
    return rows


def frame_rows(method: str) -> list[dict[str, Any]]:
    return [{"frame": frame, "is_warmup": int(frame == 1), "host_ms": SECONDS[method] * 1e3,
             "gpu_ms": SECONDS[method] * 900, "mean_path_length": "" if frame == 1 else 2.5}
            for frame in range(1, SNAPSHOTS[-1] + 1)]


def configuration_row(scene: str, method: str, seeds: tuple[int, ...]) -> dict[str, Any]:
    from analysis.statistics import estimate
    row: dict[str, Any] = {"configuration": f"{scene} / {method}", "axis:scene": scene, "axis:method": method,
                           "scene": scene, "frames": SNAPSHOTS[-1], "runs": len(seeds), "seeds": len(seeds),
                           "seeds_at_reference_floor": 0}
    errors = [relmse(method, seed, SNAPSHOTS[-1], scene) for seed in seeds]
    seconds = [SECONDS[method] * SNAPSHOTS[-1] + 0.01 * seed for seed in seeds]
    for name, values in (("host_ms_median", [SECONDS[method] * (1000 + seed) for seed in seeds]),
                         ("elapsed_s", seconds), ("relmse", errors), ("mse", [error / 2 for error in errors]),
                         ("relmse_x_s", [a * b for a, b in zip(errors, seconds)])):
        figure = estimate(values)
        ends = (figure.low, figure.high) if len(seeds) > 1 else ("", "")
        row |= {name: figure.mean, f"{name}_sd": np.std(values, ddof=1) if len(seeds) > 1 else "",
                f"{name}_low": ends[0], f"{name}_high": ends[1]}
    return row


def write_results(folder: Path, scenes: tuple[str, ...] = ("simple", "occluded"),
                  methods: tuple[str, ...] = tuple(METHODS), seeds: tuple[int, ...] = (1, 2, 3)) -> Path:
    """A finished experiment called 'study', as `qtrace run` leaves it."""
    summary, runs = [], []
    for scene in scenes:
        for method in methods:
            for seed in seeds:
                run = f"scene={scene},method={method.lower().replace(', ', '-').replace(' ', '-')},seed={seed}"
                (folder / run).mkdir(parents=True)
                write_csv(folder / run / "convergence.csv", convergence_rows(scene, method, seed))
                write_csv(folder / run / "frames.csv", frame_rows(method))
                summary.append({"run": run, "configuration": f"{scene} / {method}", "axis:scene": scene,
                                "axis:method": method, "axis:seed": str(seed), "scene": scene, "seed": seed,
                                "status": "finished", "reason": "", "frames": SNAPSHOTS[-1],
                                "host_ms_median": SECONDS[method] * (1000 + seed),
                                "relmse": relmse(method, seed, SNAPSHOTS[-1], scene), **REFERENCE_NOISE})
                runs.append({"run": run, "status": "finished"})
    write_csv(folder / "summary.csv", summary)
    write_csv(folder / "configurations.csv", [configuration_row(scene, method, seeds) for scene in scenes for method in methods])
    manifest = {"schema": 2, "status": "finished", "experiment": "study", "device": {"renderer": "a device"},
                "metrics": METRICS, "runs": runs}
    (folder / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    return folder


def write_exr_channels(file: Path, channels: dict[str, np.ndarray], metadata: dict[str, str]) -> None:
    """An image of height x width floats per channel without compression, as OpenEXR's "File Layout" has it."""
    def attribute(name: str, kind: str, data: bytes) -> bytes:
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    planes = [np.asarray(channels[name], "<f4") for name in sorted(channels)]
    height, width = planes[0].shape
    names = b"".join(name.encode() + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in sorted(channels)) + b"\0"
    header = struct.pack("<ii", 20000630, 2) + b"".join([
        attribute("channels", "chlist", names), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", struct.pack("<4i", 0, 0, width - 1, height - 1)),
        *(attribute(key, "string", text.encode()) for key, text in metadata.items())]) + b"\0"
    lines = [struct.pack("<ii", y, 4 * width * len(planes)) + b"".join(plane[y].tobytes() for plane in planes)
             for y in range(height)]
    first = len(header) + 8 * height
    offsets = [first + y * len(lines[0]) for y in range(height)]
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(header + struct.pack(f"<{height}Q", *offsets) + b"".join(lines))


def write_exr(file: Path, value: float, spp: int, side: int = 4) -> None:
    """A square grey image."""
    write_exr_channels(file, {name: np.full((side, side), value) for name in "RGB"}, {"spp": str(spp)})


class FolderTest(unittest.TestCase):
    """A test with a temporary folder of its own."""

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.results = self.folder / "study"

    def edit(self, name: str, change: Callable[[str], str]) -> None:
        file = self.results / name
        file.write_bytes(change(file.read_bytes().decode()).encode())

    def run_script(self, main: Callable[[list[str]], None], *arguments: object) -> tuple[int, str, str]:
        """Exit code, stdout and stderr."""
        from analysis import command
        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = command.run(lambda: main([str(argument) for argument in arguments]))
        return code, out.getvalue(), err.getvalue()
