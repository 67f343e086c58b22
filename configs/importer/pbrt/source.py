"""The text of a scene's files: found within the scene's folder, unpacked where they are gzip'd, of bounded size."""

from __future__ import annotations

import codecs
import zlib
from dataclasses import dataclass
from pathlib import Path

from importer.problems import ImportProblem

MOST_BYTES = 1 << 30  # of all the text that one scene reads: what is larger belongs into .ply files


@dataclass(frozen=True)
class Place:
    """Where something was said, for the sentence that an import ends with."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


class Folder:
    """A scene's folder. pbrt looks for every file relative to the main file's folder (fileformat-v4, Include)."""

    def __init__(self, main_file: Path) -> None:
        self.root = main_file.resolve().parent
        self._bytes_left = MOST_BYTES

    def find(self, name: str, where: str) -> Path:
        """An existing file within the folder: a scene is not to read what lies beside it on the reader's machine."""
        if not name or "\0" in name:
            raise ImportProblem(f"{where}: a file name is empty or holds a zero byte; it must name a file of the scene")
        path = Path(name)
        if path.is_absolute():
            raise ImportProblem(f"{where}: {name} is an absolute path; a path must be relative to the scene's folder")
        try:
            full = (self.root / path).resolve()
            exists = full.is_file()
        except (OSError, RuntimeError) as error:
            raise ImportProblem(f"{where}: {name} cannot be looked up ({error}); it must name a file") from error
        if not full.is_relative_to(self.root):
            raise ImportProblem(f"{where}: {name} leaves the scene's folder; a path must stay within it")
        if not exists:
            raise ImportProblem(f"{where}: {name} is missing; the file must stand in the scene's folder")
        return full

    def text(self, path: Path, where: str) -> str:
        try:
            raw = path.read_bytes()
        except OSError as error:
            raise ImportProblem(f"{where}: {path.name} cannot be read ({error.strerror}); it must be a text file") from error
        if raw[:2] == b"\x1f\x8b":
            raw = _unpacked(raw, self._bytes_left, f"{where}: {path.name}")
        self._bytes_left -= len(raw)
        if self._bytes_left < 0:
            raise ImportProblem(f"{where}: the scene's text is larger than {MOST_BYTES >> 20} MiB; large meshes belong"
                                " into .ply files")
        return raw.removeprefix(codecs.BOM_UTF8).decode("utf-8", errors="replace")


def _unpacked(raw: bytes, most: int, where: str) -> bytes:
    unpacker = zlib.decompressobj(wbits=31)
    try:
        text = unpacker.decompress(raw, most + 1)
    except zlib.error as error:
        raise ImportProblem(f"{where} is damaged ({error}); it must be a whole gzip file") from error
    if len(text) <= most and not unpacker.eof:
        raise ImportProblem(f"{where} ends too early; it must be a whole gzip file")
    return text
