"""Files that a scene names: they lie in the scene's folder or below."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import Iterator, Sequence

from importer.problems import ImportProblem


class SceneFolder:
    """A scene is taken from others, thus nothing outside of its folder is opened, not by a link either."""

    def __init__(self, scene: Path) -> None:
        self.root = scene.resolve().parent

    def find(self, name: str, folders: Sequence[Path], where: str) -> Path:
        """The first of the folders that has it counts; the scene's own is the last."""
        path = self._found(name, folders, where)
        if not path or not path.is_file():
            raise ImportProblem(f"{where}: there is no file \"{name[:200]}\" in the scene's folder")
        return path

    def folder(self, name: str, folders: Sequence[Path], where: str) -> Path:
        path = self._found(name, folders, where)
        if not path or not path.is_dir():
            raise ImportProblem(f"{where}: there is no folder \"{name[:200]}\" in the scene's folder")
        return path

    @contextmanager
    def reading(self, where: str) -> Iterator[None]:
        """What a reader of meshes or images says of a file, together with the element that names the file."""
        try:
            yield
        except ImportProblem as problem:
            raise ImportProblem(f"{where}: {str(problem).replace(f'{self.root}/', '')}") from problem

    def _found(self, name: str, folders: Sequence[Path], where: str) -> Path | None:
        relative = name.strip().replace("\\", "/")  # scenes from Windows
        if not relative:
            raise ImportProblem(f"{where}: the name of a file is empty")
        if relative.startswith("/") or relative[1:2] == ":":
            raise ImportProblem(f"{where}: \"{name[:200]}\" is an absolute path; paths relative to the scene are read")
        leaves = False
        for folder in [*folders, self.root]:
            try:
                path = (folder / relative).resolve()
                leaves = leaves or not path.is_relative_to(self.root)
                if path.is_relative_to(self.root) and path.exists():
                    return path
            except (OSError, ValueError, RuntimeError) as error:
                raise ImportProblem(f"{where}: \"{name[:200]}\" cannot be opened ({error})") from error
        if leaves:
            raise ImportProblem(f"{where}: \"{name[:200]}\" leads out of the scene's folder, which an import does not do")
        return None
