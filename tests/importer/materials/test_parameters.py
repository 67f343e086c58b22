"""Roughness, and textures as parameters."""

from __future__ import annotations

import sys
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.materials import models, parameters, roughness  # noqa: E402
from importer.problems import ImportProblem, Notes  # noqa: E402
from importer.scene import WHITE, Image, Texture  # noqa: E402


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
        self.assertEqual(roughness.pbrt_alpha(0.0625, True, 4), 0.25)
        self.assertEqual(roughness.pbrt_alpha(0.0625, False, 4), 0.0625)
        self.assertAlmostEqual(roughness.pbrt_alpha(0.1, True, 3), 0.461761, delta=1e-5)
        # With x = ln 0.001 = -6.907755: 1.62142 - 5.664048 + 8.274142 - 5.643087 + 1.458847.
        for least in (0.0, 1e-9, 1e-3):
            self.assertAlmostEqual(roughness.pbrt_alpha(least, True, 3), 0.04727, delta=2e-5)
        self.assertEqual(roughness.pbrt_alpha(0.25, False, 3), 0.25)

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
