"""Where the numbers are from: device, program, config; and what each means."""

from __future__ import annotations

import json
from typing import Any

from analysis.report import number
from analysis.report.sweep import Sweep


def _different(sweep: Sweep, *keys: str) -> list[str]:
    """What the runs' manifests have under the keys, each value once."""
    found: list[str] = []
    for manifest in sweep.manifests.values():
        value: Any = manifest
        for key in keys:
            value = value.get(key) if isinstance(value, dict) else None
        if value is not None and str(value) not in found:
            found.append(str(value))
    return found


def _references(sweep: Sweep) -> list[str]:
    lines = {}
    for manifest in sweep.manifests.values():
        reference = manifest.get("reference")
        if not isinstance(reference, dict) or reference.get("hash") in lines:
            continue
        how = reference.get("definition") or {}
        settings = ", ".join(f"{key} {how[key]}" for key in ("sampler", "nee", "lights", "seed") if key in how)
        noise = ", ".join(f"{name} {number.short(str(reference[key]))}" for key, name in
                          (("reference_relmse", "relMSE"), ("reference_mse", "MSE")) if key in reference)
        scene = (manifest.get("scene") or {}).get("file", "")
        lines[reference.get("hash")] = (f"{scene}: {reference.get('samples')} frames"
                                        + (f" of {how['width']}×{how['height']}" if "width" in how else "")
                                        + (f", {settings}" if settings else "") + (f"; its own noise: {noise}" if noise else "")
                                        + f"; {reference.get('hash')}")
    return list(lines.values())


def facts(sweep: Sweep) -> list[tuple[str, list[str]]]:
    """Names and their values; what is not known is left out."""
    manifest = sweep.manifest
    device = manifest.get("device") or {}
    program = manifest.get("program") or {}
    commits = [f"{commit} (of runs)" for commit in _different(sweep, "program", "commit") if commit != program.get("commit")]
    pairs = [
        ("Device", [str(device.get("renderer", ""))]),
        ("Driver", [str(device.get("gl_version", "")), *(["software: computes on the CPU"] if device.get("software") else [])]),
        ("Program", [" ".join(str(program.get(key, "")) for key in ("name", "version"))]),
        ("Commit", [str(program.get("commit", "")), *commits]),
        ("Binary (hash)", [str(program.get("binary", ""))]),
        ("Started", [str(manifest.get("started", ""))]),
        ("Ended", [str(manifest.get("ended", ""))]),
        ("Config", [str(manifest.get("config_file", ""))]),
        ("Scenes", [f"{name}: {value}" for name, value in (manifest.get("scenes") or {}).items()]),
        ("References", _references(sweep)),
        ("Times", [str(manifest.get("timing", ""))]),
        ("Published", [str((manifest.get("config", {}).get("published") or {}).get(key, "")) for key in ("source", "note")]),
    ]
    return [(name, [value for value in values if value.strip()]) for name, values in pairs if any(v.strip() for v in values)]


def formulas(sweep: Sweep) -> list[tuple[str, str]]:
    return [(str(metric.get("name", "")), str(metric.get("formula", ""))) for metric in sweep.manifest.get("metrics") or []]


def config_text(sweep: Sweep) -> str:
    return json.dumps(sweep.manifest.get("config", {}), indent=2, ensure_ascii=False)
