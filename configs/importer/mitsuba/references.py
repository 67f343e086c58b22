"""Names of objects, and what refers to them."""

from __future__ import annotations

from importer.mitsuba.plugin import Plugin
from importer.problems import ImportProblem

_MAX_DEPTH = 100  # of objects that refer to objects


class References:
    """Mitsuba 3 allows a reference before its object, thus they are resolved when all is read."""

    def __init__(self) -> None:
        self._objects: dict[str, Plugin] = {}
        self._references: list[Plugin] = []  # each stands where its object will

    def add(self, plugin: Plugin) -> None:
        if not plugin.id:
            return
        if plugin.id in self._objects:
            raise ImportProblem(f"{plugin.where}: the id \"{plugin.id}\" is taken by {self._objects[plugin.id].where}")
        self._objects[plugin.id] = plugin

    def alias(self, name: str, other: str, where: str) -> None:
        if name not in self._objects:
            raise ImportProblem(f"{where}: there is no object with the id \"{name}\" above")
        if other in self._objects:
            raise ImportProblem(f"{where}: the id \"{other}\" is taken by {self._objects[other].where}")
        self._objects[other] = self._objects[name]

    def refer(self, parent: Plugin, name: str, as_parameter: str, where: str) -> None:
        place = Plugin("ref", "", as_parameter, name, where, parent.is_old, parent.folders)
        parent.children.append(place)
        self._references.append(place)

    def resolve(self, root: Plugin) -> None:
        """A reference becomes a plugin that shares its object's parameters and children, under a name of its own."""
        for place in self._references:
            target = self._objects.get(place.id)
            if target is None:
                raise ImportProblem(f"{place.where}: there is no object with the id \"{place.id}\"")
            place.kind, place.type, place.id = target.kind, target.type, target.id
            place.properties, place.children, place.where = target.properties, target.children, target.where
            place.is_old, place.folders = target.is_old, target.folders
        _check_depth(root)


def _check_depth(root: Plugin) -> None:
    """No object may hold itself, and none may be nested so deeply that reading it would overflow the stack."""
    height: dict[int, int] = {}  # by the list of children, which a reference shares with its object
    stack = [(root, False)]
    open_lists: set[int] = set()
    while stack:
        plugin, is_done = stack.pop()
        key = id(plugin.children)
        if is_done:
            open_lists.discard(key)
            height[key] = 1 + max((height[id(child.children)] for child in plugin.children), default=0)
            if height[key] > _MAX_DEPTH:
                raise ImportProblem(f"{plugin.where}: refers to objects more than {_MAX_DEPTH} deep")
        elif key in open_lists:
            raise ImportProblem(f"{plugin.where}: the object with the id \"{plugin.id}\" refers to itself")
        elif key not in height:
            open_lists.add(key)
            stack.append((plugin, True))
            stack.extend((child, False) for child in plugin.children)
