"""Typed parameters, `"type name" [values]`: read by name, once each, so that what nobody asked for can be named."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Sequence

import numpy as np

from importer.pbrt.source import Place
from importer.pbrt.tokens import Kind, Token, Tokens, number, said
from importer.problems import ImportProblem, Notes

# How many numbers one value has (fileformat-v4, fileformat-v3; 0: any number of them).
_WIDTHS = {"integer": 1, "float": 1, "point2": 2, "vector2": 2, "point3": 3, "vector3": 3, "normal3": 3, "point": 3,
           "vector": 3, "normal": 3, "rgb": 3, "color": 3, "xyz": 3, "blackbody": 0, "spectrum": 0}
_TEXTS = ("string", "texture", "bool", "spectrum")
_SAME = {"point": "point3", "vector": "vector3", "normal": "normal3", "color": "rgb"}
_FLAGS = {"true": True, "false": False}


@dataclass(eq=False)
class Parameter:
    kind: str  # as the file says, but for `_SAME`
    name: str
    values: np.ndarray | list[str]
    place: Place


def declared(head: str, place: Place) -> tuple[str, str]:
    """Type and name from "type name"."""
    words = head.split()
    if len(words) != 2:
        raise ImportProblem(f'{place}: "{head[:60]}" is no parameter; it must be a type and a name, such as "float fov"')
    kind, name = words
    if kind not in _WIDTHS and kind not in _TEXTS:
        raise ImportProblem(f'{place}: "{kind[:40]}" is no type of a parameter; types are float, integer, rgb and so on')
    return kind, name


def read_values(tokens: Tokens, kind: str, name: str, place: Place) -> np.ndarray | list[str]:
    """What stands behind a parameter's head: one value, or values within brackets."""
    first = tokens.next()
    if first.kind is Kind.NUMBERS:
        found: Sequence[Token] = []
        numbers = first.numbers
    else:
        found = _listed(tokens, place, name) if first.kind is Kind.OPEN else [first]
        numbers = None
    if numbers is not None or _are_numbers(found, kind):
        return _checked(numbers if numbers is not None else np.array([number(token) for token in found]), kind, name, place)
    wanted = (Kind.STRING, Kind.WORD) if kind == "bool" else (Kind.STRING,)
    for token in found:
        if token.kind not in wanted or kind not in _TEXTS:
            raise ImportProblem(f'{token.place}: {said(token)} is no value of the parameter "{kind} {name}"')
    return [token.text for token in found]


def _listed(tokens: Tokens, place: Place, name: str) -> list[Token]:
    found = []
    while tokens.peek().kind is not Kind.CLOSE:
        if tokens.peek().kind not in (Kind.STRING, Kind.WORD):
            raise ImportProblem(f'{place}: the list of the parameter "{name}" has no closing bracket')
        found.append(tokens.next())
    tokens.next()
    return found


def _are_numbers(found: Sequence[Token], kind: str) -> bool:
    if kind not in _WIDTHS or kind == "spectrum" and any(token.kind is Kind.STRING for token in found):
        return False
    return all(token.kind is Kind.WORD for token in found)


def _checked(numbers: np.ndarray, kind: str, name: str, place: Place) -> np.ndarray:
    if kind not in _WIDTHS:
        if len(numbers) == 0:
            return numbers
        raise ImportProblem(f'{place}: the parameter "{kind} {name}" has numbers; it must have words in double quotes')
    width = _WIDTHS[kind]
    if width and len(numbers) % width:
        raise ImportProblem(f'{place}: the parameter "{kind} {name}" has {len(numbers)} numbers;'
                            f" it must have a multiple of {width}")
    if kind == "integer" and (numbers != np.floor(numbers)).any():
        raise ImportProblem(f'{place}: the parameter "{kind} {name}" has fractions; it must have whole numbers')
    return numbers


