"""Glass, thin walls and indices by name against Fresnel's equations."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.materials import fresnel, indices, models  # noqa: E402
from importer.problems import ImportProblem, Notes  # noqa: E402
from importer.scene import BLACK, WHITE  # noqa: E402


def exact(degrees: float, eta: float) -> float:
    """By the angles of Snell's law."""
    outside = math.radians(degrees)
    inside = math.asin(math.sin(outside) / eta)
    return 0.5 * ((math.sin(outside - inside) / math.sin(outside + inside)) ** 2
                  + (math.tan(outside - inside) / math.tan(outside + inside)) ** 2)


class Fresnel(unittest.TestCase):
    def test_angles(self) -> None:
        for eta in (1.33, 1.5, 2.419):
            for degrees in (1.0, 40.0, 75.0, 89.0):
                self.assertAlmostEqual(float(fresnel.dielectric(np.cos(np.radians(degrees)), eta)), exact(degrees, eta),
                                       delta=1e-9)

    def test_brewsters_angle_reflects_half_of_the_perpendicular_part(self) -> None:
        # At tan = 1.5: rp = 0 and rs = (1 - n^2) / (1 + n^2) = -1.25 / 3.25.
        found = float(fresnel.dielectric(np.cos(np.arctan(1.5)), 1.5))
        self.assertAlmostEqual(found, 0.5 * (1.25 / 3.25) ** 2, delta=1e-12)

    def test_from_within(self) -> None:
        # Beyond 41.81 degrees all is reflected; before it as much as outside at the refracted angle.
        self.assertEqual(float(fresnel.dielectric(np.cos(np.radians(41.9)), 1 / 1.5)), 1.0)
        inside = math.asin(math.sin(math.radians(60.0)) / 1.5)
        self.assertAlmostEqual(float(fresnel.dielectric(np.cos(inside), 1 / 1.5)), exact(60.0, 1.5), delta=1e-12)

    def test_averages(self) -> None:
        # 0.0918 outside and 0.5963 inside for 1.5 (d'Eon and Irving 2011, appendix).
        self.assertAlmostEqual(fresnel.average(1.5), 0.0918, delta=5e-5)
        self.assertAlmostEqual(fresnel.average(1 / 1.5), 0.5963, delta=5e-5)
        cosines = (np.arange(200000) + 0.5) / 200000
        for eta in (1.33, 2.4, 1 / 1.33):
            mean = float((2 * cosines * fresnel.dielectric(cosines, eta)).mean())
            self.assertAlmostEqual(fresnel.average(eta), mean, delta=1e-5)
        self.assertAlmostEqual(fresnel.schlick_average(0.04), float((2 * cosines * fresnel.schlick(cosines, 0.04)).mean()),
                               delta=1e-9)


