"""pbrt's textures on a square of -1 to 1 whose u and v run with x and y, each pixel by the texture's formula at its
corners."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path
from typing import Callable

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_rendering import film, quad, scene
from pbrt_scene import png
from rendering import RadianceTest, Source

_SIZE = 32
_CAMERA = 'Scale -1 1 1\nLookAt 0 0 5  0 0 0  0 1 0\nCamera "orthographic"\n'  # x to the right, y up
_SQUARE = quad(((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)), '"point2 uv" [0 0  1 0  1 1  0 1]')
_TOLERANCE = 2e-3  # of textures' 16-bit floats, and of 8 bits in their files

Rgb = tuple[float, float, float]
Formula = Callable[[float, float], Rgb | None]  # of u and v, upwards; None where texels are blended

# Four squares of 16 texels; row 0 is the top.
_SQUARES = np.array([[(200, 40, 40), (40, 200, 40)], [(40, 40, 200), (220, 220, 90)]])
_IMAGE = png(np.kron(_SQUARES, np.ones((16, 16, 1))).astype(np.uint8))
_ALPHA = np.concatenate([_SQUARES, np.array([[[255], [64]], [[0], [128]]])], axis=2)
_ALPHAS = png(np.kron(_ALPHA, np.ones((16, 16, 1))).astype(np.uint8))


def _srgb(values: np.ndarray) -> np.ndarray:
    x = np.asarray(values) / 255
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def _image(decode: Callable[[np.ndarray], np.ndarray] = _srgb, s: tuple[float, float] = (1, 0),
           t: tuple[float, float] = (1, 0), is_clamped: bool = False) -> Formula:
    def at(u: float, v: float) -> Rgb | None:
        st = np.array([s[0] * u + s[1], t[0] * v + t[1]])
        st = np.clip(st, 0.1, 0.9) if is_clamped else st
        if np.abs(np.mod(2 * st + 0.5, 1) - 0.5).min() < 0.07:
            return None
        column, row = np.floor(np.mod(st, 1) * 2).astype(int)
        return tuple(decode(_SQUARES[1 - row, column]))
    return at


def _checks(s: tuple[float, float], t: tuple[float, float], even: Rgb, odd: Rgb) -> Formula:
    """tex1 where the floors of s and t are even together (Checkerboard)."""
    def at(u: float, v: float) -> Rgb:
        is_even = (np.floor(s[0] * u + s[1]) + np.floor(t[0] * v + t[1])) % 2 == 0
        return even if is_even else odd
    return at


def _spectrum(name: str, kind: str, more: str = "") -> str:
    return f'Texture "{name}" "spectrum" "{kind}" {more}\n'


def _float(name: str, kind: str, more: str = "") -> str:
    return f'Texture "{name}" "float" "{kind}" {more}\n'


_FILE = '"string filename" "t.png"'
_RED, _BLUE = '"rgb tex1" [.8 .1 .1] ', '"rgb tex2" [.1 .2 .7] '


def _cases() -> dict[str, tuple[str, Formula]]:
    """Statements that define the texture "t", and what it is."""
    return {
        "image": (_spectrum("t", "imagemap", _FILE), _image()),
        "scaled": (_spectrum("t", "imagemap", _FILE + ' "float uscale" 2 "float vscale" .5 "float udelta" .2 '
                             '"float vdelta" .1'),
                   _image(s=(2, 0.2), t=(0.5, 0.1))),
        "backwards": (_spectrum("t", "imagemap", _FILE + ' "float uscale" -1 "float vscale" 3'),
                      _image(s=(-1, 0), t=(3, 0))),
        "clamped": (_spectrum("t", "imagemap", _FILE + ' "string wrap" "clamp" "float uscale" 3 "float udelta" -1'),
                    _image(s=(3, -1), is_clamped=True)),
        "linear": (_spectrum("t", "imagemap", _FILE + ' "string encoding" "linear"'), _image(lambda x: x / 255)),
        "gamma": (_spectrum("t", "imagemap", _FILE + ' "string encoding" "gamma 1.5"'), _image(lambda x: (x / 255) ** 1.5)),
        "dimmed": (_spectrum("t", "imagemap", _FILE + ' "float scale" .5'), _image(lambda x: 0.5 * _srgb(x))),
        "inverted": (_spectrum("t", "imagemap", _FILE + ' "bool invert" true'), _image(lambda x: 1 - _srgb(x))),
        "checks": (_spectrum("t", "checkerboard", _RED + _BLUE + '"float uscale" 4 "float vscale" 2 "float udelta" .5'),
                   _checks((4, 0.5), (2, 0), (.8, .1, .1), (.1, .2, .7))),
        "plain-checks": (_spectrum("t", "checkerboard", '"float vscale" 4 "float vdelta" 1'),
                         _checks((1, 0), (4, 1), (1, 1, 1), (0, 0, 0))),
        "constant": (_spectrum("t", "constant", '"rgb value" [.2 .4 .6]'), lambda u, v: (.2, .4, .6)),
        # Of v4: "tex" times the number "scale".
        "product": (_spectrum("a", "imagemap", _FILE) + _float("b", "constant", '"float value" .5')
                    + _spectrum("t", "scale", '"texture tex" "a" "texture scale" "b"'), _image(lambda x: 0.5 * _srgb(x))),
        # tex1 (1 - amount) + tex2 amount.
        "mixture": (_spectrum("a", "imagemap", _FILE)
                    + _spectrum("t", "mix", '"texture tex1" "a" "rgb tex2" [.1 .2 .3] "float amount" .25'),
                    _image(lambda x: 0.75 * _srgb(x) + 0.25 * np.array([.1, .2, .3]))),
    }


def _cases_of_version_3() -> dict[str, tuple[str, Formula]]:
    texture = 'Texture "t" "color" '
    return {
        "v3-image": (texture + f'"imagemap" {_FILE} "float uscale" 2 "float vdelta" .3', _image(s=(2, 0), t=(1, 0.3))),
        "v3-linear": (texture + f'"imagemap" {_FILE} "bool gamma" "false"', _image(lambda x: x / 255)),
        "v3-checks": (texture + f'"checkerboard" {_RED}{_BLUE}"float uscale" 4 "float vscale" 2'.replace("rgb", "color"),
                      _checks((4, 0), (2, 0), (.8, .1, .1), (.1, .2, .7))),
        # Of v3: the product of two textures of one type.
        "v3-product": ('Texture "a" "color" "imagemap" ' + _FILE + "\n" + texture
                       + '"scale" "texture tex1" "a" "color tex2" [.5 .25 1]',
                       _image(lambda x: _srgb(x) * (.5, .25, 1))),
        "v3-mixture": ('Texture "a" "color" "imagemap" ' + _FILE + "\n" + texture
                       + '"mix" "texture tex1" "a" "color tex2" [.1 .2 .3] "float amount" .25',
                       _image(lambda x: 0.75 * _srgb(x) + 0.25 * np.array([.1, .2, .3]))),
    }


def _source(texture: str, version: int) -> Source:
    kind, role = ("diffuse", "reflectance") if version == 4 else ("matte", "Kd")
    world = f'LightSource "infinite" "rgb L" [1 1 1]\n{texture}\nMaterial "{kind}" "texture {role}" "t"\n{_SQUARE}'
    return Source(scene(_CAMERA + film(_SIZE, _SIZE, version), world, 1, version), {"t.png": _IMAGE})


def _masked(alpha: str, version: int) -> Source:
    """A black square with holes over a lamp of radiance 2."""
    kind, role = ("diffuse", "reflectance") if version == 4 else ("matte", "Kd")
    behind = quad(((-2, -2, -1), (2, -2, -1), (2, 2, -1), (-2, 2, -1)))
    lamp = f'AttributeBegin\nAreaLightSource "diffuse" "rgb L" [2 2 2]\n{behind}AttributeEnd\n'
    world = f'Material "{kind}" "rgb {role}" [0 0 0]\n{lamp}{alpha.format(shape=_SQUARE.rstrip())}'
    return Source(scene(_CAMERA + film(_SIZE, _SIZE, version), world, 0, version), {"a.png": _ALPHAS, "t.png": _IMAGE})


def _expected(formula: Formula) -> np.ndarray:
    """(height, width, 3); NaN where a pixel's corners see different things."""
    picture = np.full((_SIZE, _SIZE, 3), np.nan)
    for row in range(_SIZE):
        for column in range(_SIZE):
            corners = {formula((column + x) / _SIZE, 1 - (row + y) / _SIZE) for x in (0.01, 0.99) for y in (0.01, 0.99)}
            if len(corners) == 1 and None not in corners:
                picture[row, column] = corners.pop()
    return picture


