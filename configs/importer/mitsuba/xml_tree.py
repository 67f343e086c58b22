"""Mitsuba's XML, of versions 0.x and 3, as one tree: includes put in, parameters and references resolved."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from lxml import etree

from importer.mitsuba import transforms, values
from importer.mitsuba.files import SceneFolder
from importer.mitsuba.parameters import Parameters
from importer.mitsuba.plugin import Plugin, Property, snake_case
from importer.mitsuba.references import References
from importer.mitsuba.xml_file import Element, children, element, is_old, parsed
from importer.problems import ImportProblem, Notes

_OBJECTS = {"scene", "shape", "sampler", "film", "integrator", "texture", "sensor", "emitter", "subsurface", "medium",
            "volume", "phase", "bsdf", "rfilter"}
_TEXTS = {"integer": values.integer, "float": values.number, "boolean": values.boolean, "rgb": values.rgb,
          "srgb": values.srgb, "spectrum": values.spectrum, "string": lambda text, where: text}
# The intent of 0.6 says whether a colour is a reflectance or a light, which for three channels is the same.
_KNOWN_ATTRIBUTES = {"name", "value", "x", "y", "z", "filename", "temperature", "scale", "intent"}
_MAX_FILES = 1000  # that are included, all together
_MAX_DEPTH = 60  # of objects within objects, through includes as well


class SceneTree:
    """Reads one scene. `files` are those that its XML consists of, in the order of reading."""

    def __init__(self, scene: Path, notes: Notes, parameters: dict[str, str]) -> None:
        self.folder = SceneFolder(scene)
        self.files: list[Path] = []
        self.version = ""  # of the scene's own file
        self._notes = notes
        self._parameters = Parameters(parameters)
        self._references = References()
        self._open: list[Path] = []  # the files that are being read, each included by the one before
        self._readers = {"default": self._default, "alias": self._alias, "ref": self._ref, "path": self._path,
                         "animation": self._animation, "transform": self._transform}

    def read(self, scene: Path) -> Plugin:
        if not scene.is_file():
            raise ImportProblem(f"{scene}: there is no such file")
        root = self._file(scene.resolve(), 0, ())
        if root.kind != "scene":
            raise ImportProblem(f"{scene.name}: starts with <{root.kind}>; a scene starts with <scene version=\"3.0.0\">")
        self._references.resolve(root)
        self._parameters.check_all_used(scene.name)
        return root

    def _file(self, path: Path, depth: int, folders: tuple[Path, ...]) -> Plugin:
        label = self._label(path)
        if path in self._open:
            way = " and ".join(self._label(between) for between in self._open[self._open.index(path):])
            raise ImportProblem(f"{label}: includes itself, by way of {way}")
        if len(self.files) > _MAX_FILES:
            raise ImportProblem(f"{label}: is one of more than {_MAX_FILES} files included, the most that are read")
        self.files.append(path)
        self._open.append(path)
        node = parsed(path, label)
        self.version = self.version or node.get("version", "").strip()
        holder = Plugin("", "", "", "", label, is_old(node, label), (path.parent, *folders))
        self._element(node, holder, depth)
        self._open.pop()
        if len(holder.children) != 1:
            raise ImportProblem(f"{label}: holds <{node.tag}>; a <scene> or one object is right")
        return holder.children[0]

    def _element(self, node: etree._Element, parent: Plugin, depth: int) -> None:
        """Adds what one element says to its parent."""
        item = element(node, self._label(self._open[-1]), self._parameters)
        if item.tag in _OBJECTS or item.tag == "spectrum" and "type" in item.attributes:
            self._object(item, parent, depth)
        elif item.tag == "include":
            self._include(item, parent, depth)
        elif item.tag in self._readers:
            self._readers[item.tag](item, parent)
        elif item.tag in _TEXTS or item.tag in ("point", "vector", "blackbody"):
            self._set(parent, item, item.tag, self._value(item, parent))
        elif item.tag != "null":
            raise ImportProblem(f"{item.where}: is no element of scenes of Mitsuba 0.5, 0.6 and 3")

    def _object(self, item: Element, parent: Plugin, depth: int) -> None:
        kind = "texture" if item.tag == "spectrum" else item.tag  # spectra are textures in Mitsuba 3
        type_name = item.attributes.get("type", "").lower()  # 0.6 does not tell them apart by case
        where = f"{item.line}, <{item.tag} type=\"{type_name}\">" if type_name else item.where
        if depth >= _MAX_DEPTH:
            raise ImportProblem(f"{where}: is nested more than {_MAX_DEPTH} deep")
        if not type_name and kind != "scene":
            raise ImportProblem(f"{where}: has no type")
        plugin = Plugin(kind, type_name, snake_case(item.attributes.get("name", "")), item.attributes.get("id", ""),
                        where, parent.is_old, parent.folders)
        for name in sorted(item.attributes.keys() - {"type", "version", "name", "id"}):
            self._notes.left_out(f"the attribute \"{name}\" of <{item.tag}>", where)
        self._references.add(plugin)
        parent.children.append(plugin)
        for node in children(item.node):
            self._element(node, plugin, depth + 1)

    def _include(self, item: Element, parent: Plugin, depth: int) -> None:
        """What a <scene> in the file holds belongs to the parent; another object is the parent's child."""
        path = self.folder.find(item.needed("filename"), parent.folders, item.where)
        included = self._file(path, depth + 1, parent.folders)
        if included.kind != "scene":
            included.name = snake_case(item.attributes.get("name", included.name))
            parent.children.append(included)
            return
        parent.children.extend(included.children)
        parent.properties.update(included.properties)

    def _default(self, item: Element, parent: Plugin) -> None:
        self._parameters.default(item.needed("name"), item.needed("value"), item.where)

    def _alias(self, item: Element, parent: Plugin) -> None:
        self._references.alias(item.needed("id"), item.needed("as"), item.where)

    def _ref(self, item: Element, parent: Plugin) -> None:
        self._references.refer(parent, item.needed("id"), snake_case(item.attributes.get("name", "")), item.where)

    def _path(self, item: Element, parent: Plugin) -> None:
        """A folder in which files are looked for from here on (Mitsuba 3's resource path)."""
        parent.folders = (self.folder.folder(item.needed("value"), parent.folders, item.where), *parent.folders)

    def _animation(self, item: Element, parent: Plugin) -> None:
        """Motion; with --lenient what moves stands where it is at first."""
        self._notes.refuse("motion (<animation>)", item.where)
        for node in list(children(item.node))[:1]:
            first = element(node, self._label(self._open[-1]), self._parameters)
            self._set(parent, item, "transform", self._matrix(first, parent))

    def _transform(self, item: Element, parent: Plugin) -> None:
        self._set(parent, item, "transform", self._matrix(item, parent))

    def _matrix(self, item: Element, parent: Plugin) -> np.ndarray:
        matrix = np.eye(4)
        for node in children(item.node):
            step = element(node, self._label(self._open[-1]), self._parameters)
            matrix = transforms.step(step.tag, step.attributes, parent.is_old, step.where) @ matrix
            if not np.abs(matrix).max() < 1e30:
                raise ImportProblem(f"{step.where}: its numbers are too large")
        return matrix

    def _value(self, item: Element, parent: Plugin) -> values.Value:
        """A parameter of numbers or text."""
        if item.tag in ("point", "vector"):
            return values.vector({key: text for key, text in item.attributes.items() if key != "name"}, item.where)
        if item.tag == "blackbody":
            return values.blackbody(item.needed("temperature"), item.attributes.get("scale", "1"), item.where)
        if item.tag == "spectrum" and "filename" in item.attributes:
            path = self.folder.find(item.attributes["filename"], parent.folders, item.where)
            return values.spectrum_file(path, item.where)
        return _TEXTS[item.tag](item.needed("value"), item.where)

    def _set(self, parent: Plugin, item: Element, tag: str, value: values.Value) -> None:
        name = snake_case(item.needed("name"))
        for other in sorted(item.attributes.keys() - _KNOWN_ATTRIBUTES):
            self._notes.left_out(f"the attribute \"{other}\" of <{tag}>", item.where)
        if name in parent.properties:
            raise ImportProblem(f"{item.where}: \"{name}\" is given twice")
        parent.properties[name] = Property(tag, value, f"{item.line}, <{tag} name=\"{name}\">")

    def _label(self, path: Path) -> str:
        """As the scene's own folder has it, so that no machine's paths end in messages."""
        return str(path.relative_to(self.folder.root))
