"""Coats and Burley's materials."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import gltf_model  # noqa: E402
from importer.materials import models  # noqa: E402
from importer.problems import ImportProblem, Notes  # noqa: E402
from importer.scene import BLACK, WHITE, Material  # noqa: E402


def whats(notes: Notes) -> str:
    return "\n".join(str(row["what"]) for row in notes.rows())


class Coats(unittest.TestCase):
    def coat(self, material: Material, ior: float = 1.5, specular: tuple = WHITE, thickness: float = 1.0,
             sigma_a: tuple = BLACK, notes: Notes | None = None) -> Material:
        return models.coated(material, ior, 0.0, specular, thickness, sigma_a, notes or Notes(), "w")

    def test_mitsubas_coat_over_a_diffuse_surface(self) -> None:
        # Its lobe is rho T(v) T(l) / (pi eta^2), which sends 0.90822^2 / 2.25 rho = 0.36661 rho in all; the coat 0.0918.
        made = self.coat(models.diffuse("d", (0.5,) * 3, Notes(), "w"))
        self.assertEqual((made.clearcoat, made.clearcoat_roughness), (1.0, 0.0))
        coat = gltf_model.in_all(lambda c: 0.04 + 0.96 * (1 - c) ** 5)
        self.assertAlmostEqual(gltf_model.in_all(gltf_model.reflectance, made) - coat, 0.36661 * 0.5, delta=1e-3)

    def test_over_a_metal_straight_on(self) -> None:
        metal = Material("m", base_colour=(0.9, 0.6, 0.3), metallic=1.0, roughness=0.0)
        made = self.coat(metal)
        for channel, f0 in enumerate((0.9, 0.6, 0.3)):
            self.assertAlmostEqual(gltf_model.reflectance(made, 1.0, channel), 0.04 + 0.96 ** 2 * f0, delta=1e-9)

    def test_over_plastic_both_lobes_have_their_own_factor(self) -> None:
        plastic = Material("p", base_colour=(0.5,) * 3, specular=1.0, roughness=0.0)
        made = self.coat(plastic)
        self.assertAlmostEqual(gltf_model.gloss_reflectance(made, 1.0), 0.96 * 0.04, delta=1e-9)
        coat = gltf_model.in_all(lambda c: 0.04 + 0.96 * (1 - c) ** 5)
        self.assertAlmostEqual(made.base_colour[0], 0.36661 / (1 - coat) * 0.5, delta=1e-4)

    def test_over_a_factored_mirror(self) -> None:
        made = self.coat(models.mirror("m", (0.5,) * 3, Notes(), "w"))
        self.assertAlmostEqual(gltf_model.reflectance(made, 1.0), 0.04 + 0.96 ** 2 * 0.5, delta=1e-9)

    def test_other_indices_and_factors(self) -> None:
        notes = Notes()
        made = self.coat(models.diffuse("d", BLACK, Notes(), "w"), 1.3, (0.5,) * 3, notes=notes)
        self.assertAlmostEqual(gltf_model.reflectance(made, 1.0), 0.5 * (0.3 / 2.3) ** 2, delta=1e-9)
        self.assertIn("another index than 1.5", whats(notes))
        self.assertEqual(self.coat(models.diffuse("d", BLACK, Notes(), "w"), 2.0).clearcoat, 1.0)

    def test_bad_numbers_are_one_sentence(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "^w: the index of a coat is 0.5; a number from 1 to 1000 would be right"):
            self.coat(models.diffuse("d", BLACK, Notes(), "w"), 0.5)
        with self.assertRaisesRegex(ImportProblem, "^w: Kr has a channel that is negative"):
            models.uber("u", BLACK, BLACK, (0.5, -0.5, 0.5), BLACK, 1.5, 0.1, WHITE, Notes(), "w")

    def test_absorption(self) -> None:
        notes = Notes()
        metal = Material("m", base_colour=(0.5, 0.5, 0.5), metallic=1.0, roughness=0.0)
        made = self.coat(metal, thickness=0.5, sigma_a=(1.0, 0.0, 0.0), notes=notes)
        clear = self.coat(metal)
        self.assertAlmostEqual(made.base_colour[0] / clear.base_colour[0], math.exp(-1.0), delta=1e-9)
        self.assertAlmostEqual(made.base_colour[1], clear.base_colour[1], delta=1e-12)
        self.assertIn("absorbs", whats(notes))

    def test_absorption_over_a_diffuse_surface(self) -> None:
        # Each way the mean of exp(-0.5 / cos') over the cosines inside, 2 cos d(cos) outside.
        matt = models.diffuse("d", (0.5,) * 3, Notes(), "w")
        cosines = (np.arange(10000) + 0.5) / 10000
        once = (2 * cosines * np.exp(-0.5 / np.sqrt(1 - (1 - cosines ** 2) / 2.25))).mean()
        made, clear = self.coat(matt, thickness=0.5, sigma_a=WHITE), self.coat(matt)
        self.assertAlmostEqual(made.base_colour[0] / clear.base_colour[0], once ** 2, delta=1e-5)

    def test_pbrts_coated_conductor_straight_on(self) -> None:
        # All reflections between coat and metal: R + T^2 a^2 Rc (1 + R Rc a^2 + ...); a smooth metal within the coat.
        eta, k = (0.2, 0.9, 1.1), (3.9, 2.5, 2.2)
        made = models.coated_conductor("c", 1.5, 0.0, 0.1, BLACK, eta, k, 0.0, Notes(), "w")
        for channel in range(3):
            n, absorption = eta[channel] / 1.5, k[channel] / 1.5
            metal = ((n - 1) ** 2 + absorption ** 2) / ((n + 1) ** 2 + absorption ** 2)
            a2 = math.exp(-0.2)
            series = 0.04 + sum(0.96 ** 2 * a2 * metal * (0.04 * metal * a2) ** i for i in range(30))
            self.assertAlmostEqual(gltf_model.reflectance(made, 1.0, channel), series, delta=1e-9)


class Burley(unittest.TestCase):
    def test_what_goes_over_as_it_is(self) -> None:
        notes = Notes()
        made = models.principled("p", (0.5, 0.4, 0.3), notes, "w", metallic=0.25, roughness=0.3, eta=1.4)
        self.assertEqual((made.metallic, made.roughness, made.ior, made.specular), (0.25, 0.3, 1.4, 1.0))
        self.assertEqual((made.base_colour, made.specular_colour, made.clearcoat), ((0.5, 0.4, 0.3), WHITE, 0.0))

    def test_specular_is_an_index(self) -> None:
        # 0.5 is F0 = 0.04.
        self.assertAlmostEqual(models.index_of_specular(0.5), 1.5, delta=1e-12)
        self.assertEqual(models.principled("p", WHITE, Notes(), "w", eta=models.index_of_specular(0.0)).specular, 0.0)
        with self.assertRaisesRegex(ImportProblem, "^a principled material: specular is 50; a number from 0 to 10"):
            models.index_of_specular(50.0)

    def test_clearcoat_is_a_quarter(self) -> None:
        made = models.principled("p", WHITE, Notes(), "w", clearcoat=0.8, clearcoat_gloss=1.0)
        self.assertAlmostEqual(made.clearcoat, 0.2, delta=1e-12)
        self.assertAlmostEqual(made.clearcoat_roughness ** 2, 0.001, delta=1e-12)

    def test_glass_takes_the_root_of_its_colour_at_each_face(self) -> None:
        made = models.principled("p", (0.81, 0.25, 0.0), Notes(), "w", spec_trans=1.0, roughness=0.0)
        np.testing.assert_allclose(made.base_colour, (0.9, 0.5, 0.0))
        self.assertEqual((made.transmission, made.is_thin), (1.0, False))
        self.assertTrue(models.principled("p", WHITE, Notes(), "w", spec_trans=1.0, is_thin=True).is_thin)

    def test_a_full_tint_is_the_hue(self) -> None:
        made = models.principled("p", (0.4, 0.0, 0.0), Notes(), "w", spec_tint=1.0)
        np.testing.assert_allclose(made.specular_colour, (1 / 0.212671, 0.0, 0.0))

    def test_what_is_left_out_is_named(self) -> None:
        notes = Notes()
        models.principled("p", WHITE, notes, "w", anisotropic=0.5, sheen=1.0, flatness=0.1)
        for word in ("anisotropy", "sheen", "flatness"):
            self.assertIn(word, whats(notes))
        with self.assertRaisesRegex(ImportProblem, "^w: diffuse light through a surface"):
            models.principled("p", WHITE, notes, "w", diff_trans=1.0)


if __name__ == "__main__":
    unittest.main()
