"""The light from outside, as the config's key `environment`: one radiance, or an image in a file of its own.

Its texels go into that file unchanged. A sky whose pole is not +y, or that mirrors, is met by turning the world and by the
order of its columns (importer.output.world), so that nothing is resampled and no sun loses light."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from importer.images import exr_file
from importer.output.world import World
from importer.problems import ImportProblem, Notes
from importer.scene import Rgb, Sky

_MOST_RADIANCE = 1e8  # of the key `environment`
_MOST_TEXELS = 1 << 25  # of its image (docs/limits.md)


def _checked(rgb: Rgb, what: str) -> list[float]:
    for value in rgb:
        if not 0 <= value <= _MOST_RADIANCE:  # false of NaN
            raise ImportProblem(f"environment light: its {what} is {value:g}; a number from 0 to {_MOST_RADIANCE:g} "
                                f"would be right")
    return [float(value) for value in rgb]


def _texels(sky: Sky, world: World, notes: Notes) -> np.ndarray:
    image = np.asarray(sky.image, np.float32)
    if image.ndim != 3 or image.shape[2] != 3 or 0 in image.shape:
        raise ImportProblem(f"environment light: its image has {image.shape} numbers; (height, width, 3) would be right")
    if image.shape[0] * image.shape[1] > _MOST_TEXELS:
        raise ImportProblem(f"environment light: its image has {image.shape[1]} x {image.shape[0]} texels; "
                            f"up to {_MOST_TEXELS} in all would be right")
    if not np.isfinite(image).all():
        raise ImportProblem("environment light: a texel of its image is no finite number")
    if (image < 0).any():
        notes.approximated("texels below 0 in the sky's image as 0", "environment light")
        image = np.maximum(image, 0)
    return image[:, ::-1] if world.is_sky_flipped else image


def write_sky(sky: Sky, world: World, path: Path, name: str, notes: Notes) -> Any:
    """What the config says of it; the image goes to `path`, and will be called `name` beside the config."""
    if sky.image is None:
        return _checked(sky.radiance, "radiance")
    scale = _checked(sky.scale, "scale")
    exr_file.write_exr(path, np.ascontiguousarray(_texels(sky, world, notes)))
    said: dict[str, Any] = {"file": name}
    if scale != [1.0, 1.0, 1.0]:
        said["scale"] = scale[0] if len(set(scale)) == 1 else scale
    degrees = round(world.sky_degrees, 9) + 0.0
    if degrees != 0:
        said["rotation"] = degrees
    return said
