"""Materials: which parameters and defaults of Mitsuba's plugins reach the models."""

from __future__ import annotations

import unittest

import numpy as np

from mitsuba_scenes import MaterialsTest, linear, world_fronts

# A metal, and what ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2) makes of it by hand.
_METAL = '<rgb name="eta" value="0.2, 1, 2"/><rgb name="k" value="4, 3, 2"/>'
_METAL_F0 = ((0.64 + 16) / (1.44 + 16), 9 / 13, 5 / 13)


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

    def test_what_a_rough_surface_reflects_inside_differs_between_versions(self) -> None:
        """Of white below a surface of alpha 0.3 version 3 keeps more, since it counts once scattered light alone."""
        body = '<bsdf type="roughplastic"><float name="alpha" value="0.3"/><rgb name="{}" value="0.99"/></bsdf>'
        bases = [max(self.material(body.format(name), version).base_colour)
                 for name, version in (("diffuseReflectance", "0.6.0"), ("diffuse_reflectance", "3.0.0"))]
        self.assertGreater(bases[0], 1.3 * bases[1])

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

    def test_media_that_only_absorb_are_the_glass(self) -> None:
        """0.6 has sigmaS and sigmaA, or sigmaT and albedo; Mitsuba 3 the latter; both times scale (homogeneous.cpp)."""
        shape = '<shape type="sphere"><bsdf type="{}"/><medium type="homogeneous" name="{}">{}</medium></shape>'
        absorbs = '<rgb name="sigmaS" value="0, 0, 0"/><rgb name="sigmaA" value="1, 2, 4"/><float name="scale" value="10"/>'
        total = '<float name="albedo" value="0"/><rgb name="sigma_t" value="10, 20, 40"/><phase type="isotropic"/>'
        for text, version in ((absorbs, "0.6.0"), (total, "3.0.0")):
            material = self.read(shape.format("dielectric", "interior", text), version).parts[0].material
            left = np.log(material.attenuation_colour) / material.attenuation_distance
            self.assert_close(left, (-10, -20, -40), 1e-9)
            self.assertFalse([note for note in self.noted() if "medi" in note or "phase" in note])
        scatters = total.replace('"0"', '"0.1"')
        for bsdf, name, text in (("dielectric", "interior", scatters), ("dielectric", "exterior", total),
                                 ("thindielectric", "interior", total), ("diffuse", "interior", total),
                                 ("dielectric", "interior", "")):
            self.assertIn("a medium that scatters light, or is not within", self.problem(shape.format(bsdf, name, text)))

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


if __name__ == "__main__":
    unittest.main()
