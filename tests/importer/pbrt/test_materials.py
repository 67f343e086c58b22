"""pbrt's materials as glTF's, by the formulas and defaults of materials.cpp (v4) and materials/ (v3)."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_scene import HEAD_V3, TRIANGLE, material, png, said, world, world_problem  # noqa: E402


class Version4(unittest.TestCase):
    def test_diffuse(self) -> None:
        made, _ = material('Material "diffuse" "rgb reflectance" [.1 .2 .3]')
        np.testing.assert_allclose(made.base_colour, (.1, .2, .3))
        self.assertEqual((made.specular, made.metallic), (0.0, 0.0))
        for text in ("", 'Material "diffuse"'):
            np.testing.assert_allclose(material(text)[0].base_colour, (.5, .5, .5))
        made, notes = material('Material "diffuse" "rgb reflectance" [2 .2 .3]')
        np.testing.assert_allclose(made.base_colour, (1, .2, .3))
        self.assertIn("reflectances above 1 as 1", notes)

    def test_conductors(self) -> None:
        """F0 = ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2); alpha = sqrt(roughness); glTF's roughness is its root."""
        made, _ = material('Material "conductor" "rgb eta" [1 2 .5] "rgb k" [1 0 2] "float roughness" 0.0625')
        np.testing.assert_allclose(made.base_colour, (1 / 5, 1 / 9, 4.25 / 6.25))
        self.assertEqual(made.metallic, 1.0)
        self.assertAlmostEqual(float(made.roughness), 0.5)
        made, _ = material('Material "conductor" "float roughness" 0.25 "bool remaproughness" false')
        self.assertAlmostEqual(float(made.roughness), 0.5)
        red, green, blue = made.base_colour  # copper
        self.assertTrue(0.9 < red <= 1 and 0.55 < green < 0.8 and 0.4 < blue < 0.7, made.base_colour)
        made, _ = material('Material "conductor" "rgb reflectance" [.3 .4 .5]')
        np.testing.assert_allclose(made.base_colour, (.3, .4, .5))
        self.assertEqual(made.roughness, 0.0)
        gold, _ = material('Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"')
        self.assertGreater(gold.base_colour[1], green + 0.05)
        self.assertLess(gold.base_colour[2], blue)
        made, _ = material('Material "conductor" "spectrum eta" [300 1 900 1] "spectrum k" [300 2 900 2]')
        np.testing.assert_allclose(made.base_colour, (.5, .5, .5), atol=2e-3)

    def test_anisotropic_roughness(self) -> None:
        made, notes = material('Material "conductor" "float uroughness" .04 "float vroughness" .16'
                               ' "bool remaproughness" false')
        self.assertAlmostEqual(float(made.roughness), math.sqrt(0.08))
        self.assertIn("anisotropic", " ".join(notes))
        made, notes = material('Material "conductor" "float roughness" .36 "float vroughness" .04'
                               ' "bool remaproughness" false')
        self.assertAlmostEqual(float(made.roughness), math.sqrt(0.12))

    def test_dielectrics(self) -> None:
        made, _ = material('Material "dielectric"')
        self.assertEqual((made.ior, made.transmission, made.is_thin, made.roughness), (1.5, 1.0, False, 0.0))
        made, notes = material('Material "dielectric" "spectrum eta" "glass-BK7" "float roughness" 0.0016')
        self.assertAlmostEqual(made.ior, 1.517, 2)
        self.assertAlmostEqual(float(made.roughness), 0.2)
        made, _ = material('Material "dielectric" "float eta" 2')
        self.assertEqual(made.ior, 2)
        made, notes = material('Material "dielectric" "spectrum eta" [400 1.6 589.3 1.55 700 1.5]')
        self.assertAlmostEqual(made.ior, 1.55)
        self.assertIn("dispersion: one index at all wavelengths", notes)
        made, notes = material('Material "dielectric" "spectrum eta" [400 1.6 700 1.6]')
        self.assertAlmostEqual(made.ior, 1.6)
        self.assertNotIn("dispersion", " ".join(notes))
        # R of one face is 1/25; both together 2 R / (1 + R) = 1/13.
        made, _ = material('Material "thindielectric"')
        self.assertTrue(made.is_thin)
        self.assertAlmostEqual(((made.ior - 1) / (made.ior + 1)) ** 2, 1 / 13)

    def test_coats(self) -> None:
        made, _ = material('Material "coateddiffuse" "rgb reflectance" [.2 .4 .6] "float roughness" 0')
        self.assertAlmostEqual(made.ior, 1.5)
        self.assertEqual((made.roughness, made.metallic), (0.0, 0.0))
        self.assertEqual(made.specular, 1.0)
        made, _ = material('Material "coatedconductor" "float conductor.roughness" 0.0625'
                           ' "float interface.roughness" 0.0001')
        self.assertEqual(made.metallic, 1.0)
        self.assertAlmostEqual(float(made.roughness), 0.5)
        self.assertAlmostEqual(made.clearcoat_roughness, 0.1)

    def test_mixtures(self) -> None:
        """ "amount" 0 is the first material and 1 the second."""
        names = ('MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [1 0 0]\n'
                 'MakeNamedMaterial "b" "string type" "diffuse" "rgb reflectance" [0 0 1]\n'
                 'Material "mix" "string materials" ["a" "b"] ')
        np.testing.assert_allclose(material(names + '"float amount" 0.25')[0].base_colour, (.75, 0, .25))
        np.testing.assert_allclose(material(names)[0].base_colour, (.5, 0, .5))
        self.assertIn('names the material "c"', world_problem(names.replace('"a" "b"]', '"a" "c"]') + TRIANGLE))

    def test_what_is_refused(self) -> None:
        for kind in ("hair", "subsurface", "measured"):
            self.assertIn("--lenient", world_problem(f'Material "{kind}"\n{TRIANGLE}'))
        made, notes = material('Material "diffusetransmission" "rgb reflectance" [.2 .2 .2] "float scale" 2',
                               is_lenient=True)
        np.testing.assert_allclose(made.base_colour, (.4, .4, .4))
        self.assertIn("diffuse light through a surface", notes)
        self.assertIn("no material", world_problem('Material "diffus"\n' + TRIANGLE))

    def test_relief(self) -> None:
        _, notes = material('Texture "d" "float" "constant"\nMaterial "diffuse" "texture displacement" "d"')
        self.assertEqual([note for note in notes if "filter" not in note], ["a bump map (displacement)"])
        made, _ = material('Material "diffuse" "string normalmap" "n.png"', files={"n.png": png([[(255, 128, 128)]])})
        assert made.normal_map is not None
        np.testing.assert_allclose(made.normal_map.image.pixels[0, 0, :3], (1, 128 / 255, 128 / 255))

    def test_named_materials_hold_until_the_state_ends(self) -> None:
        scene, _ = world('MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [1 0 0]\nAttributeBegin\n'
                         f'NamedMaterial "a"\n{TRIANGLE}AttributeEnd\n{TRIANGLE}NamedMaterial "a"\n{TRIANGLE}')
        colours = [part.material.base_colour for part in scene.parts]
        np.testing.assert_allclose(colours, [(1, 0, 0), (.5, .5, .5), (1, 0, 0)])
        self.assertIs(scene.parts[0].material, scene.parts[2].material)

    def test_materials_and_textures_may_be_defined_behind_the_shapes_that_name_them(self) -> None:
        """pbrt-v4 makes them when it has read the file; pbrt-v3 at once."""
        text = ('AttributeBegin\nNamedMaterial "a"\n' + TRIANGLE + "AttributeEnd\n"
                '{} "a" "string type" "{}" "texture {}" "t"\nTexture "t" "spectrum" "constant" "rgb value" [.1 .2 .3]')
        scene, _ = world(text.format("MakeNamedMaterial", "diffuse", "reflectance"))
        np.testing.assert_allclose(scene.parts[0].material.base_colour, (.1, .2, .3))
        self.assertIn('there is no material "a"', world_problem(text.format("MakeNamedMaterial", "matte", "Kd"), HEAD_V3))

    def test_unused_materials_are_not_looked_at(self) -> None:
        material('Material "hair"\nMaterial "diffuse"')


