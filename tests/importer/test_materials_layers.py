"""Coats, Burley's materials, blends, masks, lamps, roughness and textures as parameters."""

from __future__ import annotations

import math
import sys
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parent))

import gltf_model  # noqa: E402
from importer.materials import models, parameters, roughness  # noqa: E402
from importer.problems import ImportProblem, Notes  # noqa: E402
from importer.scene import BLACK, WHITE, Image, Material, Texture  # noqa: E402


def grey(*values: float) -> Texture:
    return Texture(Image("grey", np.array([[[v] * 3 for v in values]])))


def whats(notes: Notes) -> str:
    return "\n".join(str(row["what"]) for row in notes.rows())


class Roughness(unittest.TestCase):
    def test_mitsuba(self) -> None:
        self.assertEqual(roughness.mitsuba_roughness(0.25), 0.5)
        made = roughness.mitsuba_roughness(grey(0.04, 0.36))
        np.testing.assert_allclose(made.image.pixels[0, :, 1], (0.2, 0.6))

    def test_pbrt(self) -> None:
        # v4: alpha = sqrt(0.0625) = 0.25. v3, with x = ln 0.1 = -2.302585:
        # 1.62142 - 0.819955 * 2.302585 + 0.1734 * 5.301898 - 0.0171201 * 12.20807 + 0.000640711 * 28.11013 = 0.461761.
        self.assertEqual(roughness.pbrt_roughness(0.0625, True, 4), 0.5)
        self.assertEqual(roughness.pbrt_roughness(0.0625, False, 4), 0.25)
        self.assertAlmostEqual(roughness.pbrt_roughness(0.1, True, 3), math.sqrt(0.461761), delta=1e-5)
        self.assertEqual(roughness.pbrt_roughness(0.0, True, 3), 0.0)
        self.assertEqual(roughness.pbrt_roughness(0.25, False, 3), 0.5)

    def test_more_than_all_is_noted(self) -> None:
        notes = Notes()
        self.assertEqual(models.mirror("m", WHITE, notes, "w", 4.0).roughness, 1.0)
        self.assertIn("an alpha above 1", whats(notes))

    def test_anisotropy(self) -> None:
        notes = Notes()
        self.assertEqual(roughness.isotropic_alpha(0.3, 0.3, notes, "w"), 0.3)
        self.assertEqual(notes.rows(), [])
        self.assertAlmostEqual(roughness.isotropic_alpha(0.1, 0.4, notes, "w"), 0.2, delta=1e-12)
        self.assertIn("anisotropic", whats(notes))

    def test_distributions(self) -> None:
        self.assertEqual(roughness.phong_alpha(30.0), 0.25)
        notes = Notes()
        roughness.note_distribution("beckmann", notes, "w")
        self.assertIn("Beckmann", whats(notes))
        with self.assertRaisesRegex(ImportProblem, "^w: the distribution \"ward\" is none of"):
            roughness.note_distribution("ward", notes, "w")


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


class Parameters(unittest.TestCase):
    def test_statistics_of_bytes_and_of_numbers(self) -> None:
        random = np.random.default_rng(3)
        texels = random.integers(0, 256, (7, 5, 4), dtype=np.uint8)
        linear = np.where(texels[..., :3] / 255 <= 0.04045, texels[..., :3] / 255 / 12.92,
                          ((texels[..., :3] / 255 + 0.055) / 1.055) ** 2.4)
        for image in (Image("bytes", texels), Image("numbers", linear)):
            found = parameters.mean_rgb(Texture(image, scale=(2.0, 1.0, 0.5)))
            np.testing.assert_allclose(found, linear.mean(axis=(0, 1)) * (2.0, 1.0, 0.5))
            self.assertAlmostEqual(parameters.greatest(Texture(image)), linear.max(), delta=1e-12)
            self.assertFalse(parameters.is_grey(Texture(image)))
        self.assertTrue(parameters.is_grey(Texture(Image("grey", np.repeat(texels[..., :1], 3, axis=2)))))

    def test_what_is_above_1_goes_into_the_scale(self) -> None:
        made = parameters.map_colour(grey(0.5, 1.0), lambda rgb: rgb * 4.0)
        np.testing.assert_allclose(made.image.pixels[0, :, 0], (0.5, 1.0))
        self.assertEqual(made.scale, (4.0, 4.0, 4.0))

    def test_one_image_with_two_scales_is_mapped_twice(self) -> None:
        texture = grey(0.25, 1.0)
        made = [parameters.map_colour(t, np.sqrt, "root") for t in (texture, parameters.scaled(texture, 0.25), texture)]
        self.assertEqual([float(parameters.texels(t)[0, 0, 0]) for t in made], [0.5, 0.25, 0.5])

    def test_large_images_of_bytes_stay_bytes(self) -> None:
        image = Image("large", np.full((3, 5, 3), 100, dtype=np.uint8))
        with unittest.mock.patch.multiple(parameters, _LARGE=14, _STRIP=5):
            made = parameters.map_colour(Texture(image), lambda rgb: rgb * 0.5)
        self.assertEqual(made.image.pixels.dtype, np.uint8)
        # 100 of 255 is ((0.392157 + 0.055) / 1.055)^2.4 = 0.12744 linear; its half is 71.4 of 255.
        self.assertEqual(set(np.unique(made.image.pixels)), {71})

    def test_two_parameters(self) -> None:
        self.assertEqual(parameters.combine_colours((1.0, 2.0, 3.0), WHITE, np.add), (2.0, 3.0, 4.0))
        made = parameters.combine_colours(grey(0.5, 1.0), (0.8, 1.0, 2.0), np.multiply)
        np.testing.assert_allclose(parameters.texels(made)[0], [(0.4, 0.5, 1.0), (0.8, 1.0, 2.0)])


if __name__ == "__main__":
    unittest.main()
