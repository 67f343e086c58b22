"""One XML file, opened so that it opens no other, and its elements with where they stand."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator

from lxml import etree

from importer.mitsuba.parameters import Parameters
from importer.problems import ImportProblem

_MAX_BYTES = 256 << 20


@dataclass
class Element:
    """With the values of its parameters put in. `where` is as messages have it: scene.xml:12, <float>."""

    node: etree._Element
    tag: str  # in small letters: lookAt and lookat are both in use
    attributes: dict[str, str]
    where: str
    line: str  # scene.xml:12

    def needed(self, name: str) -> str:
        if name not in self.attributes:
            raise ImportProblem(f"{self.where}: needs the attribute \"{name}\"")
        return self.attributes[name]


def parsed(path: Path, label: str) -> etree._Element:
    """The root. Entities, DTDs and the network are off, and a document type is refused."""
    if path.stat().st_size > _MAX_BYTES:
        raise ImportProblem(f"{label}: is larger than {_MAX_BYTES >> 20} MiB, the most that is read of XML")
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, remove_comments=True, remove_pis=True)
    try:
        root = etree.fromstring(path.read_bytes(), parser)
    except (etree.XMLSyntaxError, OSError) as error:
        raise ImportProblem(f"{label}: is no well-formed XML ({str(error).splitlines()[0][:200]})") from error
    if root.getroottree().docinfo.internalDTD is not None:
        raise ImportProblem(f"{label}: declares a document type; scenes without <!DOCTYPE> are read")
    return root


def element(node: etree._Element, label: str, parameters: Parameters) -> Element:
    line = f"{label}:{node.sourceline}"
    where = f"{line}, <{node.tag}>"
    attributes = {name: parameters.apply(value, where) for name, value in node.attrib.items()}
    return Element(node, node.tag.lower(), attributes, where, line)


def children(node: etree._Element) -> Iterator[etree._Element]:
    """Its elements; text between them means nothing, as in Mitsuba."""
    return node.iterchildren(tag=etree.Element)


def is_old(root: etree._Element, label: str) -> bool:
    """Versions below 2 write camelCase (transform_upgrade of Mitsuba 3's parser)."""
    match = re.match(r"\s*(\d{1,3})\.\d+(\.\d+)?\s*\Z", root.get("version", ""))
    if not match:
        raise ImportProblem(f"{label}: <{root.tag}> has no version such as \"0.6.0\" or \"3.0.0\"")
    return int(match[1]) < 2
