"""Dielectrics over diffuse surfaces: the source's models integrated or simulated on their own, against glTF's model
integrated on its own."""

from __future__ import annotations

import functools
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import gltf_model  # noqa: E402
from gltf_model import COSINE, LIGHT, SOLID_ANGLE, ggx, view_of  # noqa: E402
from importer.materials import lobes, models  # noqa: E402
from importer.problems import ImportProblem, Notes  # noqa: E402
from importer.scene import BLACK, WHITE, Image, Material, Texture  # noqa: E402


def fresnel(cosine: np.ndarray, eta: float) -> np.ndarray:
    """The two amplitudes in their textbook form; 1 beyond the critical angle."""
    sine2 = (1 - cosine ** 2) / eta ** 2
    inside = np.sqrt(np.maximum(1 - sine2, 0))
    s = (cosine - eta * inside) / (cosine + eta * inside)
    p = (inside - eta * cosine) / (inside + eta * cosine)
    return np.where(sine2 < 1, (s ** 2 + p ** 2) / 2, 1.0)


def masking(cosine: np.ndarray, alpha: float) -> np.ndarray:
    """Smith's G1 of GGX (Walter et al. 2007, equation 34)."""
    return 2 / (1 + np.sqrt(1 + alpha ** 2 * (1 / cosine ** 2 - 1)))


@functools.cache
def rough_reflectance(cosine: float, alpha: float, eta: float) -> float:
    """Mitsuba's lobe: F D G1 G1 / (4 n.v), over the hemisphere."""
    half = view_of(cosine) + LIGHT
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    lobe = fresnel(half @ view_of(cosine), eta) * ggx(half[..., 2], alpha) / (4 * cosine)
    return float((lobe * masking(COSINE, alpha) * masking(cosine, alpha)).sum() * SOLID_ANGLE)


@functools.cache
def rough_transmittance(cosine: float, alpha: float, eta: float) -> float:
    """Walter et al. 2007, equation 21, over the far hemisphere, without the factor of compressed radiance."""
    view, light = view_of(cosine), LIGHT * np.array((1.0, 1.0, -1.0))
    half = -(view + eta * light)
    half *= np.sign(half[..., 2:])
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    v_h, l_h = half @ view, (half * light).sum(axis=-1)
    crossing = (v_h > 0) & (l_h < 0)
    jacobian = eta ** 2 * np.abs(l_h) / (v_h + eta * l_h) ** 2
    lobe = np.abs(v_h) * (1 - fresnel(np.abs(v_h), eta)) * ggx(half[..., 2], alpha) * jacobian / cosine
    lobe = lobe * masking(COSINE, alpha) * masking(cosine, alpha)
    return float(np.where(crossing, lobe, 0.0).sum() * SOLID_ANGLE)


def diffuse_in_all(material: object, channel: int = 0) -> float:
    return gltf_model.in_all(gltf_model.diffuse_reflectance, material)


class Lobes(unittest.TestCase):
    def test_rough_surfaces_by_quadrature_over_directions(self) -> None:
        for alpha in (0.2, 0.5):
            for cosine in (0.9, 0.4):
                for eta in (1.5, 1 / 1.5):
                    found = lobes.dielectric_gloss(np.array([cosine]), alpha, eta, True)[0]
                    self.assertAlmostEqual(found, rough_reflectance(cosine, alpha, eta), delta=0.003)
                found = lobes.passed(np.array([cosine]), alpha, 1.5, True)[0]
                self.assertAlmostEqual(found, rough_transmittance(cosine, alpha, 1.5), delta=0.003)

    def test_white_furnaces_of_the_documentation(self) -> None:
        # docs/materials.md, the column of white metal: at 0, 46 and 83 degrees.
        for roughness, row in ((0.3, (0.991, 0.985, 0.887)), (0.6, (0.825, 0.794, 0.867)), (1.0, (0.307, 0.380, 0.729))):
            cosines = np.cos(np.radians((0.0, 46.0, 83.0)))
            found = lobes.gloss(cosines, roughness ** 2, np.ones_like)
            np.testing.assert_allclose(found, row, atol=0.002)

    def test_what_glTF_leaves_to_a_diffuse_lobe(self) -> None:
        for cosine in (1.0, 0.5, 0.1):
            made = Material("white", base_colour=WHITE, specular=1.0)
            found = lobes.below(np.array([cosine]), 0.04, 1.0)[0]
            self.assertAlmostEqual(found, gltf_model.diffuse_reflectance(made, cosine), delta=2e-3)