class Textures(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 4}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {**{name: _source(text, 4) for name, (text, _) in _cases().items()},
                **{name: _source(text, 3) for name, (text, _) in _cases_of_version_3().items()}}

    def test_every_pixel_has_its_texel(self) -> None:
        for name, (_, formula) in {**_cases(), **_cases_of_version_3()}.items():
            with self.subTest(name):
                expected = _expected(formula)
                is_known = np.isfinite(expected).all(axis=2)
                self.assertGreater(is_known.mean(), 0.3)
                self.assert_near(self.pictures[name].radiance[is_known], expected[is_known], _TOLERANCE, name)


class Lamps(RadianceTest):
    """pbrt-v4's area lights with an image: its radiance by u and v, as textures have it, times "scale"."""

    EXTENSION = ".pbrt"
    KEYS = {"frames": 4}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        light = 'AreaLightSource "diffuse" "string filename" "t.png" "float scale" 3\n'
        return {"v4": Source(scene(_CAMERA + film(_SIZE, _SIZE), light + _SQUARE), {"t.png": _IMAGE})}

    def test_image(self) -> None:
        expected = _expected(_image(lambda x: 3 * _srgb(x)))
        is_known = np.isfinite(expected).all(axis=2)
        self.assert_near(self.pictures["v4"].radiance[is_known], expected[is_known], 3 * _TOLERANCE)


