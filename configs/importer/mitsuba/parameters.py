"""$parameters in attributes: values from the command line go before those of <default>."""

from __future__ import annotations

import re

from importer.problems import ImportProblem

_MAX_LENGTH = 1_000_000  # of an attribute; defaults made of defaults would double at each step


class Parameters:
    def __init__(self, given: dict[str, str]) -> None:
        self._values = dict(given)
        self._unused = set(given)
        self._pattern: re.Pattern[str] | None = None

    def default(self, name: str, value: str, where: str) -> None:
        """The first value of a name counts (SceneHandler::endElement, EDefault)."""
        if not name:
            raise ImportProblem(f"{where}: <default> needs a name")
        if name not in self._values:
            self._values[name] = value
            self._pattern = None

    def apply(self, text: str, where: str) -> str:
        """The longest name that fits counts, and what is put in is not read again; \\$ is a dollar sign."""
        if "$" not in text:
            return text
        if self._pattern is None:
            names = sorted(self._values, key=len, reverse=True)
            self._pattern = re.compile("|".join([r"\\\$", *(r"\$" + re.escape(name) for name in names)]))
        length = 0

        def value(match: re.Match[str]) -> str:
            nonlocal length
            if match[0] == "\\$":
                return "\\$"
            length += len(self._values[match[0][1:]])
            if length > _MAX_LENGTH:
                raise ImportProblem(f"{where}: its parameters grow beyond {_MAX_LENGTH} characters")
            self._unused.discard(match[0][1:])
            return self._values[match[0][1:]]

        result = self._pattern.sub(value, text)
        if unknown := re.search(r"(?<!\\)\$(\w*)", result):
            raise ImportProblem(f"{where}: ${unknown[1][:40]} has no value; give it with --define {unknown[1][:40]}=VALUE")
        return result.replace("\\$", "$")

    def check_all_used(self, scene: str) -> None:
        if self._unused:
            raise ImportProblem(f"{scene}: has no parameter ${sorted(self._unused)[0]}; --define sets those of the scene")
