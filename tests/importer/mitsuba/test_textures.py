"""Textures: how they lie on surfaces, what their colours and numbers are, and normal maps."""

from __future__ import annotations

import unittest

import numpy as np

from mitsuba_scenes import MaterialsTest, linear, looked_up, png, world_fronts
from importer.scene import Part, Texture, Wrap

_METAL = '<rgb name="eta" value="0.2, 1, 2"/><rgb name="k" value="4, 3, 2"/>'


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
