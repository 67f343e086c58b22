"""Colours in linear sRGB of spectra and of black bodies, as each of the source renderers makes them.

| renderer | reflectance | emission |
|---|---|---|
| Mitsuba 0.5, 0.6 (Spectrum::fromContinuousSpectrum, three channels) | under equal energy | under equal energy |
| Mitsuba 3 (Properties, spectrum_list_to_srgb; rgb variants) | under D65, at most 1 | under equal energy |
| pbrt-v3 (RGBSpectrum::FromSampled) | under equal energy | under equal energy |
| pbrt-v4 (SpectrumToXYZ, film's sensor cie1931) | under D65, which is its white | of luminance 1 times the scale |

Under equal energy what is equally bright at all wavelengths is (1.205, 0.948, 0.909), under D65 it is white."""

from __future__ import annotations

import math
from enum import Enum
from typing import Sequence

import numpy as np

from importer.materials import cie
from importer.problems import ImportProblem
from importer.scene import Rgb

# IEC 61966-2-1 with the digits that both renderers have.
RGB_OF_XYZ = np.array(((3.240479, -1.537150, -0.498535), (-0.969256, 1.875991, 0.041556), (0.055648, -0.204043, 1.057311)))
LUMINANCE_OF_RGB = np.array((0.212671, 0.715160, 0.072169))


class White(Enum):
    """What a spectrum is seen under."""

    EQUAL_ENERGY = 0
    D65 = 1


def rgb_of_xyz(xyz: Sequence[float]) -> Rgb:
    """Without negative parts, as both renderers clamp them."""
    red, green, blue = np.maximum(RGB_OF_XYZ @ np.asarray(xyz, dtype=float), 0.0)
    return float(red), float(green), float(blue)


def luminance(rgb: Rgb) -> float:
    return float(LUMINANCE_OF_RGB @ np.asarray(rgb, dtype=float))


def _checked(wavelengths: Sequence[float], values: Sequence[float], where: str) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.asarray(wavelengths, dtype=float), np.asarray(values, dtype=float)
    place = f"{where}: " if where else ""
    if x.ndim != 1 or x.shape != y.shape or x.size < 2:
        raise ImportProblem(f"{place}a spectrum has {x.size} wavelengths and {y.size} values; it needs two pairs at least")
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        raise ImportProblem(f"{place}a spectrum has a number that is not finite")
    if (np.diff(x) <= 0.0).any():
        raise ImportProblem(f"{place}the wavelengths of a spectrum must increase")
    return x, y


def xyz_of_spectrum(wavelengths: Sequence[float], values: Sequence[float], white: White = White.EQUAL_ENERGY,
                    is_extended: bool = False, where: str = "") -> np.ndarray:
    """Over the luminance of the white. Outside of its wavelengths (nm) a spectrum is 0 as in Mitsuba and pbrt-v4, or its
    last value where it `is_extended`, as in pbrt-v3 (AverageSpectrumSamples)."""
    x, y = _checked(wavelengths, values, where)
    grid = np.arange(cie.WAVELENGTHS[0], cie.WAVELENGTHS[-1] + 0.5, 1.0)
    spectrum = np.interp(grid, x, y) if is_extended else np.interp(grid, x, y, left=0.0, right=0.0)
    observer = np.stack([np.interp(grid, cie.WAVELENGTHS, curve) for curve in cie.OBSERVER.T])
    if white is White.D65:
        observer = observer * np.interp(grid, cie.WAVELENGTHS, cie.DAYLIGHT)
    return observer @ spectrum / observer[1].sum()


def rgb_of_spectrum(wavelengths: Sequence[float], values: Sequence[float], white: White = White.EQUAL_ENERGY,
                    is_extended: bool = False, where: str = "") -> Rgb:
    """Of an emission or an index; see the module for what each renderer sees a spectrum under."""
    return rgb_of_xyz(xyz_of_spectrum(wavelengths, values, white, is_extended, where))


def rgb_of_reflectance(wavelengths: Sequence[float], values: Sequence[float], white: White = White.D65,
                       is_extended: bool = False, where: str = "") -> Rgb:
    """The same, at most 1 in each channel."""
    red, green, blue = rgb_of_spectrum(wavelengths, values, white, is_extended, where)
    return min(red, 1.0), min(green, 1.0), min(blue, 1.0)


def rgb_of_constant_emission(value: float) -> Rgb:
    """Of an emission that is the same at all wavelengths, as Mitsuba 3 reads <spectrum value="..."/> of an emitter: not
    white, but equal energy. Mitsuba 0.6 and pbrt-v3 read such a number as grey."""
    red, green, blue = rgb_of_xyz((value, value, value))
    return red, green, blue


def blackbody_radiance(wavelengths: np.ndarray, kelvin: float) -> np.ndarray:
    """Planck's law in W / (m^2 sr m), wavelengths in nm; constants of CODATA 2018."""
    metres = np.asarray(wavelengths, dtype=float) * 1e-9
    planck, light, boltzmann = 6.62607015e-34, 299792458.0, 1.380649e-23
    return 2.0 * planck * light ** 2 / metres ** 5 / np.expm1(planck * light / (metres * boltzmann * kelvin))


def _blackbody(kelvin: float, where: str) -> Rgb:
    if not (math.isfinite(kelvin) and 100.0 <= kelvin <= 1e6):
        place = f"{where}: " if where else ""
        raise ImportProblem(f"{place}a black body has {kelvin:g} kelvin; between 100 and 1000000 would be right")
    grid = np.arange(cie.WAVELENGTHS[0], cie.WAVELENGTHS[-1] + 0.5, 1.0)
    return rgb_of_spectrum(grid, blackbody_radiance(grid, kelvin))


def rgb_of_blackbody(kelvin: float, normalised: bool, where: str = "") -> Rgb:
    """`normalised`: of luminance 1, as pbrt-v4's lights scale it (1 / SpectrumToPhotometric). Otherwise radiance in
    W / (m^2 sr nm), as Mitsuba's blackbody has it."""
    rgb = np.array(_blackbody(kelvin, where))
    red, green, blue = rgb / (luminance(tuple(rgb)) if normalised else 1e9)
    return float(red), float(green), float(blue)


def rgb_of_blackbody_by_peak(kelvin: float, where: str = "") -> Rgb:
    """Of a radiance of 1 at the wavelength where the black body is brightest, as pbrt-v3 scales it (BlackbodyNormalized);
    the wavelength by Wien's law."""
    peak = blackbody_radiance(np.array(2.897771955e6 / kelvin), kelvin)
    red, green, blue = np.array(_blackbody(kelvin, where)) / float(peak)
    return float(red), float(green), float(blue)


def named_illuminant(name: str, where: str = "") -> Rgb:
    """The colour of an illuminant that pbrt-v4 names, of luminance 1 as its lights scale it."""
    if name not in cie.CHROMATICITIES:
        place = f"{where}: " if where else ""
        known = ", ".join(sorted(cie.CHROMATICITIES))
        raise ImportProblem(f"{place}no illuminant is named \"{name}\"; known are {known}")
    x, y = cie.CHROMATICITIES[name]
    return rgb_of_xyz((x / y, 1.0, (1.0 - x - y) / y))
