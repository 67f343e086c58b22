"""Textures that are made: checkers, changed ones, and two in one."""

from __future__ import annotations

import sys
import unittest
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.images import bake, srgb  # noqa: E402
from importer.scene import Image, Texture, Wrap  # noqa: E402

# IEC 61966-2-1 at the byte 128: ((128 / 255 + 0.055) / 1.055)^2.4.
MIDDLE = 0.21586050011389926


def texture(pixels: np.ndarray, scale: tuple[float, float] = (1, 1), offset: tuple[float, float] = (0, 0),
            **options: object) -> Texture:
    matrix = np.array([[scale[0], 0, offset[0]], [0, scale[1], offset[1]]])
    return Texture(Image("image", np.asarray(pixels)), matrix, **options)


def grey(rows: list[list[float]]) -> np.ndarray:
    return np.repeat(np.array(rows, float)[..., None], 3, axis=2)


def looked_up(found: Texture, u: float, v: float) -> np.ndarray:
    """At coordinates of the surface."""
    x, y = found.image_from_uv @ (u, v, 1)
    return bake.looked_up(found, np.array([x]), np.array([y]))[0] * found.scale


class BakeTest(unittest.TestCase):
    def test_curve(self) -> None:
        self.assertAlmostEqual(float(srgb.to_linear(np.float64(128 / 255))), MIDDLE, 15)
        self.assertAlmostEqual(float(srgb.to_linear(np.float64(0.04))), 0.04 / 12.92, 15)
        bytes_ = np.arange(256)
        np.testing.assert_array_equal(np.rint(255 * srgb.from_linear(srgb.to_linear(bytes_ / 255))), bytes_)
        np.testing.assert_allclose(srgb.from_linear(np.array([-1.0, 2.0])), (0, 1))

    def test_linear_colours(self) -> None:
        image = Image("a", np.full((1, 2, 4), 128, np.uint8))
        np.testing.assert_allclose(srgb.linear(image), np.full((1, 2, 3), MIDDLE))
        np.testing.assert_array_equal(srgb.linear(Image("b", np.full((1, 1, 3), 0.3))), np.full((1, 1, 3), 0.3))

    def test_constant(self) -> None:
        np.testing.assert_array_equal(bake.constant("c", (0.5, 2, -1)).pixels, [[(0.5, 1, 0)]])

    def test_checkerboard_of_mitsuba(self) -> None:
        """checkerboard.cpp: color0 where both of u and v, less their whole parts, are on the same side of a half."""
        board = Texture(bake.checkerboard("c", (0.8, 0.1, 0.2), (0.2, 0.3, 0.4)), np.array([[20.0, 0, 0], [0, 80, 0]]),
                        is_nearest=True)
        for u, v in ((0.001, 0.001), (0.03, 0.001), (0.03, 0.008), (0.01, 0.012), (0.51, 0.33), (-0.01, 0.002)):
            is_first = ((20 * u) % 1 > 0.5) == ((80 * v) % 1 > 0.5)
            np.testing.assert_array_equal(looked_up(board, u, v), (0.8, 0.1, 0.2) if is_first else (0.2, 0.3, 0.4))

    def test_checkerboard_of_pbrt(self) -> None:
        """CheckerboardTexture: tex1 where floor(s) + floor(t) is even; the mesh's v is 1 - t."""
        board = Texture(bake.checkerboard("c", (1, 1, 1), (0, 0, 0)), np.array([[0.5, 0, 0], [0, 0.5, 0]]), is_nearest=True)
        for s, t in ((0.2, 0.3), (1.2, 0.3), (1.2, 1.3), (0.2, 1.3), (-0.2, 0.3), (5.5, 3.1), (4.5, 3.1)):
            is_first = (np.floor(s) + np.floor(t)) % 2 == 0
            np.testing.assert_array_equal(looked_up(board, s, 1 - t), np.full(3, float(is_first)), f"{s} {t}")

    def test_mapped(self) -> None:
        image = Image("a", np.array([[(128, 0, 255, 51)]], np.uint8))
        found = bake.mapped(image, lambda colours: 2 * colours)
        np.testing.assert_allclose(found.pixels, [[(2 * MIDDLE, 0, 1, 0.2)]])
        self.assertEqual(found.pixels.dtype, np.float64)
        self.assertIsNone(found.encoded)
        np.testing.assert_array_equal(image.pixels, [[(128, 0, 255, 51)]])
        self.assertEqual(bake.mapped(image, lambda c: c, "b").name, "b")

    def test_mapped_in_bands_and_bytes(self) -> None:
        rng = np.random.default_rng(1)
        image = Image("a", rng.integers(0, 256, (2 * bake._BAND + 3, 4, 4), dtype=np.uint8))
        np.testing.assert_allclose(bake.mapped(image, np.sqrt).pixels[..., :3], np.sqrt(srgb.linear(image)))
        self.addCleanup(setattr, bake, "_MAX_FLOATS", bake._MAX_FLOATS)
        bake._MAX_FLOATS = 0
        np.testing.assert_array_equal(bake.mapped(image, lambda c: c).pixels, image.pixels)  # sRGB bytes again

    def test_scaled_and_applied(self) -> None:
        found = bake.scaled(texture(grey([[0.25, 0.75]]), scale=(3, 3)), (2, 1, 0.5))
        self.assertEqual(found.scale, (2, 1, 0.5))
        self.assertEqual(bake.scaled(found, (2, 2, 2)).scale, (4, 2, 1))
        done = bake.applied(found)
        np.testing.assert_array_equal(done.image.pixels, [[(0.5, 0.25, 0.125), (1, 0.75, 0.375)]])
        self.assertEqual(done.scale, (1, 1, 1))
        np.testing.assert_array_equal(done.image_from_uv, found.image_from_uv)
        self.assertIs(bake.applied(done), done)

    def test_look_up_between_texels(self) -> None:
        ramp = texture(grey([[0, 1, 0.5, 0.25]]))
        for u, wanted in ((0.125, 0), (0.25, 0.5), (0.375, 1), (0.5, 0.75), (1, 0.125), (0, 0.125), (1.375, 1)):
            np.testing.assert_allclose(looked_up(ramp, u, 0.5), np.full(3, wanted), atol=1e-12)
        clamped = replace(ramp, wrap=(Wrap.CLAMP, Wrap.CLAMP))
        for u, wanted in ((0, 0), (-3, 0), (1, 0.25), (9, 0.25)):
            np.testing.assert_allclose(looked_up(clamped, u, 0.5), np.full(3, wanted), atol=1e-12)
        mirrored = replace(ramp, wrap=(Wrap.MIRRORED, Wrap.REPEAT))
        for u, wanted in ((-0.375, 1), (1.125, 0.25), (1.625, 1), (2.375, 1)):
            np.testing.assert_allclose(looked_up(mirrored, u, 0.5), np.full(3, wanted), atol=1e-12)
        rows = texture(grey([[0], [1]]), is_nearest=True)
        self.assertEqual([looked_up(rows, 0, v)[0] for v in (0.1, 0.6, 1.1, -0.1)], [0, 1, 0, 1])  # row 0 at v = 0


