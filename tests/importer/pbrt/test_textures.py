"""pbrt's textures and masks: which texel lies where, and its value, by textures.cpp (v4) and textures/ (v3)."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from importer.scene import Texture, Wrap  # noqa: E402
from pbrt_scene import HEAD, HEAD_V3, TRIANGLE, material, png, world, world_problem  # noqa: E402


def linear(byte: int) -> float:
    """IEC 61966-2-1."""
    value = byte / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def texel(texture: object, u: float, v: float) -> np.ndarray:
    """The nearest texel in linear colours at pbrt's u and v, which go upwards; repeated."""
    assert isinstance(texture, Texture)
    x, y = texture.image_from_uv @ (u, 1 - v, 1)
    height, width = texture.image.pixels.shape[:2]
    found = texture.image.pixels[int(y % 1 * height), int(x % 1 * width), :3]
    if texture.image.pixels.dtype == np.uint8:
        found = np.array([linear(int(value)) for value in found])
    return found * np.array(texture.scale)


FOUR = png([[(255, 0, 0), (0, 255, 0)], [(0, 0, 255), (128, 128, 128)]])  # red and green above, blue and grey below


class Masks(unittest.TestCase):
    def test_numbers(self) -> None:
        shape = TRIANGLE.strip() + ' "float alpha" {}'
        self.assertAlmostEqual(float(world(shape.format(0.25))[0].parts[0].material.opacity), 0.25)
        self.assertEqual(world(shape.format(0))[0].parts, [])
        self.assertEqual(world(shape.format(0), HEAD_V3)[0].parts, [])
        self.assertEqual(world(shape.format(0.25), HEAD_V3)[0].parts[0].material.opacity, 1.0)

    def test_textures(self) -> None:
        """v4 takes the alpha of an image that has one, and its share of rays; v3 cuts away where it is 0."""
        files = {"a.png": png([[(255, 255, 255, 0), (0, 0, 0, 255)]])}
        text = 'Texture "t" "float" "imagemap" "string filename" "a.png"\n' + TRIANGLE.strip() + ' "texture alpha" "t"'
        opacity = world(text, HEAD, files)[0].parts[0].material.opacity
        np.testing.assert_allclose(texel(opacity, 0.25, 0.5), (0, 0, 0))
        np.testing.assert_allclose(texel(opacity, 0.75, 0.5), (1, 1, 1))
        files = {"a.png": png([[(0, 0, 0), (40, 40, 40)]])}
        opacity = world(text, HEAD_V3, files)[0].parts[0].material.opacity
        np.testing.assert_allclose(texel(opacity, 0.25, 0.5), (0, 0, 0))
        np.testing.assert_allclose(texel(opacity, 0.75, 0.5), (1, 1, 1))


