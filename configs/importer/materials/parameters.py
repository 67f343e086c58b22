"""Arithmetic on what a material's parameters may be: a colour, a number, or a texture of either."""

from __future__ import annotations

import weakref
from dataclasses import dataclass, replace
from typing import Callable

import numpy as np

from importer.images import bake, srgb
from importer.scene import Colour, Image, Number, Rgb, Texture

Map = Callable[[np.ndarray], np.ndarray]
_STRIP = 1 << 18  # texels that are looked at together
_LARGE = 1 << 22  # texels: an image of bytes above that stays one of bytes, or it would take eight times the memory


@dataclass(frozen=True)
class Statistics:
    """Of an image's linear colours, by channel; not finite where a texel is not."""

    least: np.ndarray
    most: np.ndarray
    mean: np.ndarray
    is_grey: bool


# An image is looked at once, and what was mapped once is not stored twice: materials share images.
_known: weakref.WeakKeyDictionary[Image, Statistics] = weakref.WeakKeyDictionary()
_mapped: weakref.WeakKeyDictionary[Image, dict[object, Texture]] = weakref.WeakKeyDictionary()


def statistics(image: Image) -> Statistics:
    if image not in _known:
        _known[image] = _statistics(image)
    return _known[image]


def _statistics(image: Image) -> Statistics:
    pixels = image.pixels[:, :, :3]
    if pixels.dtype == np.uint8:
        # By counts of the 256 values, since all texels as numbers would be 24 bytes each.
        counts = np.stack([np.bincount(pixels[:, :, k].ravel(), minlength=256) for k in range(3)])
        values = srgb.to_linear(np.arange(256) / 255.0)
        extremes = [values[np.flatnonzero(row)[[0, -1]]] for row in counts]
        return Statistics(np.array([e[0] for e in extremes]), np.array([e[1] for e in extremes]),
                          counts @ values / counts[0].sum(),
                          all(np.array_equal(pixels[:, :, 0], pixels[:, :, k]) for k in (1, 2)))
    flat = pixels.reshape(-1, 3)
    strips = (flat[start:start + _STRIP] for start in range(0, len(flat), _STRIP))
    difference = max(float(np.abs(strip[:, :1] - strip[:, 1:]).max()) for strip in strips)
    return Statistics(flat.min(axis=0), flat.max(axis=0), flat.mean(axis=0, dtype=np.float64), difference < 1e-6)


def texels(texture: Texture) -> np.ndarray:
    """(height, width, 3) in linear colours, times the scale."""
    return srgb.linear(texture.image) * np.asarray(texture.scale)


def span(parameter: Colour | Number) -> tuple[float, float]:
    """The least and the greatest of all channels; NaN where one is no number."""
    if isinstance(parameter, Texture):
        found, scale = statistics(parameter.image), np.asarray(parameter.scale)
        ends = np.concatenate([found.least * scale, found.most * scale])
    else:
        ends = np.atleast_1d(np.array(parameter, dtype=float))
    return float(ends.min()), float(ends.max())


