"""Indices of the conductors that Mitsuba and pbrt name, as numbers for red, green and blue, and the reflectance at normal
incidence that follows."""

from __future__ import annotations

import functools

import numpy as np

from importer.materials import metal_spectra
from importer.materials.colours import White, rgb_of_spectrum
from importer.problems import ImportProblem
from importer.scene import Rgb

# Mitsuba's materials (data/ior), whose spectra it integrates under equal energy in its versions 0.5 to 3 (Spectrum::
# fromContinuousSpectrum; complex_ior_from_file): eta and k. Source of the numbers: measured values of SOPRA and of Palik's
# handbook in that integral, as Tungsten lists them (bsdfs/ComplexIorData.hpp); negative parts of k are noise and are 0 here.
_MITSUBA: dict[str, tuple[Rgb, Rgb]] = {
    "a-C": ((2.94410, 2.22715, 1.96817), (0.887433, 0.799322, 0.815286)),
    "Ag": ((0.155265, 0.116723, 0.138381), (4.82834, 3.12225, 2.14695)),
    "Al": ((1.65746, 0.880369, 0.521229), (9.22387, 6.26952, 4.83700)),
    "AlAs": ((3.60510, 3.23294, 2.21756), (0.000667025, 0.0, 0.00742612)),
    "AlSb": ((0.0, 4.14275, 4.66977), (0.0, 0.0937665, 1.30074)),
    "Au": ((0.143119, 0.374957, 1.44248), (3.98316, 2.38572, 1.60322)),
    "Be": ((4.18506, 3.18506, 2.78409), (3.83544, 3.01013, 2.86901)),
    "Cr": ((4.36968, 2.91670, 1.65470), (5.20643, 4.23136, 3.75495)),
    "CsI": ((2.14490, 1.70232, 1.66242), (0.0, 0.0, 0.0)),
    "Cu": ((0.200438, 0.924033, 1.10221), (3.91295, 2.45285, 2.14219)),
    "Cu2O": ((3.54928, 2.95206, 2.73692), (0.113218, 0.194666, 0.600168)),
    "CuO": ((3.24538, 2.44963, 2.19741), (0.520274, 0.570737, 0.717225)),
    "Cu_palik": ((0.212684, 0.919988, 1.10241), (3.92156, 2.45715, 2.13665)),
    "d-C": ((2.71125, 2.31858, 2.22886), (0.0, 0.0, 0.0)),
    "Hg": ((2.39893, 1.44003, 0.909551), (6.32763, 4.37194, 3.42179)),
    "HgTe": ((4.77953, 3.23100, 2.66003), (1.63198, 1.58082, 1.72958)),
    "Ir": ((3.08641, 2.08219, 1.61789), (5.59215, 4.06718, 3.26726)),
    "K": ((0.0640493, 0.0464101, 0.0381842), (2.10422, 1.34894, 0.913211)),
    "Li": ((0.265787, 0.195610, 0.220920), (3.54017, 2.31113, 1.66859)),
    "MgO": ((2.08959, 1.65072, 1.59488), (0.0, 0.0, 0.0)),
    "Mo": ((4.48370, 3.52546, 2.77608), (4.11113, 3.42087, 3.15060)),
    "Na": ((0.0602665, 0.0561412, 0.0619909), (3.17929, 2.11248, 1.57909)),
    "Nb": ((3.42014, 2.79019, 2.39559), (3.44138, 2.73764, 2.57991)),
    "Ni": ((2.36728, 1.66336, 1.46706), (4.49883, 3.05016, 2.34543)),
    "Rh": ((2.58580, 1.86019, 1.55443), (6.78229, 4.70295, 3.97609)),
    "Se": ((4.05926, 2.84269, 2.82076), (0.754379, 0.638515, 0.521587)),
    "Se-e": ((5.72427, 4.16540, 4.08161), (0.871375, 1.10528, 1.56478)),
    "SiC": ((3.17235, 2.52597, 2.47936), (0.0, 0.0, 0.0)),
    "SnTe": ((4.52519, 1.98115, 1.28168), (0.0, 0.0, 0.0)),
    "Ta": ((2.06258, 2.39309, 2.62807), (2.40805, 1.74137, 1.94704)),
    "Te": ((7.39084, 4.48210, 2.63707), (3.25614, 3.52739, 3.29217)),
    "Te-e": ((7.50904, 4.29646, 2.36987), (5.58421, 4.94762, 3.99751)),
    "ThF4": ((1.83072, 1.44223, 1.38765), (0.0, 0.0, 0.0)),
    "TiC": ((3.70047, 2.83744, 2.58230), (3.26569, 2.35156, 2.17279)),
    "TiN": ((1.64847, 1.15045, 1.37978), (3.36846, 1.94349, 1.10201)),
    "TiO2": ((3.45662, 2.80171, 2.90515), (0.0, 0.0, 0.0)),
    "TiO2-e": ((3.10656, 2.51316, 2.58238), (0.0, 0.0, 0.0)),
    "V": ((4.27751, 3.51315, 2.76113), (3.49118, 2.88936, 3.11170)),
    "VC": ((3.65757, 2.75273, 2.53268), (3.06835, 2.19867, 1.96318)),
    "VN": ((2.86560, 2.11918, 1.94008), (3.03233, 2.05611, 1.61629)),
    "W": ((4.37070, 3.30030, 2.99827), (3.50068, 2.60487, 2.27319)),
}
# Both files of these are the same measurement (data/ior/NAME.eta.spd and NAME_palik.eta.spd); Cu_palik is another one.
_PALIK_SUFFIX = "_palik"
# Brass: Querry 1985; its RGB under equal energy over that of a flat spectrum, since no spectrum is at hand.
_BRASS: tuple[Rgb, Rgb] = ((0.43142, 0.51513, 1.14641), (3.59444, 2.68706, 1.75141))
_EXACT_MIRROR = "none"  # Mitsuba: a reflectance of 1 at all angles


