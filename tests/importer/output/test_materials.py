"""Materials, textures and images of the .glb: that what a reader of glTF 2.0 makes of them is what scene.py says."""

from __future__ import annotations

import io
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image as Picture

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from glb_reading import Glb, image_from_uv, png_pixels
from importer.output.glb import write_glb
from importer.problems import ImportProblem, Notes
from importer.scene import Camera, Image, Material, Mesh, Part, Scene, Texture, Wrap
from scenes.png_file import png_bytes

SQUARE = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]),
              uvs=np.array([[0.0, 1], [1, 1], [1, 0], [0, 0]]))


def srgb_file(pixels: np.ndarray, kind: str = "PNG") -> bytes:
    file = io.BytesIO()
    Picture.fromarray(pixels).save(file, kind)
    return file.getvalue()


def bytes_image(rgb: list, name: str = "image") -> Image:
    pixels = np.array(rgb, np.uint8)
    return Image(name, pixels, srgb_file(pixels))


def linear(byte: int) -> float:
    """IEC 61966-2-1."""
    return byte / 255 / 12.92 if byte <= 10 else ((byte / 255 + 0.055) / 1.055) ** 2.4


class MaterialsTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.path, self.notes = Path(temporary.name) / "a.glb", Notes()

    def glb(self, *materials: Material, mesh: Mesh = SQUARE) -> Glb:
        parts = [Part(f"part_{i}", mesh, material) for i, material in enumerate(materials)]
        write_glb(Scene("a", Camera(np.eye(4), 40.0), parts), self.path, self.notes, {"file": "a.xml"})
        return Glb.read(self.path)

    def material(self, **properties: Any) -> tuple[dict[str, Any], dict[str, Any], Glb]:
        """As written, its extensions, and the file."""
        glb = self.glb(Material("m", **properties))
        said = glb.document["materials"][0]
        self.assertEqual(set(said.get("extensions", {})), set(glb.document.get("extensionsUsed", []))
                         - {"KHR_texture_transform"})
        return said, said.get("extensions", {}), glb

    def test_a_matt_surface_needs_one_extension(self) -> None:
        said, extensions, _ = self.material(base_colour=(0.1, 0.2, 0.3))
        self.assertEqual(said["pbrMetallicRoughness"],
                         {"baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": 0, "roughnessFactor": 1})
        self.assertEqual(extensions, {"KHR_materials_specular": {"specularFactor": 0}})
        self.assertNotIn("alphaMode", said)
        self.assertNotIn("emissiveFactor", said)

    def test_a_metal_needs_none(self) -> None:
        said, extensions, _ = self.material(base_colour=(0.9, 0.7, 0.5), metallic=1.0, roughness=0.3, ior=3.0)
        self.assertEqual(said["pbrMetallicRoughness"], {"baseColorFactor": [0.9, 0.7, 0.5, 1], "metallicFactor": 1,
                                                        "roughnessFactor": 0.3})
        self.assertEqual(extensions, {})

    def test_plastic_glass_and_coats(self) -> None:
        said, extensions, _ = self.material(specular=1.0, specular_colour=(1, 0.5, 0.25), ior=1.9, clearcoat=0.5,
                                            clearcoat_roughness=0.2)
        self.assertEqual(extensions, {"KHR_materials_specular": {"specularColorFactor": [1, 0.5, 0.25]},
                                      "KHR_materials_ior": {"ior": 1.9},
                                      "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.2}})
        _, thin, _ = self.material(specular=1.0, transmission=1.0)
        self.assertEqual(thin, {"KHR_materials_transmission": {"transmissionFactor": 1}})
        _, glass, _ = self.material(specular=1.0, transmission=0.8, is_thin=False, attenuation_colour=(0.5, 1, 1),
                                    attenuation_distance=3.0)
        self.assertEqual(glass["KHR_materials_volume"]["attenuationDistance"], 3)
        self.assertGreater(glass["KHR_materials_volume"]["thicknessFactor"], 0)
        self.assertEqual(glass["KHR_materials_volume"]["attenuationColor"], [0.5, 1, 1])

    def test_light(self) -> None:
        """Radiance is factor times strength, and the factor ends at 1; a lamp shines on its front alone."""
        said, extensions, _ = self.material(base_colour=(0, 0, 0), radiance=(5.0, 10.0, 2.0))
        self.assertEqual((said["emissiveFactor"], extensions["KHR_materials_emissive_strength"]),
                         ([0.5, 1, 0.2], {"emissiveStrength": 10}))
        self.assertNotIn("doubleSided", said)
        said, extensions, _ = self.material(radiance=(0.25, 0.5, 0.0), emits_both_sides=True)
        self.assertEqual(said["emissiveFactor"], [0.25, 0.5, 0])
        self.assertNotIn("KHR_materials_emissive_strength", extensions)
        self.assertTrue(said["doubleSided"])
        said, extensions, glb = self.material(radiance=Texture(bytes_image([[[255, 0, 128]]]), scale=(4, 4, 2)))
        self.assertEqual((said["emissiveFactor"], extensions["KHR_materials_emissive_strength"]),
                         ([1, 1, 0.5], {"emissiveStrength": 4}))
        np.testing.assert_allclose(glb.texels(said["emissiveTexture"]), [[[1, 0, 128 / 255]]])

    def test_a_file_goes_on_as_it_is(self) -> None:
        pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 3), np.uint8)
        jpeg = Image("photo", pixels, srgb_file(pixels, "JPEG"), "image/jpeg")
        said, _, glb = self.material(base_colour=Texture(jpeg, scale=(0.5, 1, 1)))
        surface = said["pbrMetallicRoughness"]
        self.assertEqual(glb.image_of(surface["baseColorTexture"]), jpeg.encoded)
        self.assertEqual(glb.document["images"][0]["mimeType"], "image/jpeg")
        self.assertEqual(surface["baseColorFactor"], [0.5, 1, 1, 1])

    def test_numbers_lie_in_their_channels(self) -> None:
        """The mean of R, G and B in linear values, with the scale: (L(188) + L(0) + L(255)) / 3 times 0.5."""
        texture = Texture(bytes_image([[[188, 0, 255], [10, 10, 10]]]), scale=(0.5, 0.5, 0.5))
        wanted = [0.5 * (linear(188) + linear(0) + linear(255)) / 3, 0.5 * linear(10)]
        said, extensions, glb = self.material(roughness=texture, specular=texture, transmission=texture, clearcoat=texture)
        surface = said["pbrMetallicRoughness"]
        self.assertEqual(surface["roughnessFactor"], 1)
        found = glb.texels(surface["metallicRoughnessTexture"])[0]
        np.testing.assert_allclose(found[:, 1], wanted, atol=1e-5)
        np.testing.assert_allclose(found[:, 2], 1)  # metallicFactor is multiplied with it
        found = glb.texels(extensions["KHR_materials_specular"]["specularTexture"])[0]
        np.testing.assert_allclose(found[:, 3], wanted, atol=1e-5)
        for name, key in (("transmission", "transmission"), ("clearcoat", "clearcoat")):
            found = glb.texels(extensions[f"KHR_materials_{name}"][f"{key}Texture"])[0]
            np.testing.assert_allclose(found[:, 0], wanted, atol=1e-5)

    def test_one_image_at_two_scales(self) -> None:
        image = bytes_image([[[255] * 3]])
        half = Texture(image, scale=(0.5, 0.5, 0.5))
        glb = self.glb(Material("a", roughness=Texture(image)), Material("b", roughness=half))
        for name, wanted in (("a", 1), ("b", 0.5)):
            info = glb.material(name)["pbrMetallicRoughness"]["metallicRoughnessTexture"]
            np.testing.assert_allclose(glb.texels(info)[0, 0, 1], wanted, atol=1e-5)

    def test_opacity(self) -> None:
        mask = Texture(bytes_image([[[255] * 3, [0] * 3]], "mask"))
        said, _, _ = self.material(opacity=0.25)
        self.assertEqual(said["alphaMode"], "BLEND")
        self.assertEqual(said["pbrMetallicRoughness"]["baseColorFactor"], [0.5, 0.5, 0.5, 0.25])
        said, _, glb = self.material(base_colour=(0.1, 0.2, 0.3), opacity=mask)
        self.assertEqual(said["pbrMetallicRoughness"]["baseColorFactor"], [0.1, 0.2, 0.3, 1])
        np.testing.assert_allclose(glb.texels(said["pbrMetallicRoughness"]["baseColorTexture"]), [[[1] * 4, [1, 1, 1, 0]]])
        # A colour's own alpha is of no consequence, not even where the surface lets light pass.
        pixels = np.array([[[9, 8, 7, 100]]], np.uint8)
        said, _, glb = self.material(base_colour=Texture(Image("rgba", pixels, srgb_file(pixels))), opacity=0.5)
        np.testing.assert_allclose(glb.texels(said["pbrMetallicRoughness"]["baseColorTexture"]) * 255, [[[9, 8, 7]]])

    def test_colours_and_opacity_share_an_image(self) -> None:
        colours = Texture(bytes_image([[[188, 0, 255], [1, 2, 3]]], "colours"), scale=(0.5, 1, 1))
        mask = Texture(bytes_image([[[0] * 3, [188] * 3]], "mask"))
        said, _, glb = self.material(base_colour=colours, opacity=mask)
        surface = said["pbrMetallicRoughness"]
        found = glb.texels(surface["baseColorTexture"])
        lit = np.where(found <= 0.04045, found / 12.92, ((found + 0.055) / 1.055) ** 2.4)[..., :3]
        lit *= surface["baseColorFactor"][:3]
        wanted = [[[0.5 * linear(188), 0, 1], [0.5 * linear(1), linear(2), linear(3)]]]
        np.testing.assert_allclose(lit, wanted, atol=2e-5)
        np.testing.assert_allclose(found[0, :, 3], [0, linear(188)], atol=1e-5)

    def test_colours_and_opacity_that_lie_differently(self) -> None:
        """Two colours that repeat twice, over a mask of four texels that does not."""
        twice = np.array([[2.0, 0, 0], [0, 1, 0]])
        colours = Texture(bytes_image([[[255, 0, 0], [0, 0, 255]]], "colours"), twice, is_nearest=True)
        mask = Texture(bytes_image([[[255] * 3, [0] * 3, [0] * 3, [255] * 3]], "mask"), is_nearest=True)
        said, _, glb = self.material(base_colour=colours, opacity=mask)
        info = said["pbrMetallicRoughness"]["baseColorTexture"]
        np.testing.assert_allclose(image_from_uv(info), np.eye(3)[:2])
        np.testing.assert_allclose(glb.texels(info), [[[1, 0, 0, 1], [0, 0, 1, 0], [1, 0, 0, 0], [0, 0, 1, 1]]])
        self.assertEqual([row["kind"] for row in self.notes.rows()], ["approximated"])

    def test_no_part_of_opacity_zero(self) -> None:
        glb = self.glb(Material("seen"), Material("unseen", opacity=0.0))
        self.assertEqual([node["name"] for node in glb.document["nodes"]], ["part_0", "camera"])

    def test_precision(self) -> None:
        """Linear colours in floats: 8 bits where these say all, else 16, so that 1e-4 is not lost."""
        said, _, glb = self.material(base_colour=Texture(Image("fine", np.array([[[1e-4, 0.3, 1.0]]]))))
        file = glb.texels(said["pbrMetallicRoughness"]["baseColorTexture"])[0, 0]
        np.testing.assert_allclose(file[0], 12.92e-4, atol=1e-5)
        np.testing.assert_allclose(file[1], 1.055 * 0.3 ** (1 / 2.4) - 0.055, atol=1e-5)
        normals = np.array([[[128, 127, 255]]]) / 255
        said, _, glb = self.material(normal_map=Texture(Image("normals", normals)), clearcoat=1.0)
        self.assertEqual(glb.image_of(said["normalTexture"])[24], 8)  # the PNG's bit depth
        np.testing.assert_allclose(glb.texels(said["normalTexture"]), normals)
        self.assertIn("clearcoatNormalTexture", said["extensions"]["KHR_materials_clearcoat"])

    def test_colours_above_one(self) -> None:
        """A factor ends at 1, so the scale goes into the texels, and what is above 1 then is noted."""
        said, _, glb = self.material(base_colour=Texture(bytes_image([[[188] * 3, [255] * 3]]), scale=(1.5, 1.0, 1.0)))
        surface = said["pbrMetallicRoughness"]
        self.assertEqual(surface["baseColorFactor"], [1, 1, 1, 1])
        found = glb.texels(surface["baseColorTexture"])[0]
        np.testing.assert_allclose(found[0, 0], 1.055 * (1.5 * linear(188)) ** (1 / 2.4) - 0.055, atol=1e-5)
        self.assertEqual(found[1].tolist(), [1, 1, 1])
        self.assertEqual([row["what"] for row in self.notes.rows()], ["texels above 1 as 1"])

    def test_transforms(self) -> None:
        image = bytes_image([[[1, 2, 3]]])
        angle = np.radians(37)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        for matrix in (np.eye(2), np.diag([3.0, -2.0]), -np.eye(2), turn @ np.diag([3.0, 0.5]), turn @ np.diag([-3.0, 0.5]),
                       np.diag([0.0, 2.0]), turn @ np.diag([0.0, 2.0]), np.zeros((2, 2))):
            whole = np.column_stack([matrix, [0.25, -7]])
            said, _, glb = self.material(base_colour=Texture(image, whole))
            info = said["pbrMetallicRoughness"]["baseColorTexture"]
            np.testing.assert_allclose(image_from_uv(info), whole, atol=1e-9)
            self.assertIn("KHR_texture_transform", glb.document["extensionsUsed"])
        said, _, glb = self.material(base_colour=Texture(image))
        self.assertEqual(said["pbrMetallicRoughness"]["baseColorTexture"], {"index": 0})
        self.assertNotIn("KHR_texture_transform", glb.document["extensionsUsed"])

    def test_a_sheared_texture_has_coordinates_of_its_own(self) -> None:
        """(u, v) becomes (u + v, v + 0.5); another texture of the material stays on the first coordinates."""
        sheared = Texture(bytes_image([[[1, 2, 3]]]), np.array([[1.0, 1, 0], [0, 1, 0.5]]))
        straight = Texture(bytes_image([[[9, 9, 9]]]))
        said, _, glb = self.material(base_colour=sheared, roughness=straight)
        surface = said["pbrMetallicRoughness"]
        self.assertEqual(surface["baseColorTexture"], {"index": 0, "texCoord": 1})
        self.assertNotIn("texCoord", surface["metallicRoughnessTexture"])
        np.testing.assert_allclose(glb.array(glb.primitive("part_0")["attributes"]["TEXCOORD_1"]),
                                   [[1, 1.5], [2, 1.5], [1, 0.5], [0, 0.5]])
        other = Texture(bytes_image([[[9, 9, 9]]]), np.array([[1.0, 2, 0], [0, 1, 0.5]]))
        with self.assertRaisesRegex(ImportProblem, "material m: textures that are sheared in different ways"):
            self.material(base_colour=sheared, roughness=other)

    def test_each_thing_once(self) -> None:
        """One mesh, two materials with one image each, of the same content; a third material that is the first."""
        image, twin = bytes_image([[[1, 2, 3]]]), bytes_image([[[1, 2, 3]]])
        glb = self.glb(Material("a", Texture(image)), Material("b", Texture(twin)), Material("a", Texture(image)),
                       Material("c", Texture(image, wrap=(Wrap.CLAMP, Wrap.MIRRORED), is_nearest=True)))
        document = glb.document
        self.assertEqual([m["name"] for m in document["materials"]], ["a", "b", "c"])
        self.assertEqual((len(document["images"]), len(document["textures"]), len(document["meshes"])), (1, 2, 3))
        self.assertEqual(document["samplers"][1], {"magFilter": 9728, "minFilter": 9728, "wrapS": 33071, "wrapT": 33648})
        self.assertEqual(len({m["primitives"][0]["attributes"]["POSITION"] for m in document["meshes"]}), 1)

    def test_impossible_numbers(self) -> None:
        bad = [({"base_colour": (0.5, 1.2, 0.5)}, "base colour is 1.2"), ({"roughness": float("nan")}, "roughness is nan"),
               ({"opacity": -0.5}, "opacity is -0.5"), ({"radiance": (float("inf"), 0, 0)}, "radiance is inf"),
               ({"ior": 0.5}, "index is 0.5"),
               ({"base_colour": Texture(Image("i", np.full((1, 1, 3), np.nan)))}, "image i: a texel"),
               ({"base_colour": Texture(Image("i", np.zeros((0, 1, 3))))}, "image i: it has"),
               ({"base_colour": Texture(bytes_image([[[1, 2, 3]]]), scale=(-1, 1, 1))}, "scale is -1")]
        for properties, said in bad:
            with self.subTest(said), self.assertRaisesRegex(ImportProblem, said):
                self.material(**properties)


class PngTest(unittest.TestCase):
    def test_pixels_come_back(self) -> None:
        """By a reader of the test's own and, where that has 8 bits, by Pillow."""
        random = np.random.default_rng(3)
        for channels in (1, 3, 4):
            for kind in (np.uint8, np.uint16):
                pixels = random.integers(0, np.iinfo(kind).max + 1, (6, 5, channels)).astype(kind)
                for filters in ((0,), (1,), (2,)):
                    data = png_bytes(pixels, filters=filters)
                    np.testing.assert_allclose(png_pixels(data) * np.iinfo(kind).max, pixels)
                    if kind == np.uint8:
                        found = np.asarray(Picture.open(io.BytesIO(data))).reshape(6, 5, channels)
                        np.testing.assert_array_equal(found, pixels)


if __name__ == "__main__":
    unittest.main()
