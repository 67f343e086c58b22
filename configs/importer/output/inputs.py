"""Which files an import has read, and their hashes, so that a .glb says what it was made of."""

from __future__ import annotations

import hashlib
import os
import re
import sys
from pathlib import Path
from typing import Any

from importer.problems import ImportProblem

_CODE = (".py", ".pyc", ".so")  # of this program, where it lies below the scene's folder
_HEAD = 1 << 16  # bytes, enough to tell one format from another


class Inputs:
    """Listens to what Python opens below the scene's folder. Readers need not say so, and none can forget it."""

    def __init__(self, scene: Path) -> None:
        self.scene = scene
        self.folder = scene.resolve().parent
        self.files: dict[Path, None] = {scene.resolve(): None}
        self.latest = scene.name  # below the folder, for who waits
        self._is_listening = True
        sys.addaudithook(self._hear)

    def _hear(self, event: str, arguments: tuple) -> None:
        """A hook stays for good (sys.addaudithook), so it has an end of its own; it must not fail, either."""
        if event != "open" or not self._is_listening or not isinstance(arguments[0], (str, bytes, os.PathLike)):
            return
        name, mode = os.fsdecode(arguments[0]), arguments[1]
        if isinstance(mode, str) and not set(mode) & set("wax+"):
            path = Path(os.path.realpath(name))
            if path.is_relative_to(self.folder) and path.suffix not in _CODE:
                self.files[path] = None
                self.latest = str(path.relative_to(self.folder))

    def __enter__(self) -> Inputs:
        return self

    def __exit__(self, *_: object) -> None:
        self._is_listening = False

    def describe(self, format_name: str, version: str) -> dict[str, Any]:
        """As it stands in `asset.extras`. What is opened to be hashed is among the files already."""
        files = [path for path in self.files if path.is_file()]
        hashes = {str(path.relative_to(self.folder)): _sha256(path) for path in files}
        return {"file": self.scene.name, "format": format_name, "version": version,
                "sha256": hashes[self.scene.resolve().name],
                "files": [{"name": name, "sha256": hashes[name]} for name in sorted(hashes)]}


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def format_of(scene: Path) -> str:
    """"Mitsuba" or "pbrt", by the file's ending, and by its content where that says nothing."""
    if scene.exists() and not scene.is_file():
        raise ImportProblem(f"{scene}: it is no file; a Mitsuba .xml or a .pbrt file would be right")
    try:
        with scene.open("rb") as file:
            head = file.read(_HEAD)
    except OSError as error:
        raise ImportProblem(f"{scene}: it cannot be read ({error.strerror}); a Mitsuba .xml or a .pbrt file would be right"
                            ) from error
    if ".pbrt" in scene.suffixes:
        return "pbrt"
    if scene.suffix == ".xml" or re.match(rb"(\xef\xbb\xbf)?\s*<", head):
        return "Mitsuba"
    if re.search(rb"^\s*(WorldBegin|LookAt|Camera|Film|Include|Integrator)\b", head, re.MULTILINE):
        return "pbrt"
    raise ImportProblem(f"{scene}: it is neither XML nor pbrt; a Mitsuba .xml or a .pbrt file would be right")
