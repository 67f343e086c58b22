"""The XML itself: parameters, includes, references, transforms, and what is wrong with it in one sentence each."""

from __future__ import annotations

import unittest

import numpy as np

from mitsuba_scenes import BALL, FILM, SENSOR, MitsubaTest, world_positions
from importer.mitsuba.plugin import snake_case
from importer.problems import ImportProblem


class TransformTest(MitsubaTest):
    def matrix(self, steps: str, version: str = "3.0.0") -> np.ndarray:
        name = "toWorld" if version < "1" else "to_world"
        return self.read(f'<shape type="cube"><transform name="{name}">{steps}</transform></shape>',
                         version).parts[0].to_world

    def test_later_steps_are_applied_later(self) -> None:
        """(1, 0, 0) scaled to (2, 0, 0), turned about z to (0, 2, 0), moved to (5, 2, 0)."""
        matrix = self.matrix('<scale x="2"/><rotate z="1" angle="90"/><translate x="5"/>')
        self.assert_close(matrix @ (1, 0, 0, 1), (5, 2, 0, 1))

    def test_each_step(self) -> None:
        self.assert_close(self.matrix('<scale value="3"/>'), np.diag([3, 3, 3, 1]))
        self.assert_close(self.matrix('<scale value="1, 2 3"/>'), np.diag([1, 2, 3, 1]))
        self.assert_close(self.matrix('<translate value="1 2 3"/>') @ (0, 0, 0, 1), (1, 2, 3, 1))
        self.assert_close(self.matrix('<matrix value="1 2 0 4 0 1 0 5 0 0 1 6 0 0 0 1"/>') @ (1, 1, 1, 1), (7, 6, 7, 1))
        self.assert_close(self.matrix('<matrix value="0 -1 0 1 0 0 0 0 1"/>') @ (1, 0, 0, 1), (0, 1, 0, 1))
        self.assert_close(self.matrix('<rotate x="1" y="1" z="1" angle="120"/>') @ (1, 0, 0, 1), (0, 1, 0, 1))
        matrix = self.matrix('<lookAt origin="1,2,3" target="1,2,5" up="0,1,0"/>', "0.6.0")
        self.assert_close(matrix @ (1, 0, 0, 1), (2, 2, 3, 1))
        self.assert_close(matrix @ (0, 0, 1, 1), (1, 2, 4, 1))

    def test_look_at_without_up_is_a_rotation(self) -> None:
        for version in ("3.0.0", "0.6.0"):
            for target in ("0 0 1", "0 0 -1", "1 2 3", "-1 0.5 0"):
                linear = self.matrix(f'<lookat origin="0 0 0" target="{target}"/>', version)[:3, :3]
                self.assert_close(linear @ linear.T, np.eye(3))
                self.assertAlmostEqual(np.linalg.det(linear), 1)

    def test_what_is_wrong(self) -> None:
        cases = {'<matrix value="1 2 3"/>': "9 or 16", '<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"/>': "0 0 0 1",
                 '<rotate angle="3"/>': "axis", '<rotate x="1"/>': "angle", '<scale value="nan"/>': "finite",
                 '<scale value="1 2"/>': "one or three", '<translate x="inf"/>': "finite", '<shear x="1"/>': "<transform>",
                 '<translate x="1" w="2"/>': "no attribute", '<scale x="1" value="2"/>': "both",
                 '<lookat origin="0 0 0" target="0 1 0" up="0 1 0"/>': "parallel",
                 '<scale value="1e20"/><scale value="1e20"/>': "too large", '<lookat origin="0 0" target="0 1 0"/>': "three"}
        for steps, part in cases.items():
            with self.subTest(steps):
                self.assertIn(part, self.problem(f'<shape type="cube"><transform '
                                                 f'name="to_world">{steps}</transform></shape>'))


class ParameterTest(MitsubaTest):
    SCENE = ('<scene version="3.0.0"><default name="size" value="4"/><default name="sizes" value="7"/><sensor '
             'type="perspective">'
             '<float name="fov" value="$fov"/><film type="hdrfilm"><integer name="width" value="$sizes"/>'
             '<integer name="height" value="${}"/></film></sensor><default name="size" value="9"/>' + BALL + "</scene>")

    def test_values(self) -> None:
        scene = self.read_file(self.SCENE.replace("${}", "1$size"), fov="40")
        self.assertEqual((scene.camera.width, scene.camera.height), (7, 14))
        self.assertEqual(self.read_file(self.SCENE.replace("${}", "$size"), fov="40", size="5").camera.height, 5)

    def test_what_is_wrong(self) -> None:
        with self.assertRaisesRegex(ImportProblem, r"\$fov has no value; give it with --define fov=VALUE"):
            self.read_file(self.SCENE.replace("${}", "$size"))
        with self.assertRaisesRegex(ImportProblem, r"has no parameter \$spp"):
            self.read_file(self.SCENE.replace("${}", "$size"), fov="40", spp="3")
        doubling = "".join(f'<default name="d{i + 1}x" value="$d{i}x$d{i}x"/>' for i in range(80))
        with self.assertRaisesRegex(ImportProblem, "grow beyond"):
            self.read_file(f'<scene version="3.0.0"><default name="d0x" value="1"/>{doubling}</scene>')


