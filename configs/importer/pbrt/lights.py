"""Lights without a surface (pbrt-v4: lights.cpp; pbrt-v3: lights/point.cpp, spot.cpp, distant.cpp)."""

from __future__ import annotations

import math

import numpy as np

from importer.pbrt.parameters import Parameters
from importer.pbrt.spectra import COLOURS, Spectra
from importer.pbrt.transforms import check_usable, unit
from importer.problems import ImportProblem, Notes
from importer.scene import Light, LightKind, Rgb

_REFUSED = ("goniometric", "projection")


class Lights:
    """Makes lights of one scene's statements."""

    def __init__(self, spectra: Spectra, notes: Notes, version: int) -> None:
        self._spectra = spectra
        self._notes = notes
        self._version = version
        self._count = 0

    def read(self, kind: str, parameters: Parameters, to_world: np.ndarray, colour_space: str) -> Light | None:
        """None for one that has no counterpart."""
        makers = {"point": self._point, "spot": self._spot, "distant": self._distant}
        if kind in _REFUSED:
            self._notes.refuse(f'the light "{kind}", whose image has no counterpart', str(parameters.place))
            return None
        if kind not in makers:
            raise ImportProblem(f'{parameters.place}: there is no light "{kind}"; it must be point, spot, distant or'
                                " infinite")
        check_usable(to_world, parameters.place)
        light = makers[kind](parameters, to_world, colour_space)
        self._count += 1
        light.name = f"{kind} light {self._count}"
        parameters.without_effect("nsamples", "samples")
        parameters.finish(self._notes)
        return light

    def _intensity(self, name: str, parameters: Parameters, colour_space: str, steradians: float) -> Rgb:
        """In v4 "power" is what the light sends in all directions, whatever the colour's own luminance."""
        rgb = emission(self._spectra, parameters, name, colour_space, self._version)
        power = parameters.number("power", -1.0) if self._version == 4 else -1.0
        return scaled(rgb, power / steradians) if power > 0 else rgb

    def _point(self, parameters: Parameters, to_world: np.ndarray, colour_space: str) -> Light:
        intensity = self._intensity("I", parameters, colour_space, 4 * math.pi)
        at = to_world @ [*parameters.point("from", (0, 0, 0)), 1]
        return Light("", LightKind.POINT, intensity, tuple(at[:3]))

    def _spot(self, parameters: Parameters, to_world: np.ndarray, colour_space: str) -> Light:
        outer, delta = parameters.number("coneangle", 30.0), parameters.number("conedeltaangle", 5.0)
        if not 0 < outer <= 180 or delta < 0:
            raise ImportProblem(f"{parameters.place}: the spot's cone is {outer:g} degrees wide, {delta:g} of them soft;"
                                " it must be above 0 and at most 180, and the soft part 0 or more")
        inner = max(outer - delta, 0.0)
        if outer > 90:
            self._notes.approximated("a spot wider than a hemisphere as one of 90 degrees", str(parameters.place))
        cosines = math.cos(math.radians(outer)), math.cos(math.radians(inner))
        steradians = 2 * math.pi * ((1 - cosines[1]) + (cosines[1] - cosines[0]) / 2)
        intensity = self._intensity("I", parameters, colour_space, steradians)
        self._notes.approximated("the falloff of a spot towards its rim as glTF's", str(parameters.place))
        at = to_world @ [*parameters.point("from", (0, 0, 0)), 1]
        return Light("", LightKind.SPOT, intensity, tuple(at[:3]), self._direction(parameters, to_world),
                     math.radians(min(inner, 90.0)), math.radians(min(outer, 90.0)))

    def _distant(self, parameters: Parameters, to_world: np.ndarray, colour_space: str) -> Light:
        irradiance = emission(self._spectra, parameters, "L", colour_space, self._version)
        illuminance = parameters.number("illuminance", -1.0) if self._version == 4 else -1.0
        if illuminance > 0:
            irradiance = scaled(irradiance, illuminance)
        return Light("", LightKind.DIRECTIONAL, irradiance, (0.0, 0.0, 0.0), self._direction(parameters, to_world))

    def _direction(self, parameters: Parameters, to_world: np.ndarray) -> tuple[float, ...]:
        start, end = parameters.point("from", (0, 0, 0)), parameters.point("to", (0, 0, 1))
        along = unit(to_world[:3, :3] @ (end - start))
        if along is None:
            raise ImportProblem(f'{parameters.place}: the light\'s "from" and "to" are the same point; they must differ')
        return tuple(along)


def emission(spectra: Spectra, parameters: Parameters, name: str, colour_space: str, version: int) -> Rgb:
    """A light's colour times its "scale", which is a number in v4 and a colour in v3."""
    rgb = spectra.emission(parameters, name, colour_space)
    if version == 3 and parameters.has("scale", *COLOURS):
        factors = spectra.emission(parameters, "scale", colour_space)
        return rgb[0] * factors[0], rgb[1] * factors[1], rgb[2] * factors[2]
    factor = parameters.number("scale", 1.0)
    if factor < 0:
        raise ImportProblem(f'{parameters.place}: the light\'s "scale" is {factor:g}; it must be 0 or more')
    return scaled(rgb, factor)


def scaled(rgb: Rgb, factor: float) -> Rgb:
    return rgb[0] * factor, rgb[1] * factor, rgb[2] * factor
