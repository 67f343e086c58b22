"""Conductors against Fresnel's equations and published reflectances."""

from __future__ import annotations

import cmath
import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import gltf_model  # noqa: E402
from importer.materials import fresnel, metals, models  # noqa: E402
from importer.problems import ImportProblem, Notes  # noqa: E402
from importer.scene import BLACK, WHITE, Image, Texture  # noqa: E402

ALUMINIUM = ((1.65746, 0.880369, 0.521229), (9.22387, 6.26952, 4.837))


def exact(degrees: float, eta: float, k: float) -> float:
    """Fresnel's equations with Snell's law of a complex angle."""
    inside = cmath.asin(math.sin(math.radians(degrees)) / complex(eta, k))
    angle = math.radians(degrees)
    perpendicular = cmath.sin(angle - inside) / cmath.sin(angle + inside)
    parallel = cmath.tan(angle - inside) / cmath.tan(angle + inside)
    return 0.5 * (abs(perpendicular) ** 2 + abs(parallel) ** 2)


class Reflectance(unittest.TestCase):
    def test_straight_on(self) -> None:
        # (0.65746^2 + 9.22387^2) / (2.65746^2 + 9.22387^2) = 85.5120 / 92.1419.
        self.assertAlmostEqual(metals.f0(*ALUMINIUM)[0], 0.928047, delta=1e-6)
        self.assertAlmostEqual(metals.f0(WHITE, (2.0, 2.0, 2.0))[0], 0.5, delta=1e-12)

    def test_angles(self) -> None:
        for degrees in (1.0, 30.0, 60.0, 80.0, 89.0):
            for eta, k in ((0.2, 3.9), (1.65746, 9.22387), (4.37, 5.2), (1.5, 0.0)):
                found = float(fresnel.conductor(np.cos(np.radians(degrees)), eta, k))
                self.assertAlmostEqual(found, exact(degrees, eta, k), delta=1e-9)

    def test_pbrts_metals_have_the_published_colours(self) -> None:
        # Akenine-Moeller et al., Real-Time Rendering, 4th edition, table 9.2: linear F0.
        published = {"Au": (1.0, 0.782, 0.344), "Ag": (0.972, 0.960, 0.915), "Al": (0.913, 0.922, 0.924),
                     "Cu": (0.955, 0.638, 0.538)}
        for name, colour in published.items():
            for spelling in (f"metal-{name}-eta", f"metal-{name}-k", f"metal-{name}"):
                for value, expected in zip(metals.f0(*metals.named_metal(spelling)), colour):
                    self.assertAlmostEqual(value, expected, delta=1.5e-3, msg=name)

    def test_dielectrics_among_pbrts_metals(self) -> None:
        # Magnesium oxide has an index of 1.7377 at 589 nm: F0 of (0.7377 / 2.7377)^2.
        for value in metals.f0(*metals.named_metal("metal-MgO-eta")):
            self.assertAlmostEqual(value, 0.0726, delta=0.003)

    def test_names(self) -> None:
        self.assertEqual(metals.named_metal("Al"), metals.named_metal("al_palik"))
        self.assertNotEqual(metals.named_metal("Cu"), metals.named_metal("Cu_palik"))
        self.assertEqual(metals.f0(*metals.named_metal("none")), WHITE)
        with self.assertRaisesRegex(ImportProblem, "^ball: no indices are known of the conductor \"Xx\"; known are a-C, Ag"):
            metals.named_metal("Xx", "ball")
        with self.assertRaisesRegex(ImportProblem, "known are metal-Ag, metal-Al, metal-Au, metal-Cu, metal-CuZn"):
            metals.named_metal("metal-Fe-eta")

    def test_indices_of_a_reflectance(self) -> None:
        for value, expected in zip(metals.f0(*models.indices_of_reflectance((0.1, 0.5, 0.9))), (0.1, 0.5, 0.9)):
            self.assertAlmostEqual(value, expected, delta=1e-12)


