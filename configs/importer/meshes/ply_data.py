"""The data of a .ply file behind its header, element by element, with counts checked before memory is taken."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from importer.meshes.ply_header import Element, Header, Property
from importer.meshes.text import parsed
from importer.problems import ImportProblem


@dataclass(frozen=True)
class Lists:
    counts: np.ndarray  # the length of each row's list
    values: np.ndarray  # all lists one after the other


class Body:
    """Read from the front to the back: each element once, in the header's order."""

    def __init__(self, path: Path, data: bytes, header: Header) -> None:
        self._path, self._order = path, header.order
        if header.order:
            self._data, self._at = np.frombuffer(data, np.uint8), header.size
        else:
            numbers = parsed(data[header.size:], np.float64)
            if numbers is None:
                raise ImportProblem(f"{path}: the .ply's text has something behind its header that is not a number")
            self._data, self._at = numbers, 0

    def columns(self, element: Element) -> dict[str, np.ndarray]:
        """The single values of all rows, by name."""
        if element.has_lists():
            return {p.name: self._single(rows, p) for rows in [self._rows(element)] for p in element.properties
                    if not p.count_kind}
        if not self._order:
            width = len(element.properties)
            rows = self._take(element, element.count * width).reshape(element.count, width)
            return {p.name: rows[:, k] for k, p in enumerate(element.properties)}
        kind = np.dtype([(str(k), self._order + p.kind) for k, p in enumerate(element.properties)])
        rows = self._take(element, element.count * kind.itemsize).view(kind)
        return {p.name: rows[str(k)] for k, p in enumerate(element.properties)}

    def lists(self, element: Element, name: str) -> Lists:
        """The lists of this name in all rows, as whole numbers."""
        uniform = self._uniform(element, name)
        if uniform is not None:
            return uniform
        starts, counts = self._rows(element)[name]
        wanted = next(p for p in element.properties if p.name == name)
        size = self._size(wanted.kind)
        values = np.empty(int(counts.sum()), np.int64)
        first = np.cumsum(counts) - counts
        for n in np.unique(counts[counts > 0]):
            rows = np.flatnonzero(counts == n)
            raw = self._data[starts[rows][:, None] + np.arange(n * size)]
            found = raw if not self._order else np.ascontiguousarray(raw).view(self._order + wanted.kind)
            values[first[rows][:, None] + np.arange(n)] = self._whole(found)
        return Lists(counts, values)

    def skip(self, element: Element) -> None:
        self._rows(element) if element.has_lists() else self.columns(element)

    def _uniform(self, element: Element, name: str) -> Lists | None:
        """The usual case, one list and all of the first one's length, without a loop over rows; None for others."""
        if sum(1 for p in element.properties if p.count_kind) != 1 or element.count == 0:
            return None
        before = sum(self._size(p.kind) for p in element.properties[:[p.name for p in element.properties].index(name)])
        wanted = next(p for p in element.properties if p.name == name)
        n = self._count_at(element, self._at + before, wanted)
        single = sum(self._size(p.kind) for p in element.properties if not p.count_kind)
        head, item = self._size(wanted.count_kind), self._size(wanted.kind)
        row = single + head + n * item
        if self._at + element.count * row > len(self._data):
            return None
        rows = self._data[self._at:self._at + element.count * row].reshape(element.count, row)
        counts = self._view(rows[:, before:before + head], wanted.count_kind)
        if n == 0 or (counts != n).any():
            return None
        self._at += element.count * row
        values = self._view(rows[:, before + head:before + head + n * item], wanted.kind)
        return Lists(np.full(element.count, n, np.int64), self._whole(values).reshape(-1))

    def _rows(self, element: Element) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Of each property: where its values begin in each row, and how many they are."""
        self._check_count(element, element.count * sum(self._size(p.count_kind or p.kind) for p in element.properties))
        starts = {p.name: np.empty(element.count, np.int64) for p in element.properties}
        counts = {p.name: np.ones(element.count, np.int64) for p in element.properties}
        at = self._at
        for row in range(element.count):
            for p in element.properties:
                if p.count_kind:
                    counts[p.name][row] = n = self._count_at(element, at, p)
                    at += self._size(p.count_kind)
                else:
                    n = 1
                starts[p.name][row] = at
                at += n * self._size(p.kind)
        if at > len(self._data):
            raise self._truncated(element)
        self._at = at
        return {p.name: (starts[p.name], counts[p.name]) for p in element.properties}

    def _single(self, rows: dict[str, tuple[np.ndarray, np.ndarray]], prop: Property) -> np.ndarray:
        raw = self._data[rows[prop.name][0][:, None] + np.arange(self._size(prop.kind))]
        return self._view(raw, prop.kind)[:, 0]

    def _count_at(self, element: Element, at: int, prop: Property) -> int:
        """The length of the list there."""
        size = self._size(prop.count_kind)
        raw = self._data[at:at + size]
        if len(raw) < size:
            raise self._truncated(element)
        n = raw[0] if size == 1 and prop.count_kind != "i1" else self._view(raw[None], prop.count_kind)[0, 0]
        if not 0 <= n <= len(self._data):  # also where it is NaN
            raise ImportProblem(f"{self._path}: an element {element.name!a} of the .ply has a list of {n} values")
        return int(n)

    def _size(self, kind: str) -> int:
        """Bytes of a value; of text, one number."""
        return int(kind[1:]) if self._order else 1

    def _view(self, raw: np.ndarray, kind: str) -> np.ndarray:
        return np.ascontiguousarray(raw).view(self._order + kind) if self._order else raw

    def _whole(self, values: np.ndarray) -> np.ndarray:
        if values.dtype.kind == "f" and not (np.abs(values) < 2**53).all():  # NaN is not less, either
            raise ImportProblem(f"{self._path}: a face's index is not a whole number that a mesh can have")
        return values.astype(np.int64)

    def _take(self, element: Element, size: int) -> np.ndarray:
        self._check_count(element, size)
        self._at += size
        return self._data[self._at - size:self._at]

    def _check_count(self, element: Element, size: int) -> None:
        """Before memory is taken for what a header promises."""
        if size > len(self._data) - self._at or not element.properties and element.count:
            raise self._truncated(element)

    def _truncated(self, element: Element) -> ImportProblem:
        return ImportProblem(f"{self._path}: the .ply ends within its {element.count} elements {element.name!a}")
