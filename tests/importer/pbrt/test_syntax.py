"""What a pbrt file may look like, and the sentence for each way in which it is broken."""

from __future__ import annotations

import gzip
import sys
import time
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_scene import HEAD, HEAD_V3, TRIANGLE, problem, read, said, world, world_problem  # noqa: E402


class Reading(unittest.TestCase):
    def test_comments_escapes_and_numbers_without_brackets(self) -> None:
        scene, _ = world('# Shape "nothing"\nShape "sphere" # a ball\n"float radius" 2 "float zmin" [ -1 # half\n ]')
        low, high = scene.parts[0].mesh.positions.min(0), scene.parts[0].mesh.positions.max(0)
        self.assertAlmostEqual(low[2], -1, 6)
        self.assertAlmostEqual(high[2], 2, 6)

    def test_of_two_parameters_with_one_name_the_last_holds(self) -> None:
        scene, notes = world('Shape "sphere" "float radius" 2 "float zmin" -1 "float radius" 3')
        self.assertAlmostEqual(scene.parts[0].mesh.positions.max(), 3, 6)
        self.assertNotIn("radius", " ".join(said(notes)))

    def test_a_byte_order_mark_is_no_word(self) -> None:
        self.assertEqual(len(read(f"\ufeff{HEAD}WorldBegin\n{TRIANGLE}")[0].parts), 1)

    def test_a_list_with_comments_and_one_without_are_the_same(self) -> None:
        text = 'Shape "trianglemesh" "point3 P" [0 0 0 {}1 0 0  0 1e0 +0] "integer indices" [0 1 2]'
        plain, _ = world(text.format(""))
        commented, _ = world(text.format('# ] "\n'))
        np.testing.assert_array_equal(plain.parts[0].mesh.positions, commented.parts[0].mesh.positions)

    def test_booleans_in_both_ways(self) -> None:
        for value in ("true", '"true"', "[ true ]", '[ "true" ]'):
            scene, _ = world(f'AreaLightSource "diffuse" "bool twosided" {value}\n{TRIANGLE}')
            self.assertTrue(scene.parts[0].material.emits_both_sides, value)

    def test_included_files_share_the_state_and_are_found_beside_the_main_file(self) -> None:
        files = {"parts/all.pbrt": 'Translate 1 2 3\nInclude "parts/one.pbrt"', "parts/one.pbrt": TRIANGLE}
        scene, _ = world('Include "parts/all.pbrt"\n' + TRIANGLE, files=files)
        for part in scene.parts:
            np.testing.assert_array_equal(part.to_world[:3, 3], (1, 2, 3))

    def test_an_imported_file_leaves_the_state_as_it_was(self) -> None:
        scene, _ = world('Import "a.pbrt"\n' + TRIANGLE, files={"a.pbrt": "Translate 1 2 3\n" + TRIANGLE})
        np.testing.assert_array_equal(scene.parts[0].to_world[:3, 3], (1, 2, 3))
        np.testing.assert_array_equal(scene.parts[1].to_world, np.eye(4))

    def test_packed_files(self) -> None:
        packed = gzip.compress(TRIANGLE.encode())
        scene, _ = world('Include "a.pbrt.gz"', files={"a.pbrt.gz": packed})
        self.assertEqual(len(scene.parts), 1)
        self.assertIn("a.pbrt.gz ends too early", world_problem('Include "a.pbrt.gz"', files={"a.pbrt.gz": packed[:-9]}))

    def test_versions_are_told_apart(self) -> None:
        text = 'Integrator "path"\nPixelFilter "box"\nCamera "perspective"\n{}WorldBegin\n{}LightSource "infinite" "rgb L" 1'
        for film, material, version in (('Film "rgb"\n', "", 4), ('Film "image"\n', "", 3), ("", 'Material "matte"\n', 3),
                                        ("", 'Material "conductor"\n', 4)):
            words = problem(text.format(film, material) + "\nTexture \"a\" \"float\" \"b\"\nShape \"x\"")
            self.assertIn("must have a multiple of 3", words)
            again = problem(text.replace(' "rgb L" 1', "").format(film, material) + '\nMaterial "nonsense"\nShape "sphere"')
            self.assertIn(f'no material "nonsense" in pbrt-v{version}', again)
        plain = 'Camera "perspective"\nWorldBegin\nMaterial "?"\nShape "sphere"'
        self.assertIn("pbrt-v4", problem(plain))
        self.assertIn("pbrt-v3", problem(plain + "\nWorldEnd"))
        mixed = world_problem('Material "matte"\nMaterial "conductor"')
        self.assertIn('scene.pbrt:2: Film "rgb" is of pbrt-v4, and Material "matte" of scene.pbrt:4 is of pbrt-v3', mixed)

    def test_what_nobody_asked_for_is_named(self) -> None:
        _, notes = world('Shape "sphere" "float bounce" 1 "float radius" 1')
        self.assertIn('the parameter "float bounce" of the shape "sphere"', said(notes))

    def test_attributes_are_defaults_and_what_stands_nearer_wins(self) -> None:
        scene, notes = world('Attribute "shape" "float radius" 2\nShape "sphere"\nShape "sphere" "float radius" 3\n'
                             'AttributeBegin\nAttribute "shape" "float radius" 4\nShape "sphere"\nAttributeEnd\n'
                             'Shape "sphere"\n' + TRIANGLE)
        radii = [part.mesh.positions.max() for part in scene.parts[:4]]
        np.testing.assert_allclose(radii, (2, 3, 4, 2), rtol=1e-6)
        self.assertNotIn("radius", " ".join(said(notes)))

    def test_a_million_numbers_take_seconds(self) -> None:
        count = 100_000
        positions = " ".join(f"{i} 0.5 {-i}.25e-1" for i in range(count))
        indices = " ".join(f"{i} {i + 1} {i + 2}" for i in range(0, count - 2))
        started = time.monotonic()
        scene, _ = world(f'Shape "trianglemesh" "point3 P" [{positions} 0 1 0] "integer indices" [{indices} 0 1 {count}]')
        self.assertLess(time.monotonic() - started, 5)
        self.assertEqual(len(scene.parts[0].mesh.positions), count + 1)