class Conductors(unittest.TestCase):
    def setUp(self) -> None:
        self.notes = Notes()

    def make(self, factor: object, alpha: object = 0.25) -> object:
        return models.conductor("metal", *ALUMINIUM, factor, alpha, self.notes, "ball")

    def test_without_a_factor(self) -> None:
        made = self.make(WHITE)
        self.assertEqual((made.metallic, made.roughness, made.specular), (1.0, 0.5, 0.0))
        self.assertEqual(made.base_colour, metals.f0(*ALUMINIUM))
        self.assertEqual([row["what"] for row in self.notes.rows()],
                         ["a conductor's Fresnel reflectance by Schlick's curve, which is off by 0.2 at most, near grazing "
                          "angles"])

    def test_the_stated_distance_from_schlick_is_the_worst_one(self) -> None:
        worst = 0.0
        for eta, k in zip(*ALUMINIUM):
            f0 = exact(1e-4, eta, k)
            worst = max(worst, max(abs(exact(a, eta, k) - f0 - (1 - f0) * (1 - math.cos(math.radians(a))) ** 5)
                                   for a in np.arange(0.5, 89.5, 0.5)))
        self.assertTrue(0.1 < worst <= 0.2, worst)

    def test_a_grey_factor_scales_every_angle(self) -> None:
        whole, third = self.make(WHITE), self.make((0.3, 0.3, 0.3))
        for material, alpha in ((whole, 0.5), (third, 0.5)):
            self.assertEqual(material.roughness, alpha)
        for cosine in (1.0, 0.5, 0.1):
            for channel in range(3):
                self.assertAlmostEqual(gltf_model.reflectance(third, cosine, channel),
                                       0.3 * gltf_model.gloss_reflectance(whole, cosine, channel), delta=1e-9)
        self.assertFalse(any("coloured factor" in str(row["what"]) for row in self.notes.rows()))

    def test_a_coloured_factor_is_right_straight_on_and_noted(self) -> None:
        made = self.make((0.8, 0.4, 0.2), 0.0)
        for channel, factor in enumerate((0.8, 0.4, 0.2)):
            f0 = metals.f0(*ALUMINIUM)[channel]
            self.assertAlmostEqual(gltf_model.gloss_reflectance(made, 1.0, channel), factor * f0, delta=1e-9)
        self.assertTrue(any("coloured factor" in str(row["what"]) for row in self.notes.rows()))

    def test_a_checkerboard_of_greys_stays_as_it_is(self) -> None:
        checkers = Texture(Image("checkers", np.array([[[0.2] * 3, [0.8] * 3], [[0.8] * 3, [0.2] * 3]])), is_nearest=True)
        made = self.make(checkers)
        self.assertIs(made.specular, checkers)
        self.assertEqual((made.ior, made.base_colour, made.metallic), (0.0, BLACK, 0.0))
        self.assertEqual(made.specular_colour, metals.f0(*ALUMINIUM))

    def test_a_coloured_texture_becomes_strength_and_hue(self) -> None:
        texture = Texture(Image("paint", np.array([[[0.2, 0.4, 0.1], [0.0, 0.0, 0.0]]])), scale=(0.5, 0.5, 0.5))
        made = self.make(texture)
        strength = made.specular.image.pixels * np.array(made.specular.scale)
        hue = made.specular_colour.image.pixels * np.array(made.specular_colour.scale)
        np.testing.assert_allclose(strength[0, 0], [0.2] * 3)
        np.testing.assert_allclose(strength[0, 0] * hue[0, 0], np.array((0.1, 0.2, 0.05)) * metals.f0(*ALUMINIUM))
        np.testing.assert_allclose(strength[0, 1], 0.0)

    def test_pbrts_reflectance(self) -> None:
        made = models.conductor_of_reflectance("metal", (0.5, 0.6, 0.7), 0.0, self.notes, "ball")
        self.assertEqual((made.metallic, made.base_colour, made.roughness), (1.0, (0.5, 0.6, 0.7), 0.0))

    def test_mirrors(self) -> None:
        for made in (models.mirror("m", WHITE, self.notes, "m"), models.exact_mirror("m", WHITE, 0.0, self.notes, "m")):
            self.assertEqual([gltf_model.gloss_reflectance(made, c) for c in (1.0, 0.2)], [1.0, 1.0])
        grey = models.mirror("m", (0.9, 0.9, 0.9), self.notes, "m")
        for cosine in (1.0, 0.5, 0.05):
            self.assertAlmostEqual(gltf_model.reflectance(grey, cosine), 0.9, delta=1e-12)
        self.assertEqual(self.notes.rows(), [])

    def test_bad_numbers_are_one_sentence(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "^ball: k of a conductor is nan; a number from 0 to 1e.06 would be"):
            models.conductor("m", WHITE, (1.0, math.nan, 1.0), WHITE, 0.1, self.notes, "ball")
        with self.assertRaisesRegex(ImportProblem, "eta and k are both 0"):
            models.conductor("m", BLACK, BLACK, WHITE, 0.1, self.notes, "ball")
        with self.assertRaisesRegex(ImportProblem, "^ball: alpha is -0.1"):
            self.make(WHITE, -0.1)
        with self.assertRaisesRegex(ImportProblem, "negative or no number"):
            self.make((0.5, -0.5, 0.5))


if __name__ == "__main__":
    unittest.main()