@dataclass
class Parameters:
    """The parameters of one statement; `fallbacks` are those of the `Attribute` directive, which many statements share."""

    own: list[Parameter]
    place: Place
    what: str  # as in "the shape "sphere""
    fallbacks: Sequence[Parameter] = ()
    _read: set[str] = field(default_factory=set)

    def find(self, name: str, *kinds: str) -> Parameter | None:
        """The parameter of one of these types; one of the name alone and of another type is an error."""
        self._read.add(name)
        other = None
        for parameter in [*self.own, *self.fallbacks]:
            if parameter.name != name:
                continue
            if _SAME.get(parameter.kind, parameter.kind) in kinds:
                return parameter
            other = parameter
        if other is not None:
            raise ImportProblem(f'{other.place}: the parameter "{name}" of {self.what} is of the type {other.kind};'
                                f" it must be {' or '.join(kinds)}")
        return None

    def has(self, name: str, *kinds: str) -> bool:
        """Whether it is there, of one of these types or of any; it does not count as read."""
        return any(parameter.name == name and (not kinds or _SAME.get(parameter.kind, parameter.kind) in kinds)
                   for parameter in [*self.own, *self.fallbacks])

    def number(self, name: str, default: float) -> float:
        parameter = self.find(name, "float", "integer")
        return default if parameter is None else float(self._single(parameter))

    def integer(self, name: str, default: int) -> int:
        parameter = self.find(name, "integer")
        return default if parameter is None else int(self._single(parameter))

    def string(self, name: str, default: str) -> str:
        parameter = self.find(name, "string")
        return default if parameter is None else str(self._single(parameter))

    def flag(self, name: str, default: bool) -> bool:
        parameter = self.find(name, "bool")
        if parameter is None:
            return default
        text = str(self._single(parameter))
        if text not in _FLAGS:
            raise ImportProblem(f'{parameter.place}: "{text[:40]}" is no value of the parameter "bool {name}";'
                                " it must be true or false")
        return _FLAGS[text]

    def numbers(self, name: str, *kinds: str, width: int = 1, count: int | None = None) -> np.ndarray | None:
        """Numbers in rows of `width`, `count` rows of them where that is given; None where there is no parameter."""
        parameter = self.find(name, *kinds)
        if parameter is None:
            return None
        values = np.asarray(parameter.values, dtype=np.float64)
        if len(values) % width or count is not None and len(values) != width * count:
            wanted = f"a multiple of {width}" if count is None else str(width * count)
            raise ImportProblem(f'{parameter.place}: the parameter "{name}" of {self.what} has {len(values)} numbers;'
                                f" it must have {wanted}")
        return values.reshape(-1, width) if width > 1 else values

    def point(self, name: str, default: Sequence[float]) -> np.ndarray:
        found = self.numbers(name, "point3", width=3, count=1)
        return np.asarray(default, dtype=np.float64) if found is None else found[0]

    def strings(self, name: str) -> list[str]:
        parameter = self.find(name, "string")
        return [] if parameter is None else [str(value) for value in parameter.values]

    def texture(self, name: str) -> str | None:
        """The name of a texture, where the parameter is one."""
        if not self.has(name, "texture"):
            return None
        parameter = self.find(name, "texture")
        assert parameter is not None
        return str(self._single(parameter))

    def without_effect(self, *names: str) -> None:
        """These are meant for a renderer that works in another way, and say nothing of the picture."""
        self._read.update(names)

    def finish(self, notes: Notes) -> None:
        """Names what nobody has asked for."""
        for parameter in self.own:
            if parameter.name not in self._read:
                notes.left_out(f'the parameter "{parameter.kind} {parameter.name}" of {self.what}', str(parameter.place))
                self._read.add(parameter.name)

    def _single(self, parameter: Parameter) -> float | str:
        if len(parameter.values) != 1:
            raise ImportProblem(f'{parameter.place}: the parameter "{parameter.name}" of {self.what} has'
                                f" {len(parameter.values)} values; it must have one")
        return parameter.values[0]
