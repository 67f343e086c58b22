"""Textures made of formulas, and PNG files of them.

Everything repeats after the image's edge, so that a surface of any size can be covered.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence

import numpy as np

from png_file import png_bytes

GOLDEN = (5**0.5 - 1) / 2


@dataclass(frozen=True)
class Image:
    name: str
    png: bytes


def png(name: str, pixels: np.ndarray, palette: np.ndarray | None = None) -> Image:
    """(height, width) grey values or indices of the palette, or (height, width, 3) RGB; all of 8 bits."""
    return Image(name, png_bytes(pixels.astype(np.uint8), palette))


def _bytes(values: np.ndarray) -> np.ndarray:
    """[0, 1] as 0 to 255; rounded before, so that every CPU finds the same."""
    return np.floor(np.clip(values.round(6), 0, 1) * 255 + 0.5).astype(np.uint8)


def srgb(linear: np.ndarray | Sequence[float]) -> np.ndarray:
    """IEC 61966-2-1."""
    value = np.clip(np.asarray(linear, float), 0, 1)
    return np.where(value <= 0.0031308, 12.92 * value, 1.055 * value ** (1 / 2.4) - 0.055)


def scatter(count: int, seed: int) -> np.ndarray:
    """Numbers in [0, 1) without any pattern that one sees, the same on every machine."""
    index = np.arange(1, count + 1) + 7919 * seed
    return index * index * GOLDEN % 1


def noise(size: int, frequencies: tuple[int, int], waves: int, seed: int, stretch: tuple[int, int] = (1, 1)) -> np.ndarray:
    """About 0 with a deviation of 1: waves of whole frequencies in a band, times `stretch` along x and y."""
    y, x = np.mgrid[0:size, 0:size] * (2 * np.pi / size)
    low, high = frequencies
    total = np.zeros((size, size))
    for turn, phase, pick in scatter(3 * waves, seed).reshape(waves, 3):
        frequency = low * (high / low) ** pick
        kx = round(frequency * np.cos(2 * np.pi * turn)) * stretch[0]
        ky = round(frequency * np.sin(2 * np.pi * turn)) * stretch[1]
        total += np.cos(kx * x + ky * y + 2 * np.pi * phase)
    return total * np.sqrt(2 / waves)


def normals(name: str, height: np.ndarray, metres: float) -> Image:
    """Of a height map in metres that is `metres` wide; y of the normals is up in the image (glTF 2.0, 3.9.3)."""
    step = 2 * metres / len(height)
    right = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) / step
    up = (np.roll(height, 1, axis=0) - np.roll(height, -1, axis=0)) / step
    normal = np.stack([-right, -up, np.ones_like(height)], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    return png(name, _bytes(normal / 2 + 0.5))


@dataclass(frozen=True)
class Tiles:
    """Square tiles, `count` of them along an image that is `metres` wide; `joint` in metres."""

    count: int
    metres: float
    joint: float
    size: int = 256

    def _across(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of each pixel: its tile's number, and its place in it, -1 to 1 along x and y."""
        at = (np.arange(self.size) + 0.5) / self.size * self.count
        index, place = np.floor(at).astype(int), 2 * (at % 1) - 1
        return index[:, None] * self.count + index, np.tile(place, (self.size, 1)), np.tile(-place[:, None], (1, self.size))

    def face(self) -> np.ndarray:
        """1 on tiles, 0 in joints, with a bevel of the joint's width between."""
        _, x, y = self._across()
        edge = (1 - np.maximum(abs(x), abs(y))) * self.metres / self.count / 2  # metres from the tile's border
        t = np.clip((edge - self.joint / 2) / self.joint, 0, 1)
        return t * t * (3 - 2 * t)

    def each(self, seed: int) -> np.ndarray:
        """A number of [0, 1) for every tile."""
        return scatter(self.count * self.count, seed)[self._across()[0]]

    def tilted(self, slope: float, seed: int) -> np.ndarray:
        """Heights of tiles that lie a little askew: at most by `slope`."""
        _, x, y = self._across()
        lean_x, lean_y = 2 * self.each(seed) - 1, 2 * self.each(seed + 1) - 1
        return slope * (lean_x * x + lean_y * y) * self.metres / self.count / 2

    def colours(self, name: str, tile: Sequence[float], joint: Sequence[float], spread: float, seed: int) -> Image:
        """Linear RGB; tiles differ in brightness by a share of `spread`."""
        shade = (1 - spread * self.each(seed))[..., None]
        return png(name, _bytes(srgb(np.where(self.face()[..., None] > 0.5, shade * tile, joint))))

    def roughness(self, name: str, tile: float, joint: float) -> Image:
        """Green: roughness; blue: metallic, which is 0."""
        rough = joint + (tile - joint) * self.face()
        return png(name, _bytes(np.stack([np.ones_like(rough), rough, np.zeros_like(rough)], axis=2)))


def speckled(name: str, tiles: Tiles, seed: int) -> Image:
    """Grey stone: grains of some size, and joints of a third of its brightness."""
    grain = noise(tiles.size, (20, 60), 60, seed) * 0.06 + noise(tiles.size, (3, 9), 20, seed + 1) * 0.05
    stone = np.where(tiles.face() > 0.5, 0.82 - 0.12 * tiles.each(seed) + grain, 0.3)
    return png(name, _bytes(srgb((stone * 48).round() / 48)))


def wood(name: str, dark: Sequence[float], light: Sequence[float], planks: int, seed: int, size: int = 256) -> Image:
    """Grain along x, in `planks` boards across y; linear RGB of late and early wood, by a palette of 48 colours."""
    at = (np.arange(size) + 0.5) / size * planks
    board = np.broadcast_to(np.floor(at).astype(int)[:, None], (size, size))
    shift = scatter(planks, seed)
    y = np.broadcast_to((np.arange(size) / size)[:, None], (size, size))
    wave = noise(size, (1, 2), 9, seed + 1, (1, 2)) + 0.25 * noise(size, (2, 4), 12, seed + 2, (1, 7))
    rings = 0.5 + 0.5 * np.sin(2 * np.pi * (5 * y + 3 * shift[board]) + 2.6 * wave)
    fibre = 0.09 * noise(size, (1, 3), 60, seed + 3, (1, 30))
    share = np.clip(0.22 + 0.45 * rings + 0.25 * shift[board] + fibre, 0, 1)
    share = np.where((at % 1 < 0.03 * planks / 4)[:, None] & (planks > 1), 0, share)
    levels = np.linspace(0, 1, 48)[:, None]
    return png(name, (share * 47).round(), _bytes(srgb(np.asarray(dark) + levels * (np.asarray(light) - dark))))
