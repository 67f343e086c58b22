"""What a scene says of how it is rendered: path length, and settings that a renderer of another kind does not have."""

from __future__ import annotations

from importer.pbrt.parameters import Parameters
from importer.pbrt.statements import Statement
from importer.problems import ImportProblem, Notes

# Integrators whose images are of global illumination up to "maxdepth" bounces, 5 by default (integrators.cpp).
_INTEGRATORS = ("path", "volpath", "bdpt", "mlt", "sppm", "lightpath", "simplepath", "simplevolpath", "randomwalk")
_OTHERS = {"directlighting": "mirrors and direct light alone", "whitted": "mirrors and direct light alone",
           "ao": "ambient occlusion alone", "ambientocclusion": "ambient occlusion alone",
           "function": "a function, not a scene"}
_WITHOUT_EFFECT = {  # on what the picture converges to
    "Integrator": ("lightsampler", "lightsamplestrategy", "rrthreshold", "pixelbounds", "strategy", "samplelights",
                   "samplebsdf", "bootstrapsamples", "chains", "mutationsperpixel", "largestepprobability", "sigma",
                   "photonsperiteration", "iterations", "numiterations", "imagewritefrequency", "radius", "seed",
                   "visualizestrategies", "visualizeweights"),
    "Option": ("disablepixeljitter", "disabletexturefiltering", "disablewavelengthjitter", "msereferenceimage",
               "msereferenceout", "rendercoordsys", "seed", "pixelstats", "wavefront", "displacementedgescale"),
}
_BOX_RADIUS = 0.5  # of pbrt's box filter, which is that of one pixel then


def read_max_bounces(kind: str, parameters: Parameters, notes: Notes) -> int:
    """pbrt counts bounces from 0, which is what is seen directly (PathIntegrator::Li)."""
    where = str(parameters.place)
    if kind in _OTHERS:
        notes.refuse(f'the integrator "{kind}", which renders {_OTHERS[kind]}', where)
        parameters.without_effect(*(parameter.name for parameter in parameters.own if parameter.name != "maxdepth"))
    elif kind not in _INTEGRATORS:
        raise ImportProblem(f'{where}: there is no integrator "{kind}"; it must be one of {", ".join(_INTEGRATORS)}')
    depth = parameters.integer("maxdepth", 5)
    if depth < 0:
        raise ImportProblem(f'{where}: the integrator\'s "maxdepth" is {depth}; it must be 0 or more')
    if parameters.flag("regularize", False):
        notes.left_out("regularisation, which makes surfaces rougher that light has met by way of others", where)
    parameters.without_effect(*_WITHOUT_EFFECT["Integrator"])
    parameters.finish(notes)
    return depth


def note_filter(statement: Statement | None, main_file: str, version: int, notes: Notes) -> None:
    """The pixel filter, which is a box of one pixel here."""
    default = "gaussian" if version == 4 else "box"
    kind = default if statement is None else statement.strings[0]
    where = main_file if statement is None else str(statement.place)
    if kind == "box":
        sizes = [] if statement is None else [float(parameter.values[0]) for parameter in statement.parameters
                                              if parameter.name in ("xradius", "yradius", "xwidth", "ywidth")
                                              and len(parameter.values) == 1]
        if all(size == _BOX_RADIUS for size in sizes):
            return
    notes.approximated(f'the pixel filter "{kind}" as a box of one pixel', where)


def read_option(statement: Statement, notes: Notes) -> None:
    """pbrt's command line in a file (BasicSceneBuilder::Option)."""
    for parameter in statement.parameters:
        is_on = list(parameter.values) not in (["false"], [])
        if parameter.name == "forcediffuse" and is_on:
            notes.refuse("all materials as diffuse ones (Option forcediffuse)", str(parameter.place))
        elif parameter.name not in (*_WITHOUT_EFFECT["Option"], "forcediffuse"):
            notes.left_out(f'the option "{parameter.name}"', str(parameter.place))
