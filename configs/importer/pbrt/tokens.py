"""Words, strings and numbers of a pbrt file (fileformat-v4 and -v3: strings in double quotes, comments from # on)."""

from __future__ import annotations

import re
import warnings
from enum import Enum
from typing import NamedTuple

import numpy as np

from importer.pbrt.source import Place
from importer.problems import ImportProblem

# Possessive quantifiers: no input makes the matcher try again, so that each runs in linear time.
_BETWEEN = re.compile(r"(?:\s++|#[^\n]*+)*+")
_STRING = re.compile(r'"((?:[^"\\\n]|\\.)*+)"')
_WORD = re.compile(r'[^\s"\[\]#]++')
_PLAIN_NUMBERS = re.compile(r"\[([\s0-9eE+.\-]*+)\]")
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f"}


class Kind(Enum):
    WORD = "a word"
    STRING = "a string"
    NUMBERS = "a list of numbers"
    OPEN = "["
    CLOSE = "]"
    END = "the end of the file"


class Token(NamedTuple):
    kind: Kind
    text: str
    place: Place
    numbers: np.ndarray | None = None


class Tokens:
    """One file's tokens, one of them looked at ahead. A list of numbers is one token, for meshes are written so."""

    def __init__(self, text: str, file: str) -> None:
        self._text = text
        self._file = file
        self._at = 0
        self._line = 1
        self._line_at = 0
        self._ahead: Token | None = None

    def peek(self) -> Token:
        if self._ahead is None:
            self._ahead = self._read()
        return self._ahead

    def next(self) -> Token:
        token = self.peek()
        self._ahead = None
        return token

    def _read(self) -> Token:
        between = _BETWEEN.match(self._text, self._at)
        start = between.end() if between else self._at
        self._line += self._text.count("\n", self._line_at, start)
        self._line_at = start
        place = Place(self._file, self._line)
        if start >= len(self._text):
            self._at = start
            return Token(Kind.END, "", place)
        first = self._text[start]
        if first == '"':
            return self._string(start, place)
        if first == "[":
            return self._list(start, place)
        self._at = start + 1
        if first == "]":
            return Token(Kind.CLOSE, "]", place)
        word = _WORD.match(self._text, start)
        assert word is not None  # nothing but space, quotes, brackets and # is no word's beginning
        self._at = word.end()
        return Token(Kind.WORD, word.group(), place)

    def _string(self, start: int, place: Place) -> Token:
        found = _STRING.match(self._text, start)
        if found is None:
            raise ImportProblem(f"{place}: a string has no end; it must be closed by a double quote on its line")
        self._at = found.end()
        text = found.group(1)
        if "\\" in text:
            text = re.sub(r"\\(.)", lambda escape: _ESCAPES.get(escape.group(1), escape.group(1)), text)
        return Token(Kind.STRING, text, place)

    def _list(self, start: int, place: Place) -> Token:
        found = _PLAIN_NUMBERS.match(self._text, start)
        if found is None:
            self._at = start + 1
            return Token(Kind.OPEN, "[", place)
        self._at = found.end()
        return Token(Kind.NUMBERS, "", place, _numbers(found.group(1), place))


def _numbers(text: str, place: Place) -> np.ndarray:
    if not text.strip():
        return np.zeros(0)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # so numpy says that text is left over
        try:
            numbers = np.fromstring(text, dtype=np.float64, sep=" ")
        except (DeprecationWarning, ValueError) as error:
            raise ImportProblem(f"{place}: a list holds what is no number; it must be numbers within brackets") from error
    return finite(numbers, place)


def finite(numbers: np.ndarray, place: Place) -> np.ndarray:
    if not np.isfinite(numbers).all():
        raise ImportProblem(f"{place}: a number is too large for 64 bits or no number; it must be finite")
    return numbers


def number(token: Token) -> float:
    """A number that stands alone, as in `Translate 0 1 0`."""
    try:
        value = float(token.text) if token.kind is Kind.WORD else None
    except ValueError:
        value = None
    if value is None or "_" in token.text:
        raise ImportProblem(f"{token.place}: {said(token)} stands where a number is expected")
    return float(finite(np.array([value]), token.place)[0])


def said(token: Token) -> str:
    """The token as a sentence quotes it, shortened."""
    return f'"{token.text[:40]}"' if token.kind in (Kind.WORD, Kind.STRING) else token.kind.value
