"""pbrt's lights: radiance, intensity and direction by the formulas of lights.cpp, and where skies have their pixels."""

from __future__ import annotations

import math
import struct
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from importer.scene import LightKind, Sky  # noqa: E402
from pbrt_scene import HEAD_V3, TRIANGLE, said, world, world_problem  # noqa: E402


def pfm(pixels: np.ndarray) -> bytes:
    """Rows from the bottom, as the format has them."""
    height, width, _ = pixels.shape
    return f"PF\n{width} {height}\n-1.0\n".encode() + pixels[::-1].astype("<f4").tobytes()


def seen(sky: Sky, direction: tuple[float, float, float]) -> np.ndarray:
    """What a sky sends from a direction of the world, by the conventions of `Sky` alone."""
    assert sky.image is not None
    x, y, z = np.linalg.inv(sky.to_world) @ (np.array(direction) / np.linalg.norm(direction))
    u = (math.atan2(x, -z) / (2 * math.pi) + 0.5) % 1
    v = math.acos(max(-1.0, min(1.0, y))) / math.pi
    height, width, _ = sky.image.shape
    return sky.image[min(int(v * height), height - 1), min(int(u * width), width - 1)] * np.array(sky.scale)


class Delta(unittest.TestCase):
    def one(self, text: str, head: str | None = None):  # noqa: ANN201
        return world(text, **({} if head is None else {"head": head}))[0].lights[0]

    def test_points(self) -> None:
        light = self.one('Translate 1 0 0\nLightSource "point" "rgb I" [1 2 3] "point3 from" [0 5 0] "float scale" 2')
        self.assertIs(light.kind, LightKind.POINT)
        np.testing.assert_allclose(light.position, (1, 5, 0))
        np.testing.assert_allclose(light.intensity, (2, 4, 6))
        light = self.one('LightSource "point" "float power" 100')
        np.testing.assert_allclose(light.intensity, np.full(3, 100 / (4 * math.pi)))

    def test_spots(self) -> None:
        light = self.one('Rotate 90 0 1 0\nLightSource "spot" "point3 from" [0 1 0] "point3 to" [0 1 3] "float coneangle" 40'
                         ' "float conedeltaangle" 10')
        np.testing.assert_allclose(light.position, (0, 1, 0), atol=1e-12)
        np.testing.assert_allclose(light.direction, (1, 0, 0), atol=1e-12)  # Rotate takes z to x
        self.assertAlmostEqual(light.outer_cone, math.radians(40))
        self.assertAlmostEqual(light.inner_cone, math.radians(30))
        light = self.one('LightSource "spot" "float power" 10 "float coneangle" 90 "float conedeltaangle" 90')
        # 2 pi ((1 - cos 0) + (cos 0 - cos 90) / 2) = pi steradians.
        np.testing.assert_allclose(light.intensity, np.full(3, 10 / math.pi))

    def test_spots_have_a_direction_of_their_own(self) -> None:
        light = self.one('LightSource "spot"')
        np.testing.assert_allclose(light.direction, (0, 0, 1))
        self.assertAlmostEqual(light.outer_cone, math.radians(30))
        self.assertAlmostEqual(light.inner_cone, math.radians(25))
        self.assertIn("falloff of a spot", " ".join(said(world('LightSource "spot"')[1])))

    def test_distant_lights_shine_from_from_to_to(self) -> None:
        light = self.one('LightSource "distant" "point3 from" [0 10 0] "point3 to" [0 0 0] "rgb L" [3 2 1] "float scale" 2')
        self.assertIs(light.kind, LightKind.DIRECTIONAL)
        np.testing.assert_allclose(light.direction, (0, -1, 0))
        np.testing.assert_allclose(light.intensity, (6, 4, 2))
        light = self.one('Scale 2 2 2\nLightSource "distant" "rgb L" [1 1 1] "float illuminance" 7')
        np.testing.assert_allclose(light.intensity, (7, 7, 7))
        np.testing.assert_allclose(light.direction, (0, 0, 1))

    def test_colours_of_version_4_have_luminance_1(self) -> None:
        for text in ('"blackbody I" 3000', '"spectrum I" [400 5 500 7 700 9]', '"spectrum I" "stdillum-A"'):
            light = self.one(f'LightSource "point" {text} "float scale" 4')
            self.assertAlmostEqual(float(np.dot((.212671, .715160, .072169), light.intensity)), 4, 3, text)
        warm = self.one('LightSource "point" "blackbody I" 3000').intensity
        self.assertGreater(warm[0], warm[1])
        self.assertGreater(warm[1], warm[2])

    def test_colours_of_version_3_are_taken_as_they_are(self) -> None:
        light = self.one('LightSource "point" "color I" [1 2 3] "rgb scale" [2 2 4]', HEAD_V3)
        np.testing.assert_allclose(light.intensity, (2, 4, 12))
        once = self.one('LightSource "point" "spectrum I" [400 1 700 1]', HEAD_V3).intensity
        twice = self.one('LightSource "point" "spectrum I" [400 2 700 2]', HEAD_V3).intensity
        np.testing.assert_allclose(twice, np.multiply(once, 2))
        # A flat spectrum of 1 is XYZ 1, 1, 1, extended beyond its ends: (1.205, 0.948, 0.909) in sRGB.
        np.testing.assert_allclose(once, (1.2047, 0.9484, 0.9087), atol=2e-3)

    def test_colour_spaces(self) -> None:
        """The red primary of Rec. 2020 is (1.660, -0.125, -0.018) in sRGB (ITU-R BT.2407), below 0 clamped; white is
        white."""
        light = self.one('ColorSpace "rec2020"\nLightSource "point" "rgb I" [1 0 0]')
        np.testing.assert_allclose(light.intensity, (1.660, 0, 0), atol=2e-3)
        light = self.one('ColorSpace "rec2020"\nLightSource "point" "rgb I" [1 1 1]')
        np.testing.assert_allclose(light.intensity, (1, 1, 1), atol=1e-3)

    def test_problems(self) -> None:
        for text in ('"spot" "float coneangle" 0', '"spot" "point3 to" [0 0 0]', '"distant" "point3 to" [0 0 0]',
                     '"point" "float scale" -1', '"point" "rgb I" [1 1]', '"point" "rgb I" [-1 0 0]',
                     '"point" "blackbody I" [3000 2]', '"point" "spectrum I" [400]', '"point" "spectrum I" "a.spd"'):
            self.assertRegex(world_problem(f"LightSource {text}"), r"scene\.pbrt:4: .*must")
        self.assertIn("stdillum-X", world_problem('LightSource "point" "spectrum I" "stdillum-X"'))

    def test_spectra_from_files(self) -> None:
        spd = {"a.spd": "# a lamp\n400 1 # violet\n700 1\n"}
        from_file = world('LightSource "point" "spectrum I" "a.spd"', files=spd)[0].lights[0].intensity
        np.testing.assert_allclose(from_file, self.one('LightSource "point" "spectrum I" [400 1 700 1]').intensity)
        self.assertIn("what is no number", world_problem('LightSource "point" "spectrum I" "a.spd"', files={"a.spd": "x"}))