class Bodies(unittest.TestCase):
    def setUp(self) -> None:
        self.notes = Notes()

    def make(self, int_ior: float, ext_ior: float, alpha: float = 0.0, reflectance: tuple = WHITE,
             transmittance: tuple = WHITE) -> object:
        return models.dielectric("glass", int_ior, ext_ior, alpha, reflectance, transmittance, self.notes, "vase")

    def test_glass(self) -> None:
        made = self.make(1.5, 1.0, 0.04, transmittance=(0.9, 0.8, 0.7))
        self.assertEqual((made.ior, made.transmission, made.is_thin, made.specular), (1.5, 1.0, False, 1.0))
        self.assertEqual(made.base_colour, (0.9, 0.8, 0.7))
        self.assertAlmostEqual(made.roughness, 0.2, delta=1e-12)
        self.assertFalse(models.is_inward(made))
        self.assertEqual([row["what"] for row in self.notes.rows()],
                         ["Fresnel's reflectance of glass by Schlick's curve, which is off by 0.05 at most, near grazing "
                          "angles"])
        worst = max(abs(exact(a, 1.5) - 0.04 - 0.96 * (1 - math.cos(math.radians(a))) ** 5)
                    for a in np.arange(0.5, 89.5, 0.5))
        self.assertTrue(0.02 < worst <= 0.05, worst)

    def test_a_bubble_is_turned_inside_out(self) -> None:
        made = self.make(1.0, 1.5)
        self.assertTrue(models.is_inward(made))
        self.assertAlmostEqual(made.ior, 1.5, delta=1e-12)
        lit = models.lamp(models.masked(made, 0.5, self.notes, "b"), (1.0, 1.0, 1.0), False, self.notes, "b")
        self.assertTrue(models.is_inward(lit))

    def test_only_the_ratio_counts(self) -> None:
        self.assertAlmostEqual(self.make(2.0, 1.6).ior, 1.25, delta=1e-12)

    def test_no_interface_bends_and_reflects_nothing(self) -> None:
        made = self.make(1.33, 1.33, 0.3)
        self.assertEqual((made.ior, made.is_thin, made.transmission), (1.0, True, 1.0))
        self.assertEqual((made.roughness, made.specular), (0.0, 0.0))
        self.assertEqual(self.notes.rows(), [])

    def test_what_is_left_of_light_within(self) -> None:
        """exp(-absorption * length), whatever the length that glTF has it for; a wall without a body takes up nothing."""
        glass = models.dielectric("g", 1.5, 1.0, 0.0, WHITE, WHITE, Notes(), "here")
        found = models.absorbing(glass, (250.0, 1000.0, 0.0), "here")
        for length in (1e-4, 2e-3):
            left = np.array(found.attenuation_colour) ** (length / found.attenuation_distance)
            np.testing.assert_allclose(left, np.exp(-length * np.array((250.0, 1000.0, 0.0))), rtol=1e-12)
        self.assertIs(models.absorbing(glass, (0.0, 0.0, 0.0), "here"), glass)
        with self.assertRaisesRegex(ImportProblem, "^here: what a medium absorbs on a unit of length is 1e"):
            models.absorbing(glass, (1e300, 0.0, 0.0), "here")
        bubble = models.dielectric("b", 1.0, 1.5, 0.0, WHITE, WHITE, Notes(), "here")
        pane = models.thin_dielectric("p", 1.5, 1.0, WHITE, WHITE, Notes(), "here")
        grey = models.diffuse("d", WHITE, Notes(), "here")
        self.assertEqual([models.can_absorb(one) for one in (glass, bubble, pane, grey)], [True, False, False, False])

    def test_a_factor_of_what_is_reflected_is_noted(self) -> None:
        made = self.make(1.5, 1.0, reflectance=BLACK)
        self.assertEqual(made.specular, 0.0)
        self.assertTrue(any("factor of what glass reflects" in str(row["what"]) for row in self.notes.rows()))

    def test_bad_indices(self) -> None:
        for index in (0.0, -1.5, math.nan, math.inf):
            with self.assertRaisesRegex(ImportProblem, "^vase: an index of refraction is"):
                self.make(index, 1.0)


class Walls(unittest.TestCase):
    def test_both_faces_together(self) -> None:
        # R + T R T + T R^3 T ... with R = 0.04 is 0.0769231.
        series = 0.04 + sum(0.96 ** 2 * 0.04 ** (2 * n + 1) for n in range(20))
        made = models.thin_dielectric("pane", 1.5, 1.0, WHITE, WHITE, Notes(), "w")
        self.assertAlmostEqual(((made.ior - 1) / (made.ior + 1)) ** 2, series, delta=1e-9)
        self.assertEqual((made.transmission, made.is_thin, made.roughness), (1.0, True, 0.0))

    def test_the_rarer_side_does_not_matter(self) -> None:
        notes = Notes()
        a, b = (models.thin_dielectric("pane", *pair, WHITE, WHITE, notes, "w").ior for pair in ((1.5, 1.0), (1.0, 1.5)))
        self.assertAlmostEqual(a, b, delta=1e-12)


class Names(unittest.TestCase):
    def test_mitsuba_and_pbrt(self) -> None:
        notes = Notes()
        self.assertEqual(indices.named_index("Water", notes, "w"), 1.333)
        self.assertEqual(indices.named_index("bk7", notes, "w"), 1.5046)
        self.assertEqual(notes.rows(), [])
        # Schott's data sheets: nD of N-BK7 and SF11.
        self.assertAlmostEqual(indices.named_index("glass-BK7", notes, "w"), 1.51673, delta=1e-4)
        self.assertAlmostEqual(indices.named_index("glass-F11", notes, "w"), 1.78446, delta=2e-4)
        self.assertEqual(notes.rows()[0]["count"], 2)
        with self.assertRaisesRegex(ImportProblem, "^w: no index of refraction is named \"jelly\"; known are vacuum"):
            indices.named_index("jelly", notes, "w")


if __name__ == "__main__":
    unittest.main()