class Masks(RadianceTest):
    """Of a black surface with the opacity a before a lamp of radiance 2: 2 (1 - a)."""

    EXTENSION = ".pbrt"
    KEYS = {"frames": 256}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        image = 'Texture "a" "float" "imagemap" "string filename" "a.png"\n{shape} "texture alpha" "a"'
        checks = ('Texture "a" "float" "checkerboard" "float tex1" 0 "float tex2" {odd} "float uscale" 2 "float vscale" 2\n'
                  '{{shape}} "texture alpha" "a"')
        return {"constant": _masked('{shape} "float alpha" .25', 4), "image": _masked(image, 4),
                "checks": _masked(checks.format(odd=0.5), 4), "v3-checks": _masked(checks.format(odd=0.5), 3)}

    def _check(self, name: str, formula: Formula) -> None:
        expected = _expected(formula)
        is_known = np.isfinite(expected).all(axis=2)
        picture = self.pictures[name]
        # A pixel that none or all of its rays pass has no variance.
        self.assert_near(picture.radiance[is_known], expected[is_known], 6 * picture.error[is_known] + 0.01, name)

    def test_constant(self) -> None:
        self._check("constant", lambda u, v: (1.5,) * 3)

    def test_alpha_of_an_image_is_what_counts_in_version_4(self) -> None:
        """Of a file with four channels, by the same decoding as the colours (MIPMap::Bilerp for Float)."""
        opacity = _srgb(_ALPHA[:, :, 3])

        def at(u: float, v: float) -> Rgb | None:
            if min(abs(np.mod(2 * x + 0.5, 1) - 0.5) for x in (u, v)) < 0.07:
                return None
            return (2 * (1 - opacity[1 - int(v * 2), int(u * 2)]),) * 3
        self._check("image", at)

    def test_checks(self) -> None:
        self._check("checks", _checks((2, 0), (2, 0), (2.0,) * 3, (1.0,) * 3))

    def test_version_3_cuts_away_what_is_0_and_nothing_else(self) -> None:
        self._check("v3-checks", _checks((2, 0), (2, 0), (2.0,) * 3, (0.0,) * 3))


if __name__ == "__main__":
    unittest.main()