class MitsubasPlastic(unittest.TestCase):
    def setUp(self) -> None:
        self.notes = Notes()

    def make(self, diffuse: object, alpha: object = 0.0, specular: tuple = WHITE, nonlinear: bool = False, version: int = 3,
             ior: float = 1.5) -> object:
        return models.plastic("plastic", diffuse, ior, alpha, specular, nonlinear, self.notes, "cup", version)

    def test_smooth_linear(self) -> None:
        # The lobe T(v) T(l) rho / (pi eta^2 (1 - Fi)): with 1 - Fi = (1 - Fe) / eta^2 it sends (1 - Fe) rho = 0.90822 rho.
        made = self.make((0.5, 0.25, 0.0))
        self.assertAlmostEqual(diffuse_in_all(made), 0.90822 * 0.5, delta=1e-3)
        self.assertAlmostEqual(made.base_colour[1] / made.base_colour[0], 0.5, delta=1e-12)
        self.assertEqual(made.base_colour[2], 0.0)
        self.assertAlmostEqual(made.ior, 1.5, delta=1e-9)
        self.assertEqual((made.roughness, made.specular, made.metallic), (0.0, 1.0, 0.0))

    def test_smooth_nonlinear(self) -> None:
        # 0.90822^2 rho / (2.25 (1 - 0.59635 rho)): 0.26112 of 0.5.
        made = self.make((0.5, 0.5, 0.5), nonlinear=True)
        self.assertAlmostEqual(diffuse_in_all(made), 0.26112, delta=1e-3)
        # White is the same in both: what enters leaves.
        self.assertAlmostEqual(self.make(WHITE, nonlinear=True).base_colour[0], self.make(WHITE).base_colour[0], delta=1e-9)

    def test_rough(self) -> None:
        alpha, rho = 0.3, 0.5
        passed = self._mean(rough_transmittance, alpha, 1.5)
        inside = self._mean(rough_reflectance, alpha, 1 / 1.5)
        expected = passed ** 2 * rho / 2.25
        self.assertAlmostEqual(diffuse_in_all(self.make((rho,) * 3, alpha)), expected / (1 - inside), delta=0.01)
        self.assertAlmostEqual(diffuse_in_all(self.make((rho,) * 3, alpha, nonlinear=True)), expected / (1 - rho * inside),
                               delta=0.01)
        # Mitsuba 0.6 counts as reflected inside what does not pass: passed rho in all.
        self.assertAlmostEqual(diffuse_in_all(self.make((rho,) * 3, alpha, version=0)), passed * rho, delta=0.01)

    def _mean(self, function: object, alpha: float, eta: float) -> float:
        nodes, weights = np.polynomial.legendre.leggauss(12)
        return float(sum(w * c * function(float(c), alpha, eta) for c, w in zip((nodes + 1) / 2, weights)))

    def test_the_gloss_is_scaled(self) -> None:
        made = self.make(BLACK, 0.0, (0.5, 0.5, 0.5))
        for cosine in (1.0, 0.5):
            schlick = 0.04 + 0.96 * (1 - cosine) ** 5
            self.assertAlmostEqual(gltf_model.reflectance(made, cosine), 0.5 * schlick, delta=1e-9)
        self.assertEqual(made.specular, 0.5)

    def test_what_the_note_says_of_angles(self) -> None:
        self.make((0.5, 0.5, 0.5))
        rows = [str(row["what"]) for row in self.notes.rows()]
        self.assertEqual(len(rows), 1)
        self.assertIn("up to 60 degrees from the normal it is off by 0.05 of reflectance at most, up to 85 by 0.3", rows[0])
        made = self.make((0.5, 0.5, 0.5))

        def source(cosine: float) -> float:
            f = float(fresnel(np.array(cosine), 1.5))
            return f + (1 - f) * 0.90822 * 0.5 / (2.25 * (1 - 0.59635))

        def distance(degrees: float) -> float:
            cosine = float(np.cos(np.radians(degrees)))
            return abs(source(cosine) - gltf_model.reflectance(made, cosine))

        self.assertTrue(0.02 < max(distance(a) for a in (0, 15, 30, 45, 60)) <= 0.05)
        self.assertTrue(0.2 < max(distance(a) for a in (70, 75, 80, 85)) <= 0.3)

    def test_textures_of_linear_plastic_keep_their_image(self) -> None:
        image = Image("wood", np.array([[[200, 100, 50], [10, 20, 30]]], dtype=np.uint8), b"file", "image/jpeg")
        made = self.make(Texture(image))
        self.assertIs(made.base_colour.image, image)
        self.assertAlmostEqual(made.base_colour.scale[0], self.make((1.0, 1.0, 1.0)).base_colour[0], delta=1e-12)

    def test_textures_of_nonlinear_plastic_are_mapped_texel_by_texel_and_once(self) -> None:
        image = Image("wood", np.array([[[188, 188, 188], [0, 0, 0]]], dtype=np.uint8))
        made, again = (self.make(Texture(image), nonlinear=True) for _ in range(2))
        rho = ((188 / 255 + 0.055) / 1.055) ** 2.4
        np.testing.assert_allclose(made.base_colour.image.pixels[0, 0], self.make((rho,) * 3, nonlinear=True).base_colour)
        np.testing.assert_allclose(made.base_colour.image.pixels[0, 1], 0.0)
        self.assertIs(made.base_colour.image, again.base_colour.image)

    def test_an_index_below_1_is_refused(self) -> None:
        with self.assertRaisesRegex(ImportProblem, "^cup: the index of a dielectric surface is 0.9 of that above it; 1 or mo"):
            self.make(WHITE, ior=0.9)

    def test_without_a_step_of_the_index_there_is_no_lobe(self) -> None:
        made = self.make((0.2, 0.4, 0.6), ior=1.0)
        np.testing.assert_allclose(made.base_colour, (0.2, 0.4, 0.6), atol=1e-12)
        self.assertEqual(made.specular, 0.0)


