"""Media of pbrt: what only takes up light within glass is the glass's; all others are refused."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_scene import HEAD, HEAD_V3, TRIANGLE, said, world, world_problem  # noqa: E402

ABSORBS = '"string type" "homogeneous" "rgb sigma_a" [ 1 2 4 ] "rgb sigma_s" [ 0 0 0 ]'
SCATTERS = ABSORBS.replace("[ 0 0 0 ]", "[ 0 .1 0 ]")
GLASS = {HEAD: "dielectric", HEAD_V3: "glass"}


def scene(medium: str, sides: str, material: str) -> str:
    return f'MakeNamedMedium "m" {medium}\nMediumInterface {sides}\nMaterial "{material}"\nShape "sphere"\n'


class MediaTest(unittest.TestCase):
    def test_media_that_only_absorb_are_the_glass(self) -> None:
        more, inside = ABSORBS + ' "float scale" 10', '"m" ""'
        for head, glass in GLASS.items():
            text = (f'AttributeBegin\n{scene(more, inside, glass)}Shape "disk"\nAttributeEnd\n'
                    f'Material "{glass}"\n{TRIANGLE}')
            found, notes = world(text, head)
            sphere, disk, triangle = (part.material for part in found.parts)
            np.testing.assert_allclose(np.log(sphere.attenuation_colour) / sphere.attenuation_distance, (-10, -20, -40))
            self.assertIs(sphere, disk)
            self.assertIsNone(triangle.attenuation_distance)
            self.assertNotIn("medi", " ".join(said(notes)))

    def test_others_are_refused(self) -> None:
        for medium, sides, material in ((SCATTERS, '"m" ""', "dielectric"), (ABSORBS, '"" "m"', "dielectric"),
                                        (ABSORBS, '"m"', "dielectric"), (ABSORBS, '"m" ""', "thindielectric"),
                                        (ABSORBS, '"m" ""', "diffuse"), ('"string type" "cloud"', '"m" ""', "dielectric"),
                                        ('"string type" "homogeneous"', '"m" ""', "dielectric"),
                                        (ABSORBS + ' "rgb Le" [ 1 1 1 ]', '"m" ""', "dielectric")):
            with self.subTest(medium=medium, sides=sides, material=material):
                text = scene(medium, sides, material)
                self.assertIn("a medium that scatters light, or is not within glass", world_problem(text))
                found, notes = world(text, is_lenient=True)
                self.assertIsNone(found.parts[0].material.attenuation_distance)
                self.assertIn("a medium that scatters light, or is not within glass (MediumInterface)", said(notes))


if __name__ == "__main__":
    unittest.main()