class IncludeTest(MitsubaTest):
    def test_scenes_and_objects(self) -> None:
        self.write("parts/white.xml", '<bsdf version="3.0.0" type="diffuse" id="white"><rgb name="reflectance" '
                                      'value="0.9"/></bsdf>')
        self.write("parts/more.xml", '<scene version="0.6.0"><include filename="white.xml"/><shape type="sphere">'
                   '<transform name="toWorld"><translate x="$x"/></transform><ref id="white"/></shape></scene>')
        scene = self.read('<default name="x" value="3"/><include filename="parts/more.xml"/><shape type="cube"><ref '
                          'id="white"/></shape>')
        self.assert_close(scene.parts[0].material.base_colour, (0.9, 0.9, 0.9))
        self.assertIs(scene.parts[0].material, scene.parts[1].material)
        self.assert_close(np.abs(world_positions(scene.parts[0]) - (3, 0, 0)).max(axis=0), (1, 1, 1))

    def test_path_and_files_beside_an_include(self) -> None:
        triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        self.write("far/away/mesh.obj", triangle)
        shape = '<shape type="obj"><string name="filename" value="mesh.obj"/></shape>'
        self.assertEqual(len(self.read(f'<path value="far/away"/>{shape}').parts), 1)
        self.write("far/away/part.xml", f'<scene version="3.0.0">{shape}</scene>')
        self.assertEqual(len(self.read('<include filename="far\\away\\part.xml"/>' + BALL).parts), 2)
        self.assertIn("no folder", self.problem('<path value="nowhere"/>'))

    def test_loops(self) -> None:
        self.write("a.xml", '<scene version="3.0.0"><include filename="b.xml"/></scene>')
        self.write("b.xml", '<scene version="3.0.0"><include filename="a.xml"/></scene>')
        self.assertIn("a.xml: includes itself, by way of a.xml and b.xml", self.problem('<include filename="a.xml"/>'))
        self.assertIn("includes itself", self.problem('<include filename="scene.xml"/>'))

    def test_many_files(self) -> None:
        """Each includes the next one twice, which is 2^14 in all."""
        for i in range(30):
            next_one = f'<include filename="{i + 1}.xml"/>'
            self.write(f"{i}.xml", f'<scene version="3.0.0">{2 * next_one if i < 14 else ""}</scene>')
        self.assertIn("more than 1000 files", self.problem('<include filename="0.xml"/>'))


