"""Materials: which parameters and defaults of Mitsuba's plugins reach the models, and how textures lie."""

from __future__ import annotations

import io
import unittest

import numpy as np
from PIL import Image as Pillow

from mitsuba_scenes import MitsubaTest, world_fronts
from importer.scene import Material, Part, Texture, Wrap

# A copper as veach-ajar writes its metals, and what ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2) makes of it by hand.
_METAL = '<rgb name="eta" value="0.2, 1, 2"/><rgb name="k" value="4, 3, 2"/>'
_METAL_F0 = ((0.64 + 16) / (1.44 + 16), 9 / 13, 5 / 13)


def png(pixels: list[list[tuple[int, int, int]]]) -> bytes:
    data = io.BytesIO()
    Pillow.fromarray(np.array(pixels, np.uint8)).save(data, "PNG")
    return data.getvalue()


def linear(byte: int) -> float:
    value = byte / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def looked_up(texture: Texture, u: float, v: float) -> np.ndarray:
    """The nearest texel at a point of the surface: row 0 of the image at v = 0."""
    x, y = texture.image_from_uv @ (u, v, 1)
    pixels = texture.image.pixels
    height, width = pixels.shape[:2]
    texel = pixels[int(np.floor(y * height)) % height, int(np.floor(x * width)) % width, :3]
    values = np.array([linear(byte) for byte in texel]) if pixels.dtype == np.uint8 else texel
    return values * texture.scale


class MaterialsTest(MitsubaTest):
    def part(self, bsdf: str, version: str = "3.0.0", shape: str = "rectangle", is_lenient: bool = False) -> Part:
        return self.read(f'<shape type="{shape}">{bsdf}</shape>', version, is_lenient).parts[0]

    def material(self, bsdf: str, version: str = "3.0.0") -> Material:
        return self.part(bsdf, version).material


