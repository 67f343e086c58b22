"""Texts of XML attributes as numbers and colours. What cannot be read ends in a sentence that names the element."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from importer.problems import ImportProblem
from importer.scene import Rgb

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\Z")
_INTEGER = re.compile(r"[+-]?\d{1,18}\Z")
_HEX = re.compile(r"#[0-9a-fA-F]{6}\Z")
_MAX_SAMPLES = 100_000  # of a spectrum; measured ones have some hundred


@dataclass(frozen=True)
class Spectrum:
    """Values at wavelengths in nanometres, linear in between."""

    wavelengths: tuple[float, ...]
    values: tuple[float, ...]


@dataclass(frozen=True)
class Blackbody:
    kelvin: float
    scale: float = 1.0


Value = float | int | bool | str | Rgb | Spectrum | Blackbody | np.ndarray


def words(text: str) -> list[str]:
    """Mitsuba parts lists at commas and blanks alike (string::tokenize)."""
    return [word for word in re.split(r"[\s,]+", text) if word]


def number(text: str, where: str) -> float:
    """Not by `float` alone, which takes "nan", "inf" and "1_000" as well."""
    text = text.strip()
    if _NUMBER.match(text) and math.isfinite(value := float(text)):
        return value
    raise ImportProblem(f"{where}: \"{text[:40]}\" is not a finite number")


def numbers(text: str, where: str) -> list[float]:
    return [number(word, where) for word in words(text)]


def integer(text: str, where: str) -> int:
    text = text.strip()
    if not _INTEGER.match(text):
        raise ImportProblem(f"{where}: \"{text[:40]}\" is not an integer")
    return int(text)


def boolean(text: str, where: str) -> bool:
    word = text.strip().lower()
    if word not in ("true", "false"):
        raise ImportProblem(f"{where}: \"{text[:40]}\" is neither \"true\" nor \"false\"")
    return word == "true"


def rgb(text: str, where: str) -> Rgb:
    """One or three numbers, or #rrggbb, which the tag <rgb> takes without a curve (SceneHandler::endElement)."""
    parts = words(text)
    if len(parts) == 1 and _HEX.match(parts[0]):
        return tuple(int(parts[0][i:i + 2], 16) / 255.0 for i in (1, 3, 5))  # type: ignore[return-value]
    values = [number(part, where) for part in parts]
    if len(values) == 1:
        return values[0], values[0], values[0]
    if len(values) != 3:
        raise ImportProblem(f"{where}: \"{text[:40]}\" has {len(values)} values; a colour has one or three")
    return values[0], values[1], values[2]


def srgb(text: str, where: str) -> Rgb:
    """The same, with sRGB's curve undone (IEC 61966-2-1)."""
    return tuple(v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4
                 for v in rgb(text, where))  # type: ignore[return-value]


def spectrum(text: str, where: str) -> float | Rgb | Spectrum:
    """One number for all wavelengths, "wavelength:value" pairs, or the three values of a renderer built for RGB."""
    parts = words(text)
    if not parts or len(parts) > _MAX_SAMPLES:
        raise ImportProblem(f"{where}: a spectrum has one value or up to {_MAX_SAMPLES} pairs, not {len(parts)}")
    if ":" not in parts[0]:
        values = [number(part, where) for part in parts]
        if len(values) == 1:
            return values[0]
        if len(values) == 3:
            return values[0], values[1], values[2]
        raise ImportProblem(f"{where}: {len(values)} values without wavelengths; write \"400:0.1, 700:0.2\"")
    pairs = [part.split(":") for part in parts]
    if any(len(pair) != 2 for pair in pairs):
        raise ImportProblem(f"{where}: a spectrum's parts must read wavelength:value, as in \"400:0.1, 700:0.2\"")
    return _checked(Spectrum(tuple(number(a, where) for a, _ in pairs), tuple(number(b, where) for _, b in pairs)), where)


def spectrum_file(path: Path, where: str) -> Spectrum:
    """Lines of a wavelength and a value; # starts a comment (spectrum_from_file of Mitsuba 3, InterpolatedSpectrum)."""
    if path.stat().st_size > 10_000_000:
        raise ImportProblem(f"{where}: {path.name} is too large for a spectrum; it should have some hundred lines")
    rows = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        values = numbers(line.partition("#")[0], f"{where}: {path.name}")
        if values and len(values) != 2:
            raise ImportProblem(f"{where}: {path.name} has a line with {len(values)} values; two are right")
        if values:
            rows.append(values)
    return _checked(Spectrum(tuple(a for a, _ in rows), tuple(b for _, b in rows)), where)


def blackbody(temperature: str, scale: str, where: str) -> Blackbody:
    """A temperature such as "5000" or "5000K"."""
    kelvin = number(temperature.strip().rstrip("Kk"), where)
    if not 100.0 <= kelvin <= 1e6:
        raise ImportProblem(f"{where}: a temperature of {kelvin:g} K; between 100 and 1000000 is right")
    return Blackbody(kelvin, number(scale, where))


def vector(attributes: dict[str, str], where: str, missing: float | None = None) -> np.ndarray:
    """Three numbers from x, y and z, or from `value`; one of those left out is `missing`, where that is allowed."""
    if "value" in attributes:
        if any(axis in attributes for axis in "xyz"):
            raise ImportProblem(f"{where}: has both `value` and x, y or z; one of them is right")
        values = numbers(attributes["value"], where)
        if len(values) == 1:
            values *= 3
        if len(values) != 3:
            raise ImportProblem(f"{where}: `value` has {len(values)} numbers; one or three are right")
        return np.array(values)
    if missing is None and not all(axis in attributes for axis in "xyz"):
        raise ImportProblem(f"{where}: x, y and z are needed")
    return np.array([number(attributes[axis], where) if attributes.get(axis, "") != "" else missing for axis in "xyz"])


def _checked(spectrum: Spectrum, where: str) -> Spectrum:
    if len(spectrum.wavelengths) < 2:
        raise ImportProblem(f"{where}: a spectrum over wavelengths has two samples or more")
    if any(b <= a for a, b in zip(spectrum.wavelengths, spectrum.wavelengths[1:])) or spectrum.wavelengths[0] <= 0:
        raise ImportProblem(f"{where}: a spectrum's wavelengths must rise from sample to sample, in nanometres")
    return spectrum
