"""Materials of pbrt-v3, with their parameters and defaults (pbrt-v3: materials/; fileformat-v3, Materials)."""

from __future__ import annotations

import numpy as np

from importer.materials import models
from importer.materials import parameters as arithmetic
from importer.pbrt.materials import Reader
from importer.scene import WHITE, Colour, Material, Number, Texture

REFUSED = {"hair": "fibres", "subsurface": "light within a translucent solid",
           "kdsubsurface": "light within a translucent solid", "fourier": "a measured reflectance"}
# What a shape may say in its material's place.
OVERRIDES = ("Kd", "Ks", "Kr", "Kt", "sigma", "roughness", "uroughness", "vroughness", "remaproughness", "eta", "index", "k",
             "opacity", "bumpmap", "reflect", "transmit", "color", "metallic", "amount")


_ALONG_U_AND_V = ("uroughness", "vroughness")


def _matte(reader: Reader) -> Material:
    return models.rough_diffuse(reader.name, reader.colour("Kd", 0.5), reader.number("sigma", 0.0), reader.notes,
                                reader.where)


def _plastic(reader: Reader) -> Material:
    """Its index is 1.5 (PlasticMaterial::ComputeScatteringFunctions), but the two sides have changed places there: it
    reflects as a surface does that is seen from within, all beyond 42 degrees."""
    reader.notes.approximated("pbrt-v3's plastic, whose gloss is that of its inner side, by the gloss of its outer side",
                              reader.where)
    return models.lambert_and_gloss(reader.name, reader.colour("Kd", 0.25), reader.colour("Ks", 0.25), 1.5,
                                    reader.alpha(0.1, names=("roughness",)), reader.notes, reader.where)


def _metal(reader: Reader) -> Material:
    eta, k = reader.metal("eta", "k")
    return models.conductor(reader.name, eta, k, WHITE, reader.alpha(0.01), reader.notes, reader.where)


def _glass(reader: Reader) -> Material:
    reflected, passed = reader.colour("Kr", 1.0), reader.colour("Kt", 1.0)
    alpha = reader.alpha(0.0, names=_ALONG_U_AND_V, is_smooth_at_0=True)
    return models.dielectric(reader.name, reader.index("eta", "index"), 1.0, alpha, reflected, passed, reader.notes,
                             reader.where)


def _mirror(reader: Reader) -> Material:
    return models.mirror(reader.name, reader.colour("Kr", 0.9), reader.notes, reader.where)


def _uber(reader: Reader) -> Material:
    diffuse, glossy = reader.colour("Kd", 0.25), reader.colour("Ks", 0.25)
    mirrored, passed = reader.colour("Kr", 0.0), reader.colour("Kt", 0.0)
    return models.uber(reader.name, diffuse, glossy, mirrored, passed, reader.index("eta", "index"), reader.alpha(0.1),
                       reader.colour("opacity", 1.0), reader.notes, reader.where)


def _substrate(reader: Reader) -> Material:
    return models.substrate(reader.name, reader.colour("Kd", 0.5), reader.colour("Ks", 0.5),
                            reader.alpha(0.1, names=_ALONG_U_AND_V), reader.notes, reader.where)


def _translucent(reader: Reader) -> Material:
    """Kd and Ks, each reflected by one share and passed by another."""
    reflected, passed = reader.colour("reflect", 0.5), reader.colour("transmit", 0.5)
    diffuse, glossy = reader.colour("Kd", 0.25), reader.colour("Ks", 0.25)
    alpha = reader.alpha(0.1, names=("roughness",))
    if arithmetic.greatest(passed) > 0:
        reader.notes.refuse("light that a translucent surface passes", reader.where)
    return models.lambert_and_gloss(reader.name, _product(diffuse, reflected), _product(glossy, reflected), 1.5, alpha,
                                    reader.notes, reader.where)


def _disney(reader: Reader) -> Material:
    if reader.parameters.has("scatterdistance"):
        reader.notes.refuse("light within a translucent solid (scatterdistance)", reader.where)
        reader.parameters.without_effect("scatterdistance")
    is_thin = reader.parameters.flag("thin", False)
    passed_diffusely = reader.number("difftrans", 1.0)
    return models.principled(
        reader.name, reader.colour("color", 0.5), reader.notes, reader.where, metallic=reader.number("metallic", 0.0),
        roughness=reader.number("roughness", 0.5), eta=reader.index("eta"), spec_tint=reader.number("speculartint", 0.0),
        spec_trans=reader.number("spectrans", 0.0), is_thin=is_thin, clearcoat=reader.number("clearcoat", 0.0),
        clearcoat_gloss=reader.number("clearcoatgloss", 1.0), anisotropic=reader.number("anisotropic", 0.0),
        sheen=reader.number("sheen", 0.0), sheen_tint=reader.number("sheentint", 0.5),
        flatness=reader.number("flatness", 0.0), diff_trans=passed_diffusely if is_thin else 0.0)


def _mix(reader: Reader) -> Material:
    """"amount" of the first material, the rest of the second (MixMaterial): the other way round than in pbrt-v4."""
    names = [reader.parameters.string(role, "") for role in ("namedmaterial1", "namedmaterial2")]
    first, second = (reader.other(name, f"namedmaterial{number}") for number, name in enumerate(names, 1))
    amount = reader.colour("amount", 0.5)
    if not arithmetic.is_grey(amount):
        reader.notes.approximated("a coloured amount of a mixture as the mean of its channels", reader.where)
    share: Number = amount if isinstance(amount, Texture) else float(np.mean(amount))
    return models.blended(second, first, share, reader.notes, reader.where)


def _product(first: Colour, second: Colour) -> Colour:
    return arithmetic.combine_colours(first, second, np.multiply)


MAKERS = {"matte": _matte, "plastic": _plastic, "metal": _metal, "glass": _glass, "mirror": _mirror, "uber": _uber,
          "substrate": _substrate, "translucent": _translucent, "disney": _disney, "mix": _mix}