def f0(eta: Rgb, k: Rgb) -> Rgb:
    """The reflectance at normal incidence: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2)."""
    n, absorption = np.asarray(eta, dtype=float), np.asarray(k, dtype=float)
    red, green, blue = ((n - 1.0) ** 2 + absorption ** 2) / ((n + 1.0) ** 2 + absorption ** 2)
    return float(red), float(green), float(blue)


def is_exact_mirror(name: str) -> bool:
    return name == _EXACT_MIRROR


def named_metal(name: str, where: str = "") -> tuple[Rgb, Rgb]:
    """eta and k of a conductor. Of a name of pbrt, such as "metal-Cu-eta", "metal-Cu-k" or "metal-Cu", those whose
    reflectance at normal incidence has the colour that the spectra have under D65, as pbrt-v4 renders by wavelengths; of a
    name of Mitsuba, such as "Cu", those by which it renders in RGB. "none" is eta 0 and k 1, a perfect mirror."""
    if name.startswith("metal-"):
        return _pbrt_metal(name, where)
    if is_exact_mirror(name):
        return (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    known = {key.lower(): key for key in _MITSUBA}
    key = known.get(name.lower()) or known.get(name.lower().removesuffix(_PALIK_SUFFIX))
    if key is None:
        place = f"{where}: " if where else ""
        raise ImportProblem(f"{place}no indices are known of the conductor \"{name}\"; known are "
                            f"{', '.join(sorted(_MITSUBA, key=str.lower))} and none, or eta and k as numbers")
    return _MITSUBA[key]


def _pbrt_metal(name: str, where: str) -> tuple[Rgb, Rgb]:
    element = name.removeprefix("metal-").removesuffix("-eta").removesuffix("-k")
    if element == "CuZn":
        return _BRASS
    if element not in metal_spectra.NAMES:
        place = f"{where}: " if where else ""
        known = ", ".join(f"metal-{n}" for n in sorted((*metal_spectra.NAMES, "CuZn")))
        raise ImportProblem(f"{place}no indices are known of the conductor \"{name}\"; known are {known}")
    return _seen_under_daylight(element)


@functools.cache
def _seen_under_daylight(element: str) -> tuple[Rgb, Rgb]:
    return indices_of_spectra(*metal_spectra.spectra(element))


def indices_of_spectra(wavelengths: np.ndarray, eta: np.ndarray, k: np.ndarray) -> tuple[Rgb, Rgb]:
    """eta's colour under D65 and the k at which F0 has exactly the colour of the reflectance by wavelength; a dielectric's
    eta follows from that reflectance with a k of 0."""
    reflectance = ((eta - 1.0) ** 2 + k ** 2) / ((eta + 1.0) ** 2 + k ** 2)
    f = np.clip(np.array(rgb_of_spectrum(wavelengths, reflectance, White.D65, is_extended=True)), 0.0, 0.9999)
    n = np.array(rgb_of_spectrum(wavelengths, eta, White.D65, is_extended=True))
    # F0 solved for k^2; below 0 where eta alone reflects more than that, and then eta gives way.
    squared = (f * (n + 1.0) ** 2 - (n - 1.0) ** 2) / (1.0 - f)
    root = np.sqrt(f)
    n = np.where(squared >= 0.0, n, (1.0 + root) / (1.0 - root))
    k_rgb = np.sqrt(np.maximum(squared, 0.0))
    return tuple(map(float, n)), tuple(map(float, k_rgb))  # type: ignore[return-value]