class Problems(unittest.TestCase):
    def check(self, text: str, *parts: str, head: str = HEAD, files: dict[str, bytes | str] | None = None) -> None:
        sentence = world_problem(text, head, files)
        for part in parts:
            self.assertIn(part, sentence)
        self.assertNotIn("\n", sentence)

    def test_words(self) -> None:
        self.check("Shapes \"sphere\"", 'scene.pbrt:4: "Shapes" is no directive')
        self.check('SurfaceIntegrator "path"', "belongs to pbrt-v2")
        self.check('"Shape"', "stands where a directive such as Shape is expected")
        self.check("[1 2 3]", "stands where a directive")
        self.check('\n\nShape "sphere', "scene.pbrt:6: a string has no end")
        self.check("Shape sphere", '"sphere" stands where Shape expects a string')
        self.check('Shape "sphere" "radius" 1', '"radius" is no parameter; it must be a type and a name')
        self.check('Shape "sphere" "length radius" 1', '"length" is no type')
        self.check('Shape "sphere" "float radius" ["2"]', '"2" is no value of the parameter "float radius"')
        self.check('Shape "sphere" "float radius" [2', 'list of the parameter "radius" has no closing bracket')
        self.check('Shape "sphere" "float radius"', "no value")
        self.check("Translate 1 2", "the end of the file stands where a number is expected")
        self.check("Translate 1 2 x", '"x" stands where a number is expected')
        self.check("Translate [1 2]", "Translate has 2 numbers; it must have 3")
        self.check("Transform [1 2 3]", "Transform has 3 numbers; it must have 16")

    def test_numbers(self) -> None:
        self.check('Shape "sphere" "float radius" nan', "must be finite")
        self.check('Shape "sphere" "float radius" [1e999]', "must be finite")
        self.check('Shape "sphere" "float radius" [1e]', "holds what is no number")
        self.check('Shape "sphere" "float radius" [1 2]', "has 2 values; it must have one")
        self.check('Shape "sphere" "float radius" 1_0', "stands where a number is expected")
        self.check('Shape "trianglemesh" "point3 P" [1 2]', "must have a multiple of 3")
        self.check('Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2.5]', "whole numbers")
        self.check('Shape "sphere" "string radius" "x"',
                   'the parameter "radius" of the shape "sphere" is of the type string')
        self.check('AreaLightSource "diffuse" "bool twosided" "yes"\n' + TRIANGLE, "it must be true or false")

    def test_files(self) -> None:
        self.check('Include "a.pbrt"', "scene.pbrt:4: a.pbrt is missing")
        self.check('Include "/etc/hostname"', "is an absolute path")
        self.check('Include "../scene.pbrt"', "leaves the scene's folder")
        self.check('Shape "plymesh" "string filename" "../a.ply"', "leaves the scene's folder")
        self.check('Shape "plymesh" "string filename" "a.ply"', "a.ply is missing")
        self.check('Shape "plymesh"', "a file name is empty")
        self.check('Include "."', "is missing")
        self.check('Include "scene.pbrt"', "scene.pbrt includes itself")
        loop = {"a.pbrt": 'Include "b.pbrt"', "b.pbrt": '\nInclude "a.pbrt"'}
        self.check('Include "a.pbrt"', "b.pbrt:2: a.pbrt includes itself", files=loop)

    def test_includes_that_would_never_end_are_cut_short(self) -> None:
        files: dict[str, bytes | str] = {f"{i}.pbrt": f'Include "{i + 1}.pbrt"\n' * 2 for i in range(40)}
        files["40.pbrt"] = ""
        self.check('Include "0.pbrt"', "more than 10000 includes", files=files)

    def test_brackets(self) -> None:
        self.check("AttributeEnd", "AttributeEnd closes nothing")
        self.check("AttributeBegin", "scene.pbrt:4: AttributeBegin has no AttributeEnd")
        self.check("AttributeBegin\nTransformEnd", "TransformEnd closes AttributeBegin of scene.pbrt:4")
        self.check("ObjectEnd", "ObjectEnd closes nothing")
        self.check('ObjectBegin "a"\nObjectBegin "b"', "objects must not hold others")
        self.check('ObjectInstance "a"', 'there is no object "a"')
        self.check("WorldBegin", "a second WorldBegin")
        self.check('Film "rgb"', "Film stands behind WorldBegin")
        self.assertIn("Shape stands before WorldBegin", problem('Shape "sphere"'))
        self.assertIn("there is no WorldBegin", problem(HEAD))
        self.assertIn("the scene has no Camera", problem("WorldBegin"))

    def test_names(self) -> None:
        self.check('NamedMaterial "a"', 'there is no material "a"')
        self.check('MakeNamedMaterial "a"\nNamedMaterial "a"\n' + TRIANGLE, 'the material "a" has no "string type"')
        self.check('CoordSysTransform "a"', 'there is no coordinate system "a"')
        self.check('Material "diffuse" "texture reflectance" "a"\nShape "sphere"', 'names the texture "a"')
        self.check('Texture "a" "colour" "constant"', "must be float or spectrum")
        self.check('MakeNamedMaterial "a" "string type" "diffuse"\nMakeNamedMaterial "a" "string type" "mix"',
                   '"a" has been defined at scene.pbrt:4')
        self.check('Shape "cube"', 'there is no shape "cube"')
        self.check('LightSource "sun"', 'there is no light "sun"')
        self.check('AreaLightSource "spot"', 'there is no area light "spot"')
        self.check(f'MediumInterface "fog" ""\n{TRIANGLE}', 'there is no medium "fog"')
        self.check('ColorSpace "adobe"', 'is no colour space')
        self.check('Attribute "film" "float a" 1', 'Attribute is about "film"')

    def test_loops_of_textures_and_materials(self) -> None:
        self.check('Texture "a" "float" "scale" "texture tex1" "a"\nMaterial "plastic" "texture roughness" "a"\n' + TRIANGLE,
                   'names the texture "a"', head=HEAD_V3)
        self.check('Texture "a" "float" "scale" "texture tex" "a"\n'
                   'Material "dielectric" "texture roughness" "a"\n' + TRIANGLE, "is made of itself")
        self.check('MakeNamedMaterial "a" "string type" "mix" "string materials" ["a" "a"]\nNamedMaterial "a"\n' + TRIANGLE,
                   "materials are mixed of themselves")

    def test_refused_unless_lenient(self) -> None:
        for text, word in (('Shape "curve"', "curve"), ('Shape "loopsubdiv"', "subdivision"),
                           ('Material "hair"\nShape "sphere"', "hair"), ('MediumInterface "" "fog"', "medium"),
                           ('LightSource "goniometric"', "goniometric"), ("ActiveTransform EndTime", "shutter")):
            self.check(text, word, "--lenient leaves it out")
            scene, notes = world(text + "\n" + TRIANGLE, is_lenient=True)
            self.assertTrue(any(row["kind"] == "left out" and word in str(row["what"]) for row in notes.rows()), text)
            self.assertEqual(scene.parts[-1].mesh.name, "trianglemesh")

    def test_a_whole_file_of_noise_is_one_sentence(self) -> None:
        self.assertIn("no directive", problem("\ufffd\x00\x01 \x7f"))
        self.assertIn("there is no WorldBegin", problem(""))

    def test_empty_worlds_are_read(self) -> None:
        scene, _ = read('Camera "perspective"\nWorldBegin')
        self.assertEqual(scene.parts, [])


if __name__ == "__main__":
    unittest.main()