class PbrtsCoatedDiffuse(unittest.TestCase):
    def simulate(self, cosine: float, rho: float, thickness: float, depth: int) -> float:
        """LayeredBxDF with smooth glass over Lambert: photons that enter, walk and leave; what is reflected outside too."""
        random = np.random.default_rng(7)
        count, eta = 60000, 1.5
        outside = float(fresnel(np.array(cosine), eta))
        weight = np.full(count, 1 - outside)
        direction = np.full(count, np.sqrt(1 - (1 - cosine ** 2) / eta ** 2))
        left = np.zeros(count)
        for _ in range((depth + 1) // 2):
            weight *= np.exp(-thickness / direction) * rho  # down, and by Lambert up again
            direction = np.sqrt((random.permutation(count) + random.random(count)) / count)
            up = np.exp(-thickness / direction)
            reflected = fresnel(direction, 1 / eta)
            left += weight * up * (1 - reflected)
            weight *= up * reflected
        return outside + float(left.mean())

    def test_against_a_simulation(self) -> None:
        for rho, thickness, depth in ((0.5, 0.01, 10), (0.9, 0.3, 10), (1.0, 0.01, 3)):
            made = models.coated_diffuse("paint", (rho,) * 3, 1.5, 0.0, thickness, BLACK, depth, Notes(), "w")
            nodes, weights = np.polynomial.legendre.leggauss(12)
            cosines = (nodes + 1) / 2
            expected = sum(w * c * (self.simulate(c, rho, thickness, depth) - float(fresnel(np.array(c), 1.5)))
                           for c, w in zip(cosines, weights))
            self.assertAlmostEqual(diffuse_in_all(made), expected, delta=0.002, msg=(rho, thickness, depth))

    def test_a_coat_that_scatters_is_noted(self) -> None:
        notes = Notes()
        models.coated_diffuse("paint", WHITE, 1.5, 0.0, 0.01, (0.5, 0.5, 0.5), 10, notes, "w")
        self.assertTrue(any("coat that scatters" in str(row["what"]) for row in notes.rows()))


class PbrtV3(unittest.TestCase):
    def test_plastic_keeps_its_diffuse_light(self) -> None:
        for alpha in (0.0, 0.2):
            made = models.lambert_and_gloss("p", (0.4, 0.2, 0.1), (0.25,) * 3, 1.5, alpha, Notes(), "w")
            self.assertAlmostEqual(diffuse_in_all(made), 0.4, delta=1e-3)
            self.assertEqual(made.specular, 0.25)
        matt = models.lambert_and_gloss("p", (0.4, 0.2, 0.1), BLACK, 1.5, 0.1, Notes(), "w")
        self.assertEqual((matt.specular, matt.base_colour), (0.0, (0.4, 0.2, 0.1)))

    def test_what_no_base_colour_gives_is_noted(self) -> None:
        notes = Notes()
        made = models.lambert_and_gloss("p", WHITE, WHITE, 1.5, 0.0, notes, "w")
        self.assertEqual(made.base_colour, WHITE)
        self.assertTrue(any("no base colour up to 1" in str(row["what"]) for row in notes.rows()))

    def test_substrate(self) -> None:
        # FresnelBlend's diffuse lobe: 28 / (23 pi) Rd (1 - Rs) (1 - (1 - cos/2)^5) of view and of light.
        rd, rs = 0.5, 0.1
        made = models.substrate("s", (rd,) * 3, (rs,) * 3, 0.04, Notes(), "w")

        def lobe(cosine: float) -> float:
            sides = (1 - (1 - cosine / 2) ** 5) * (1 - (1 - COSINE / 2) ** 5)
            return float((28 / (23 * np.pi) * rd * (1 - rs) * sides * COSINE).sum() * SOLID_ANGLE)

        self.assertAlmostEqual(diffuse_in_all(made), gltf_model.in_all(lobe), delta=1e-3)
        self.assertEqual(gltf_model.dielectric_f0(made), (0.1, 1.0))
        self.assertAlmostEqual(made.roughness, 0.2, delta=1e-12)

    def test_uber(self) -> None:
        notes = Notes()
        made = models.uber("u", (0.2,) * 3, BLACK, (0.5,) * 3, BLACK, 1.5, 0.1, (0.25,) * 3, notes, "w")
        self.assertEqual((made.roughness, made.specular, made.opacity), (0.0, 0.5, 0.25))
        passing = models.uber("u", (0.2,) * 3, (0.1,) * 3, BLACK, (0.6,) * 3, 1.5, 0.1, WHITE, notes, "w")
        self.assertAlmostEqual(passing.transmission, 0.75, delta=1e-12)
        np.testing.assert_allclose(passing.base_colour, 0.8)
        self.assertTrue(any("Kt" in str(row["what"]) for row in notes.rows()))

    def test_phong(self) -> None:
        made = models.phong("p", (0.3,) * 3, (0.2,) * 3, 100.0, Notes(), "w")
        for cosine in (1.0, 0.6):
            self.assertAlmostEqual(gltf_model.diffuse_reflectance(made, cosine), 0.3, delta=1e-3)
        self.assertAlmostEqual(made.roughness ** 2, (2 / 402) ** 0.5, delta=1e-12)


if __name__ == "__main__":
    unittest.main()
