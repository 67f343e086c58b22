"""Materials of pbrt-v4, with their parameters and defaults (pbrt-v4: materials.cpp; fileformat-v4, Materials)."""

from __future__ import annotations

from importer.materials import models
from importer.materials import parameters as arithmetic
from importer.pbrt.materials import Reader
from importer.problems import ImportProblem
from importer.scene import WHITE, Material

REFUSED = {"hair": "fibres", "subsurface": "light within a translucent solid", "measured": "a measured reflectance"}
_OF_THE_WALK = ("nsamples", "twosided")


def _diffuse(reader: Reader) -> Material:
    return models.diffuse(reader.name, reader.colour("reflectance", 0.5), reader.notes, reader.where)


def _coated_diffuse(reader: Reader) -> Material:
    reflectance, albedo = reader.colour("reflectance", 0.5), reader.colour("albedo", 0.0)
    index, alpha = reader.index("eta"), reader.alpha(0.0)
    thickness, depth = reader.one_number("thickness", 0.01), reader.parameters.integer("maxdepth", 10)
    reader.one_number("g", 0.0)  # the direction of scattering by the albedo, which is noted where it is not 0
    reader.parameters.without_effect(*_OF_THE_WALK)
    return models.coated_diffuse(reader.name, reflectance, index, alpha, thickness, albedo, depth, reader.notes,
                                 reader.where)


def _conductor(reader: Reader) -> Material:
    alpha = reader.alpha(0.0)
    if not reader.parameters.has("reflectance"):
        eta, k = reader.metal("eta", "k")
        return models.conductor(reader.name, eta, k, WHITE, alpha, reader.notes, reader.where)
    _check_reflectance_alone(reader, "eta", "k")
    reflectance = reader.colour("reflectance", 0.5)
    return models.conductor_of_reflectance(reader.name, reflectance, alpha, reader.notes, reader.where)


def _coated_conductor(reader: Reader) -> Material:
    coat_index = reader.index("interface.eta")
    coat_alpha, alpha = reader.alpha(0.0, "interface."), reader.alpha(0.0, "conductor.")
    thickness, albedo = reader.one_number("thickness", 0.01), reader.colour("albedo", 0.0)
    reader.one_number("g", 0.0)
    if reader.parameters.has("reflectance"):
        _check_reflectance_alone(reader, "conductor.eta", "conductor.k")
        reflectance = reader.colour("reflectance", 0.5)
        if isinstance(reflectance, arithmetic.Texture):
            reader.notes.approximated("the texture of a coated conductor's reflectance as its mean", reader.where)
        eta, k = models.indices_of_reflectance(arithmetic.mean_rgb(reflectance))
    else:
        eta, k = reader.metal("conductor.eta", "conductor.k")
    reader.parameters.without_effect(*_OF_THE_WALK, "maxdepth")
    return models.coated_conductor(reader.name, coat_index, coat_alpha, thickness, albedo, eta, k, alpha, reader.notes,
                                   reader.where)


def _check_reflectance_alone(reader: Reader, *others: str) -> None:
    for other in others:
        if reader.parameters.has(other):
            raise ImportProblem(f'{reader.where}: a conductor has both "reflectance" and "{other}"; it must have one of'
                                " them")


def _dielectric(reader: Reader) -> Material:
    index = reader.index("eta")
    return models.dielectric(reader.name, index, 1.0, reader.alpha(0.0), WHITE, WHITE, reader.notes, reader.where)


def _thin_dielectric(reader: Reader) -> Material:
    return models.thin_dielectric(reader.name, reader.index("eta"), 1.0, WHITE, WHITE, reader.notes, reader.where)


def _diffuse_transmission(reader: Reader) -> Material:
    factor = reader.one_number("scale", 1.0)
    reflected, passed = (arithmetic.scaled(reader.colour(name, 0.25), factor)
                         for name in ("reflectance", "transmittance"))
    return models.diffuse_transmitter(reader.name, reflected, passed, reader.notes, reader.where)


def _mix(reader: Reader) -> Material:
    """The first of two materials where "amount" is 0, the second where it is 1."""
    names = reader.parameters.strings("materials")
    if len(names) != 2:
        raise ImportProblem(f'{reader.where}: a mixture has {len(names)} "materials"; it must name two')
    first, second = (reader.other(name, "materials") for name in names)
    return models.blended(first, second, reader.number("amount", 0.5), reader.notes, reader.where)


MAKERS = {"diffuse": _diffuse, "coateddiffuse": _coated_diffuse, "conductor": _conductor,
          "coatedconductor": _coated_conductor, "dielectric": _dielectric, "thindielectric": _thin_dielectric,
          "diffusetransmission": _diffuse_transmission, "mix": _mix}