class Areas(unittest.TestCase):
    def lamp(self, text: str, shape: str = TRIANGLE, head: str | None = None):  # noqa: ANN201
        return world(f'AreaLightSource "diffuse" {text}\n{shape}', **({} if head is None else {"head": head}))

    def test_an_rgb_is_the_radiance(self) -> None:
        material = self.lamp('"rgb L" [3 2 1] "float scale" 5')[0].parts[0].material
        np.testing.assert_allclose(material.radiance, (15, 10, 5))
        self.assertFalse(material.emits_both_sides)
        np.testing.assert_allclose(self.lamp("")[0].parts[0].material.radiance, (1, 1, 1))

    def test_lamps_end_with_their_state(self) -> None:
        scene, _ = world('AttributeBegin\nAreaLightSource "diffuse" "rgb L" [3 2 1]\n' + TRIANGLE
                         + "AttributeEnd\n" + TRIANGLE)
        np.testing.assert_allclose(scene.parts[1].material.radiance, (0, 0, 0))

    def test_power_of_a_ball(self) -> None:
        """pi L A = 100 with the area 4 pi 4 of a ball of radius 2."""
        for sides, text in ((1, ""), (2, ' "bool twosided" true')):
            radiance = self.lamp('"float power" 100' + text, 'Shape "sphere" "float radius" 2')[0].parts[0].material.radiance
            np.testing.assert_allclose(radiance, np.full(3, 100 / (math.pi * 16 * math.pi * sides)))

    def test_each_triangle_has_all_of_the_power(self) -> None:
        quad = 'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0] "integer indices" [0 1 2 0 2 3]'
        scene, notes = self.lamp('"float power" 10', "Scale 2 2 2\n" + quad)
        np.testing.assert_allclose(scene.parts[0].material.radiance, np.full(3, 10 / (math.pi * 2)))
        self.assertNotIn("power", " ".join(said(notes)))
        uneven = quad.replace("1 1 0 0 1 0]", "1 1 0 0 3 0]")
        self.assertIn("as evenly spread", " ".join(said(self.lamp('"float power" 10', uneven)[1])))

    def test_lamps_with_images(self) -> None:
        files = {"a.pfm": pfm(np.array([[[4.0, 2, 1]], [[8, 0, 0]]]))}
        scene, _ = world('AreaLightSource "diffuse" "string filename" "a.pfm" "float scale" 3\n' + TRIANGLE, files=files)
        texture = scene.parts[0].material.radiance
        np.testing.assert_allclose(texture.image.pixels[0, 0] * texture.scale, (12, 6, 3))
        self.assertTrue(texture.is_nearest)
        np.testing.assert_array_equal(texture.image_from_uv, np.eye(3)[:2])
        np.testing.assert_allclose(scene.parts[0].mesh.uvs, [(0, 1), (1, 1), (1, 0)])
        self.assertIn("has both", world_problem('AreaLightSource "diffuse" "string filename" "a.pfm" "rgb L" [1 1 1]\n'
                                                + TRIANGLE, files=files))

    def test_lamps_that_are_not_seen(self) -> None:
        scene, notes = self.lamp('"rgb L" [2 2 2]', TRIANGLE.strip() + ' "float alpha" 0')
        np.testing.assert_allclose(scene.parts[0].material.radiance, (2, 2, 2))
        self.assertIn("not seen", " ".join(said(notes)))

    def test_surfaces_without_a_material(self) -> None:
        scene, notes = self.lamp('"rgb L" [1 1 1]', 'Material "interface"\n' + TRIANGLE)
        self.assertEqual(scene.parts, [])
        self.assertIn("pbrt-v4 leaves out", " ".join(said(notes)))
        scene, notes = self.lamp('"rgb L" [1 1 1]', 'Material "none"\n' + TRIANGLE, HEAD_V3)
        np.testing.assert_allclose(scene.parts[0].material.radiance, (1, 1, 1))
        np.testing.assert_allclose(scene.parts[0].material.base_colour, (0, 0, 0))


