"""Small scenes of other renderers through the importer and through the program, for tests of radiance.

The program and its independent check both read the .glb, so that neither sees an error of the importer. These tests compare
pictures with numbers that follow from the source renderer's documents alone."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Mapping

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "configs")]

from analysis.exr import read_exr
from importer import __main__ as command

PROGRAM = Path(os.environ.get("QTRACE_BINARY", str(ROOT / "build/release/qtrace")))
# Of the config that the importer writes, what its source says.
_OF_SOURCE = ("width", "height", "max_bounces", "russian_roulette_start", "environment")
# Samples that know nothing of each other, so that the variance in the files holds.
_KEYS: dict[str, Any] = {"sampler": "bsdf", "nee": "one_ray", "random": "independent", "reference": {"frames": 2}}


FIRST_HITS = {"max_bounces": 0, "russian_roulette_start": 0}  # for tests that look at nothing else


@dataclass(frozen=True)
class Source:
    """A scene file, what stands beside it, options of the command, and keys over those of the config that it writes."""

    text: str
    files: Mapping[str, str | bytes] = field(default_factory=dict)
    options: tuple[str, ...] = ()
    keys: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Picture:
    """Arrays of (height, width, 3). What a ray through a pixel's centre meets first is 0 where that is nothing."""

    radiance: np.ndarray
    error: np.ndarray  # standard error of the radiance
    normal: np.ndarray
    position: np.ndarray
    albedo: np.ndarray
    emission: np.ndarray
    notes: tuple[str, ...]  # what the importer approximated or left out

    @property
    def is_hit(self) -> np.ndarray:
        return np.linalg.norm(self.normal, axis=2) > 0.5


def render(sources: Mapping[str, Source], extension: str, **keys: Any) -> dict[str, Picture]:
    """All in one process of the program, by label."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        names = {label: f"c{number}" for number, label in enumerate(sources)}  # the program's folders have no spaces
        cases = {names[label]: _imported(folder / names[label], source, extension) for label, source in sources.items()}
        config = {"name": "radiance", **_KEYS, **keys, "snapshots": [keys["frames"]], "sweep": [{"case": cases}]}
        (folder / "radiance.json").write_text(json.dumps(config))
        result = subprocess.run([PROGRAM, "run", folder / "radiance.json", "--quiet", "--out", folder / "out"],
                                capture_output=True, text=True)
        if result.returncode:
            raise AssertionError(f"the program ended with {result.returncode}: {result.stderr}")
        return {label: _picture(folder, names[label]) for label in sources}


def _imported(folder: Path, source: Source, extension: str) -> dict[str, Any]:
    """What this case overrides in the config of all: the scene and what the importer's own config says of it."""
    folder.mkdir()
    for name, content in {f"source{extension}": source.text, **source.files}.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
    said, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(errors):
        code = command.main([str(folder / f"source{extension}"), str(folder / "scene.glb"), *source.options])
    if code:
        raise AssertionError(f"{folder.name} is not imported: {errors.getvalue()}")
    (folder / "said.txt").write_text(said.getvalue())
    written = json.loads(re.sub(r"^//.*\n", "", (folder / "scene.json").read_text(), flags=re.MULTILINE))
    keys = {"environment": [0, 0, 0], **{name: written[name] for name in _OF_SOURCE if name in written}}
    if isinstance(keys["environment"], dict):
        keys["environment"]["file"] = f"{folder.name}/{keys['environment']['file']}"
    return {"scene": f"{folder.name}/scene.glb", **keys, **source.keys}


def _picture(folder: Path, name: str) -> Picture:
    place = folder / "out/radiance" / f"case={name}"
    first = read_exr(place / "first_hit.exr").channels
    final = read_exr(sorted(place.glob("frame_*.exr"))[-1]).channels
    layers = {name: np.stack([first[f"{name}.{axis}"] for axis in axes], axis=2).astype(float)
              for name, axes in (("normal", "XYZ"), ("position", "XYZ"), ("albedo", "RGB"), ("emission", "RGB"))}
    variance = np.stack([final[f"variance.{channel}"] for channel in "RGB"], axis=2).astype(float)
    radiance = np.stack([final[channel] for channel in "RGB"], axis=2).astype(float)
    return Picture(radiance, np.sqrt(np.maximum(variance, 0)), **layers,
                   notes=tuple((folder / name / "said.txt").read_text().splitlines()))


def mean_of(picture: Picture, where: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Radiance of a region, and its standard error."""
    count = max(int(where.sum()), 1)
    return picture.radiance[where].mean(axis=0), np.sqrt((picture.error[where] ** 2).sum(axis=0)) / count


@unittest.skipUnless(PROGRAM.exists(), f"{PROGRAM} is not built; QTRACE_BINARY names another one")
class RadianceTest(unittest.TestCase):
    """Renders all that `sources` gives before the first test."""

    EXTENSION = ".xml"
    KEYS: dict[str, Any] = {"frames": 2}
    pictures: dict[str, Picture] = {}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        raise NotImplementedError

    @classmethod
    def setUpClass(cls) -> None:
        cls.pictures = render(cls.sources(), cls.EXTENSION, **cls.KEYS)

    def assert_near(self, actual: np.ndarray, expected: object, allowed: object, what: str = "") -> None:
        """Element by element; says where the difference is greatest over what is allowed."""
        actual, expected, allowed = np.broadcast_arrays(np.asarray(actual, float), np.asarray(expected, float),
                                                        np.asarray(allowed, float))
        excess = np.abs(actual - expected) - allowed
        self.assertTrue(np.isfinite(actual).all(), what)
        if excess.size and excess.max() > 0:
            at = np.unravel_index(excess.argmax(), excess.shape)
            self.fail(f"{what} at {tuple(map(int, at))}: {actual[at]:.5g}, expected {expected[at]:.5g} +- "
                      f"{allowed[at]:.2g}; {int((excess > 0).sum())} of {excess.size} are off")

    def assert_radiance(self, picture: Picture, expected: object, allowed: object = 1e-3, what: str = "") -> None:
        """Each pixel within six standard errors and the allowance, and the mean of all within four and that."""
        expected = np.broadcast_to(np.asarray(expected, float), picture.radiance.shape)
        allowed = np.broadcast_to(np.asarray(allowed, float), picture.radiance.shape)
        self.assert_near(picture.radiance, expected, 6 * picture.error + allowed, what)
        everywhere = np.ones(picture.radiance.shape[:2], bool)
        mean, error = mean_of(picture, everywhere)
        self.assert_near(mean, expected.mean(axis=(0, 1)), 4 * error + allowed.mean(axis=(0, 1)), f"the mean of {what}")
