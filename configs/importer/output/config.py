"""The experiment beside the .glb: the source's picture, path length and sky, and two methods to start with."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from importer.problems import ImportProblem, Notes
from importer.scene import Scene

UNLIMITED = 64  # events of a path where the source sets no limit: what is left of its light is next to nothing
_MOST_BOUNCES, _MOST_PIXELS = 1024, 16384  # of the keys (docs/keys.md)
_FRAMES, _REFERENCE_FRAMES = 32, 256
# With fewer events roulette costs more than it saves (configs/time_to_error.json).
_ROULETTE = 8
_METHODS = {
    "path tracing with NEE": {"sampler": "bsdf", "nee": "one_ray"},
    "the same with the table": {"sampler": "rl", "nee": "one_ray"},
}


def _bounces(scene: Scene, notes: Notes) -> int:
    if scene.max_bounces is None:
        notes.approximated(f"paths without a limit as paths of at most {UNLIMITED} scattering events", "integrator")
        return UNLIMITED
    if scene.max_bounces > _MOST_BOUNCES:
        notes.approximated(f"paths of more than {_MOST_BOUNCES} scattering events as paths of so many", "integrator")
    return max(0, min(scene.max_bounces, _MOST_BOUNCES))


def config_of(scene: Scene, glb_name: str, environment: Any, notes: Notes) -> dict[str, Any]:
    camera = scene.camera
    if max(camera.width, camera.height) > _MOST_PIXELS:
        raise ImportProblem(f"camera: its picture is {camera.width} x {camera.height}; up to {_MOST_PIXELS} pixels a side "
                            f"would be right")
    bounces = _bounces(scene, notes)
    config = {
        "name": Path(glb_name).stem[:100], "scene": glb_name, "width": camera.width, "height": camera.height,
        "frames": _FRAMES, "max_bounces": bounces, "russian_roulette_start": min(bounces, _ROULETTE),
        "environment": environment, "baseline": next(iter(_METHODS)), "reference": {"frames": _REFERENCE_FRAMES},
        "sweep": [{"method": _METHODS}]}
    if environment == [0.0, 0.0, 0.0]:
        del config["environment"]  # nothing is the default
    return config


def write_config(config: dict[str, Any], path: Path, source_name: str) -> None:
    """With the lines that say where it comes from; a config may have comments."""
    name = " ".join(source_name.split())
    head = (f"// Imported from {name}: the resolution, the length of paths and the sky are the source's.\n"
            f"// Frames, reference and methods are a start: docs/experiments.md. What is approximated stands in the .glb's\n"
            f"// asset.extras and is explained in docs/importing.md.\n")
    path.write_text(head + json.dumps(config, indent=2, allow_nan=False) + "\n")
