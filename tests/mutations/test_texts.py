"""The lists of edits fit the sources: what each replaces stands there exactly once. Trying them takes minutes each; this
tells at once when a source has moved on."""

import unittest

from importer import IMPORTER_MUTATIONS
from light_paths import LIGHT_PATH_MUTATIONS
from mutations import MUTATIONS
from protections import PROTECTIONS
from tree import ROOT, Edit


class TextsTest(unittest.TestCase):
    def check(self, name: str, edit: Edit) -> None:
        with self.subTest(name):
            text = (ROOT / edit.file).read_text(encoding="utf-8")
            self.assertEqual(text.count(edit.find), 1, f"{edit.file}: {edit.find!r}")
            self.assertNotEqual(edit.find, edit.replace)

    def test_mutations(self) -> None:
        mutations = [*MUTATIONS, *LIGHT_PATH_MUTATIONS, *IMPORTER_MUTATIONS]
        self.assertEqual(len({m.name for m in mutations}), len(mutations))
        for m in mutations:
            self.check(m.name, Edit(m.path, m.find, m.replace))

    def test_protections(self) -> None:
        for protection in PROTECTIONS:
            for edit in protection.edits:
                self.check(protection.name, edit)


if __name__ == "__main__":
    unittest.main()
