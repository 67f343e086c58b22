"""Cameras: the directions that Mitsuba's formulas give for points of the picture, against those of the camera read."""

from __future__ import annotations

import unittest

import numpy as np

from mitsuba_scenes import MitsubaTest
from importer.scene import Camera

_LOOK = '<transform name="to_world"><lookat origin="1, 2, 3" target="4 2.5 -1" up="0.1, 1, 0"/></transform>'


def source_direction(x: float, y: float, x_fov: float, aspect: float, to_world: np.ndarray) -> np.ndarray:
    """The ray at (x, y) of the film, from (0, 0) at its top left to (1, 1), in the world: the inverse of
    camera_to_sample = scale(-1/2, -aspect/2) translate(-1, -1/aspect) perspective(x_fov) (PerspectiveCamera)."""
    tangent = np.tan(np.radians(x_fov) / 2)
    local = np.array([(1 - 2 * x) * tangent, (1 - 2 * y) / aspect * tangent, 1.0])
    return unit(to_world[:3, :3] @ local)


def camera_direction(x: float, y: float, camera: Camera) -> np.ndarray:
    """glTF 2.0, 3.10: along -z, +y up, +x to the right."""
    tangent = np.tan(np.radians(camera.vertical_fov) / 2)
    aspect = camera.width / camera.height
    return unit(camera.to_world[:3, :3] @ np.array([(2 * x - 1) * tangent * aspect, (1 - 2 * y) * tangent, -1.0]))


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v)


def look_at(origin: np.ndarray, target: np.ndarray, up: np.ndarray) -> np.ndarray:
    direction = unit(target - origin)
    left = unit(np.cross(up, direction))
    matrix = np.eye(4)
    matrix[:3] = np.stack([left, np.cross(direction, left), direction, origin], axis=1)
    return matrix


def sensor(body: str, width: int = 640, height: int = 360, kind: str = "perspective", film: str = "") -> str:
    return (f'<sensor type="{kind}">{body}<film type="hdrfilm"><integer name="width" value="{width}"/>'
            f'<integer name="height" value="{height}"/>{film}<rfilter type="box"/></film></sensor>')


