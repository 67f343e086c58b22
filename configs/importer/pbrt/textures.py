"""Textures (pbrt-v4: textures.cpp; pbrt-v3: textures/): images as they are, simple patterns and arithmetic baked."""

from __future__ import annotations

from dataclasses import replace
from typing import Callable

import numpy as np

from importer.images.load import load_scaled
from importer.materials import parameters as arithmetic
from importer.pbrt.parameters import Parameters
from importer.pbrt.source import Folder
from importer.pbrt.spectra import Spectra
from importer.pbrt.state import Definition, State
from importer.problems import ImportProblem, Notes
from importer.scene import Colour, Image, Number, Rgb, Texture, Wrap

# What stands for a pattern that is left out: the middle of what it varies between.
_PATTERNS = {"bilerp": 0.5, "dots": 0.5, "fbm": 0.5, "wrinkled": 0.5, "windy": 0.5, "marble": 0.5, "ptex": 0.5, "uv": 0.5,
             "directionmix": 0.5}
_WRAPS = {"repeat": Wrap.REPEAT, "clamp": Wrap.CLAMP, "black": Wrap.CLAMP, "octahedralsphere": Wrap.CLAMP}
_OF_THE_FILTER = ("filter", "maxanisotropy", "trilinear")
_DEEPEST = 64