class ModelsTest(MaterialsTest):
    def test_diffuse(self) -> None:
        self.assert_close(self.material('<bsdf type="diffuse"/>').base_colour, (0.5, 0.5, 0.5))
        self.assert_noted("front alone, without twosided")
        twosided = '<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.1 0.2 0.3"/></bsdf></bsdf>'
        self.assert_close(self.material(twosided).base_colour, (0.1, 0.2, 0.3))
        self.assertEqual(self.noted(), [])
        srgb = '<bsdf type="diffuse"><srgb name="reflectance" value="#ff8000"/></bsdf>'
        self.assert_close(self.material(srgb, "0.6.0").base_colour, (1, linear(128), 0))
        self.assert_close(self.material(srgb.replace("srgb", "rgb"), "0.6.0").base_colour, (1, 128 / 255, 0))

    def test_spectra_of_reflectances(self) -> None:
        """A reflectance of 0.5 all over is grey under 3's daylight, and coloured under 0.6's equal energy."""
        body = '<bsdf type="diffuse"><spectrum name="reflectance" value="300:0.5, 900:0.5"/></bsdf>'
        self.assert_close(self.material(body).base_colour, (0.5, 0.5, 0.5), 2e-3)
        self.assert_close(self.material(body, "0.6.0").base_colour, (0.6024, 0.4742, 0.4544), 2e-3)
        self.write("grey.spd", "# half\n300 0.5\n900 0.5\n")
        self.assert_close(self.material('<bsdf type="diffuse"><spectrum name="reflectance" '
                                        'filename="grey.spd"/></bsdf>').base_colour,
                          (0.5, 0.5, 0.5), 2e-3)
        uniform = ('<bsdf type="diffuse"><spectrum type="uniform" name="reflectance"><float name="value" value="0.3"/>'
                   "</spectrum></bsdf>")
        self.assert_close(self.material(uniform).base_colour, (0.3, 0.3, 0.3))

    def test_conductors(self) -> None:
        smooth = self.material(f'<bsdf type="conductor">{_METAL}</bsdf>')
        self.assertEqual((smooth.metallic, smooth.roughness), (1, 0))
        self.assert_close(smooth.base_colour, _METAL_F0)
        rough = self.material(f'<bsdf type="roughconductor"><float name="alpha" value="0.25"/>{_METAL}</bsdf>')
        self.assertAlmostEqual(rough.roughness, 0.5)
        self.assert_noted("Beckmann")
        self.assertAlmostEqual(self.material(f'<bsdf type="roughconductor">{_METAL}</bsdf>').roughness, np.sqrt(0.1))
        ggx = ('<string name="distribution" value="ggx"/><float name="alpha_u" value="0.04"/>'
               '<float name="alpha_v" value="0.16"/>')
        self.assertAlmostEqual(self.material(f'<bsdf type="roughconductor">{ggx}{_METAL}</bsdf>').roughness, np.sqrt(0.08))
        self.assertFalse(any("Beckmann" in text for text in self.noted()))

    def test_a_conductor_within_another_medium(self) -> None:
        """0.6 divides eta and k by extEta (SmoothConductor)."""
        body = f'<bsdf type="conductor">{_METAL}<string name="extEta" value="water"/></bsdf>'
        eta, k = np.array([0.2, 1, 2]) / 1.333, np.array([4, 3, 2]) / 1.333
        self.assert_close(self.material(body, "0.6.0").base_colour, ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2))

    def test_default_conductors(self) -> None:
        """Copper in 0.6, a perfect mirror in 3."""
        red, green, blue = self.material('<bsdf type="conductor"/>', "0.6.0").base_colour
        self.assertTrue(red > 0.85 and 0.4 < green < 0.75 and blue < green)
        self.assert_close(self.material('<bsdf type="conductor"/>').base_colour, (1, 1, 1))
        none = '<bsdf type="conductor"><string name="material" value="none"/></bsdf>'
        self.assert_close(self.material(none, "0.6.0").base_colour, (1, 1, 1))
        self.assertIn("Unobtainium", self.problem('<shape type="cube"><bsdf type="conductor">'
                                                  '<string name="material" value="Unobtainium"/></bsdf></shape>'))

    def test_dielectrics(self) -> None:
        glass = self.material('<bsdf type="dielectric"/>')
        self.assertAlmostEqual(glass.ior, 1.5046 / 1.000277)
        self.assertEqual((glass.transmission, glass.is_thin, glass.roughness), (1, False, 0))
        water = '<string name="intIOR" value="water"/><float name="extIOR" value="1"/>'
        self.assertAlmostEqual(self.material(f'<bsdf type="dielectric">{water}</bsdf>', "0.6.0").ior, 1.333)
        rough = self.material('<bsdf type="roughdielectric"><float name="alpha" value="0.09"/></bsdf>')
        self.assertAlmostEqual(rough.roughness, 0.3)
        self.assertTrue(self.material('<bsdf type="thindielectric"/>').is_thin)
        self.assertIn("no index of refraction", self.problem('<shape type="cube"><bsdf type="dielectric">'
                                                             '<string name="int_ior" value="jelly"/></bsdf></shape>'))

    def test_a_bubble_is_turned_inside_out(self) -> None:
        """An index below 1 behind the front is one above 1 before it: glTF's volume lies on the other side."""
        body = '<bsdf type="dielectric"><float name="int_ior" value="1"/><float name="ext_ior" value="1.5"/></bsdf>'
        part = self.part(body)
        self.assertAlmostEqual(part.material.ior, 1.5)
        self.assert_close(world_fronts(part), [(0, 0, -1)] * 2)

    def test_plastics(self) -> None:
        for kind, roughness in (("plastic", 0), ("roughplastic", np.sqrt(0.1))):
            plastic = self.material(f'<bsdf type="{kind}"/>')
            self.assertAlmostEqual(plastic.ior, 1.49 / 1.000277, 4)
            self.assertAlmostEqual(plastic.roughness, roughness)
            self.assertEqual(plastic.specular, 1)

    def test_masks_blends_and_nests(self) -> None:
        inner = '<bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf>'
        self.assertEqual(self.material(f'<bsdf type="mask">{inner.format(1)}</bsdf>').opacity, 0.5)
        bumps = f'<texture type="checkerboard"/><float name="scale" value="2"/>{inner.format("0.2 0.4 0.6")}'
        nest = (f'<bsdf type="mask" id="leaf"><float name="opacity" value="0.25"/><bsdf type="twosided">'
                f'<bsdf type="bumpmap">{bumps}</bsdf></bsdf></bsdf>')
        material = self.material(nest)
        self.assertEqual((material.opacity, material.name), (0.25, "leaf"))
        self.assert_close(material.base_colour, (0.2, 0.4, 0.6))
        self.assertEqual(self.noted(), ["left out: bump maps"])
        blend = f'<bsdf type="blendbsdf"><float name="weight" value="0.25"/>{inner.format(0)}{inner.format(1)}</bsdf>'
        self.assert_close(self.material(blend).base_colour, (0.25, 0.25, 0.25))
        mixture = (f'<bsdf type="mixturebsdf"><string name="weights" value="0.5, 0.3, '
                   f'0.2"/>{inner.format(1)}{inner.format(0)}'
                   f'{inner.format(0.5)}</bsdf>')
        self.assert_close(self.material(mixture, "0.6.0").base_colour, (0.6, 0.6, 0.6))
        self.assertIn("holds 1 <bsdf>", self.problem(f'<shape type="cube"><bsdf '
                                                     f'type="blendbsdf">{inner.format(1)}</bsdf></shape>'))

    def test_two_sides(self) -> None:
        body = '<bsdf type="twosided"><bsdf type="diffuse"/><bsdf type="plastic"/></bsdf>'
        self.assert_close(self.material(body).base_colour, (0.5, 0.5, 0.5))
        self.assert_noted("different materials on the two sides")

    def test_null_is_not_there(self) -> None:
        scene = self.read('<shape type="cube"><bsdf type="null"/></shape><shape type="rectangle"/>')
        self.assertEqual(len(scene.parts), 1)
        self.assert_noted("surfaces that nothing sees")

    def test_principled(self) -> None:
        body = ('<bsdf type="principled"><rgb name="base_color" value="0.1 0.2 0.3"/>'
                '<float name="metallic" value="1"/></bsdf>')
        material = self.material(body)
        self.assert_close(material.base_colour, (0.1, 0.2, 0.3))
        self.assertEqual(material.metallic, 1)
        self.assertIn("both", self.problem('<shape type="cube"><bsdf type="principled"><float name="eta" value="1.4"/>'
                                           '<float name="specular" value="0.4"/></bsdf></shape>'))

    def test_one_material_for_all_references(self) -> None:
        scene = self.read('<bsdf type="plastic" id="a"/><shape type="cube"><ref id="a"/></shape>'
                          '<shape type="sphere"><ref id="a"/></shape>')
        self.assertIs(scene.parts[0].material, scene.parts[1].material)
        self.assertEqual(scene.parts[0].material.name, "a")

    def test_what_is_refused(self) -> None:
        self.assertIn('"hk"', self.problem('<shape type="cube"><bsdf type="hk"/></shape>'))
        self.part('<bsdf type="ward"><rgb name="diffuse_reflectance" value="1"/></bsdf>', is_lenient=True)
        self.assertEqual(self.noted(), ['left out: a bsdf of type "ward"'])
        self.assertIn("known are", self.problem('<shape type="cube"><bsdf type="velvet"/></shape>'))
        self.assertIn("medium", self.problem('<shape type="cube"><medium type="homogeneous" name="interior"/></shape>'))
        self.assertIn("below a surface", self.problem('<shape type="cube"><subsurface type="dipole"/></shape>', "0.6.0"))
        self.assertIn("negative", self.problem('<shape type="cube"><bsdf type="diffuse"><rgb name="reflectance" value="-1"/>'
                                               "</bsdf></shape>"))
        self.read('<shape type="cube"><bsdf type="diffuse"><float name="glow" value="1"/></bsdf></shape>')
        self.assert_noted('left out: the parameter "glow" of bsdf diffuse')