class CameraTest(MitsubaTest):
    TO_WORLD = look_at(np.array([1.0, 2.0, 3.0]), np.array([4.0, 2.5, -1.0]), np.array([0.1, 1.0, 0.0]))

    def check(self, camera: Camera, x_fov: float, aspect: float, to_world: np.ndarray) -> None:
        for x, y in ((0, 0), (1, 0), (0, 1), (1, 1), (0.5, 0.5), (0.3, 0.8)):
            self.assert_close(camera_direction(x, y, camera), source_direction(x, y, x_fov, aspect, to_world), 1e-9)

    def test_corners_of_a_wide_picture(self) -> None:
        camera = self.read(sensor(f'<float name="fov" value="70"/>{_LOOK}')).camera
        self.assertEqual((camera.width, camera.height), (640, 360))
        self.check(camera, 70, 640 / 360, self.TO_WORLD)
        self.assert_close(camera.to_world[:3, 3], (1, 2, 3))

    def test_right_in_the_picture_is_minus_x(self) -> None:
        camera = self.read(sensor('<float name="fov" value="90"/>', 200, 100)).camera
        self.assert_close(camera_direction(1, 0.5, camera), np.array([-1, 0, 1]) / np.sqrt(2))
        self.assert_close(camera_direction(0.5, 0, camera), unit(np.array([0, 0.5, 1])))

    def test_axes_of_the_field_of_view(self) -> None:
        """Widths worked out by hand at 45 degrees: x; y times 16/9; the diagonal's share 16 / sqrt(16^2 + 9^2)."""
        half = np.tan(np.radians(22.5))
        tangents = {"x": half, "larger": half, "y": half * 16 / 9, "smaller": half * 16 / 9,
                    "diagonal": half * 16 / np.sqrt(337)}
        for axis, tangent in tangents.items():
            with self.subTest(axis):
                body = f'<float name="fov" value="45"/><string name="fov_axis" value="{axis}"/>{_LOOK}'
                self.check(self.read(sensor(body)).camera, 2 * np.degrees(np.arctan(tangent)), 16 / 9, self.TO_WORLD)
        portrait = self.read(sensor('<float name="fov" value="45"/><string name="fov_axis" value="smaller"/>', 90,
                                    160)).camera
        self.check(portrait, 45, 9 / 16, np.eye(4))
        portrait = self.read(sensor('<float name="fov" value="45"/><string name="fov_axis" value="larger"/>', 90,
                                    160)).camera
        self.assertAlmostEqual(portrait.vertical_fov, 45)

    def test_old_names_and_focal_length(self) -> None:
        """50 mm before 36 mm x 24 mm: a diagonal of 2 atan(sqrt(36^2 + 24^2) / 100)."""
        body = '<string name="focalLength" value="50mm"/>' + _LOOK.replace("to_world", "toWorld").replace("lookat", "lookAt")
        camera = self.read(sensor(body, 300, 200), "0.6.0").camera
        self.check(camera, 2 * np.degrees(np.arctan(18 / 50)), 1.5, self.TO_WORLD)
        default = self.read(sensor("", 300, 200)).camera
        self.check(default, 2 * np.degrees(np.arctan(18 / 50)), 1.5, np.eye(4))

    def test_mirrored_camera(self) -> None:
        """As scenes of 0.6 write it for renderers with x to the right: the picture is mirrored, not turned."""
        body = '<float name="fov" value="60"/><transform name="toWorld"><scale x="-1"/></transform>'
        camera = self.read(sensor(body), "0.5.0").camera
        self.assertLess(np.linalg.det(camera.to_world[:3, :3]), 0)
        self.check(camera, 60, 640 / 360, np.diag([-1.0, 1, 1, 1]))

    def test_crop_in_the_middle(self) -> None:
        crop = ('<integer name="crop_offset_x" value="160"/><integer name="crop_offset_y" value="90"/>'
                '<integer name="crop_width" value="320"/><integer name="crop_height" value="180"/>')
        camera = self.read(sensor('<float name="fov" value="80"/>', film=crop)).camera
        self.assertEqual((camera.width, camera.height), (320, 180))
        for x, y in ((0, 0), (1, 0.25)):  # of the crop, which is the middle half of the film each way
            self.assert_close(camera_direction(x, y, camera),
                              source_direction(0.25 + x / 2, 0.25 + y / 2, 80, 16 / 9, np.eye(4)))
        self.assertEqual(self.noted(), [])

    def test_crop_elsewhere_renders_the_whole_picture(self) -> None:
        crop = '<integer name="cropOffsetX" value="10"/><integer name="cropWidth" value="100"/>'
        camera = self.read(sensor('<float name="fov" value="80"/>', film=crop), "0.6.0").camera
        self.assertEqual((camera.width, camera.height), (640, 360))
        self.check(camera, 80, 16 / 9, np.eye(4))
        self.assert_noted("a crop window away from the picture's middle")

    def test_orthographic(self) -> None:
        """The film spans 2 x 2/aspect before to_world, which here scales it by 10: 20 wide and 10 high."""
        body = '<transform name="to_world"><scale x="10" y="10"/><translate x="1"/></transform>'
        camera = self.read(sensor(body, 200, 100, "orthographic")).camera
        self.assertIsNone(camera.vertical_fov)
        self.assertAlmostEqual(camera.half_height, 5)
        self.assertIn("different scales", self.problem(sensor('<transform name="to_world"><scale x="2"/></transform>', 2, 2,
                                                              "orthographic")))

    def test_thin_lens_is_a_pinhole(self) -> None:
        body = ('<float name="fov" value="30"/><float name="aperture_radius" value="0.1"/>'
                '<float name="focus_distance" value="3"/>')
        self.check(self.read(sensor(body, kind="thinlens")).camera, 30, 16 / 9, np.eye(4))
        self.assert_noted("left out: depth of field")

    def test_defaults_and_notes(self) -> None:
        camera = self.read('<sensor type="perspective"><float name="fov" value="40"/></sensor>').camera
        self.assertEqual((camera.width, camera.height), (768, 576))
        self.assert_noted("the pixel filter (gaussian) as a box")
        self.read(sensor('<float name="fov" value="40"/><float name="near_clip" value="0.1"/><float name="glow" '
                         'value="1"/>'))
        self.assertEqual(self.noted(), ['left out: the parameter "glow" of sensor perspective'])

    def test_clipping_planes(self) -> None:
        """Mitsuba sees from depth near_clip to far_clip; what lies outside of that within the picture is named."""
        body = '<float name="fov" value="40"/><float name="near_clip" value="{}"/><float name="far_clip" value="{}"/>'
        wall = ('<shape type="rectangle"><transform name="to_world"><scale value="50"/><translate z="{}"/></transform>'
                '<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>')
        for near, far, depth, expected in ((1, 100, 5, ""), (1, 100, 0.5, "nearer than the near one, at 1"),
                                           (1, 100, -0.5, ""), (1, 100, 150, "farther than the far one, at 100")):
            self.read(sensor(body.format(near, far)) + wall.format(depth))
            self.assertEqual([text.partition("what lies ")[2].partition(", is")[0] for text in self.noted()],
                             [expected] if expected else [])
        beside = '<shape type="cube"><transform name="to_world"><translate x="5" z="0.5"/></transform>'
        self.read(sensor(body.format(1, 100)) + beside + '<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>')
        self.assertEqual(self.noted(), [])

    def test_what_is_refused(self) -> None:
        cases = {
            '<float name="fov" value="0"/>': "between 0 and 180",
            '<float name="fov" value="180"/>': "between 0 and 180",
            '<float name="fov" value="40"/><string name="fov_axis" value="z"/>': "x, y, diagonal, smaller and larger",
            '<float name="fov" value="40"/><string name="focal_length" value="50mm"/>': "both",
            '<string name="focal_length" value="-5mm"/>': "a length such as",
            '<float name="fov" value="40"/><float name="principal_point_offset_x" value="0.1"/>': "shifted camera",
            '<string name="fov" value="wide"/>': "must be a number",
            '<transform name="to_world"><lookat origin="0,0,0" target="0,0,0"/></transform>': "same point",
            '<transform name="to_world"><scale x="0"/></transform>': "is flat",
        }
        for body, part in cases.items():
            with self.subTest(body):
                self.assertIn(part, self.problem(sensor(body)))
        self.assertIn("from 1 to 32768", self.problem(sensor("", 0, 5)))
        self.assertIn("from 1 to 32768", self.problem(sensor("", 10**12, 5)))
        self.assertIn("outside of its 640 x 360", self.problem(sensor("", film='<integer name="crop_width" value="700"/>')))
        self.assertIn("no counterpart", self.problem('<sensor type="spherical"/>'))


