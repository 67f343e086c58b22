"""docs/importing.md names what the readers know, and nothing else."""

from __future__ import annotations

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "configs"))

from importer.mitsuba import camera as mitsuba_camera
from importer.mitsuba import colours, integrator, parts
from importer.mitsuba import lights as mitsuba_lights
from importer.mitsuba import materials as mitsuba_materials
from importer.mitsuba import shapes as mitsuba_shapes
from importer.mitsuba import textures as mitsuba_textures
from importer.pbrt import camera as pbrt_camera
from importer.pbrt import film, materials_v3, materials_v4, options
from importer.pbrt import lights as pbrt_lights
from importer.pbrt import materials as pbrt_materials
from importer.pbrt import shapes as pbrt_shapes
from importer.pbrt import textures as pbrt_textures

# What a reader's own table does not hold, as a dispatch within a function does.
PBRT_SHAPES = ("trianglemesh", "plymesh", "bilinearmesh", "sphere", "disk", "cylinder")
PBRT_TEXTURES = ("imagemap", "constant", "scale", "mix", "checkerboard")
PBRT_LIGHTS = ("diffuse", "point", "spot", "distant", "infinite")
KNOWN = {
    "Mitsuba": {
        "shapes": (*mitsuba_shapes.FILES, *mitsuba_shapes.ANALYTIC, *parts.GROUPS, *mitsuba_shapes.NO_COUNTERPART),
        "materials": (*mitsuba_materials.BSDFS, *mitsuba_materials.NO_COUNTERPART),
        "textures": (*mitsuba_textures.TEXTURES, *mitsuba_textures._WITHOUT_COUNTERPART),
        "colours": colours.SPECTRA,
        "lights": (*mitsuba_lights.EMITTERS, *mitsuba_lights._NO_COUNTERPART),
        "cameras": mitsuba_camera.SENSORS,
        "integrators": (*integrator.INTEGRATORS, *integrator._AROUND),
    },
    "pbrt": {
        "shapes": (*PBRT_SHAPES, *pbrt_shapes._REFUSED),
        "materials of v4": (*materials_v4.MAKERS, *materials_v4.REFUSED, "interface"),
        "materials of v3": (*materials_v3.MAKERS, *materials_v3.REFUSED, "none"),
        "textures": (*PBRT_TEXTURES, *pbrt_textures._PATTERNS),
        "lights": (*PBRT_LIGHTS, *pbrt_lights._REFUSED),
        "cameras": ("perspective", "orthographic", *pbrt_camera._REFUSED),
        "films": (*film.FILMS[3], *film.FILMS[4]),
        "integrators": (*options._INTEGRATORS, *options._OTHERS),
    },
}


def named(section: str) -> dict[str, set[str]]:
    """The names in the second column, by the last bold word of the first."""
    found: dict[str, set[str]] = {}
    kind = ""
    for first, second in re.findall(r"(?m)^\| *([^|]*?) *\| *([^|]*?) *\|", section):
        kind = first.strip("*") or kind
        found.setdefault(kind, set()).update(re.findall(r"`([^`]+)`", second))
    return found


class PageTest(unittest.TestCase):
    def test_names(self) -> None:
        page = (ROOT / "docs/importing.md").read_text()
        for title, kinds in KNOWN.items():
            section = page.split(f"\n## {title}\n")[1].split("\n## ")[0]
            on_page = named(section)
            for kind, names in kinds.items():
                with self.subTest(f"{title}, {kind}"):
                    self.assertEqual(on_page[kind], set(names))

    def test_dispatches(self) -> None:
        """The names above that are written out stand in the readers' own messages."""
        for module, names in ((pbrt_shapes, PBRT_SHAPES), (pbrt_textures, PBRT_TEXTURES), (pbrt_lights, PBRT_LIGHTS[1:])):
            source = Path(module.__file__).read_text()
            for name in names:
                self.assertRegex(source, rf"\b{name}\b")
        self.assertLessEqual({"none", "interface"}, set(pbrt_materials._INVISIBLE))


if __name__ == "__main__":
    unittest.main()
