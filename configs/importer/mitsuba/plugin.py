"""An object of the scene's XML with its parameters, in the names of Mitsuba 3, whatever version wrote it."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from importer.mitsuba.transforms import affine
from importer.mitsuba.values import Value
from importer.problems import ImportProblem, Notes


@dataclass
class Property:
    tag: str
    value: Value
    where: str


@dataclass(eq=False)
class Plugin:
    """What a reader asks for is remembered, so that what nobody asked for can be named."""

    kind: str  # the element's name: "shape", "bsdf"
    type: str  # "sphere", "diffuse"; of the scene ""
    name: str  # as which parameter of its parent it stands; "" where it has no name
    id: str
    where: str  # "scene.xml:12, <shape type="sphere">"
    is_old: bool  # of version 0.x
    folders: tuple[Path, ...]  # where its files may lie
    properties: dict[str, Property] = field(default_factory=dict)
    children: list["Plugin"] = field(default_factory=list)  # references among them are resolved by the tree's reader
    _used: set[str] = field(default_factory=set)
    _used_children: set[int] = field(default_factory=set)

    @property
    def key(self) -> int:
        """The same for an object and all references to it."""
        return id(self.properties)

    def has(self, name: str) -> bool:
        return name in self.properties

    def gives(self, name: str) -> bool:
        """Whether a parameter is given, be it as a value or as an object."""
        return self.has(name) or any(child.name == name for child in self.children)

    def get(self, name: str) -> Property | None:
        self._used.add(name)
        return self.properties.get(name)

    def number(self, name: str, default: float) -> float:
        value = self._value(name, default, (int, float), "a number")
        return float(value)

    def integer(self, name: str, default: int) -> int:
        value = self._value(name, default, (int, float), "an integer")
        if int(value) != value:
            raise ImportProblem(f"{self.where}: \"{name}\" is {value}; an integer is right")
        return int(value)

    def boolean(self, name: str, default: bool) -> bool:
        return bool(self._value(name, default, (bool,), "\"true\" or \"false\""))

    def string(self, name: str, default: str | None = None) -> str:
        """Without a default the parameter is needed."""
        value = self._value(name, default, (str,), "a string")
        if value is None:
            raise ImportProblem(f"{self.where}: needs a \"{name}\"")
        return value

    def vector(self, name: str, default: tuple[float, float, float]) -> np.ndarray:
        found = self.get(name)
        if found and found.tag not in ("point", "vector"):
            raise ImportProblem(f"{found.where}: \"{name}\" is a <{found.tag}>; a <point> or <vector> is right")
        return found.value if found else np.array(default)

    def transform(self, name: str) -> np.ndarray:
        found = self.get(name)
        if found and found.tag != "transform":
            raise ImportProblem(f"{found.where}: \"{name}\" is a <{found.tag}>; a <transform> is right")
        return affine(found.value, found.where) if found else np.eye(4)

    def child(self, name: str) -> "Plugin | None":
        """The object that stands as the parameter of this name."""
        for child in self.children:
            if child.name == name:
                self._used_children.add(id(child))
                return child
        return None

    def all_of(self, *kinds: str) -> list["Plugin"]:
        found = [child for child in self.children if child.kind in kinds]
        self._used_children.update(id(child) for child in found)
        return found

    def only(self, kind: str) -> "Plugin | None":
        """The one child of a kind, or none."""
        found = self.all_of(kind)
        if len(found) > 1:
            raise ImportProblem(f"{self.where}: has {len(found)} <{kind}>; one is right")
        return found[0] if found else None

    def ignore(self, *names: str) -> None:
        """Parameters that do not change what light does, such as how many samples are taken."""
        self._used.update(names)

    def note_rest(self, notes: Notes) -> None:
        """Names what no reader asked for. An instance of a shared object is read more than once, but named once."""
        for name in self.properties.keys() - self._used:
            notes.left_out(f"the parameter \"{name}\" of {self.kind} {self.type}", self.properties[name].where)
        for child in self.children:
            if id(child) not in self._used_children:
                notes.left_out(f"<{child.kind} type=\"{child.type}\"> in {self.kind} {self.type}", child.where)
        self._used.update(self.properties)
        self._used_children.update(id(child) for child in self.children)

    def _value(self, name: str, default: Value | None, types: tuple[type, ...], what: str) -> Value | None:
        found = self.get(name)
        if not found:
            return default
        if not isinstance(found.value, types) or isinstance(found.value, bool) != (types == (bool,)):
            raise ImportProblem(f"{found.where}: \"{name}\" must be {what}")
        return found.value


def snake_case(name: str) -> str:
    """toWorld is to_world, intIOR int_ior (camel_to_underscore_case of Mitsuba 3's parser)."""
    return re.sub(r"(?<=[a-z])[A-Z]+", lambda capitals: "_" + capitals[0].lower(), name)