class PathLengthTest(MitsubaTest):
    def bounces(self, body: str, version: str = "3.0.0") -> int | None:
        return self.read(body, version).max_bounces

    def test_depths(self) -> None:
        """max_depth = 1 is what is seen directly, 2 one bounce, -1 no limit (the path plugin's documentation)."""
        for depth, expected in ((1, 0), (2, 1), (13, 12), (-1, None), (0, 0)):
            body = f'<integrator type="path"><integer name="max_depth" value="{depth}"/></integrator>'
            self.assertEqual(self.bounces(body), expected)
        self.assertEqual(self.bounces('<integrator type="bdpt"><integer name="maxDepth" value="6"/></integrator>', "0.6.0"),
                         5)
        self.assertIsNone(self.bounces('<integrator type="path"/>'))
        self.assertIsNone(self.bounces(""))
        self.assertEqual(self.bounces('<integrator type="direct"/>'), 1)

    def test_integrators_around_others(self) -> None:
        inner = '<integrator type="path"><integer name="max_depth" value="4"/></integrator>'
        self.assertEqual(self.bounces(f'<integrator type="aov"><string name="aovs" value="dd:depth"/>{inner}</integrator>'),
                         3)
        self.assertEqual(self.bounces(f'<integrator type="moment">{inner}</integrator>'), 3)
        self.assertEqual(self.noted(), [])

    def test_notes(self) -> None:
        self.bounces('<integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>')
        self.assert_noted("left out: hide_emitters")
        self.bounces('<integrator type="depth"/>')
        self.assert_noted('the integrator "depth"')
        self.bounces('<integrator type="guided_path"><integer name="sppPerPass" value="1"/><float name="budget" value="9"/>'
                     "</integrator>", "0.5.0")
        self.assertEqual(self.noted(), ['left out: parameters of the integrator "guided_path": budget, spp_per_pass'])
        self.assertIn("max_depth", self.problem('<integrator type="path"><integer name="max_depth" '
                                                'value="-2"/></integrator>'))


if __name__ == "__main__":
    unittest.main()
