"""What makes up scenes for the importer (./dev fuzz --only import): that it sees what is no right answer."""

from __future__ import annotations

import random
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

FUZZ = Path(__file__).resolve().parents[2] / "fuzz"
sys.path.insert(0, str(FUZZ))

import import_fuzz as fuzz  # noqa: E402
from import_mutations import Mutator  # noqa: E402
from import_seeds import seeds, words  # noqa: E402

SEEDS = seeds()


class FuzzTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def test_what_it_starts_from_is_read(self) -> None:
        for case in SEEDS:
            answer = fuzz.attempt(case, ["--lenient"], self.folder)
            self.assertEqual((answer.code, answer.problem, answer.err), (0, "", ""), list(case))

    def test_some_tries(self) -> None:
        mutator = Mutator(random.Random(7), words())
        for _ in range(40):
            case = mutator.changed(SEEDS)
            self.assertEqual(fuzz.attempt(case, [], self.folder).problem, "", case)

    def test_wrong_answers_are_seen(self) -> None:
        def memory(_: list[str]) -> int:
            return len(bytearray(b"x") * (2 * fuzz.MEMORY)) * 0

        def a_file_left(_: list[str]) -> int:
            Path("out.glb").write_bytes(b"")
            print("import: no", file=sys.stderr)
            return 1

        def forever(_: list[str]) -> int:
            while True:
                pass

        cases = ((lambda _: 1 // 0, "the code 2"), (memory, "MB"), (a_file_left, "has written files"),
                 (lambda _: 0, "cannot be read"), (lambda _: 1, "more than one line"), (forever, "more than 1 s"))
        for answer, said in cases:
            with (self.subTest(said), mock.patch.object(fuzz.command, "main", answer), mock.patch.object(fuzz, "MEMORY", 1 << 29),
                  mock.patch.object(fuzz, "CPU_SECONDS", 1 if answer is forever else fuzz.CPU_SECONDS)):
                self.assertIn(said, fuzz.attempt(SEEDS[-1], [], self.folder).problem)


if __name__ == "__main__":
    unittest.main()