class TexturesTest(MaterialsTest):
    def texture(self, body: str, version: str = "3.0.0") -> Texture:
        texture = self.material(f'<bsdf type="diffuse"><texture name="reflectance" {body}</texture></bsdf>',
                                version).base_colour
        assert isinstance(texture, Texture)
        return texture

    def test_bitmap(self) -> None:
        self.write("a.png", png([[(255, 0, 0), (0, 255, 0)], [(0, 0, 255), (128, 128, 128)]]))
        texture = self.texture('type="bitmap"><string name="filename" value="a.png"/>')
        self.assert_close(looked_up(texture, 0.1, 0.1), (1, 0, 0))
        self.assert_close(looked_up(texture, 0.9, 0.1), (0, 1, 0))
        self.assert_close(looked_up(texture, 0.9, 0.9), [linear(128)] * 3)
        self.assertEqual(texture.wrap, (Wrap.REPEAT, Wrap.REPEAT))
        self.assertFalse(texture.is_nearest)
        self.assertEqual(texture.image.encoded, (self.folder / "a.png").read_bytes())

    def test_raw_filter_and_wrap(self) -> None:
        self.write("a.png", png([[(128, 128, 128)]]))
        options = ('type="bitmap"><string name="filename" value="a.png"/><boolean name="raw" value="true"/>'
                   '<string name="filter_type" value="nearest"/><string name="wrap_mode" value="mirror"/>')
        texture = self.texture(options)
        self.assert_close(looked_up(texture, 0.5, 0.5), [128 / 255] * 3)
        self.assertEqual((texture.is_nearest, texture.wrap), (True, (Wrap.MIRRORED, Wrap.MIRRORED)))
        old = ('type="bitmap"><string name="filename" value="a.png"/><float name="gamma" value="1"/>'
               '<string name="wrapModeV" value="clamp"/><string name="filterType" value="ewa"/>')
        texture = self.texture(old, "0.6.0")
        self.assert_close(looked_up(texture, 0.5, 0.5), [128 / 255] * 3)
        self.assertEqual(texture.wrap, (Wrap.REPEAT, Wrap.CLAMP))

    def test_transforms_of_uv(self) -> None:
        """3: the steps of to_uv one after the other; 0.6: uv * scale + offset (Texture2D)."""
        self.write("a.png", png([[(1, 2, 3)]]))
        new = self.texture('type="bitmap"><string name="filename" value="a.png"/><transform name="to_uv"><scale x="2" '
                           'y="3"/>'
                           '<translate x="0.25" y="0.5"/></transform>')
        old = self.texture('type="bitmap"><string name="filename" value="a.png"/><float name="uscale" value="2"/>'
                           '<float name="vscale" value="3"/><float name="uoffset" value="0.25"/>'
                           '<float name="voffset" value="0.5"/>', "0.6.0")
        for texture in (new, old):
            self.assert_close(texture.image_from_uv @ (0.1, 0.2, 1), (0.45, 1.1))
        turned = self.texture('type="bitmap"><string name="filename" value="a.png"/><transform name="to_uv">'
                              '<rotate z="1" angle="90"/></transform>')
        self.assert_close(turned.image_from_uv @ (1, 0, 1), (0, 1))

    def test_checkerboard(self) -> None:
        """color0 where both are in the first, or both in the second half of their period (Checkerboard::eval)."""
        texture = self.texture('type="checkerboard"><rgb name="color0" value="0.8"/><rgb name="color1" value="0.1, 0.2, '
                               '0.3"/>'
                               '<transform name="to_uv"><scale x="20" y="80"/></transform>')
        for u, v in np.random.default_rng(1).uniform(-1, 2, (40, 2)):
            is_first = ((20 * u) % 1 > 0.5) == ((80 * v) % 1 > 0.5)
            self.assert_close(looked_up(texture, u, v), (0.8, 0.8, 0.8) if is_first else (0.1, 0.2, 0.3))
        self.assertTrue(texture.is_nearest)
        default = self.texture('type="checkerboard">', "0.6.0")
        self.assert_close(looked_up(default, 0.1, 0.1), [0.4] * 3)
        self.assert_close(looked_up(default, 0.1, 0.6), [0.2] * 3)

    def test_scale(self) -> None:
        texture = self.texture('type="scale"><rgb name="scale" value="0.5, 1, 0.25"/><texture type="checkerboard"/>',
                               "0.6.0")
        self.assert_close(looked_up(texture, 0.1, 0.1), (0.2, 0.4, 0.1))
        constant = self.material('<bsdf type="diffuse"><texture name="reflectance" type="scale"><float name="scale" '
                                 'value="0.5"/>'
                                 '<rgb name="value" value="0.4"/></texture></bsdf>', "0.6.0")
        self.assert_close(constant.base_colour, (0.2, 0.2, 0.2))

    def test_numbers_from_textures(self) -> None:
        material = self.material(f'<bsdf type="roughconductor">{_METAL}<texture name="alpha" type="checkerboard">'
                                 '<rgb name="color0" value="0.25"/><rgb name="color1" value="0.04"/></texture></bsdf>')
        self.assertIsInstance(material.roughness, Texture)
        self.assert_close(looked_up(material.roughness, 0.1, 0.1), [0.5] * 3)
        self.assert_close(looked_up(material.roughness, 0.1, 0.6), [0.2] * 3)

    def test_what_is_wrong(self) -> None:
        self.write("broken.png", b"\x89PNG\r\n\x1a\nno")
        for body, part in (('type="bitmap">', "needs a \"filename\""),
                           ('type="bitmap"><string name="filename" value="none.png"/>', "no file \"none.png\""),
                           ('type="bitmap"><string name="filename" value="broken.png"/>', "broken.png"),
                           ('type="marble">', "known are"), ('type="wireframe">', '"wireframe"'),
                           ('type="checkerboard"><transform name="to_uv"><scale x="0"/></transform>', "no area")):
            with self.subTest(body):
                self.assertIn(part, self.problem(f'<shape type="cube"><bsdf type="diffuse"><texture name="reflectance" '
                                                 f'{body}'
                                                 "</texture></bsdf></shape>"))


