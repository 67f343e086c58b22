"""<medium>: what takes up light within glass and scatters none of it. All other media have no meaning here."""

from __future__ import annotations

from importer.mitsuba.colours import Use, rgb_of_property
from importer.mitsuba.plugin import Plugin
from importer.problems import Notes
from importer.scene import Rgb

# 0.6 has the two parts and the sum of them; Mitsuba 3 the sum, and the share that is scattered (homogeneous.cpp).
_SCATTERED_AND_REST = (("sigma_s", "sigma_a"), ("albedo", "sigma_t"))


def read_absorption(medium: Plugin, notes: Notes) -> Rgb | None:
    """Per unit of length; None where it scatters, or is not the same everywhere."""
    for scattered, rest in _SCATTERED_AND_REST:
        if medium.type == "homogeneous" and medium.has(scattered) and medium.has(rest):
            if any(_rgb(medium, scattered)):
                return None
            scale = medium.number("scale", 1.0)
            red, green, blue = (scale * share for share in _rgb(medium, rest))
            medium.all_of("phase")  # says where light is scattered to
            medium.ignore("sample_emitters", "has_spectral_extinction")
            medium.note_rest(notes)
            return red, green, blue
    return None


def _rgb(medium: Plugin, name: str) -> Rgb:
    found = medium.get(name)
    assert found is not None
    return rgb_of_property(found, Use.INDEX, medium.is_old)