class CombinedTest(unittest.TestCase):
    def test_two_colours(self) -> None:
        self.assertEqual(bake.combined((1, 2, 3), (4, 5, 6), np.multiply), (4.0, 10.0, 18.0))

    def test_equal_mappings_meet_texel_by_texel(self) -> None:
        a = texture(grey([[0.1, 0.2], [0.3, 0.4]]), scale=(3, 2), offset=(0.1, 0))
        b = replace(texture(grey([[0.5, 0.25], [1, 0]]), scale=(3, 2), offset=(0.1, 0)), scale=(1, 0.5, 1))
        found = bake.combined(a, b, np.multiply)
        np.testing.assert_allclose(found.image.pixels[..., 0], [(0.05, 0.05), (0.3, 0)])
        np.testing.assert_allclose(found.image.pixels[..., 1], [(0.025, 0.025), (0.15, 0)])
        np.testing.assert_array_equal(found.image_from_uv, a.image_from_uv)
        self.assertEqual(found.scale, (1, 1, 1))

    def test_names_do_not_double(self) -> None:
        """Textures mixed of mixed ones are as deep as the source has them, and their names must not fill the memory."""
        a, b = (Texture(Image(name, grey([[0.5]]))) for name in ("wood", "bark"))
        self.assertEqual(bake.combined(a, b, np.add).image.name, "wood_bark")
        self.assertEqual(bake.combined(a, a, np.add).image.name, "wood")
        for _ in range(60):
            a = bake.combined(a, replace(b, image=Image(f"{a.image.name}*", b.image.pixels)), np.multiply)
        self.assertLess(len(a.image.name), 100)

    def test_a_texture_and_a_colour(self) -> None:
        a = texture(grey([[0.5, 0.25]]), scale=(3, 3), wrap=(Wrap.CLAMP, Wrap.MIRRORED))
        for found in (bake.combined(a, (1, 0.5, 9), np.multiply), bake.combined((1, 0.5, 9), a, np.multiply)):
            np.testing.assert_array_equal(found.image.pixels, [[(0.5, 0.25, 1), (0.25, 0.125, 1)]])
            self.assertEqual(found.wrap, a.wrap)
        constant = bake.combined(a, (1, 0.5, 9), lambda first, second: second)
        np.testing.assert_array_equal(constant.image.pixels, np.tile((1, 0.5, 1), (1, 2, 1)))

    def test_sizes_differ(self) -> None:
        a, b = texture(grey([[0, 1]])), texture(grey([[0.5] * 8] * 4))
        found = bake.combined(a, b, lambda x, y: x)
        # Middles of eighths between texel middles at 1/4 and 3/4.
        np.testing.assert_allclose(found.image.pixels[0, :, 0], (0.375, 0.125, 0.125, 0.375, 0.625, 0.875, 0.875, 0.625))
        self.assertEqual(found.image.pixels.shape, (4, 8, 3))

    def test_checkers_within_a_larger_texture(self) -> None:
        board = texture(grey([[1, 0], [0, 1]]), scale=(4, 2), is_nearest=True)
        wide = texture(grey([[0.25, 0.75]]), is_nearest=True)
        for pair in ((board, wide), (wide, board)):
            found = bake.combined(*pair, np.multiply)
            np.testing.assert_array_equal(found.image_from_uv, wide.image_from_uv)
            self.assertEqual(found.image.pixels.shape, (4, 8, 3))
            for u, v in ((0.1, 0.1), (0.2, 0.1), (0.9, 0.3), (0.6, 0.8), (1.1, -0.1)):
                np.testing.assert_allclose(looked_up(found, u, v), looked_up(board, u, v) * looked_up(wide, u, v))

    def test_periods_that_do_not_fit_are_baked_once(self) -> None:
        a = texture(grey([[0.2, 0.8]]), scale=(1.5, 1), is_nearest=True)
        b = texture(grey([[1, 0.5]]), scale=(2.5, 1), is_nearest=True)
        found = bake.combined(a, b, np.multiply)
        np.testing.assert_array_equal(found.image_from_uv, np.eye(3)[:2])
        for u in (0.1, 0.5, 0.85):
            np.testing.assert_allclose(looked_up(found, u, 0.5), looked_up(a, u, 0.5) * looked_up(b, u, 0.5))

    def test_turned_mappings(self) -> None:
        rng = np.random.default_rng(1)
        a = texture(rng.random((4, 4, 3)), is_nearest=True)
        b = replace(texture(rng.random((4, 4, 3)), is_nearest=True), image_from_uv=np.array([[0.0, 1, 0], [-1, 0, 1]]))
        found = bake.combined(a, b, lambda x, y: y)
        for u, v in rng.random((20, 2)):
            np.testing.assert_allclose(looked_up(found, u, v), looked_up(b, u, v))

    def test_flat_mapping(self) -> None:
        """A scale of 0 maps all of the surface to one texel's row."""
        a, b = texture(grey([[0.5, 1]]), scale=(0, 1)), texture(grey([[0.25, 0.75]]))
        found = bake.combined(a, b, np.multiply)
        for u in (0.25, 0.75):
            np.testing.assert_allclose(looked_up(found, u, 0.5), looked_up(a, u, 0.5) * looked_up(b, u, 0.5))
        self.assertIsInstance(bake.combined(a, a, np.multiply), Texture)

    def test_sizes_are_limited(self) -> None:
        self.addCleanup(setattr, bake, "MAX_SIDE", bake.MAX_SIDE)
        bake.MAX_SIDE = 16
        found = bake.combined(texture(grey([[1, 0]]), scale=(1000, 1)), texture(grey([[0.5]])), np.multiply)
        self.assertEqual(found.image.pixels.shape, (1, 16, 3))


if __name__ == "__main__":
    unittest.main()
