"""Textures that a file does not have: checkers, constants, and textures changed or joined texel by texel."""

from __future__ import annotations

from dataclasses import replace
from typing import Callable, Iterator

import numpy as np

from importer.images import srgb
from importer.scene import WHITE, Colour, Image, Rgb, Texture, Wrap

MAX_SIDE = 4096  # of images that are made here
_MAX_FLOATS = 1 << 22  # texels that are kept as floats
_BAND = 256
_LONGEST_NAME = 64  # joined of joined ones it would double at each step
_SAME = 1e-6


def constant(name: str, rgb: Rgb) -> Image:
    return Image(name, np.clip(np.array(rgb, float).reshape(1, 1, 3), 0, 1))


def checkerboard(name: str, first: Rgb, second: Rgb) -> Image:
    """2 x 2 texels for a texture with `is_nearest`: `first` where u and v are both below or both above a half, as
    Mitsuba's checkerboard has color0. pbrt's checkers are one unit each, and with its v turned over (v' = 1 - v) they
    are these at (u / 2, v' / 2), `first` being tex1."""
    pixels = np.array([[first, second], [second, first]], float)
    return Image(name, np.clip(pixels, 0, 1))


def mapped(image: Image, function: Callable[[np.ndarray], np.ndarray], name: str | None = None) -> Image:
    """The function gets and returns some lines of linear colours, (lines, width, 3), of which [0, 1] is kept; it has to
    be one of each texel for itself. Alpha stays as it is."""
    height, width, channels = image.pixels.shape
    result = Image(name or image.name, _empty(height, width, channels))
    for rows in _bands(height):
        _store(result, rows, np.asarray(function(srgb.linear_lines(image, rows)), float))
    if channels == 4:
        alpha = image.pixels[..., 3] / (255 if image.pixels.dtype == np.uint8 else 1)
        result.pixels[..., 3] = np.rint(alpha * 255) if result.pixels.dtype == np.uint8 else alpha
    return result


def _empty(height: int, width: int, channels: int) -> np.ndarray:
    """Linear colours; for images so large that they would take hundreds of MB that way, bytes in sRGB."""
    return np.empty((height, width, channels), np.float64 if height * width <= _MAX_FLOATS else np.uint8)


def _bands(height: int) -> Iterator[slice]:
    """Some lines at a time, since the steps of a formula take several times the memory of what they work on."""
    for top in range(0, height, _BAND):
        yield slice(top, min(top + _BAND, height))


def _store(image: Image, rows: slice, colours: np.ndarray) -> None:
    is_bytes = image.pixels.dtype == np.uint8
    image.pixels[rows, :, :3] = np.rint(255 * srgb.from_linear(colours)) if is_bytes else np.clip(colours, 0, 1)


def scaled(texture: Texture, rgb: Rgb) -> Texture:
    """The same image with a larger or smaller `scale`, which may be above 1 after it; see `applied`."""
    return replace(texture, scale=tuple(a * b for a, b in zip(texture.scale, rgb)))


def applied(texture: Texture) -> Texture:
    """With a scale of 1: where it was not, its texels are multiplied and clipped."""
    if texture.scale == WHITE:
        return texture
    image = mapped(texture.image, lambda colours: colours * texture.scale, f"{texture.image.name}_scaled")
    return replace(texture, image=image, scale=WHITE)


def combined(first: Colour, second: Colour, how: Callable[[np.ndarray, np.ndarray], np.ndarray], name: str = "") -> Colour:
    """`how` of two colours or textures, as a colour of two colours, else as a texture with a scale of 1.

    `how` gets (lines, width, 3) or (3,) arrays with scales in them and returns the like; of textures, [0, 1] is kept.
    Where the textures' mappings agree, their texels meet one to one, or the larger image's with the smaller one looked
    up between its own. Else one of them is repeated within the other's period where it fits there a whole number
    of times; where none does, the square of u and v from 0 to 1 is baked, and what lies outside of it repeats it.
    """
    if not isinstance(first, Texture) and not isinstance(second, Texture):
        return tuple(float(x) for x in how(np.array(first, float), np.array(second, float)))
    textures = [t for t in (first, second) if isinstance(t, Texture)]
    base = _base(textures)
    size = _size(textures, base)
    joined = "_".join(dict.fromkeys(t.image.name for t in textures))[:_LONGEST_NAME]
    image = Image(name or joined, _empty(size[1], size[0], 3))
    for rows in _bands(size[1]):
        sources = [_sampled(c, base, size, rows) if isinstance(c, Texture) else np.array(c, float) for c in (first, second)]
        _store(image, rows, np.asarray(how(*sources), float))
    return replace(base, image=image, scale=WHITE, is_nearest=all(t.is_nearest for t in textures))