class Textures:
    """Makes textures of one scene's definitions, each once. Colours and numbers have names of their own in pbrt."""

    def __init__(self, folder: Folder, spectra: Spectra, notes: Notes, version: int) -> None:
        self._folder = folder
        self._spectra = spectra
        self._notes = notes
        self._version = version
        self._images: dict[tuple[object, ...], tuple[Image, float]] = {}
        self._made: dict[Definition, Colour | Number] = {}
        self._being_made: list[Definition] = []

    def colour(self, parameters: Parameters, name: str, default: float | None, state: State) -> Colour | None:
        """A parameter that is a constant or the name of a texture of colours."""
        texture = parameters.texture(name)
        if texture is None:
            return self._spectra.reflectance(parameters, name, default, state.colour_space)
        made = self._named(texture, state.colour_textures, parameters, name)
        return made if not isinstance(made, float) else (made, made, made)

    def number(self, parameters: Parameters, name: str, default: float | None, state: State) -> Number | None:
        """A parameter that is a number or the name of a texture of numbers."""
        texture = parameters.texture(name)
        if texture is None:
            return parameters.number(name, default or 0.0) if parameters.has(name) else default
        made = self._named(texture, state.number_textures, parameters, name)
        assert isinstance(made, (float, Texture))
        return made

    def normal_map(self, name: str, where: str) -> Texture:
        """pbrt-v4 looks a normal map up by u and v themselves, in the frame of dp/du and dp/dv (NormalMap)."""
        image, _ = self._image(name, True, where)
        return Texture(image, np.eye(3)[:2])

    def emission(self, name: str, where: str) -> Texture:
        """The radiance of a lamp by its u and v, the nearest texel (DiffuseAreaLight::L)."""
        image, factor = self._image(name, None, where)
        return Texture(image, np.eye(3)[:2], is_nearest=True, scale=(factor, factor, factor))

    def _named(self, name: str, table: dict[str, Definition], parameters: Parameters, role: str) -> Colour | Number:
        if name not in table:
            raise ImportProblem(f'{parameters.place}: the parameter "{role}" of {parameters.what} names the texture'
                                f' "{name}"; no texture of that type has been defined')
        definition = table[name]
        if definition not in self._made:
            if definition in self._being_made or len(self._being_made) > _DEEPEST:
                raise ImportProblem(f'{definition.statement.place}: the texture "{name}" is made of itself, or of more than'
                                    f" {_DEEPEST} within each other; textures must end in images and constants")
            self._being_made.append(definition)
            self._made[definition] = self._make(definition)
            self._being_made.pop()
        return self._made[definition]

    def _make(self, definition: Definition) -> Colour | Number:
        is_number = definition.statement.strings[1] == "float"
        kind = definition.statement.strings[2]
        parameters = definition.parameters
        makers: dict[str, Callable[[Parameters, bool, State], Colour | Number]] = {
            "constant": self._constant, "scale": self._scale, "mix": self._mix, "imagemap": self._imagemap,
            "checkerboard": self._checkerboard}
        if kind in _PATTERNS:
            self._notes.refuse(f'the texture "{kind}", a pattern that is not baked', str(parameters.place))
            grey = _PATTERNS[kind]
            return grey if is_number else (grey, grey, grey)
        if kind not in makers:
            raise ImportProblem(f'{parameters.place}: there is no texture "{kind}"; it must be {", ".join(makers)}')
        made = makers[kind](parameters, is_number, definition.state)
        parameters.finish(self._notes)
        return made

    def _operand(self, parameters: Parameters, name: str, default: float, is_number: bool, state: State) -> Colour:
        """As a colour, so that the arithmetic of colours does for numbers."""
        if is_number:
            number = self.number(parameters, name, default, state)
            assert number is not None
            return arithmetic.colour_of_number(number)
        colour = self.colour(parameters, name, default, state)
        assert colour is not None
        return colour

    def _constant(self, parameters: Parameters, is_number: bool, state: State) -> Colour | Number:
        return _result(self._operand(parameters, "value", 1.0, is_number, state), is_number)

    def _scale(self, parameters: Parameters, is_number: bool, state: State) -> Colour | Number:
        """v4: "tex" times the number "scale"; v3: "tex1" times "tex2", both of the texture's type."""
        if self._version == 4:
            first = self._operand(parameters, "tex", 1.0, is_number, state)
            second = self._operand(parameters, "scale", 1.0, True, state)
        else:
            first = self._operand(parameters, "tex1", 1.0, is_number, state)
            second = self._operand(parameters, "tex2", 1.0, is_number, state)
        return _result(_product(first, second), is_number)

    def _mix(self, parameters: Parameters, is_number: bool, state: State) -> Colour | Number:
        first = self._operand(parameters, "tex1", 0.0, is_number, state)
        second = self._operand(parameters, "tex2", 1.0, is_number, state)
        amount = self._operand(parameters, "amount", 0.5, True, state)
        rest = arithmetic.map_colour(amount, lambda share: 1 - share)
        mixed = arithmetic.combine_colours(_product(first, rest), _product(second, amount), np.add)
        return _result(mixed, is_number)

    def _checkerboard(self, parameters: Parameters, is_number: bool, state: State) -> Colour | Number:
        """tex1 where the floors of s and t are even together. Two by two texels, v upwards as pbrt has it."""
        if parameters.integer("dimension", 2) != 2:
            self._notes.refuse("a checkerboard in three dimensions", str(parameters.place))
        colours: list[Rgb] = []
        for name, default in (("tex1", 1.0), ("tex2", 0.0)):
            operand = self._operand(parameters, name, default, is_number, state)
            if isinstance(operand, Texture):
                self._notes.approximated("a texture within a checkerboard by its mean", str(parameters.place))
            colours.append(arithmetic.mean_rgb(operand))
        parameters.without_effect("aamode")
        pixels = np.array([[colours[1], colours[0]], [colours[0], colours[1]]])
        brightest = max(1.0, float(pixels.max()))
        halved = np.diag([0.5, 0.5, 1.0]) @ self._st_from_uv(parameters)
        return Texture(Image("checkerboard", pixels / brightest), _image_from_uv(halved), is_nearest=True,
                       scale=(brightest, brightest, brightest))

    def _imagemap(self, parameters: Parameters, is_number: bool, state: State) -> Colour | Number:
        where = str(parameters.place)
        wrap = parameters.string("wrap", "repeat")
        if wrap not in _WRAPS:
            raise ImportProblem(f'{where}: there is no wrap mode "{wrap}"; it must be {", ".join(_WRAPS)}')
        if wrap in ("black", "octahedralsphere"):
            self._notes.approximated(f'textures that continue as "{wrap}" by their border\'s texels', where)
        image, brightest, exponent = self._decoded(parameters, is_number)
        factor = parameters.number("scale", 1.0)
        parameters.without_effect(*_OF_THE_FILTER)
        texture = Texture(image, _image_from_uv(self._st_from_uv(parameters)), (_WRAPS[wrap], _WRAPS[wrap]))
        if exponent != 1:
            powered = arithmetic.map_colour(texture, lambda rgb: rgb ** exponent, ("power", exponent))
            assert isinstance(powered, Texture)
            texture = powered
        scaled = replace(texture, scale=tuple(value * factor * brightest for value in texture.scale))
        if parameters.flag("invert", False):
            return arithmetic.map_colour(scaled, lambda rgb: np.maximum(1 - rgb, 0), ("inverted", factor))
        return scaled

    def _decoded(self, parameters: Parameters, is_number: bool) -> tuple[Image, float, float]:
        """The image, its factor, and the power of its values that is still to be taken (Image::Read: what is no PNG is
        decoded by its type; v3: ImageTexture's "gamma", true for the formats of 8 bits)."""
        name = parameters.string("filename", "")
        where = str(parameters.place)
        is_png = name.lower().endswith(".png")
        encoding = parameters.string("encoding", "sRGB") if self._version == 4 else "sRGB"
        if self._version == 3 and not parameters.flag("gamma", True):
            return *self._image(name, True, where, is_number), 1.0
        exponent = 1.0
        if encoding.startswith("gamma "):
            exponent = _exponent(encoding.removeprefix("gamma "), parameters)
        elif encoding not in ("sRGB", "linear"):
            raise ImportProblem(f'{where}: there is no encoding "{encoding}"; it must be sRGB, linear or gamma with a'
                                " number")
        if not is_png or encoding == "sRGB":
            return *self._image(name, None, where, is_number), 1.0
        return *self._image(name, True, where, is_number), exponent

    def _image(self, name: str, is_linear: bool | None, where: str, is_number: bool = False) -> tuple[Image, float]:
        """An image with values up to 1, and their factor."""
        path = self._folder.find(name, where)
        key = (path, is_linear, is_number)
        if key not in self._images:
            image, factor = load_scaled(path, is_linear)
            self._images[key] = (_alpha(image) if is_number and self._version == 4 else image), factor
        return self._images[key]

    def _st_from_uv(self, parameters: Parameters) -> np.ndarray:
        """pbrt's s and t, (3, 3) on its own u and v, which go upwards (TextureMapping2D::Create)."""
        mapping = parameters.string("mapping", "uv")
        if mapping != "uv":
            if mapping not in ("spherical", "cylindrical", "planar"):
                raise ImportProblem(f'{parameters.place}: there is no mapping "{mapping}"; it must be uv, spherical,'
                                    " cylindrical or planar")
            self._notes.refuse(f'the mapping "{mapping}" of a texture; that by u and v stands for it', str(parameters.place))
            parameters.without_effect("v1", "v2")
        scale = [parameters.number(name, 1.0) for name in ("uscale", "vscale")]
        delta = [parameters.number(name, 0.0) for name in ("udelta", "vdelta")]
        return np.array([[scale[0], 0, delta[0]], [0, scale[1], delta[1]], [0, 0, 1]])


