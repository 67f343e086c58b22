"""Shapes: where they lie, how large they are and which side shines, by the documentation of Mitsuba's shapes."""

from __future__ import annotations

import time
import unittest

import numpy as np

from mitsuba_scenes import GREY, MitsubaTest, area, world_fronts, world_positions
from importer.scene import Part

_MATRIX = np.array([[0.5, -1, 0.2, 1], [1.5, 0.3, 0.1, 2], [0.2, 0.4, 2, 3], [0, 0, 0, 1]])
# A tetrahedron's corner: one triangle in the plane z = 0 that runs counter-clockwise about +z.
_TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
_ROOF = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\n"


def matrix(m: np.ndarray) -> str:
    return f'<transform name="to_world"><matrix value="{" ".join(f"{x:.17g}" for x in m.ravel())}"/></transform>'


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v)


class AnalyticTest(MitsubaTest):
    def part(self, body: str, version: str = "3.0.0") -> Part:
        return self.read(body, version).parts[0]

    def test_rectangle(self) -> None:
        """From -1 to 1 in x and y, normal +z, uv = (local + 1) / 2 (rectangle.cpp)."""
        part = self.part(f'<shape type="rectangle">{matrix(_MATRIX)}{GREY}</shape>')
        x, y = _MATRIX[:3, 0], _MATRIX[:3, 1]
        self.assertAlmostEqual(area(part), 4 * np.linalg.norm(np.cross(x, y)))
        normal = unit(np.linalg.inv(_MATRIX[:3, :3]).T @ (0, 0, 1))
        self.assert_close(world_fronts(part), [normal] * 2)
        local = part.mesh.uvs * 2 - 1
        self.assert_close(world_positions(part), _MATRIX[:3, 3] + local[:, :1] * x + local[:, 1:] * y)

    def test_mirrored_rectangles_and_disks_shine_by_their_transformed_normal(self) -> None:
        for kind in ("rectangle", "disk"):
            for scales, normal in (((-1, 1, 1), (0, 0, 1)), ((1, -1, 1), (0, 0, 1)), ((1, 1, -1), (0, 0, -1))):
                for version in ("3.0.0", "0.6.0"):
                    with self.subTest(kind, scales=scales, version=version):
                        name = "to_world" if version > "1" else "toWorld"
                        text = matrix(np.diag([*scales, 1.0])).replace("to_world", name)
                        part = self.part(f'<shape type="{kind}">{text}{GREY}</shape>', version)
                        self.assert_close(world_fronts(part), [normal] * len(part.mesh.triangles))

    def test_flat_scale(self) -> None:
        """A rectangle scaled by 0 along z is the same rectangle."""
        part = self.part('<shape type="rectangle"><transform name="to_world"><scale x="2" y="3" z="0"/>'
                         f'<rotate x="1" angle="-90"/></transform>{GREY}</shape>')
        self.assertAlmostEqual(area(part), 24)
        self.assert_close(world_fronts(part), [(0, 1, 0)] * 2)
        self.assertIn("no area", self.problem('<shape type="disk"><transform name="to_world"><scale '
                                              'x="0"/></transform></shape>'))
        self.assertIn("no volume", self.problem('<shape type="cube"><transform name="to_world"><scale '
                                                'x="0"/></transform></shape>'))

    def test_disk_cube_and_cylinder(self) -> None:
        disk = self.part(f'<shape type="disk"><transform name="to_world"><scale value="2"/></transform>{GREY}</shape>')
        self.assertAlmostEqual(area(disk), 4 * np.pi, delta=0.02)
        self.assert_close(world_fronts(disk), [(0, 0, 1)] * len(disk.mesh.triangles))
        cube = self.part(f'<shape type="cube">{GREY}</shape>')
        self.assertAlmostEqual(area(cube), 24)
        self.assert_close(np.abs(world_positions(cube)), np.ones((24, 3)))
        tube = self.part('<shape type="cylinder"><point name="p0" x="1" y="0" z="0"/><point name="p1" x="1" y="3" z="0"/>'
                         f'<float name="radius" value="0.5"/>{GREY}</shape>')
        self.assertAlmostEqual(area(tube), 2 * np.pi * 0.5 * 3, delta=0.02)
        positions = world_positions(tube)
        self.assert_close(np.hypot(positions[:, 0] - 1, positions[:, 2]), np.full(len(positions), 0.5))

    def outward(self, part: Part, centre: tuple[float, float, float]) -> float:
        """1 where all fronts face away from the centre, -1 where all face it."""
        middles = world_positions(part)[part.mesh.triangles].mean(axis=1) - centre
        sides = np.sign((middles * world_fronts(part)).sum(axis=1))
        self.assertEqual(len(set(sides)), 1)
        return float(sides[0])

    def test_sphere(self) -> None:
        body = '<point name="center" x="1" y="2" z="3"/><float name="radius" value="2"/>'
        part = self.part(f'<shape type="sphere">{body}{GREY}</shape>')
        self.assert_close(np.linalg.norm(world_positions(part) - (1, 2, 3), axis=1), np.full(len(part.mesh.positions), 2))
        self.assertEqual(self.outward(part, (1, 2, 3)), 1)
        part = self.part(f'<shape type="sphere">{body}<boolean name="flip_normals" value="true"/>{GREY}</shape>')
        self.assertEqual(self.outward(part, (1, 2, 3)), -1)

    def test_sphere_with_centre_and_transform(self) -> None:
        """3 transforms centre and radius; 0.6 divides by the scale before it moves (Sphere::Sphere of both)."""
        body = ('<point name="center" x="1" y="0" z="0"/><float name="radius" value="2"/>'
                '<transform name="to_world"><scale value="3"/><translate y="1"/></transform>')
        for version, centre in (("3.0.0", (3, 1, 0)), ("0.6.0", (1, 1, 0))):
            text = body.replace("to_world", "toWorld") if version < "1" else body
            part = self.part(f'<shape type="sphere">{text}{GREY}</shape>', version)
            self.assert_close(np.linalg.norm(world_positions(part) - centre, axis=1), np.full(len(part.mesh.positions), 6))

    def test_sphere_under_different_scales(self) -> None:
        """Mitsuba takes the length of the transformed x axis as the radius and stays a sphere."""
        part = self.part('<shape type="sphere"><transform name="to_world"><scale x="2" y="5" z="1"/><rotate y="1" '
                         'angle="30"/>'
                         f'</transform>{GREY}</shape>')
        self.assert_close(np.linalg.norm(world_positions(part), axis=1), np.full(len(part.mesh.positions), 2))
        self.assert_noted("a sphere under different scales")

    def test_mirrored_spheres_and_cylinders(self) -> None:
        """3 flips the normals of both where to_world mirrors (Sphere::update, Cylinder::update); 0.6 those of cylinders,
        whose normal is the cross product of transformed tangents, but not those of spheres."""
        for kind, version, side in (("sphere", "3.0.0", -1), ("sphere", "0.6.0", 1), ("cylinder", "3.0.0", -1),
                                    ("cylinder", "0.6.0", -1)):
            with self.subTest(kind, version=version):
                name = "to_world" if version > "1" else "toWorld"
                part = self.part(f'<shape type="{kind}"><transform name="{name}"><scale z="-1"/></transform>{GREY}</shape>',
                                 version)
                self.assertEqual(self.outward(part, (0, 0, 0) if kind == "sphere" else (0, 0, -0.5)), side)

    def test_wrong_sizes(self) -> None:
        self.assertIn("radius is -1", self.problem('<shape type="sphere"><float name="radius" value="-1"/></shape>'))
        self.assertIn("two different ends", self.problem('<shape type="cylinder"><point name="p1" x="0" y="0" '
                                                         'z="0"/></shape>'))
        self.assertIn('"hair"', self.problem('<shape type="hair"/>'))
        self.assertIn("known are", self.problem('<shape type="teapot"/>'))


