"""Parameters that vary over a surface as images of their own: one number a texel, colours that their scale leaves in
[0, 1], and a colour with its opacity."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import Callable

import numpy as np

from importer.images import bake, srgb
from importer.problems import Notes
from importer.scene import WHITE, Image, Texture


def texel_numbers(texture: Texture) -> np.ndarray:
    """(height, width) float32: the mean of R, G and B with the texture's scale, as scene.py has it."""
    rgb = texture.image.pixels[..., :3]
    weights = np.asarray(texture.scale, float) / 3  # one channel at a time, as each is larger than the image
    total = np.zeros(rgb.shape[:2], np.float32)
    for i in range(3):
        channel = srgb.linear(Image("", rgb[..., i:i + 1]))[..., 0].astype(np.float32, copy=False)
        total += channel * np.float32(weights[i])
    return total


@dataclass
class Packer:
    """Keeps what it has made, so that materials that share a texture share the packed one."""

    notes: Notes
    _made: dict[tuple, Image] = field(default_factory=dict)
    _kept: list[Image] = field(default_factory=list)  # so that no other image gets the identity of one that is known

    def numbers(self, texture: Texture, where: str) -> Texture:
        """With a scale of 1: grey, of which one channel is kept in memory."""
        def make() -> np.ndarray:
            values = self._clipped(texel_numbers(texture), where)
            return np.broadcast_to(values[..., None], (*values.shape, 3))

        return self._with(texture, ("numbers", texture.scale), make)

    def colours(self, texture: Texture, where: str) -> Texture:
        """With no scale above 1, which a factor of a colour cannot be."""
        if max(texture.scale) <= 1:
            return texture
        scale = np.asarray(texture.scale, float)
        return self._with(texture, ("colours", texture.scale),
                          lambda: self._clipped(srgb.linear(texture.image) * scale, where))

    def colours_and_opacity(self, colours: Texture, opacity: Texture, where: str) -> Texture:
        """Both in one image with a scale of 1, mapped as `bake.combined` chooses for the two."""
        coverage = self.numbers(opacity, where)
        colours = self.colours(colours, where)
        if not (np.array_equal(colours.image_from_uv, coverage.image_from_uv) and colours.wrap == coverage.wrap):
            self.notes.approximated("a colour and an opacity that lie differently as one image, resampled", where)
        rgb, alpha = (bake.combined(colours, coverage, lambda *both: both[i]) for i in (0, 1))
        pixels = np.concatenate([rgb.image.pixels, alpha.image.pixels[..., :1]], axis=2)
        return dataclasses.replace(rgb, image=Image(rgb.image.name, pixels))

    def _with(self, texture: Texture, key: tuple, make: Callable[[], np.ndarray]) -> Texture:
        key = (id(texture.image), *key)
        if key not in self._made:
            self._kept.append(texture.image)
            self._made[key] = Image(texture.image.name, make())
        return dataclasses.replace(texture, image=self._made[key], scale=WHITE)

    def _clipped(self, values: np.ndarray, where: str) -> np.ndarray:
        if values.max() > 1 + 1e-6:
            self.notes.approximated("texels above 1 as 1", where)
        return np.clip(values, 0, 1)