class Textures(unittest.TestCase):
    def colour(self, definition: str, head: str = HEAD, files: dict[str, bytes] | None = None) -> Texture:
        kind, name = ("diffuse", "reflectance") if head == HEAD else ("matte", "Kd")
        made, self.notes = material(f'{definition}\nMaterial "{kind}" "texture {name}" "t"', head,
                                    files or {"a.png": FOUR})
        return made.base_colour  # type: ignore[return-value]

    def test_images_have_their_last_row_at_v_0(self) -> None:
        texture = self.colour('Texture "t" "spectrum" "imagemap" "string filename" "a.png"')
        grey = [linear(128)] * 3
        for u, v, rgb in ((.25, .75, (1, 0, 0)), (.75, .75, (0, 1, 0)), (.25, .25, (0, 0, 1)), (.75, .25, grey)):
            np.testing.assert_allclose(texel(texture, u, v), rgb)
        self.assertIsNotNone(texture.image.encoded)
        self.assertEqual(texture.wrap, (Wrap.REPEAT, Wrap.REPEAT))

    def test_mapping(self) -> None:
        """s = 2 u + 0.25, t = 1.5 v + 0.3 (UVMapping::Map)."""
        plain = self.colour('Texture "t" "spectrum" "imagemap" "string filename" "a.png"')
        mapped = self.colour('Texture "t" "spectrum" "imagemap" "string filename" "a.png" "float uscale" 2'
                             ' "float vscale" 1.5'
                             ' "float udelta" .25 "float vdelta" .3')
        for u in np.arange(0.03, 1, 0.1):
            for v in np.arange(0.02, 1, 0.1):
                np.testing.assert_allclose(texel(mapped, u, v), texel(plain, 2 * u + .25, 1.5 * v + .3))

    def test_encodings(self) -> None:
        text = 'Texture "t" "spectrum" "imagemap" "string filename" "a.png" '
        np.testing.assert_allclose(texel(self.colour(text + '"string encoding" "linear"'), .75, .25), [128 / 255] * 3)
        cubed = self.colour(text + '"string encoding" "gamma 3"')
        np.testing.assert_allclose(texel(cubed, .75, .25), [(128 / 255) ** 3] * 3, atol=2e-3)
        v3 = text.replace("spectrum", "color")
        np.testing.assert_allclose(texel(self.colour(v3 + '"bool gamma" "false"', HEAD_V3), .75, .25), [128 / 255] * 3)
        np.testing.assert_allclose(texel(self.colour(v3, HEAD_V3), .75, .25), [linear(128)] * 3)
        self.assertIn('no encoding "x"', world_problem(text + '"string encoding" "x"\nMaterial "diffuse"'
                                                       ' "texture reflectance" "t"\n' + TRIANGLE, files={"a.png": FOUR}))

    def test_scale_and_invert(self) -> None:
        text = 'Texture "t" "spectrum" "imagemap" "string filename" "a.png" "float scale" 0.5 '
        np.testing.assert_allclose(texel(self.colour(text), .25, .75), (.5, 0, 0))
        np.testing.assert_allclose(texel(self.colour(text + '"bool invert" true'), .25, .75), (.5, 1, 1), atol=5e-3)

    def test_wraps(self) -> None:
        for wrap, found in (("clamp", Wrap.CLAMP), ("black", Wrap.CLAMP), ("repeat", Wrap.REPEAT)):
            texture = self.colour(f'Texture "t" "spectrum" "imagemap" "string filename" "a.png" "string wrap" "{wrap}"')
            self.assertEqual(texture.wrap, (found, found))
            self.assertEqual("border" in " ".join(self.notes), wrap == "black")

    def test_checkerboards(self) -> None:
        """tex1 where floor(s) + floor(t) is even."""
        texture = self.colour('Texture "t" "spectrum" "checkerboard" "float uscale" 4 "float vscale" 2 "rgb tex1" [.1 .2 .3]'
                              ' "rgb tex2" [.7 .8 .9]')
        for u in (0.1, 0.3, 0.6, 0.9, 1.1):
            for v in (0.1, 0.4, 0.6, 0.9, 1.3):
                even = (math.floor(4 * u) + math.floor(2 * v)) % 2 == 0
                np.testing.assert_allclose(texel(texture, u, v), (.1, .2, .3) if even else (.7, .8, .9))

    def test_arithmetic(self) -> None:
        image = 'Texture "i" "{}" "imagemap" "string filename" "a.png"\n'
        v4 = self.colour(image.format("spectrum") + 'Texture "t" "spectrum" "scale" "texture tex" "i" "float scale" 0.25')
        np.testing.assert_allclose(texel(v4, .25, .75), (.25, 0, 0))
        v3 = self.colour(image.format("color")
                         + 'Texture "t" "color" "scale" "texture tex1" "i" "rgb tex2" [.5 1 1]', HEAD_V3)
        np.testing.assert_allclose(texel(v3, .25, .75), (.5, 0, 0))
        brighter = self.colour(image.format("color") + 'Texture "t" "color" "scale" "texture tex1" "i" "rgb tex2" [2 2 2]',
                               HEAD_V3)
        np.testing.assert_allclose(texel(brighter, .75, .25), [2 * linear(128)] * 3, atol=5e-3)
        mixed = self.colour(image.format("spectrum") + 'Texture "t" "spectrum" "mix" "texture tex1" "i" "rgb tex2" [0 0 1]'
                            ' "float amount" 0.25')
        np.testing.assert_allclose(texel(mixed, .25, .75), (.75, 0, .25), atol=5e-3)
        constant = self.colour('Texture "c" "spectrum" "constant" "rgb value" [.2 .4 .6]\n'
                               'Texture "t" "spectrum" "scale" "texture tex" "c" "float scale" .5')
        np.testing.assert_allclose(constant, (.1, .2, .3))

    def test_numbers(self) -> None:
        """glTF's roughness texel is the fourth root of pbrt-v4's."""
        made, _ = material('Texture "t" "float" "imagemap" "string filename" "a.png" "string encoding" "linear"\n'
                           'Material "conductor" "texture roughness" "t"', files={"a.png": FOUR})
        np.testing.assert_allclose(texel(made.roughness, .75, .25), [(128 / 255) ** 0.25] * 3, atol=5e-3)

    def test_patterns_are_refused_and_lenient_means_stand_for_them(self) -> None:
        text = 'Texture "t" "spectrum" "marble"\nMaterial "diffuse" "texture reflectance" "t"'
        self.assertIn("marble", world_problem(text + "\n" + TRIANGLE))
        np.testing.assert_allclose(material(text, is_lenient=True)[0].base_colour, (.5, .5, .5))
        text = ('Texture "t" "spectrum" "imagemap" "string filename" "a.png" "string mapping" "planar"\n'
                'Material "diffuse" "texture reflectance" "t"\n')
        self.assertIn("planar", world_problem(text + TRIANGLE, files={"a.png": FOUR}))

    def test_an_image_used_twice_is_read_once(self) -> None:
        scene, _ = world('Texture "a" "spectrum" "imagemap" "string filename" "a.png"\n'
                         'Texture "b" "spectrum" "imagemap" "string filename" "a.png" "float uscale" 2\n'
                         f'Material "diffuse" "texture reflectance" "a"\n{TRIANGLE}'
                         f'Material "diffuse" "texture reflectance" "b"\n{TRIANGLE}', files={"a.png": FOUR})
        first, second = (part.material.base_colour for part in scene.parts)
        assert isinstance(first, Texture) and isinstance(second, Texture)
        self.assertIs(first.image, second.image)


if __name__ == "__main__":
    unittest.main()
