"""The statements of an .obj file by kind, with their numbers as arrays.

Text is cut into blocks of some MiB at ends of lines, so that the masks over its bytes stay small.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Iterator

import numpy as np

from importer.meshes.text import parsed
from importer.problems import ImportProblem

_BLOCK = 16 << 20
_KINDS = {"v": b"v ", "vt": b"vt", "vn": b"vn", "f": b"f "}
_SPACE, _NEWLINE, _SLASH = 32, 10, 47


@dataclass(frozen=True)
class Numbers:
    values: np.ndarray
    per_line: np.ndarray  # how many tokens each statement has
    lines: np.ndarray  # each statement's line in the block, from 0 on
    per_token: np.ndarray  # how many numbers each token has; empty where each has one

    def line_of_token(self, token: int) -> int:
        return int(np.repeat(self.lines, self.per_line)[token])


def blocks(path: Path, data: bytes) -> Iterator["Block"]:
    """Lines that end with a backslash go on in the next one."""
    if b"\\" in data:
        data = data.replace(b"\\\r\n", b"   ").replace(b"\\\n", b"  ")
    if b"\r" in data and b"\n" not in data:
        data = data.replace(b"\r", b"\n")
    start = line = 0
    while start < len(data):
        end = len(data) if start + _BLOCK >= len(data) else data.rfind(b"\n", start, start + _BLOCK) + 1
        if end <= start:  # one line longer than a block
            end = data.find(b"\n", start) + 1 or len(data)
        block = Block(path, data[start:end], line)
        yield block
        start, line = end, line + len(block.starts)


class Block:
    """Whole lines of the file."""

    def __init__(self, path: Path, text: bytes, first_line: int) -> None:
        self.path, self.first_line = path, first_line
        if b"\t" in text or b"\r" in text:
            text = text.translate(bytes.maketrans(b"\t\r\v\f", b"    "))
        self.bytes = np.frombuffer(text + (b"" if text.endswith(b"\n") else b"\n"), np.uint8)
        self.ends = np.flatnonzero(self.bytes == _NEWLINE) + 1
        self.starts = np.concatenate([[0], self.ends[:-1]])
        self._begins = self._first_letters()
        self._kinds = self._kind_of_lines()

    def _first_letters(self) -> np.ndarray:
        """Where each line's keyword begins: behind its indentation."""
        indented = self.bytes[self.starts] == _SPACE
        if not indented.any():
            return self.starts
        letters = np.flatnonzero(self.bytes != _SPACE)  # the last byte is the end of a line, so each line has one
        return np.where(indented, letters[np.searchsorted(letters, self.starts)], self.starts)

    def _kind_of_lines(self) -> dict[str, np.ndarray]:
        """The numbers of the lines of each kind."""
        size = len(self.bytes) - 1
        letters = [self.bytes[np.minimum(self._begins + k, size)] for k in range(3)]
        kinds = {}
        for kind, name in _KINDS.items():
            found = (letters[0] == name[0]) & (letters[1] == name[1])
            if name[1] != _SPACE:
                found &= letters[2] == _SPACE
            kinds[kind] = np.flatnonzero(found)
        return kinds

    def counts_before(self, lines: np.ndarray) -> np.ndarray:
        """(n, 3): how many v, vt and vn the block has before each line."""
        return np.stack([np.searchsorted(self._kinds[kind], lines) for kind in ("v", "vt", "vn")], axis=1)

    def problem(self, line: int, what: str) -> ImportProblem:
        return ImportProblem(f"{self.path}, line {self.first_line + line + 1}: {what}")

    def _text(self, kind: str) -> np.ndarray:
        """The bytes of a kind's lines, with spaces in place of keywords and comments."""
        lines = self._kinds[kind]
        taken = np.zeros(len(self.starts), bool)
        taken[lines] = True
        lengths = self.ends - self.starts
        text = self.bytes[np.repeat(taken, lengths)]
        offset = np.cumsum(lengths[lines]) - lengths[lines] + self._begins[lines] - self.starts[lines]
        for k in range(len(_KINDS[kind].strip())):
            text[offset + k] = _SPACE
        if (text == ord("#")).any():
            text = _without_comments(text)
        return text

    def numbers(self, kind: str) -> Numbers:
        """Of v, vt and vn."""
        text, lines = self._text(kind), self._kinds[kind]
        per_line = _tokens_per_line(text)
        values = self._parsed(text.tobytes(), np.float64, int(per_line.sum()), kind)
        return Numbers(values, per_line, lines, np.empty(0, np.int64))

    def corners(self) -> Numbers:
        """Of f: a token is a corner, and its numbers the indices between slashes, 0 for those left out."""
        raw, lines = self._text("f"), self._kinds["f"]
        per_line = _tokens_per_line(raw)
        text = raw.tobytes()
        if b"//" in text:
            text = text.replace(b"//", b"/0/")
        for end in (b" ", b"\n"):
            if b"/" + end in text:
                text = text.replace(b"/" + end, b"/0" + end)
        array = np.frombuffer(text, np.uint8)
        is_inside = array > _SPACE
        begins = np.flatnonzero(is_inside & np.concatenate([[True], ~is_inside[:-1]]))
        slashes = np.flatnonzero(array == _SLASH)
        per_token = 1 + np.bincount(np.searchsorted(begins, slashes, side="right") - 1, minlength=len(begins))
        values = self._parsed(text.replace(b"/", b" "), np.int64, int(per_token.sum()), "f")
        return Numbers(values, per_line, lines, per_token)

    def _parsed(self, text: bytes, kind: type, count: int, name: str) -> np.ndarray:
        """All numbers of the text; where it has something else, the line with it is looked for."""
        values = parsed(text, kind)
        if values is not None and len(values) == count:
            return values
        for line, row in zip(self._kinds[name], text.splitlines()):
            numbers = parsed(row, kind)
            if numbers is None or len(numbers) != len(row.split()):
                raise self.problem(line, f"'{name}' is followed by something that is not a number: {_shown(row)}")
        raise ImportProblem(f"{self.path}: the numbers after '{name}' cannot be read")


def _tokens_per_line(text: np.ndarray) -> np.ndarray:
    if len(text) == 0:
        return np.empty(0, np.int64)
    is_inside = text > _SPACE
    begins = np.flatnonzero(is_inside & np.concatenate([[True], ~is_inside[:-1]]))
    ends = np.flatnonzero(text == _NEWLINE)
    return np.diff(np.searchsorted(begins, ends), prepend=0)


def _without_comments(text: np.ndarray) -> np.ndarray:
    """Spaces from # to the end of its line."""
    ends = np.flatnonzero(text == _NEWLINE)
    marks = np.flatnonzero(text == ord("#"))
    change = np.zeros(len(text) + 1, np.int64)
    np.add.at(change, marks, 1)
    np.add.at(change, ends[np.searchsorted(ends, marks)], -1)
    return np.where(np.cumsum(change)[:-1] > 0, np.uint8(_SPACE), text)


def _shown(row: bytes) -> str:
    return repr(row[:60].decode("ascii", "replace").strip())