class NormalMapTest(MaterialsTest):
    """A map whose one normal leans along x and, less, along y: (0.6, 0.48, 0.64)."""

    NORMAL = np.array([0.6, 0.48, 0.64])
    BODY = ('<bsdf type="normalmap"><texture name="normalmap" type="bitmap"><boolean name="raw" value="true"/>'
            '<string name="filename" value="n.png"/></texture><bsdf type="diffuse"/></bsdf>')

    def leaning(self, part: Part) -> np.ndarray:
        """glTF's: x along u, y against v, z along the normal (3.9.3); of a triangle, by its dp/du and dp/dv."""
        corner = part.mesh.triangles[0]
        p, uv = part.mesh.positions[corner] @ part.to_world[:3, :3].T, part.mesh.uvs[corner]
        du, dv = np.linalg.solve(np.stack([uv[1] - uv[0], uv[2] - uv[0]]), np.stack([p[1] - p[0], p[2] - p[0]]))
        x, y, z = 2 * looked_up(part.material.normal_map, 0.5, 0.5) - 1
        return x * du / np.linalg.norm(du) - y * dv / np.linalg.norm(dv) + z * world_fronts(part)[0]

    def test_directions(self) -> None:
        """Mitsuba's frame: s along dp/du, t = n x s (NormalMap::frame)."""
        self.write("n.png", png([[tuple(np.round((self.NORMAL + 1) / 2 * 255).astype(int))]]))
        self.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")
        obj = '<shape type="obj"><string name="filename" value="mesh.obj"/>'
        mirror = '<transform name="to_world"><scale x="-1"/></transform>'
        # u runs along s; what n x s is then, by hand.
        cases = ((f'<shape type="rectangle">{self.BODY}</shape>', (1, 0, 0), (0, 1, 0), (0, 0, 1)),
                 (f'<shape type="rectangle">{mirror}{self.BODY}</shape>', (-1, 0, 0), (0, -1, 0), (0, 0, 1)),
                 (f"{obj}{self.BODY}</shape>", (1, 0, 0), (0, 1, 0), (0, 0, 1)),
                 (f"{obj}{mirror}{self.BODY}</shape>", (-1, 0, 0), (0, 1, 0), (0, 0, -1)))
        for body, s, t, n in cases:
            with self.subTest(body):
                part = self.read(body).parts[0]
                self.assert_close(np.cross(n, s), t)
                self.assert_close(self.leaning(part), self.NORMAL @ np.array([s, t, n]), 0.01)


if __name__ == "__main__":
    unittest.main()