class Version3(unittest.TestCase):
    def made(self, text: str, **more):  # noqa: ANN003, ANN201
        return material(text, HEAD_V3, **more)[0]

    def test_roughness_by_the_polynomial(self) -> None:
        """alpha(0.1) = 1.62142 + 0.819955 x + 0.1734 x^2 + 0.0171201 x^3 + 0.000640711 x^4 with x = ln 0.1 = -2.302585:
        1.62142 - 1.888016 + 0.919334 - 0.208999 + 0.018010 = 0.461749."""
        made = self.made('Material "metal" "float roughness" 0.1')
        self.assertAlmostEqual(float(made.roughness), math.sqrt(0.461749), 4)
        made = self.made('Material "metal" "float roughness" 0.25 "bool remaproughness" "false"')
        self.assertAlmostEqual(float(made.roughness), 0.5)

    def test_no_roughness_is_smooth_in_glass_alone(self) -> None:
        """And there only where both are 0 (GlassMaterial); elsewhere the polynomial makes an alpha of 0.04727 of it."""
        least = math.sqrt(0.04727)
        for kind, values in (("metal", '"float roughness" 0'), ("plastic", '"float roughness" 0'),
                           ("uber", '"float roughness" 0'), ("substrate", '"float uroughness" 0 "float vroughness" 0')):
            self.assertAlmostEqual(float(self.made(f'Material "{kind}" {values}').roughness), least, 3, kind)
        self.assertEqual(self.made('Material "glass"').roughness, 0.0)
        made = self.made('Material "glass" "float uroughness" 0 "float vroughness" .1')
        self.assertAlmostEqual(float(made.roughness), (0.04727 * 0.461749) ** 0.25, 3)

    def test_matte_mirror_glass(self) -> None:
        np.testing.assert_allclose(self.made('Material "matte" "rgb Kd" [.1 .2 .3]').base_colour, (.1, .2, .3))
        np.testing.assert_allclose(self.made("").base_colour, (.5, .5, .5))
        mirror = self.made('Material "mirror"')
        self.assertAlmostEqual(float(mirror.specular), 0.9)
        self.assertEqual((mirror.ior, mirror.roughness), (0.0, 0.0))
        glass = self.made('Material "glass" "float index" 1.25')
        self.assertEqual((glass.ior, glass.transmission, glass.roughness), (1.25, 1.0, 0.0))
        self.assertEqual(self.made('Material "glass" "float eta" 1.75').ior, 1.75)

    def test_plastic_and_its_like(self) -> None:
        made = self.made('Material "plastic" "rgb Kd" [.4 .4 .4] "rgb Ks" [.1 .1 .1]')
        self.assertAlmostEqual(made.ior, 1.5)
        self.assertAlmostEqual(float(made.specular), 0.1)
        self.assertAlmostEqual(float(made.roughness), math.sqrt(0.461749), 4)
        substrate = self.made('Material "substrate" "rgb Ks" [.04 .04 .04]')
        self.assertEqual(substrate.specular, 1.0)
        np.testing.assert_allclose(substrate.specular_colour, (.04, .04, .04))
        uber = self.made('Material "uber" "rgb opacity" [.25 .25 .25]')
        self.assertAlmostEqual(float(uber.opacity), 0.25)

    def test_each_material_knows_its_own_roughness(self) -> None:
        """plastic: "roughness"; substrate and glass: "uroughness" and "vroughness"; metal: all of them."""
        both = '"float roughness" .25 "float uroughness" .04 "float vroughness" .04 "bool remaproughness" "false"'
        for kind, roughness, unknown in (("plastic", .5, "uroughness"), ("substrate", .2, "float roughness"),
                                         ("metal", .2, ""), ("glass", .2, "float roughness")):
            made, notes = material(f'Material "{kind}" {both}', HEAD_V3)
            self.assertAlmostEqual(float(made.roughness), roughness, 6, kind)
            self.assertEqual("the parameter" in " ".join(notes), unknown != "")
            self.assertIn(unknown, " ".join(notes))

    def test_disney(self) -> None:
        made = self.made('Material "disney" "rgb color" [.2 .4 .6] "float metallic" 0.5 "float roughness" 0.3')
        np.testing.assert_allclose(made.base_colour, (.2, .4, .6))
        self.assertEqual((made.metallic, made.roughness, made.ior), (0.5, 0.3, 1.5))
        scattering = f'Material "disney" "rgb scatterdistance" [1 1 1]\n{TRIANGLE}'
        self.assertIn("scatterdistance", world_problem(scattering, HEAD_V3))

    def test_mixtures_are_the_other_way_round(self) -> None:
        """ "amount" is the share of the first material (MixMaterial)."""
        text = ('MakeNamedMaterial "a" "string type" "matte" "rgb Kd" [1 0 0]\n'
                'MakeNamedMaterial "b" "string type" "matte" "rgb Kd" [0 0 1]\n'
                'Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" [.25 .25 .25]')
        np.testing.assert_allclose(self.made(text).base_colour, (.25, 0, .75))

    def test_names_are_forgotten_with_their_state(self) -> None:
        text = ('MakeNamedMaterial "a" "string type" "matte" "rgb Kd" [1 0 0]\nAttributeBegin\n'
                'MakeNamedMaterial "a" "string type" "matte" "rgb Kd" [0 1 0]\nAttributeEnd\nNamedMaterial "a"')
        np.testing.assert_allclose(self.made(text).base_colour, (1, 0, 0))

    def test_shapes_may_say_what_their_material_says(self) -> None:
        scene, notes = world('Material "matte" "rgb Kd" [1 0 0]\n' + TRIANGLE.strip() + ' "rgb Kd" [0 1 0]\n' + TRIANGLE,
                             HEAD_V3)
        np.testing.assert_allclose(scene.parts[0].material.base_colour, (0, 1, 0))
        np.testing.assert_allclose(scene.parts[1].material.base_colour, (1, 0, 0))
        self.assertEqual(said(notes), [])

    def test_metals_of_pbrts_own_folder(self) -> None:
        """Scenes come without these files, whose names say which metal it is."""
        gold = self.made('Material "metal" "spectrum eta" "spds/Au.eta.spd" "spectrum k" "spds/Au.k.spd"')
        copper = self.made('Material "metal"')
        self.assertGreater(gold.base_colour[1], copper.base_colour[1])


if __name__ == "__main__":
    unittest.main()