class MeshTest(MitsubaTest):
    def part(self, obj: str, body: str = "", version: str = "3.0.0", kind: str = "obj") -> Part:
        self.write("mesh.obj", obj)
        return self.read(f'<shape type="{kind}"><string name="filename" value="mesh.obj"/>{body}{GREY}</shape>',
                         version).parts[0]

    def test_sides_without_normals_follow_the_corners_in_the_world(self) -> None:
        """OBJMesh transforms corners first and takes cross products of these, so a mirror turns the front round."""
        for flag in ("true", "false"):
            for scales in ((1, 1, 1), (-1, 1, 1), (1, 1, -1), (2, -1, -1)):
                with self.subTest(face_normals=flag, scales=scales):
                    part = self.part(_TRIANGLE + "f 1 2 3\n",
                                     f'<boolean name="face_normals" value="{flag}"/>' + matrix(np.diag([*scales, 1.0])))
                    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)]) * scales
                    expected = unit(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
                    self.assert_close(world_fronts(part), [expected])

    def test_sides_with_normals_follow_these(self) -> None:
        """Normals are transformed as normals, by the inverse transposed."""
        obj = _TRIANGLE + "vn 0.1 0 -1\nf 1//1 2//1 3//1\n"
        for scales in ((1, 1, 1), (-1, 1, 1), (1, 1, -1)):
            part = self.part(obj, matrix(np.diag([*scales, 1.0])))
            normal = np.linalg.inv(np.diag(scales)).T @ (0.1, 0, -1)
            self.assertGreater(float(world_fronts(part)[0] @ normal), 0.9)

    def test_flip_normals(self) -> None:
        flip = '<boolean name="flipNormals" value="true"/>'
        self.assert_close(world_fronts(self.part(_TRIANGLE + "f 1 2 3\n", flip, "0.6.0")), [(0, 0, -1)])
        with_normals = _TRIANGLE + "vn 0 0 -1\nf 1//1 2//1 3//1\n"
        part = self.part(with_normals, flip, "0.6.0")
        self.assert_close(world_fronts(part), [(0, 0, 1)])
        self.assert_close(part.mesh.normals, [(0, 0, 1)] * 3)

    def test_face_normals_and_smooth_ones(self) -> None:
        self.assertIsNone(self.part(_ROOF, '<boolean name="face_normals" value="true"/>').mesh.normals)
        normals = self.part(_ROOF).mesh.normals
        self.assert_close(normals[0], unit(np.array([0, 1, 1])))  # two triangles with a right angle each there

    def test_creases(self) -> None:
        """The roof's two triangles meet at 90 degrees: one normal per corner below that angle, shared ones above."""
        flat = self.part(_ROOF, '<float name="maxSmoothAngle" value="80"/>', "0.6.0").mesh
        self.assert_close(flat.normals[flat.triangles], [[(0, 0, 1)] * 3, [(0, 1, 0)] * 3])
        self.assertEqual(len(flat.positions), 6)
        smooth = self.part(_ROOF, '<float name="maxSmoothAngle" value="100"/>', "0.6.0").mesh
        self.assertEqual(len(smooth.positions), 4)
        self.assert_close(smooth.normals[smooth.triangles[0, 0]], unit(np.array([0, 1, 1])))
        self.assert_close(smooth.positions[smooth.triangles], flat.positions[flat.triangles])

    def test_texture_coordinates(self) -> None:
        """An .obj's v is turned over unless it says otherwise; Mitsuba's own then runs downwards."""
        obj = _TRIANGLE + "f 1/1 2/2 3/3\n"
        corner = {tuple(p): uv for p, uv in zip(*(lambda m: (m.positions, m.uvs))(self.part(obj).mesh))}
        self.assert_close(corner[0, 1, 0], (0, 0))
        self.assert_close(corner[1, 0, 0], (1, 1))
        mesh = self.part(obj, '<boolean name="flip_tex_coords" value="false"/>').mesh
        corner = {tuple(p): uv for p, uv in zip(mesh.positions, mesh.uvs)}
        self.assert_close(corner[0, 1, 0], (0, 1))

    def test_ply_and_its_texture_coordinates(self) -> None:
        self.write("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                               "float z\n"
                   "property float u\nproperty float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                   "0 0 0 0 0.25\n1 0 0 1 0.25\n0 1 0 0 1\n3 0 1 2\n")
        body = '<shape type="ply"><string name="filename" value="mesh.ply"/>{}</shape>'
        self.assert_close(self.read(body.format("")).parts[0].mesh.uvs[:, 1], (0.25, 0.25, 1))
        flipped = self.read(body.format('<boolean name="flip_tex_coords" value="true"/>')).parts[0].mesh.uvs[:, 1]
        self.assert_close(flipped, (0.75, 0.75, 0))

    def test_meshes_are_shared(self) -> None:
        self.write("mesh.obj", _TRIANGLE + "f 1 2 3\n")
        shape = '<shape type="obj"><string name="filename" value="mesh.obj"/>{}</shape>'
        parts = self.read(shape.format("") * 2 + shape.format('<boolean name="face_normals" value="true"/>')).parts
        self.assertIs(parts[0].mesh, parts[1].mesh)
        self.assertIsNot(parts[0].mesh, parts[2].mesh)

    def test_materials_of_an_obj(self) -> None:
        """0.6 alone has several materials for one .obj, and reads its .mtl file."""
        self.write("mesh.obj", _TRIANGLE + "f 1 2 3\n")
        shape = '<shape type="obj"><string name="filename" value="mesh.obj"/>{}</shape>'
        self.assertIn("several <bsdf>", self.problem(shape.format(GREY * 2), "0.6.0"))
        self.assertIn("has 2 <bsdf>", self.problem(shape.format(GREY * 2)))
        self.read(shape.format(""), "0.6.0")
        self.assert_noted(".mtl")
        self.read(shape.format(""))
        self.assertEqual(self.noted(), [])

    def test_what_is_wrong_with_files(self) -> None:
        shape = '<shape type="{}"><string name="filename" value="{}"/></shape>'
        self.write("empty.obj", "v 0 0 0\n")
        self.write("short.ply", "ply\nformat ascii 1.0\n")
        self.assertIn("no file \"none.obj\"", self.problem(shape.format("obj", "none.obj")))
        problem = self.problem(shape.format("obj", "empty.obj"))
        self.assertIn('scene.xml:1, <shape type="obj">: empty.obj: ', problem)
        self.assertNotIn(str(self.folder), problem)
        self.assertIn("short.ply", self.problem(shape.format("ply", "short.ply")))
        self.assertIn("needs a \"filename\"", self.problem('<shape type="obj"/>'))


class InstanceTest(MitsubaTest):
    def test_instances(self) -> None:
        scene = self.read('<shape type="shapegroup" id="two"><shape type="rectangle"><transform name="to_world">'
                          f'<translate x="1"/></transform>{GREY}</shape><shape type="sphere">{GREY}</shape></shape>'
                          '<shape type="instance"><ref id="two"/></shape>'
                          '<shape type="instance"><ref id="two"/><transform name="to_world"><scale value="2"/>'
                          '<translate z="5"/></transform></shape>')
        self.assertEqual(len(scene.parts), 4)
        self.assertIs(scene.parts[0].mesh, scene.parts[2].mesh)
        self.assertIs(scene.parts[0].material, scene.parts[2].material)
        self.assert_close(world_positions(scene.parts[0]).mean(axis=0), (1, 0, 0))
        self.assert_close(world_positions(scene.parts[2]).mean(axis=0), (2, 0, 5))
        self.assert_close(np.linalg.norm(world_positions(scene.parts[3]) - (0, 0, 5), axis=1),
                          np.full(len(scene.parts[3].mesh.positions), 2))

    def test_a_mirroring_instance_keeps_the_side(self) -> None:
        """Instances transform rays and normals (Instance::compute_surface_interaction)."""
        scene = self.read('<shape type="shapegroup" id="g"><shape type="rectangle"/></shape><shape type="instance">'
                          '<ref id="g"/><transform name="to_world"><scale x="-1" z="-1" y="-1"/></transform></shape>')
        self.assert_close(world_fronts(scene.parts[0]), [(0, 0, -1)] * 2)

    def test_merges_that_double_are_counted_before_they_are_read(self) -> None:
        """40 steps are more shapes than any machine holds."""
        cubes = '<shape type="merge" id="m0"><shape type="cube"/><shape type="cube"/></shape>'
        steps = cubes + "".join(f'<shape type="merge" id="m{i}"><ref id="m{i - 1}"/><ref id="m{i - 1}"/></shape>'
                                for i in range(1, 40))
        start = time.monotonic()
        self.assertIn("one of more than 1000000 shapes", self.problem(steps))
        self.assertLess(time.monotonic() - start, 2)
        self.assertEqual(len(self.read(steps.split('<shape type="merge" id="m3">')[0]).parts), 2 + 4 + 8)

    def test_what_is_wrong(self) -> None:
        self.assertIn("needs one <ref>", self.problem('<shape type="instance"/>'))
        self.assertIn("no shape that is seen", self.problem('<shape type="shapegroup" id="g"><shape type="cube"/></shape>'))
        self.assertIn("within a group", self.problem(
            '<shape type="shapegroup" id="a"><shape type="instance"><ref id="b"/></shape></shape>'
            '<shape type="shapegroup" id="b"><shape type="cube"/></shape><shape type="instance"><ref id="a"/></shape>'))


if __name__ == "__main__":
    unittest.main()
