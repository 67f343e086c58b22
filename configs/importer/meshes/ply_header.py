"""The header of a .ply file: which elements it has, how many, and how their properties lie.

Source: Greg Turk, "The PLY Polygon File Format"; the unofficial types are those of Mitsuba's PLYMesh.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from importer.problems import ImportProblem

_TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
          "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
          "double": "f8", "float64": "f8", "long": "i8", "int64": "i8", "ulong": "u8", "uint64": "u8", "half": "f2",
          "float16": "f2"}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST = 1 << 20  # of a header; comments may be long


@dataclass(frozen=True)
class Property:
    name: str
    kind: str  # of NumPy, without the order of bytes
    count_kind: str | None = None  # of a list's length; None: one value


@dataclass
class Element:
    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    def has_lists(self) -> bool:
        return any(p.count_kind for p in self.properties)


@dataclass(frozen=True)
class Header:
    order: str  # "<" or ">"; "" for text
    elements: list[Element]
    size: int  # bytes up to the data


def read_header(path: Path, data: bytes) -> Header:
    if data[:3] != b"ply" or data[3:4] not in (b"\n", b"\r", b" "):
        raise ImportProblem(f"{path}: the file is not a .ply, which begins with a line 'ply'")
    end = data.find(b"end_header", 0, _LONGEST)
    if end < 0:
        raise ImportProblem(f"{path}: the .ply's header has no 'end_header'")
    order, elements = None, []
    for number, line in enumerate(data[:end].decode("latin-1").splitlines(), 1):
        try:
            order = _read_line(line.split(), elements, order)
        except (ValueError, LookupError) as error:
            raise ImportProblem(f"{path}, line {number}: {line[:80]!a} has no place in a .ply's header: {error}") from error
    if order is None:
        raise ImportProblem(f"{path}: the .ply's header has no 'format'")
    return Header(order, elements, _end_of_line(data, end))


def _read_line(words: list[str], elements: list[Element], order: str | None) -> str | None:
    """Adds what the line says to `elements`, and returns the order of bytes as far as it is known."""
    match words:
        case [] | ["ply"] | ["comment" | "obj_info", *_]:
            pass
        case ["format", name, "1.0"]:
            return _known(_ORDERS, name)
        case ["element", name, count]:
            if int(count) < 0:
                raise ValueError("a count is 0 or more")
            elements.append(Element(name, int(count)))
        case ["property", *_, name] if elements and any(p.name == name for p in elements[-1].properties):
            raise ValueError("an element has each property once")
        case ["property", "list", count_kind, kind, name] if elements:
            if _known(_TYPES, count_kind)[0] == "f":
                raise ValueError("the length of a list is a whole number")
            elements[-1].properties.append(Property(name, _known(_TYPES, kind), _known(_TYPES, count_kind)))
        case ["property", kind, name] if elements:
            elements[-1].properties.append(Property(name, _known(_TYPES, kind)))
        case _:
            raise ValueError("it takes format, element and property lines, in this order")
    return order


def _known(table: dict[str, str], name: str) -> str:
    if name not in table:
        raise ValueError(f"it takes one of {', '.join(table)}")
    return table[name]


def _end_of_line(data: bytes, end: int) -> int:
    """Behind the line 'end_header', which ends as the first line does: binary data may begin with any byte."""
    after = end + len(b"end_header")
    while data[after:after + 1] in (b" ", b"\t"):
        after += 1
    return after + (2 if data[after:after + 2] == b"\r\n" else 1)
