"""What pages say that a machine can check: links, files that they name, the version, and the layers of the picture."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = [*(ROOT / "docs").glob("*.md"), ROOT / "CONTRIBUTING.md", ROOT / "README.md", ROOT / "analysis/README.md"]


class DocsTest(unittest.TestCase):
    def test_links_lead_somewhere(self) -> None:
        links = [(page, link) for page in PAGES for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", page.read_text())]
        self.assertGreater(len(links), 5)
        for page, link in links:
            if "://" not in link:
                self.assertTrue((page.parent / link).exists(), f"{page.name}: {link}")

    def test_named_files_are_there(self) -> None:
        """Of paths from the root in back quotes, such as `engine/core/settings.h`."""
        folders = "engine|experiments|shaders|tests|analysis|docs|configs"
        text = "".join((ROOT / name).read_text() for name in ("docs/architecture.md", "CONTRIBUTING.md"))
        named = re.findall(rf"`((?:{folders})/[\w./-]+)`", text)
        self.assertGreater(len(named), 20)
        for name in named:
            self.assertTrue((ROOT / name).exists(), name)

    def test_version(self) -> None:
        built = re.search(r"project\(qtrace VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertIn(f"\nversion: {built}\n", (ROOT / "CITATION.cff").read_text())

    def test_picture_has_the_layers(self) -> None:
        declared = re.search(r"kLayers\{([^}]*)\}", (ROOT / "tests/unit/layers_test.cpp").read_text())[1]
        drawn = re.findall(r'font-weight="bold">([\w/]+)</text><text', (ROOT / "docs/layers.svg").read_text())
        self.assertEqual(drawn[-1], "analysis")
        self.assertEqual([name for name in drawn if name not in ("layer", "analysis")],
                         re.findall(r'"([\w/]+)"', declared))


if __name__ == "__main__":
    unittest.main()
