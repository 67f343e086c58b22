"""Blends, masks, lamps, and what is matt."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.materials import models, parameters  # noqa: E402
from importer.problems import ImportProblem, Notes  # noqa: E402
from importer.scene import BLACK, WHITE, Image, Texture  # noqa: E402


def grey(*values: float) -> Texture:
    return Texture(Image("grey", np.array([[[v] * 3 for v in values]])))


def whats(notes: Notes) -> str:
    return "\n".join(str(row["what"]) for row in notes.rows())


class Blends(unittest.TestCase):
    def setUp(self) -> None:
        self.notes = Notes()
        self.red = models.diffuse("red", (0.8, 0.0, 0.0), self.notes, "w")
        self.blue = models.diffuse("blue", (0.0, 0.0, 0.4), self.notes, "w")

    def test_two_lamberts_are_exact(self) -> None:
        made = models.blended(self.red, self.blue, 0.25, self.notes, "w")
        np.testing.assert_allclose(made.base_colour, (0.6, 0.0, 0.1))
        self.assertEqual((made.specular, made.metallic, made.transmission, self.notes.rows()), (0.0, 0.0, 0.0, []))

    def test_a_texture_chooses_texel_by_texel(self) -> None:
        made = models.blended(self.red, self.blue, grey(0.0, 1.0), self.notes, "w")
        np.testing.assert_allclose(made.base_colour.image.pixels[0] * np.array(made.base_colour.scale),
                                   [(0.8, 0.0, 0.0), (0.0, 0.0, 0.4)], atol=1e-12)

    def test_all_or_nothing(self) -> None:
        metal = models.mirror("m", WHITE, self.notes, "w")
        self.assertIs(models.blended(self.red, metal, 0.0, self.notes, "w"), self.red)
        self.assertIs(models.blended(self.red, metal, 1.0, self.notes, "w"), metal)
        self.assertEqual(self.notes.rows(), [])

    def test_with_nothing_it_is_a_mask(self) -> None:
        self.assertEqual(models.blended(models.null("n"), self.red, 0.3, self.notes, "w").opacity, 0.3)
        made = models.blended(self.red, models.null("n"), grey(0.25, 1.0), self.notes, "w")
        np.testing.assert_allclose(made.opacity.image.pixels[0, :, 0], (0.75, 0.0))
        self.assertEqual((made.base_colour, self.notes.rows()), ((0.8, 0.0, 0.0), []))

    def test_other_pairs_are_noted(self) -> None:
        metal = models.conductor_of_reflectance("m", (0.9, 0.9, 0.9), 0.01, Notes(), "w")
        made = models.blended(self.red, metal, 0.5, self.notes, "w")
        self.assertEqual((made.metallic, made.roughness), (0.5, metal.roughness))
        np.testing.assert_allclose(made.base_colour, (0.85, 0.45, 0.45))
        self.assertIn("mean of their parameters", whats(self.notes))

    def test_bad_weights(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "^w: the weight of a blend is no number"):
            models.blended(self.red, self.blue, math.nan, self.notes, "w")


class MasksAndLamps(unittest.TestCase):
    def setUp(self) -> None:
        self.notes = Notes()
        self.matt = models.diffuse("matt", (0.5, 0.5, 0.5), self.notes, "w")

    def test_masks_multiply(self) -> None:
        half = models.masked(self.matt, 0.5, self.notes, "w")
        self.assertEqual(models.masked(half, 0.5, self.notes, "w").opacity, 0.25)
        made = models.masked(half, grey(0.2, 1.0), self.notes, "w").opacity
        np.testing.assert_allclose(parameters.texels(made)[0, :, 0], (0.1, 0.5))
        both = models.masked(models.masked(self.matt, grey(0.2, 1.0), self.notes, "w"), grey(0.5, 0.5), self.notes, "w")
        np.testing.assert_allclose(parameters.texels(both.opacity)[0, :, 0], (0.1, 0.5))
        self.assertEqual(models.masked(models.null("n"), grey(0.2, 1.0), self.notes, "w").opacity, 0.0)

    def test_a_lamp_keeps_its_material(self) -> None:
        lit = models.lamp(self.matt, (5.0, 4.0, 3.0), True, self.notes, "w")
        self.assertEqual((lit.radiance, lit.emits_both_sides, lit.base_colour), ((5.0, 4.0, 3.0), True, (0.5, 0.5, 0.5)))
        self.assertEqual((self.matt.radiance, self.notes.rows()), (BLACK, []))
        with self.assertRaisesRegex(ImportProblem, "^w: a radiance has a channel that is negative"):
            models.lamp(self.matt, (1.0, -1.0, 0.0), False, self.notes, "w")

    def test_a_lamp_on_nothing_is_seen(self) -> None:
        lit = models.lamp(models.null("n"), WHITE, False, self.notes, "w")
        self.assertEqual((lit.opacity, lit.base_colour), (1.0, BLACK))
        self.assertIn("opaque black", whats(self.notes))

    def test_matt_surfaces(self) -> None:
        self.assertEqual(models.rough_diffuse("m", WHITE, 0.0, self.notes, "w").specular, 0.0)
        self.assertEqual(self.notes.rows(), [])
        models.rough_diffuse("m", WHITE, 20.0, self.notes, "w")
        self.assertIn("Oren and Nayar", whats(self.notes))
        self.assertEqual(models.diffuse("m", (2.0, 0.5, 0.0), self.notes, "w").base_colour, (1.0, 0.5, 0.0))
        self.assertIn("above 1", whats(self.notes))
        with self.assertRaisesRegex(ImportProblem, "^w: the reflectance has a channel that is negative or no number"):
            models.diffuse("m", (math.nan, 0.5, 0.0), self.notes, "w")

    def test_diffuse_light_through_a_surface(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "^w: diffuse light through a surface, which has no meaning here"):
            models.diffuse_transmitter("m", WHITE, WHITE, self.notes, "w")
        lenient = Notes(is_lenient=True)
        self.assertEqual(models.diffuse_transmitter("m", (0.3,) * 3, WHITE, lenient, "w").base_colour, (0.3,) * 3)
        self.assertEqual(lenient.rows()[0]["kind"], "left out")


if __name__ == "__main__":
    unittest.main()
