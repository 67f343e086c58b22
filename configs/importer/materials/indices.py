"""Indices of refraction by name."""

from __future__ import annotations

from importer.problems import ImportProblem, Notes

# Source: Mitsuba, the table of "Smooth dielectric material" (include/mitsuba/render/ior.h): Hecht, Optics, 4th edition;
# measured at about 589 nm.
_MITSUBA = {
    "vacuum": 1.0, "helium": 1.000036, "hydrogen": 1.000132, "air": 1.000277, "carbon dioxide": 1.00045,
    "water": 1.3330, "acetone": 1.36, "ethanol": 1.361, "carbon tetrachloride": 1.461, "glycerol": 1.4729, "benzene": 1.501,
    "silicone oil": 1.52045, "bromine": 1.661, "water ice": 1.31, "fused quartz": 1.458, "pyrex": 1.470,
    "acrylic glass": 1.49, "polypropylene": 1.49, "bk7": 1.5046, "sodium chloride": 1.544, "amber": 1.55, "pet": 1.5750,
    "diamond": 2.419,
}
# pbrt-v4's glasses at the D line, 589.3 nm (util/spectrum.cpp; refractiveindex.info, CC0). Its names F5, F10 and F11 are
# Schott's SF5, SF10 and SF11.
_PBRT = {
    "glass-BK7": 1.5167, "glass-BAF10": 1.6699, "glass-FK51A": 1.4865, "glass-LASF9": 1.8500,
    "glass-F5": 1.6725, "glass-SF5": 1.6725, "glass-F10": 1.7280, "glass-SF10": 1.7280, "glass-F11": 1.7844,
    "glass-SF11": 1.7844,
}


def named_index(name: str, notes: Notes, where: str) -> float:
    """Of a name of Mitsuba or pbrt."""
    if name in _PBRT:
        notes.approximated("glass whose index depends on the wavelength with that of 589 nm", where)
        return _PBRT[name]
    if name.lower() in _MITSUBA:
        return _MITSUBA[name.lower()]
    known = _PBRT if name.startswith("glass-") else _MITSUBA
    raise ImportProblem(f"{where}: no index of refraction is named \"{name}\"; known are {', '.join(known)}, or a number")
