"""Media by name: what takes up light within glass and scatters none of it. All others have no meaning here."""

from __future__ import annotations

from importer.materials import models
from importer.pbrt.parameters import Parameters
from importer.pbrt.source import Place
from importer.pbrt.spectra import COLOURS, Spectra
from importer.pbrt.statements import Statement
from importer.problems import ImportProblem, Notes
from importer.scene import Material, Rgb

_WHAT = "a medium that scatters light, or is not within glass (MediumInterface)"


class Media:
    """Of one scene."""

    def __init__(self, spectra: Spectra, notes: Notes) -> None:
        self._spectra = spectra
        self._notes = notes
        self._named: dict[str, tuple[Parameters, str]] = {}  # and the colour space
        self._made: dict[tuple[Material, str], Material] = {}

    def define(self, name: str, parameters: Parameters, colour_space: str) -> None:
        self._named[name] = parameters, colour_space

    def inside(self, statement: Statement) -> str:
        """The name of what lies behind the fronts of the shapes that follow; one name alone is that of both sides."""
        inside, outside = (statement.strings * 2)[:2]
        if not outside:
            return inside
        self._notes.refuse(_WHAT, str(statement.place))
        return ""

    def filled(self, material: Material, name: str, place: Place) -> Material:
        """Glass that takes up light says so itself."""
        if name not in self._named:
            raise ImportProblem(f'{place}: there is no medium "{name}"; MakeNamedMedium must define it')
        if (material, name) not in self._made:
            absorption = self._absorption(name) if models.can_absorb(material) else None
            if absorption is None:
                self._notes.refuse(_WHAT, str(place))
                return material
            self._made[material, name] = models.absorbing(material, absorption, str(place))
        return self._made[material, name]

    def _absorption(self, name: str) -> Rgb | None:
        """Per unit of length; None where it scatters, shines, or is not the same everywhere (pbrt-v4: media.cpp)."""
        parameters, colour_space = self._named[name]
        absorbed, scattered = (parameters.find(part, *COLOURS) for part in ("sigma_a", "sigma_s"))
        if parameters.string("type", "") != "homogeneous" or absorbed is None or scattered is None:
            return None
        if any(self._spectra.values(scattered, colour_space)) or parameters.has("preset") or parameters.has("Le"):
            return None
        scale = parameters.number("scale", 1.0)
        parameters.without_effect("g")  # says where light is scattered to
        parameters.finish(self._notes)
        red, green, blue = (scale * share for share in self._spectra.values(absorbed, colour_space))
        return red, green, blue