def _square(matrix: np.ndarray) -> np.ndarray:
    return np.vstack([matrix, (0, 0, 1)])


def _from(base: Texture, texture: Texture) -> np.ndarray | None:
    """(3, 3): the texture's image coordinates of the base's; None where the base's cannot be undone."""
    if np.allclose(base.image_from_uv, texture.image_from_uv, rtol=0, atol=_SAME):
        return np.eye(3)
    matrix = _square(base.image_from_uv)
    if abs(np.linalg.det(matrix)) < 1e-12:
        return None
    return _square(texture.image_from_uv) @ np.linalg.inv(matrix)


def _base(textures: list[Texture]) -> Texture:
    """The texture whose period all others fit into, or one of the identity."""
    for base in textures:
        if all(other is base or _fits(base, other) for other in textures):
            return base
    return replace(textures[0], image_from_uv=np.eye(3)[:2], wrap=(Wrap.REPEAT, Wrap.REPEAT))


def _fits(base: Texture, texture: Texture) -> bool:
    """Whether the texture repeats itself wherever the base does. Of mirrored and clamped ones only equal mappings do."""
    matrix = _from(base, texture)
    if matrix is None:
        return False
    if np.allclose(matrix, np.eye(3), atol=_SAME) and base.wrap == texture.wrap:
        return True
    is_whole = np.allclose(matrix[:2, :2], np.round(matrix[:2, :2]), atol=_SAME)
    return is_whole and {*base.wrap, *texture.wrap} == {Wrap.REPEAT}


def _size(textures: list[Texture], base: Texture) -> tuple[int, int]:
    """Width and height: no texture has more texels along the base's axes, but none above `MAX_SIDE` is made."""
    sides = [1, 1]
    for texture in textures:
        height, width = texture.image.pixels.shape[:2]
        texels = np.abs(_from(base, texture)[:2, :2]) * np.array([[width], [height]])
        sides = [max(side, int(np.ceil(along - _SAME))) for side, along in zip(sides, texels.max(axis=0))]
    return min(sides[0], MAX_SIDE), min(sides[1], MAX_SIDE)


def _sampled(texture: Texture, base: Texture, size: tuple[int, int], rows: slice) -> np.ndarray:
    """(lines, width, 3) in linear colours, times the scale: at the middles of the base's texels in these lines."""
    width, height = size
    matrix = _from(base, texture)
    if np.allclose(matrix, np.eye(3), atol=_SAME) and texture.image.pixels.shape[:2] == (height, width):
        return srgb.linear_lines(texture.image, rows) * texture.scale
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(rows.start, rows.stop) + 0.5) / height)
    u, v = (matrix[k, 0] * x + matrix[k, 1] * y + matrix[k, 2] for k in range(2))
    return looked_up(texture, u, v) * texture.scale


def looked_up(texture: Texture, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The image's linear colours at its own coordinates: between texels, whose middles are at (i + 1/2) / size."""
    height, width = texture.image.pixels.shape[:2]
    across, down = texture.wrap
    if texture.is_nearest:
        return srgb.linear_at(texture.image, _wrapped(np.floor(v * height), height, down),
                              _wrapped(np.floor(u * width), width, across))
    x, y = u * width - 0.5, v * height - 0.5
    left, top = np.floor(x), np.floor(y)
    columns = [_wrapped(left + k, width, across) for k in (0, 1)]
    share = (x - left)[..., None]
    lines = []
    for row in (_wrapped(top + k, height, down) for k in (0, 1)):
        near, far = (srgb.linear_at(texture.image, row, column) for column in columns)
        lines.append(near * (1 - share) + far * share)
    share = (y - top)[..., None]
    return lines[0] * (1 - share) + lines[1] * share


def _wrapped(index: np.ndarray, size: int, wrap: Wrap) -> np.ndarray:
    index = index.astype(np.int64)
    if wrap is Wrap.CLAMP:
        return np.clip(index, 0, size - 1)
    if wrap is Wrap.MIRRORED:
        index = index % (2 * size)
        return np.minimum(index, 2 * size - 1 - index)
    return index % size
