"""Arithmetic on what a material's parameters may be: a colour, a number, or a texture of either."""

from __future__ import annotations

import weakref
from dataclasses import replace
from typing import Callable

import numpy as np

from importer.scene import Colour, Image, Number, Rgb, Texture

Map = Callable[[np.ndarray], np.ndarray]

_DECODED = np.arange(256) / 255.0
_DECODED = np.where(_DECODED <= 0.04045, _DECODED / 12.92, ((_DECODED + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
# What was mapped once is not stored twice: several materials share an image with the same function of it.
_mapped: weakref.WeakKeyDictionary[Image, dict[object, Texture]] = weakref.WeakKeyDictionary()


def linear_pixels(image: Image) -> np.ndarray:
    """(height, width, 3) float64 in linear colours, without alpha."""
    pixels = image.pixels[:, :, :3]
    return _DECODED[pixels] if pixels.dtype == np.uint8 else pixels.astype(np.float64)


def texels(texture: Texture) -> np.ndarray:
    return linear_pixels(texture.image) * np.asarray(texture.scale)


def texture_of(values: np.ndarray, like: Texture, name: str) -> Texture:
    """A texture of these texels that lies as `like` does; what is above 1 goes into its scale."""
    values = np.maximum(values, 0.0)
    greatest = float(values.max(initial=0.0))
    scale = greatest if greatest > 1.0 else 1.0
    return replace(like, image=Image(name, values / scale), scale=(scale, scale, scale))


def mean_rgb(colour: Colour) -> Rgb:
    if not isinstance(colour, Texture):
        return colour
    red, green, blue = texels(colour).reshape(-1, 3).mean(axis=0)
    return float(red), float(green), float(blue)


def mean_number(number: Number) -> float:
    return float(np.mean(mean_rgb(number))) if isinstance(number, Texture) else float(number)


def greatest(colour: Colour) -> float:
    return float(texels(colour).max()) if isinstance(colour, Texture) else max(colour)


def is_grey(colour: Colour) -> bool:
    values = texels(colour) if isinstance(colour, Texture) else np.array(colour)
    return bool((np.ptp(values, axis=-1) <= 1e-6 * max(1.0, float(values.max()))).all())


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
        result = texture_of(function(texels(texture)), texture, texture.image.name)
        if key is None:
            return result
        known[index] = result
    found = known[index]
    return replace(texture, image=found.image, scale=found.scale)


def _lie_alike(a: Texture, b: Texture) -> bool:
    return bool(np.allclose(a.image_from_uv, b.image_from_uv)) and a.wrap == b.wrap


def _resampled(a: Texture, b: Texture) -> np.ndarray:
    """b's texels at the centres of a's, the nearest ones; where they lie differently, over a's first period."""
    height, width = a.image.pixels.shape[:2]
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    image_b = np.stack([u, v])
    if not _lie_alike(a, b):
        to_uv = np.linalg.inv(np.vstack([a.image_from_uv, (0.0, 0.0, 1.0)]))
        uv = np.einsum("ij,jhw->ihw", to_uv[:2], np.stack([u, v, np.ones_like(u)]))
        image_b = np.einsum("ij,jhw->ihw", b.image_from_uv, np.concatenate([uv, np.ones_like(u)[None]]))
    rows, columns = b.image.pixels.shape[:2]
    x = np.floor(image_b[0] * columns).astype(np.int64) % columns
    y = np.floor(image_b[1] * rows).astype(np.int64) % rows
    return texels(b)[y, x]


def combine_colours(a: Colour, b: Colour, function: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Colour:
    """A function of two parameters, texel by texel of the texture with more texels. Exact where both lie alike and have
    the same number of texels."""
    if not isinstance(a, Texture) and not isinstance(b, Texture):
        red, green, blue = function(np.array(a, dtype=float), np.array(b, dtype=float))
        return float(red), float(green), float(blue)
    if not isinstance(b, Texture):
        return map_colour(a, lambda rgb: function(rgb, np.array(b, dtype=float)))
    if not isinstance(a, Texture):
        return map_colour(b, lambda rgb: function(np.array(a, dtype=float), rgb))
    if a.image.pixels[:, :, 0].size >= b.image.pixels[:, :, 0].size:
        return texture_of(function(texels(a), _resampled(a, b)), a, f"{a.image.name} and {b.image.name}")
    return texture_of(function(_resampled(b, a), texels(b)), b, f"{a.image.name} and {b.image.name}")


def combine_numbers(a: Number, b: Number, function: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Number:
    if not isinstance(a, Texture) and not isinstance(b, Texture):
        return float(function(np.array(float(a)), np.array(float(b))))

    def of_means(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        x, y = (np.mean(side, axis=-1, keepdims=True) for side in (x, y))
        return np.broadcast_to(function(x, y), (*np.broadcast_shapes(x.shape, y.shape)[:-1], 3))

    left: Colour = a if isinstance(a, Texture) else (a, a, a)
    right: Colour = b if isinstance(b, Texture) else (b, b, b)
    result = combine_colours(left, right, of_means)
    assert isinstance(result, Texture)
    return result


def colour_of_number(number: Number) -> Colour:
    return number if isinstance(number, Texture) else (number, number, number)
