"""Whether a scene is one of pbrt-v3 or of pbrt-v4, which files do not say: by words that only one of them knows."""

from __future__ import annotations

from typing import Iterable, Iterator

from importer.pbrt.source import Place
from importer.pbrt.statements import Statement
from importer.problems import ImportProblem

_MATERIALS = {
    3: ("matte", "plastic", "metal", "glass", "mirror", "uber", "substrate", "translucent", "disney", "fourier",
        "kdsubsurface", "none"),
    4: ("diffuse", "coateddiffuse", "coatedconductor", "conductor", "dielectric", "thindielectric", "diffusetransmission",
        "interface", "measured"),
}
_KINDS = {
    "Film": {3: ("image",), 4: ("rgb", "gbuffer", "spectral")},
    "Sampler": {3: ("02sequence", "lowdiscrepancy", "random", "maxmindist"),
                4: ("independent", "paddedsobol", "zsobol", "pmj02bn")},
    "Integrator": {3: ("directlighting", "whitted"),
                   4: ("simplepath", "lightpath", "simplevolpath", "randomwalk", "function")},
    "Shape": {3: ("cone", "paraboloid", "hyperboloid", "nurbs", "heightfield"), 4: ("bilinearmesh",)},
    "Camera": {3: ("environment",), 4: ("spherical",)},
    "Material": _MATERIALS,
}
_DIRECTIVES = {"Option": 4, "Attribute": 4, "ColorSpace": 4, "ImportBegin": 4, "TransformTimes": 3}
_TYPES = {"color": 3, "xyz": 3}
_OF_LIGHTS = {"mapname": 3, "filename": 4, "illuminance": 4, "power": 4, "portal": 4}


def version_of(statements: Iterable[Statement]) -> int:
    """A file with words of both is neither, and is not guessed at. One that reads as either is v3 if it has the WorldEnd
    that only v3 needs."""
    found: dict[int, tuple[str, Place]] = {}
    otherwise = 4
    for statement in statements:
        if statement.directive == "WorldEnd":
            otherwise = 3
        for version, word in _evidence(statement):
            found.setdefault(version, (word, statement.place))
        if len(found) == 2:
            raise ImportProblem(f"{found[4][1]}: {found[4][0]} is of pbrt-v4, and {found[3][0]} of {found[3][1]} is of"
                                " pbrt-v3; a scene must be of one version")
    return next(iter(found), otherwise)


def _evidence(statement: Statement) -> Iterator[tuple[int, str]]:
    if statement.directive in _DIRECTIVES:
        yield _DIRECTIVES[statement.directive], statement.directive.removesuffix("Begin")
    for kind in _kinds(statement):
        for version, words in _KINDS.get(statement.directive.removeprefix("MakeNamed"), {}).items():
            if kind in words:
                yield version, f'{statement.directive} "{kind}"'
    if statement.directive == "Texture" and statement.strings[1] == "color":
        yield 3, 'a texture of the type "color"'
    for parameter in statement.parameters:
        if parameter.kind in _TYPES:
            yield _TYPES[parameter.kind], f'the type "{parameter.kind}"'
        if statement.directive == "LightSource" and parameter.name in _OF_LIGHTS:
            yield _OF_LIGHTS[parameter.name], f'a light\'s "{parameter.name}"'


def _kinds(statement: Statement) -> list[str]:
    if statement.directive == "MakeNamedMaterial":
        return [str(value) for parameter in statement.parameters if parameter.name == "type" for value in parameter.values]
    return statement.strings[:1]