class Skies(unittest.TestCase):
    def test_constant_skies_add_up(self) -> None:
        scene, _ = world('LightSource "infinite" "rgb L" [1 2 3] "float scale" 2\n'
                         'LightSource "infinite" "float illuminance" 1')
        np.testing.assert_allclose(scene.sky.radiance, np.array([2, 4, 6]) + 1 / math.pi)
        self.assertIsNone(scene.sky.image)

    def test_version_3_has_its_pole_along_z_and_starts_at_x(self) -> None:
        """Row = theta from +z over pi, column = phi from +x towards +y over 2 pi (InfiniteAreaLight::Le)."""
        image = np.zeros((8, 16, 3))
        image[..., 0] = np.arange(8)[:, None]
        image[..., 1] = np.arange(16)
        scene, _ = world('LightSource "infinite" "string mapname" "a.pfm" "rgb L" [1 1 2]', HEAD_V3, {"a.pfm": pfm(image)})
        for theta, phi in ((0.3, 0.2), (1.0, 1.7), (1.7, 3.0), (2.5, 4.0), (3.0, 6.2)):
            direction = (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))
            found = seen(scene.sky, direction)
            np.testing.assert_allclose(found[:2], (int(theta / math.pi * 8), int(phi / math.pi / 2 * 16)))

    def test_the_sky_turns_with_the_light(self) -> None:
        image = np.zeros((8, 16, 3))
        image[0] = 1  # about the light's +z
        text = 'LightSource "infinite" "string mapname" "a.pfm"'
        for turn, up in (("Rotate -90 1 0 0", (0, 1, 0)), ("Scale 1 1 -1", (0, 0, -1)), ("Scale 3 3 3", (0, 0, 1))):
            scene, notes = world(f"{turn}\n{text}", HEAD_V3, {"a.pfm": pfm(image)})
            np.testing.assert_allclose(seen(scene.sky, up), (1, 1, 1))
            np.testing.assert_allclose(scene.sky.to_world @ scene.sky.to_world.T, np.eye(3), atol=1e-12)
            self.assertNotIn("stretched", " ".join(said(notes)))
        scene, notes = world(f"Scale 1 1 2\n{text}", HEAD_V3, {"a.pfm": pfm(image)})
        self.assertIn("stretched", " ".join(said(notes)))

    def test_a_projective_matrix_turns_a_sky_by_its_linear_part(self) -> None:
        """A scene of the field writes a matrix row by row, which makes of its translation a fourth row. With x to y, y to z
        and z to x, what comes from the world's +x is what the image has at the light's +z: its upper edge."""
        image = np.zeros((64, 128, 3))
        image[:4] = 1
        scene, _ = world('ConcatTransform [0 1 0 0  0 0 1 0  1 0 0 8.87  0 0 0 1]\n'
                         'LightSource "infinite" "string mapname" "a.pfm"', HEAD_V3, {"a.pfm": pfm(image)})
        self.assertAlmostEqual(seen(scene.sky, (1, 0.01, 0.01))[0], 1)
        self.assertAlmostEqual(seen(scene.sky, (0.01, 1, 0.01))[0], 0)

    def test_version_4_is_octahedral(self) -> None:
        """By the book's figure 3.22: the middle of the square is +z, its corners are -z, the middle of the right side +x
        and that of the lower side, where t is 1, +y."""
        size = 64
        image = np.zeros((size, size, 3))
        s, t = np.meshgrid((np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size)
        image[..., 0], image[..., 1] = s, t
        scene, _ = world('LightSource "infinite" "string filename" "a.pfm" "float scale" 2', files={"a.pfm": pfm(image)})
        # At x = y = 1/2, z = 1/sqrt 2: r = sqrt(1 - z) and both coordinates are r/2.
        half = math.sqrt(1 - math.sqrt(0.5)) / 2
        # At an azimuth of 22.5 degrees and z = -1/2, r is sqrt(1/2), of which a quarter goes to t: folded, 1 - r/4 and
        # 1 - 3 r/4 of the half side.
        eighth, r = math.pi / 8, math.sqrt(0.5)
        low = (math.sqrt(0.75) * math.cos(eighth), math.sqrt(0.75) * math.sin(eighth), -0.5)
        for direction, st in (((0.02, 0.02, 1), (0.5, 0.5)), (low, (1 - r / 8, 1 - 3 * r / 8)),
                              ((1, 0.01, 0.01), (1, 0.5)), ((-0.01, 1, 0.01), (0.5, 1)),
                              ((0.5, 0.5, math.sqrt(0.5)), (0.5 + half / 2, 0.5 + half / 2)),
                              ((-0.5, 0.5, math.sqrt(0.5)), (0.5 - half / 2, 0.5 + half / 2)),
                              ((0.5, 0.5, -math.sqrt(0.5)), (1 - half / 2, 1 - half / 2)),
                              ((0.01, -0.01, -1), (1, 0))):
            np.testing.assert_allclose(seen(scene.sky, direction)[:2], np.multiply(st, 2), atol=0.08, err_msg=str(direction))

    def test_resampled_light_is_kept(self) -> None:
        """Each pixel of the square has the same solid angle: one lit among 32 x 32 is 4 pi / 1024 of a white sky."""
        for row, column in ((3, 29), (16, 16), (20, 9)):
            image = np.zeros((32, 32, 3))
            image[row, column] = 100
            sky = world('LightSource "infinite" "string filename" "a.pfm"', files={"a.pfm": pfm(image)})[0].sky
            assert sky.image is not None
            height, width, _ = sky.image.shape
            edges = np.cos(np.arange(height + 1) / height * math.pi)
            solid_angles = (edges[:-1] - edges[1:]) * 2 * math.pi / width
            flux = (sky.image[..., 0] * solid_angles[:, None]).sum()
            self.assertAlmostEqual(flux / (100 * 4 * math.pi / 1024), 1, delta=0.05)

    def test_illuminance_of_an_image(self) -> None:
        """A white sky of radiance 1 gives pi on what faces up; 5 are asked for."""
        files = {"a.pfm": pfm(np.ones((32, 32, 3)))}
        scene, notes = world('LightSource "infinite" "string filename" "a.pfm" "float illuminance" 5', files=files)
        self.assertAlmostEqual(scene.sky.scale[0], 5 / math.pi, delta=0.01)
        self.assertIn("twice as much", " ".join(said(notes)))

    def test_an_image_and_a_constant(self) -> None:
        files = {"a.pfm": pfm(np.ones((4, 4, 3)))}
        sky = world('LightSource "infinite" "string filename" "a.pfm" "float scale" 3\n'
                    'LightSource "infinite" "rgb L" [1 2 3]',
                    files=files)[0].sky
        np.testing.assert_allclose(seen(sky, (0, 1, 0.1)), (4, 5, 6), rtol=1e-6)

    def test_problems(self) -> None:
        files = {"a.pfm": pfm(np.ones((4, 8, 3))), "b.pfm": pfm(np.ones((4, 4, 3))), "c.pfm": struct.pack("<I", 7)}
        light = 'LightSource "infinite" "string filename" '
        self.assertIn("8 x 4 pixels; a sky of pbrt-v4 must be square", world_problem(light + '"a.pfm"', files=files))
        self.assertIn("takes one of them", world_problem(light + '"b.pfm" "rgb L" [1 1 1]', files=files))
        self.assertIn("c.pfm", world_problem(light + '"c.pfm"', files=files))
        self.assertIn("a second sky with an image", world_problem(f'{light}"b.pfm"\n' * 2, files=files))
        _, notes = world(light + '"b.pfm" "point3 portal" [0 0 0 1 0 0 1 1 0 0 1 0]', files=files)
        self.assertIn("portal", " ".join(said(notes)))


if __name__ == "__main__":
    unittest.main()
