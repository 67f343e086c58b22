"""Tiny pbrt scenes for tests: text in a folder of their own, read by the front end."""

from __future__ import annotations

import io
import sys
import tempfile
from pathlib import Path
from typing import Mapping, Sequence

import numpy as np
from PIL import Image as Pillow

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "configs"))

from importer.pbrt.read import read_pbrt  # noqa: E402
from importer.problems import ImportProblem, Notes  # noqa: E402
from importer.scene import Material, Scene  # noqa: E402

HEAD = 'Camera "perspective"\nFilm "rgb"\n'
HEAD_V3 = 'Camera "perspective"\nFilm "image"\n'
TRIANGLE = 'Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0] "integer indices" [0 1 2]\n'


def read(text: str, files: Mapping[str, bytes | str] | None = None, is_lenient: bool = False) -> tuple[Scene, Notes]:
    """A whole scene file, beside which `files` stand."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "scene"
        folder.mkdir()
        (folder / "scene.pbrt").write_text(text, encoding="utf-8")
        for relative, content in (files or {}).items():
            path = folder / relative
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        notes = Notes(is_lenient)
        return read_pbrt(folder / "scene.pbrt", notes), notes


def world(text: str, head: str = HEAD, files: Mapping[str, bytes | str] | None = None,
          is_lenient: bool = False) -> tuple[Scene, Notes]:
    """What stands behind WorldBegin."""
    end = "WorldEnd\n" if head == HEAD_V3 else ""
    return read(f"{head}WorldBegin\n{text}\n{end}", files, is_lenient)


def problem(text: str, files: Mapping[str, bytes | str] | None = None) -> str:
    """The sentence with which the import of a whole file ends."""
    try:
        read(text, files)
    except ImportProblem as found:
        return str(found)
    raise AssertionError("the scene was read")


def world_problem(text: str, head: str = HEAD, files: Mapping[str, bytes | str] | None = None) -> str:
    return problem(f"{head}WorldBegin\n{text}\n", files)


def material(text: str, head: str = HEAD, files: Mapping[str, bytes | str] | None = None,
             is_lenient: bool = False) -> tuple[Material, list[str]]:
    """Of a triangle behind the statements, and what was noted."""
    scene, notes = world(text + "\n" + TRIANGLE, head, files, is_lenient)
    return scene.parts[0].material, said(notes)


def said(notes: Notes) -> list[str]:
    return [str(row["what"]) for row in notes.rows()]


def png(pixels: Sequence[Sequence[tuple[int, ...]]]) -> bytes:
    """Rows from the top."""
    array = np.array(pixels, np.uint8)
    file = io.BytesIO()
    Pillow.fromarray(array, "RGBA" if array.shape[2] == 4 else "RGB").save(file, "PNG")
    return file.getvalue()
