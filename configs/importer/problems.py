"""What an import says: one sentence where it cannot go on, and a list of what it changed."""

from __future__ import annotations

from collections import Counter


class ImportProblem(Exception):
    """One sentence that names the file, the element, what is wrong and what would be right."""


class Notes:
    """What the .glb says differently from its source, once each, with how often it was met and where first."""

    def __init__(self, is_lenient: bool = False) -> None:
        self.is_lenient = is_lenient
        self._counts: Counter[tuple[str, str]] = Counter()
        self._first: dict[tuple[str, str], str] = {}

    def approximated(self, what: str, where: str) -> None:
        """Something that is rendered in another way, such as "Beckmann's microfacets as GGX's"."""
        self._add("approximated", what, where)

    def left_out(self, what: str, where: str) -> None:
        """Something without an effect on radiance that matters here, or that has no counterpart, such as bump maps."""
        self._add("left out", what, where)

    def refuse(self, what: str, where: str) -> None:
        """Something without which the picture is another one: an end, or with --lenient a note."""
        if not self.is_lenient:
            raise ImportProblem(f"{where}: {what}, which has no meaning here; --lenient leaves it out")
        self._add("left out", what, where)

    def _add(self, kind: str, what: str, where: str) -> None:
        self._counts[kind, what] += 1
        self._first.setdefault((kind, what), where)

    def rows(self) -> list[dict[str, str | int]]:
        """As they stand in the file's `asset.extras` and in the terminal, in the order in which they were met."""
        return [{"kind": kind, "what": what, "count": count, "first": self._first[kind, what]}
                for (kind, what), count in self._counts.items()]
