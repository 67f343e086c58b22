"""A scene's statements in order, with those of the files that it includes (pbrt-v4's parser.cpp, fileformat-v4)."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Iterator

import numpy as np

from importer.pbrt.parameters import Parameter, declared, read_values
from importer.pbrt.source import Folder, Place
from importer.pbrt.tokens import Kind, Tokens, number, said
from importer.problems import ImportProblem

MOST_INCLUDES = 10_000  # two files that include each other's neighbours twice would go on for ever otherwise
DEEPEST_INCLUDE = 64

# What stands behind a directive: how many strings, how many numbers, and whether parameters follow.
_FORMS = {
    **dict.fromkeys(("Identity", "WorldBegin", "WorldEnd", "AttributeBegin", "AttributeEnd", "TransformBegin",
                     "TransformEnd", "ReverseOrientation", "ObjectEnd"), (0, 0, False)),
    **dict.fromkeys(("Translate", "Scale"), (0, 3, False)),
    **dict.fromkeys(("Transform", "ConcatTransform"), (0, 16, False)),
    **dict.fromkeys(("Include", "Import", "CoordinateSystem", "CoordSysTransform", "NamedMaterial", "ObjectBegin",
                     "ObjectInstance", "ColorSpace", "MediumInterface"), (1, 0, False)),
    **dict.fromkeys(("Shape", "Material", "MakeNamedMaterial", "MakeNamedMedium", "LightSource", "AreaLightSource",
                     "Camera", "Film", "Sampler", "PixelFilter", "Integrator", "Accelerator", "Attribute"),
                    (1, 0, True)),
    "Rotate": (0, 4, False),
    "LookAt": (0, 9, False),
    "TransformTimes": (0, 2, False),
    "ActiveTransform": (0, 0, False),
    "Texture": (3, 0, True),
    "Option": (0, 0, True),
}
_OLD = ("SurfaceIntegrator", "VolumeIntegrator", "Renderer", "Volume", "SearchPath")


@dataclass(eq=False)
class Statement:
    directive: str
    place: Place
    strings: list[str] = field(default_factory=list)
    numbers: np.ndarray = field(default_factory=lambda: np.zeros(0))
    parameters: list[Parameter] = field(default_factory=list)


def read_statements(main_file: Path, folder: Folder) -> Iterator[Statement]:
    """All statements; those of an `Import` stand between statements "ImportBegin" and "ImportEnd" of our own."""
    where = main_file.name
    open_files = [(main_file.resolve(), Tokens(folder.text(main_file, where), where), False)]
    includes = 0
    while open_files:
        path, tokens, is_import = open_files[-1]
        token = tokens.next()
        if token.kind is Kind.END:
            open_files.pop()
            if is_import:
                yield Statement("ImportEnd", token.place)
            continue
        if token.kind is not Kind.WORD:
            raise ImportProblem(f"{token.place}: {said(token)} stands where a directive such as Shape is expected")
        statement = _statement(token.text, token.place, tokens)
        if statement.directive not in ("Include", "Import"):
            yield statement
            continue
        includes += 1
        inner = folder.find(statement.strings[0], str(statement.place))
        _check_include(inner, [path for path, _, _ in open_files], includes, statement)
        if statement.directive == "Import":
            yield Statement("ImportBegin", statement.place)
        text = folder.text(inner, str(statement.place))
        open_files.append((inner, Tokens(text, statement.strings[0]), statement.directive == "Import"))


def _check_include(inner: Path, open_files: list[Path], includes: int, statement: Statement) -> None:
    name = statement.strings[0]
    if inner in open_files:
        raise ImportProblem(f"{statement.place}: {name} includes itself, at once or by way of other files;"
                            " includes must not form a loop")
    if includes > MOST_INCLUDES or len(open_files) > DEEPEST_INCLUDE:
        raise ImportProblem(f"{statement.place}: more than {MOST_INCLUDES} includes, or {DEEPEST_INCLUDE} within each"
                            " other; a scene must include fewer files")


def _statement(directive: str, place: Place, tokens: Tokens) -> Statement:
    if directive in _OLD:
        raise ImportProblem(f"{place}: {directive} belongs to pbrt-v2; scenes of pbrt-v3 and pbrt-v4 are read")
    if directive not in _FORMS:
        raise ImportProblem(f'{place}: "{directive[:40]}" is no directive of pbrt-v3 or pbrt-v4')
    strings, numbers, has_parameters = _FORMS[directive]
    statement = Statement(directive, place)
    for _ in range(strings):
        statement.strings.append(_string(tokens, directive))
    if directive == "MediumInterface" and tokens.peek().kind is Kind.STRING:
        statement.strings.append(tokens.next().text)
    if directive == "ActiveTransform":
        statement.strings.append(tokens.next().text)
    if numbers:
        statement.numbers = _fixed_numbers(tokens, numbers, directive, place)
    while has_parameters and tokens.peek().kind is Kind.STRING:
        statement.parameters.append(_parameter(tokens))
    statement.parameters = _last_ones(statement.parameters)
    return statement


def _last_ones(parameters: list[Parameter]) -> list[Parameter]:
    """Of parameters of one type and name the last holds (v4: ParameterDictionary, v3: ParamSet::EraseFloat and so on)."""
    last = {(parameter.kind, parameter.name): parameter for parameter in parameters}
    return parameters if len(last) == len(parameters) else list(last.values())


def _string(tokens: Tokens, directive: str) -> str:
    token = tokens.next()
    if token.kind is not Kind.STRING:
        raise ImportProblem(f"{token.place}: {said(token)} stands where {directive} expects a string in double quotes")
    return token.text


def _fixed_numbers(tokens: Tokens, count: int, directive: str, place: Place) -> np.ndarray:
    """pbrt puts the 16 numbers of a matrix into brackets and no others; exporters differ, so both are read."""
    if tokens.peek().kind is Kind.NUMBERS:
        numbers = tokens.next().numbers
    else:
        is_open = tokens.peek().kind is Kind.OPEN
        if is_open:
            tokens.next()
        numbers = np.array([number(tokens.next()) for _ in range(count)])
        if is_open and tokens.next().kind is not Kind.CLOSE:
            raise ImportProblem(f"{place}: {directive} has more than {count} numbers, or no closing bracket")
    if numbers is None or len(numbers) != count:
        raise ImportProblem(f"{place}: {directive} has {0 if numbers is None else len(numbers)} numbers;"
                            f" it must have {count}")
    return numbers


def _parameter(tokens: Tokens) -> Parameter:
    head = tokens.next()
    kind, name = declared(head.text, head.place)
    return Parameter(kind, name, read_values(tokens, kind, name, head.place), head.place)
