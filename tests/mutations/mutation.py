"""A deliberate error."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutation:
    """`find` must stand exactly once in the file, so that lists of errors cannot rot."""

    name: str
    file: str  # below shaders/, or below the root where it begins with engine/, experiments/ or configs/
    find: str
    replace: str

    @property
    def path(self) -> str:
        """From the root."""
        return self.file if self.file.startswith(("engine/", "experiments/", "configs/")) else f"shaders/{self.file}"
