"""Colours of pbrt's constant parameters: rgb, xyz, black bodies, spectra by name, by pairs and from .spd files.

pbrt-v4 scales a light's spectrum so that its luminance is 1 and multiplies by "scale"; an rgb is the pixel's value then
(lights.cpp: scale / SpectrumToPhotometric). pbrt-v3 takes spectra as they are (paramset.cpp)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from importer.materials import colours, indices, metals
from importer.pbrt.parameters import Parameter, Parameters
from importer.pbrt.source import Folder
from importer.problems import ImportProblem, Notes
from importer.scene import WHITE, Rgb

COLOURS = ("rgb", "xyz", "spectrum", "blackbody")
_MOST_SPECTRUM_BYTES = 1 << 20
# Columns: the primaries' XYZ from their chromaticities and white (pbrt-v4, colorspace.cpp; the standards of that name).
_CHROMATICITIES = {"dci-p3": ((.680, .320), (.265, .690), (.150, .060), (.3127, .3290)),
                   "rec2020": ((.708, .292), (.170, .797), (.131, .046), (.3127, .3290)),
                   "aces2065-1": ((.7347, .2653), (0., 1.), (.0001, -.077), (.32168, .33767))}
_YELLOW = 589.3  # nm, the line D, at which indices are given
_METAL_FILE = re.compile(r"(\w+)\.(?:eta|k)\.spd")


class Spectra:
    """Makes colours of one scene's parameters."""

    def __init__(self, folder: Folder, notes: Notes, version: int) -> None:
        self._folder = folder
        self._notes = notes
        self._version = version

    def emission(self, parameters: Parameters, name: str, colour_space: str) -> Rgb:
        """Of a light; white of luminance 1 where the file says nothing (lights.cpp; v3: Spectrum(1.0))."""
        parameter = parameters.find(name, *COLOURS)
        if parameter is None:
            return WHITE
        if parameter.kind in ("rgb", "color", "xyz"):
            return self._plain(parameter, colour_space)
        if parameter.kind == "blackbody":
            return self._blackbody(parameter)
        if _names(parameter) and self._version == 4 and not _is_file(parameter):
            return colours.named_illuminant(str(parameter.values[0]), str(parameter.place))
        rgb = self._spectrum(parameter, colours.White.EQUAL_ENERGY)
        luminance = colours.luminance(rgb) if self._version == 4 else 1.0
        return _scaled(rgb, 1 / luminance if luminance > 0 else 0.0)

    def reflectance(self, parameters: Parameters, name: str, default: float | None, colour_space: str) -> Rgb | None:
        """A constant share of light, or a factor of one, which may be above 1."""
        parameter = parameters.find(name, *COLOURS)
        if parameter is None:
            return None if default is None else (default, default, default)
        return self.values(parameter, colour_space)

    def values(self, parameter: Parameter, colour_space: str) -> Rgb:
        """Of reflectances, indices and absorptions: seen under pbrt-v4's white, D65, or v3's, which is equal energy."""
        if parameter.kind in ("rgb", "color", "xyz"):
            return self._plain(parameter, colour_space)
        if parameter.kind == "blackbody":
            return self._blackbody(parameter)
        return self._spectrum(parameter, colours.White.D65 if self._version == 4 else colours.White.EQUAL_ENERGY)

    def metal(self, parameters: Parameters, eta: str, k: str, colour_space: str) -> tuple[Rgb, Rgb]:
        """Index and absorption of a conductor; copper's where there is none (materials.cpp; v3: metal.cpp)."""
        both = [parameters.find(name, *COLOURS) for name in (eta, k)]
        if self._version == 4 and all(found is not None and self._is_table(found) for found in both):
            tables = [self._pairs(found) for found in both if found is not None]
            k_there = np.interp(tables[0][:, 0], tables[1][:, 0], tables[1][:, 1])
            return metals.indices_of_spectra(tables[0][:, 0], tables[0][:, 1], k_there)
        found_values = []
        for which, found in enumerate(both):
            name = ("metal-Cu" if self._version == 4 else "Cu") if found is None else self._metal_name(found)
            if name is not None:
                where = str(parameters.place if found is None else found.place)
                found_values.append(metals.named_metal(name, where)[which])
            elif found is not None:
                found_values.append(self.values(found, colour_space))
        return found_values[0], found_values[1]

    def _is_table(self, parameter: Parameter) -> bool:
        return parameter.kind == "spectrum" and self._metal_name(parameter) is None

    def index(self, parameters: Parameters, name: str, default: float) -> float:
        """A dielectric's index, of which there is one for all wavelengths here."""
        if not parameters.has(name, *COLOURS):
            return parameters.number(name, default)
        parameter = parameters.find(name, *COLOURS)
        assert parameter is not None
        if _names(parameter) and not _is_file(parameter):
            return indices.named_index(str(parameter.values[0]), self._notes, str(parameter.place))
        if parameter.kind == "spectrum":
            pairs = self._pairs(parameter)
            values, at_yellow = pairs[:, 1], float(np.interp(_YELLOW, pairs[:, 0], pairs[:, 1]))
        else:
            values = np.array(self.values(parameter, "srgb"))
            at_yellow = float(values.mean())
        if np.ptp(values) > 1e-6:
            self._notes.approximated("dispersion: one index at all wavelengths", str(parameter.place))
        return at_yellow

    def _plain(self, parameter: Parameter, colour_space: str) -> Rgb:
        values = np.asarray(parameter.values, dtype=float)
        if len(values) != 3:
            raise ImportProblem(f'{parameter.place}: the parameter "{parameter.kind} {parameter.name}" has {len(values)}'
                                " numbers; it must have 3")
        if (values < 0).any():
            raise ImportProblem(f'{parameter.place}: the parameter "{parameter.kind} {parameter.name}" has a negative'
                                " number; colours must be 0 or more")
        if parameter.kind == "xyz":
            return colours.rgb_of_xyz(values)
        if colour_space == "srgb":
            return float(values[0]), float(values[1]), float(values[2])
        return colours.rgb_of_xyz(_xyz_of_rgb(colour_space) @ values)

    def _blackbody(self, parameter: Parameter) -> Rgb:
        """v4: kelvin. v3: pairs of kelvin and a factor, which are added (ParamSet::AddBlackbodySpectrum)."""
        values = [float(value) for value in parameter.values]
        where = str(parameter.place)
        if self._version == 4:
            if len(values) != 1:
                raise ImportProblem(f'{where}: the parameter "blackbody {parameter.name}" must have one number of kelvin')
            return colours.rgb_of_blackbody(values[0], True, where)
        if len(values) != 2:
            raise ImportProblem(f'{where}: the parameter "blackbody {parameter.name}" has {len(values)} numbers; it must'
                                " have two in pbrt-v3, kelvin and a factor")
        return _scaled(colours.rgb_of_blackbody_by_peak(values[0], where), values[1])

    def _spectrum(self, parameter: Parameter, white: colours.White) -> Rgb:
        pairs = self._pairs(parameter)
        return colours.rgb_of_spectrum(pairs[:, 0], pairs[:, 1], white, self._version == 3, str(parameter.place))

    def _pairs(self, parameter: Parameter) -> np.ndarray:
        numbers = self._file(parameter) if _names(parameter) else np.asarray(parameter.values, dtype=float)
        if len(numbers) % 2 or len(numbers) < 4:
            raise ImportProblem(f'{parameter.place}: the spectrum "{parameter.name}" has {len(numbers)} numbers;'
                                " it must have pairs of a wavelength and a value, two at least")
        pairs = numbers.reshape(-1, 2)
        return pairs[np.argsort(pairs[:, 0], kind="stable")] if self._version == 3 else pairs

    def _file(self, parameter: Parameter) -> np.ndarray:
        where = str(parameter.place)
        if len(parameter.values) != 1:
            raise ImportProblem(f'{where}: the spectrum "{parameter.name}" names {len(parameter.values)} files; one is read')
        name = str(parameter.values[0])
        path: Path = self._folder.find(name, where)
        if path.stat().st_size > _MOST_SPECTRUM_BYTES:
            raise ImportProblem(f"{where}: {name} is larger than a mebibyte; a spectrum is a short table")
        text = "\n".join(line.split("#")[0] for line in self._folder.text(path, where).splitlines())
        try:
            numbers = np.array([float(word) for word in text.split()])
        except ValueError as error:
            raise ImportProblem(f"{where}: {name} holds what is no number; a spectrum is a table of wavelength and value"
                                ) from error
        return numbers

    def _metal_name(self, parameter: Parameter) -> str | None:
        """Of "metal-Au-eta" in v4; in v3 of "spds/Au.eta.spd", where the scene comes without pbrt's own files."""
        if not _names(parameter) or len(parameter.values) != 1:
            return None
        name = str(parameter.values[0])
        if not _is_file(parameter):
            return name
        from_pbrt = _METAL_FILE.fullmatch(Path(name).name)
        is_there = (self._folder.root / name).is_file() and not Path(name).is_absolute()
        return from_pbrt.group(1) if from_pbrt and not is_there else None


def _names(parameter: Parameter) -> bool:
    return isinstance(parameter.values, list)


def _is_file(parameter: Parameter) -> bool:
    return any(str(value).lower().endswith(".spd") or "/" in str(value) for value in parameter.values)


def _scaled(rgb: Rgb, factor: float) -> Rgb:
    return rgb[0] * factor, rgb[1] * factor, rgb[2] * factor


def _xyz_of_rgb(colour_space: str) -> np.ndarray:
    """The matrix whose columns are the primaries', so long that 1, 1, 1 is the white of luminance 1."""
    *primaries, white = [np.array([x / y, 1.0, (1 - x - y) / y]) if y else np.array([x, y, 1 - x - y])
                         for x, y in _CHROMATICITIES[colour_space]]
    columns = np.column_stack(primaries)
    return columns * np.linalg.solve(columns, white)