class FolderTest(MitsubaTest):
    def test_nothing_outside_is_opened(self) -> None:
        inner = self.folder / "scene"
        self.write("secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        inner.mkdir()
        (inner / "link.obj").symlink_to(self.folder / "secret.obj")
        self.folder = inner
        for name, part in (("../secret.obj", "leads out"), ("a/../../secret.obj", "leads out"), ("link.obj", "leads out"),
                           (str(inner.parent / "secret.obj"), "absolute"), ("C:\\secret.obj", "absolute"), ("", "empty"),
                           ("x" * 5000, "cannot be opened"), (".", "no file")):
            with self.subTest(name[:40]):
                self.assertIn(part, self.problem(f'<shape type="obj"><string name="filename" value="{name}"/></shape>'))
        self.assertIn("leads out", self.problem('<include filename="../other.xml"/>'.replace("other.xml", "secret.obj")))
        self.assertIn("leads out", self.problem('<path value=".."/>'))


class ReferenceTest(MitsubaTest):
    def test_forward_references_and_aliases(self) -> None:
        scene = self.read('<shape type="cube"><ref id="later"/></shape><bsdf type="diffuse" id="later"/>'
                          '<alias id="later" as="other"/><shape type="sphere"><ref id="other"/></shape>')
        self.assertIs(scene.parts[0].material, scene.parts[1].material)

    def test_references_under_names(self) -> None:
        scene = self.read('<texture type="checkerboard" id="t"/><shape type="cube"><bsdf type="diffuse">'
                          '<ref name="reflectance" id="t"/></bsdf></shape>')
        self.assertTrue(scene.parts[0].material.base_colour.is_nearest)

    def test_what_is_wrong(self) -> None:
        self.assertIn('no object with the id "x"', self.problem('<shape type="cube"><ref id="x"/></shape>'))
        self.assertIn("is taken by", self.problem('<bsdf type="diffuse" id="a"/><bsdf type="diffuse" id="a"/>'))
        self.assertIn("refers to itself", self.problem('<bsdf type="twosided" id="a"><ref id="b"/></bsdf>'
                                                       '<bsdf type="twosided" id="b"><ref id="a"/></bsdf>'))
        chain = "".join(f'<bsdf type="twosided" id="b{i}"><ref id="b{i + 1}"/></bsdf>' for i in range(300))
        self.assertIn("more than 100 deep", self.problem(f'{chain}<bsdf type="diffuse" id="b300"/>'))
        # Each refers to the next one twice: as a tree that would be 2^60 objects.
        net = "".join(f'<bsdf type="blendbsdf" id="n{i}"><ref id="n{i + 1}"/><ref id="n{i + 1}"/></bsdf>' for i in range(60))
        scene = self.read(f'{net}<bsdf type="diffuse" id="n60"/><shape type="cube"><ref id="n0"/></shape>')
        self.assert_close(scene.parts[0].material.base_colour, (0.5, 0.5, 0.5))


class WrongTest(MitsubaTest):
    def file_problem(self, text: str) -> str:
        with self.assertRaises(ImportProblem) as caught:
            self.read_file(text)
        return str(caught.exception)

    def test_files(self) -> None:
        head = '<scene version="3.0.0">'
        cases = {
            "": "no well-formed XML", "<scene": "no well-formed XML", f"{head}{SENSOR}": "no well-formed XML",
            "<scene></scene>": "no version", '<scene version="new"/>': "no version",
            '<bsdf version="3.0.0" type="diffuse"/>': "starts with <bsdf>",
            f"{head}</scene>": "no <sensor>", f"{head}{SENSOR}</scene>": "no shape",
            f"{head}{SENSOR}<luminaire type='area'/></scene>": "<luminaire>: is no element",
            f"{head}{SENSOR}<shape/></scene>": "has no type",
            f"{head}{SENSOR}<bsdf type='diffuse'><float value='1'/></bsdf></scene>": 'needs the attribute "name"',
            f"{head}{SENSOR}<bsdf type='diffuse'><rgb name='reflectance' value='1 2'/></bsdf></scene>": "one or three",
            f"{head}{SENSOR}<bsdf type='diffuse'><float name='a' value='1_0'/></bsdf></scene>": "finite",
            f"{head}{SENSOR}<bsdf type='diffuse'><integer name='a' value='1.5'/></bsdf></scene>": "not an integer",
            f"{head}{SENSOR}<bsdf type='diffuse'><boolean name='a' value='yes'/></bsdf></scene>": 'neither "true"',
            f"{head}{SENSOR}<bsdf type='diffuse'><spectrum name='a' value='400:1, 300:2'/></bsdf></scene>": "must rise",
            head + SENSOR + '<bsdf type="diffuse">' + 2 * '<float name="a" value="1"/>' + "</bsdf></scene>": "given twice",
            head + 80 * '<bsdf type="twosided">' + 80 * "</bsdf>" + "</scene>": "nested more than 60",
            '<!DOCTYPE scene [<!ENTITY a "b">]><scene version="3.0.0"/>': "document type",
            '<!DOCTYPE scene SYSTEM "x.dtd"><scene version="3.0.0"/>': "document type",
        }
        for text, part in cases.items():
            with self.subTest(text[:120]):
                problem = self.file_problem(text)
                self.assertIn(part, problem)
                self.assertIn("scene.xml", problem)
                self.assertNotIn("\n", problem)

    def test_entities_do_not_grow(self) -> None:
        entities = "".join(f'<!ENTITY e{i + 1} "{10 * f"&e{i};"}">' for i in range(12))
        bomb = f'<!DOCTYPE s [<!ENTITY e0 "0123456789">{entities}]><scene version="&e12;"/>'
        self.assertIn("scene.xml", self.file_problem(bomb))

    def test_lines(self) -> None:
        self.assertIn('scene.xml:3, <shape type="hair">', self.file_problem(
            f'<scene version="3.0.0">\n{SENSOR}\n<shape type="hair"/></scene>'))

    def test_names(self) -> None:
        for old, new in (("toWorld", "to_world"), ("intIOR", "int_ior"), ("extEta", "ext_eta"), ("k", "k"),
                         ("cropOffsetX", "crop_offset_x"), ("wrapModeU", "wrap_mode_u"), ("sigmaA", "sigma_a")):
            self.assertEqual(snake_case(old), new)

    def test_motion(self) -> None:
        body = ('<shape type="cube"><animation name="toWorld"><transform time="0"><translate x="1"/></transform>'
                '<transform time="1"><translate x="2"/></transform></animation></shape>')
        self.assertIn("motion", self.problem(body, "0.6.0"))
        self.assert_close(self.read(body, "0.6.0", is_lenient=True).parts[0].to_world[:3, 3], (1, 0, 0))

    def test_sensors(self) -> None:
        other = f'<sensor type="perspective"><float name="fov" value="20"/>{FILM}</sensor>'
        camera = self.read(SENSOR + other).camera
        self.assertAlmostEqual(camera.vertical_fov, 2 * np.degrees(np.arctan(0.5)))
        self.assert_noted("all sensors but the first")


if __name__ == "__main__":
    unittest.main()