def _texture_of(texture: Texture, function: Map) -> Texture:
    """The function of its texels, strip by strip, as each is 24 bytes meanwhile; what is above 1 goes into the scale."""
    pixels = texture.image.pixels
    rows = max(1, _STRIP // pixels.shape[1])
    strips = [replace(texture, image=Image("", pixels[row:row + rows])) for row in range(0, pixels.shape[0], rows)]
    scale = max(1.0, *(float(function(texels(strip)).max()) for strip in strips))
    is_kept_in_bytes = pixels.dtype == np.uint8 and pixels[..., 0].size > _LARGE
    of_floats = np.float64 if pixels.dtype == np.uint8 else pixels.dtype
    made = np.empty((*pixels.shape[:2], 3), np.uint8 if is_kept_in_bytes else of_floats)
    for i, strip in enumerate(strips):
        values = np.clip(function(texels(strip)) / scale, 0.0, 1.0)
        made[i * rows:(i + 1) * rows] = np.rint(srgb.from_linear(values) * 255.0) if is_kept_in_bytes else values
    return replace(texture, image=Image(texture.image.name, made), scale=(scale, scale, scale))


def mean_rgb(colour: Colour) -> Rgb:
    if not isinstance(colour, Texture):
        return colour
    red, green, blue = statistics(colour.image).mean * np.asarray(colour.scale)
    return float(red), float(green), float(blue)


def mean_number(number: Number) -> float:
    return float(np.mean(mean_rgb(number))) if isinstance(number, Texture) else float(number)


def greatest(colour: Colour) -> float:
    return span(colour)[1]


def is_grey(colour: Colour) -> bool:
    if isinstance(colour, Texture):
        return statistics(colour.image).is_grey and is_grey(colour.scale)
    return max(colour) - min(colour) <= 1e-6 * max(1.0, max(colour))


def is_constant(parameter: Colour | Number, value: float) -> bool:
    """Whether it is that number, or that grey."""
    if isinstance(parameter, Texture):
        return False
    return bool(np.all(np.abs(np.asarray(parameter) - value) < 1e-9))


def scaled(colour: Colour, factor: Rgb | float) -> Colour:
    """Times a factor; the texels of a texture stay as they are."""
    r, g, b = (factor, factor, factor) if isinstance(factor, (int, float)) else factor
    if isinstance(colour, Texture):
        return replace(colour, scale=(colour.scale[0] * r, colour.scale[1] * g, colour.scale[2] * b))
    return (colour[0] * r, colour[1] * g, colour[2] * b)


def scaled_number(number: Number, factor: float) -> Number:
    if isinstance(number, Texture):
        return replace(number, scale=tuple(s * factor for s in number.scale))
    return number * factor


def map_colour(colour: Colour, function: Map, key: object = None) -> Colour:
    """The function of each texel, an array (..., 3). With a `key` that says which function it is, equal calls share
    their image."""
    if not isinstance(colour, Texture):
        red, green, blue = function(np.array(colour, dtype=float))
        return float(red), float(green), float(blue)
    return _mapped_texture(colour, function, key)


def map_number(number: Number, function: Map, key: object = None) -> Number:
    """The function of the number, or of the mean of each texel's R, G and B."""
    if not isinstance(number, Texture):
        return float(function(np.array(float(number))))
    return _mapped_texture(number, lambda rgb: np.repeat(function(rgb.mean(axis=2, keepdims=True)), 3, axis=2),
                           None if key is None else ("number", key))


def _mapped_texture(texture: Texture, function: Map, key: object) -> Texture:
    known = _mapped.setdefault(texture.image, {})
    index = (key, texture.scale)
    if key is None or index not in known:
        result = _texture_of(texture, function)
        if key is None:
            return result
        known[index] = result
    found = known[index]
    return replace(texture, image=found.image, scale=found.scale)


def combine_colours(a: Colour, b: Colour, function: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Colour:
    """A function of two parameters, texel by texel (see `bake.combined`), which must not grow beyond the greatest of both
    and its value there."""
    most = np.array([max(greatest(a), 0.0)]), np.array([max(greatest(b), 0.0)])
    limit = float(max(1.0, most[0].max(), most[1].max(), function(*most).max()))
    made = bake.combined(a, b, lambda x, y: function(x, y) / limit)
    return made if limit == 1.0 else scaled(made, limit)


def combine_numbers(a: Number, b: Number, function: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Number:
    if not isinstance(a, Texture) and not isinstance(b, Texture):
        return float(function(np.array(float(a)), np.array(float(b))))

    def of_means(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return function(*(np.mean(side, axis=-1, keepdims=True) for side in (x, y)))

    result = combine_colours(colour_of_number(a), colour_of_number(b), of_means)
    assert isinstance(result, Texture)
    return result


def colour_of_number(number: Number) -> Colour:
    return number if isinstance(number, Texture) else (number, number, number)