def _image_from_uv(st_from_uv: np.ndarray) -> np.ndarray:
    """From `Mesh`'s v, which goes downwards, to the image's: pbrt's row at t is that at 1 - t (ImageTexture::Evaluate)."""
    turned = np.array([[1.0, 0, 0], [0, -1, 1], [0, 0, 1]])
    return (turned @ st_from_uv @ turned)[:2]


def _alpha(image: Image) -> Image:
    """Of an image with transparency, pbrt-v4's numbers are the alphas, decoded as the colours are (MIPMap::Bilerp)."""
    if image.pixels.shape[2] < 4 or image.pixels[:, :, 3].min() >= (255 if image.pixels.dtype == np.uint8 else 1.0):
        return image
    return Image(image.name, np.repeat(image.pixels[:, :, 3:4], 3, axis=2))


def _product(first: Colour, second: Colour) -> Colour:
    if not isinstance(second, Texture):
        return arithmetic.scaled(first, second)
    if not isinstance(first, Texture):
        return arithmetic.scaled(second, first)
    return arithmetic.combine_colours(first, second, np.multiply)


def _result(colour: Colour, is_number: bool) -> Colour | Number:
    return float(np.mean(colour)) if is_number and not isinstance(colour, Texture) else colour


def _exponent(word: str, parameters: Parameters) -> float:
    try:
        exponent = float(word)
    except ValueError:
        exponent = 0.0
    if not 0.1 <= exponent <= 10:
        raise ImportProblem(f'{parameters.place}: the encoding "gamma {word}" must have a number between 0.1 and 10')
    return exponent
