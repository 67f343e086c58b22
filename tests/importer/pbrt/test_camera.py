"""pbrt's transformations, cameras and films by rays that are worked out by hand from fileformat-v4 and cameras.cpp."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from importer.scene import Camera  # noqa: E402
from pbrt_scene import TRIANGLE, problem, read, said, world  # noqa: E402

_END = "\nWorldBegin\n"


def corner_ray(camera: Camera, right: float, up: float) -> np.ndarray:
    """Of a perspective camera of glTF, at a share of the half picture to the right and up; unit, in the world."""
    assert camera.vertical_fov is not None
    half = math.tan(math.radians(camera.vertical_fov) / 2)
    local = np.array([right * half * camera.width / camera.height, up * half, -1.0])
    along = camera.to_world[:3, :3] @ local
    return along / np.linalg.norm(along)


def camera_of(text: str, *, is_lenient: bool = False) -> tuple[Camera, list[str]]:
    scene, notes = read(text + _END, is_lenient=is_lenient)
    return scene.camera, said(notes)


class Transforms(unittest.TestCase):
    def matrix(self, text: str) -> np.ndarray:
        return world(text + "\n" + TRIANGLE)[0].parts[0].to_world

    def moved(self, text: str, point: tuple[float, float, float]) -> np.ndarray:
        return (self.matrix(text) @ [*point, 1])[:3]

    def test_the_last_statement_acts_first(self) -> None:
        np.testing.assert_allclose(self.moved("Translate 1 2 3\nScale 2 3 4", (1, 1, 1)), (3, 5, 7))
        np.testing.assert_allclose(self.moved("Scale 2 3 4\nTranslate 1 2 3", (1, 1, 1)), (4, 9, 16))

    def test_rotations_follow_the_right_hand(self) -> None:
        np.testing.assert_allclose(self.moved("Rotate 90 0 0 5", (1, 0, 0)), (0, 1, 0), atol=1e-12)
        np.testing.assert_allclose(self.moved("Rotate 90 1 0 0", (0, 1, 0)), (0, 0, 1), atol=1e-12)
        # 120 degrees about (1, 1, 1) take x to y.
        np.testing.assert_allclose(self.moved("Rotate 120 1 1 1", (1, 0, 0)), (0, 1, 0), atol=1e-12)

    def test_matrices_stand_column_by_column(self) -> None:
        text = "[1 0 0 0  0 1 0 0  0 0 1 0  7 8 9 1]"
        np.testing.assert_allclose(self.moved(f"Scale 2 2 2\nTransform {text}", (0, 0, 0)), (7, 8, 9))
        np.testing.assert_allclose(self.moved(f"Scale 2 2 2\nConcatTransform {text}", (0, 0, 0)), (14, 16, 18))
        np.testing.assert_allclose(self.moved("Transform [0 1 0 0  -1 0 0 0  0 0 1 0  0 0 0 1]", (1, 0, 0)), (0, 1, 0))

    def test_look_at(self) -> None:
        """From world to camera: what is looked at lies along +z, what is up along +y."""
        text = "LookAt 1 2 3  1 2 8  0 1 0"
        np.testing.assert_allclose(self.moved(text, (1, 2, 3)), (0, 0, 0), atol=1e-12)
        np.testing.assert_allclose(self.moved(text, (1, 2, 8)), (0, 0, 5), atol=1e-12)
        np.testing.assert_allclose(self.moved(text, (1, 4, 3)), (0, 2, 0), atol=1e-12)
        np.testing.assert_allclose(self.moved(text, (2, 2, 3)), (1, 0, 0), atol=1e-12)

    def test_states(self) -> None:
        np.testing.assert_array_equal(self.matrix("AttributeBegin\nScale 2 2 2\nAttributeEnd"), np.eye(4))
        np.testing.assert_array_equal(self.matrix("TransformBegin\nScale 2 2 2\nTransformEnd"), np.eye(4))
        np.testing.assert_array_equal(self.matrix("Scale 2 2 2\nIdentity"), np.eye(4))
        part = world('TransformBegin\nScale 2 2 2\nMaterial "dielectric"\nTransformEnd\n' + TRIANGLE)[0].parts[0]
        np.testing.assert_array_equal(part.to_world, np.eye(4))
        self.assertEqual(part.material.transmission, 1.0)  # which is no transformation, and stays
        text = 'Translate 1 0 0\nCoordinateSystem "here"\nIdentity\nScale 2 2 2\nCoordSysTransform "here"'
        np.testing.assert_array_equal(self.moved(text, (0, 0, 0)), (1, 0, 0))

    def test_the_camera_and_the_world_are_coordinate_systems(self) -> None:
        scene, _ = read('Translate 0 0 -5\nCamera "perspective"\nWorldBegin\nCoordSysTransform "camera"\n' + TRIANGLE
                        + 'CoordSysTransform "world"\n' + TRIANGLE)
        np.testing.assert_allclose(scene.parts[0].to_world[:3, 3], (0, 0, 5))
        np.testing.assert_array_equal(scene.parts[1].to_world, np.eye(4))

    def test_what_flattens_or_is_not_affine(self) -> None:
        for text in ("Scale 1 0 1", "Transform [1 0 0 0  0 1 0 0  0 0 0 0  0 0 0 1]", "Rotate 90 0 0 0",
                     "LookAt 0 0 0 0 0 0 0 1 0", "LookAt 0 0 0 0 1 0 0 1 0",
                     "Transform [1 0 0 1  0 1 0 0  0 0 1 0  0 0 0 1]",
                     "Scale 1e200 1e200 1e200\n" * 2):
            for use in (TRIANGLE, 'LightSource "point"', 'ObjectBegin "a"\nObjectEnd\nObjectInstance "a"'):
                self.assertRegex(problem(f'Camera "perspective"\nWorldBegin\n{text}\n{use}'), "must")
            self.assertRegex(problem(f'{text}\nCamera "perspective"\nWorldBegin\n{TRIANGLE}'), "must")

    def test_what_flattens_and_is_not_used(self) -> None:
        """As exporters write it about groups that hold nothing."""
        scene, _ = world("AttributeBegin\nConcatTransform [0 0 0 0  0 1 0 0  0 0 -1 0  5 6 7 1]\nAttributeEnd\n" + TRIANGLE)
        np.testing.assert_array_equal(scene.parts[0].to_world, np.eye(4))


class Cameras(unittest.TestCase):
    def test_the_field_of_view_is_across_the_shorter_side(self) -> None:
        for width, height, vertical in ((400, 200, 60), (200, 200, 60)):
            camera, _ = camera_of(f'Camera "perspective" "float fov" 60\nFilm "rgb" "integer xresolution" {width}'
                                  f' "integer yresolution" {height}')
            self.assertAlmostEqual(camera.vertical_fov or 0, vertical)
            self.assertEqual((camera.width, camera.height), (width, height))
        camera, _ = camera_of('Camera "perspective" "float fov" 90\nFilm "rgb" "integer xresolution" 100'
                              ' "integer yresolution" 300')
        self.assertAlmostEqual(math.tan(math.radians(camera.vertical_fov or 0) / 2), 3)

    def test_defaults(self) -> None:
        for head, version in (('Film "rgb"', 4), ('Film "image"', 3)):
            camera, _ = camera_of('Camera "perspective"\n' + head)
            self.assertEqual((camera.width, camera.height), (1280, 720), version)
            self.assertAlmostEqual(camera.vertical_fov or 0, 90)

    def test_without_a_transformation_it_looks_along_z_with_x_to_the_right(self) -> None:
        """pbrt's camera space is left-handed, so that the picture of a right-handed camera is its mirror image."""
        camera, _ = camera_of('Camera "perspective" "float fov" 90\nFilm "rgb" "integer xresolution" 200'
                              ' "integer yresolution" 100')
        np.testing.assert_allclose(corner_ray(camera, 0, 0), (0, 0, 1), atol=1e-12)
        np.testing.assert_allclose(corner_ray(camera, 1, 1), np.array([2, 1, 1]) / math.sqrt(6), atol=1e-12)
        self.assertLess(np.linalg.det(camera.to_world[:3, :3]), 0)

    def test_look_at_puts_what_is_right_of_the_camera_on_the_left_of_a_right_handed_world(self) -> None:
        """From (0, 0, 5) to the origin, y up: right is up x forward = y x -z = -x (util/transform.cpp, LookAt)."""
        camera, _ = camera_of('LookAt 0 0 5  0 0 0  0 1 0\nCamera "perspective" "float fov" 90\nFilm "rgb"'
                              ' "integer xresolution" 100 "integer yresolution" 100')
        np.testing.assert_allclose(camera.to_world[:3, 3], (0, 0, 5))
        np.testing.assert_allclose(corner_ray(camera, 1, 1), np.array([-1, 1, -1]) / math.sqrt(3), atol=1e-12)

    def test_scenes_of_other_programs_mirror_first(self) -> None:
        camera, _ = camera_of('Scale -1 1 1\nLookAt 0 0 5  0 0 0  0 1 0\nCamera "perspective" "float fov" 90\nFilm "rgb"'
                              ' "integer xresolution" 100 "integer yresolution" 100')
        np.testing.assert_allclose(corner_ray(camera, 1, 1), np.array([1, 1, -1]) / math.sqrt(3), atol=1e-12)
        self.assertGreater(np.linalg.det(camera.to_world[:3, :3]), 0)

    def test_screen_windows_and_orthographic_cameras(self) -> None:
        film = '\nFilm "rgb" "integer xresolution" 300 "integer yresolution" 200'
        camera, notes = camera_of('Camera "orthographic" "float screenwindow" [-3 3 -2 2]' + film)
        self.assertIsNone(camera.vertical_fov)
        self.assertAlmostEqual(camera.half_height, 2)
        self.assertNotIn("square", " ".join(notes))
        camera, _ = camera_of('Camera "orthographic"' + film)
        self.assertAlmostEqual(camera.half_height, 1)
        camera, _ = camera_of('Camera "perspective" "float fov" 90 "float screenwindow" [-.75 .75 -.5 .5]' + film)
        self.assertAlmostEqual(math.tan(math.radians(camera.vertical_fov or 0) / 2), 0.5)
        self.assertIn("off the camera's axis", problem('Camera "perspective" "float screenwindow" [0 2 -1 1]\nWorldBegin'))
        camera, notes = camera_of('Camera "perspective" "float screenwindow" [-1 1 -1 1]' + film)
        self.assertIn("pixels that are not square", " ".join(notes))

    def test_lengths_along_the_axes_are_the_picture_s(self) -> None:
        """A camera that is scaled by 1/2 sees twice as much of the world where rays are parallel, and as much where they
        meet; one that is shorter along its axis sees more."""
        film = '\nFilm "rgb" "integer xresolution" 100 "integer yresolution" 100'
        camera, _ = camera_of('Scale .5 .5 .5\nCamera "orthographic"' + film)
        self.assertAlmostEqual(camera.half_height, 2)
        camera, _ = camera_of('Scale .5 .5 .5\nCamera "perspective" "float fov" 90' + film)
        self.assertAlmostEqual(camera.vertical_fov or 0, 90)
        camera, notes = camera_of('Scale 1 1 2\nCamera "perspective" "float fov" 90' + film)
        self.assertAlmostEqual(math.tan(math.radians(camera.vertical_fov or 0) / 2), 2)
        camera, notes = camera_of('Scale 2 1 1\nCamera "perspective" "float fov" 90' + film)
        self.assertIn("pixels that are not square", " ".join(notes))

    def test_frame_aspect_ratio_sets_the_window(self) -> None:
        camera, _ = camera_of('Camera "perspective" "float fov" 90 "float frameaspectratio" 0.5\nFilm "rgb"'
                              ' "integer xresolution" 100 "integer yresolution" 200')
        self.assertAlmostEqual(math.tan(math.radians(camera.vertical_fov or 0) / 2), 2)

    def test_crops_about_the_middle(self) -> None:
        film = 'Film "rgb" "integer xresolution" 400 "integer yresolution" 200 '
        camera, _ = camera_of('Camera "perspective" "float fov" 90\n' + film + '"float cropwindow" [.25 .75 .25 .75]')
        self.assertEqual((camera.width, camera.height), (200, 100))
        self.assertAlmostEqual(math.tan(math.radians(camera.vertical_fov or 0) / 2), 0.5)
        camera, _ = camera_of('Camera "perspective" "float fov" 90\n' + film + '"integer pixelbounds" [100 300 0 200]')
        self.assertEqual((camera.width, camera.height), (200, 200))
        self.assertAlmostEqual(camera.vertical_fov or 0, 90)
        camera, notes = camera_of('Camera "perspective" "float fov" 90\n' + film + '"float cropwindow" [0 .5 0 1]')
        self.assertEqual((camera.width, camera.height), (400, 200))
        self.assertIn("crop window, which is off the middle", " ".join(notes))

    def test_what_has_no_counterpart(self) -> None:
        camera, notes = camera_of('Camera "perspective" "float lensradius" 0.1 "float focaldistance" 3')
        self.assertIn("a lens as a pinhole, without depth of field", notes)
        for kind in ("realistic", "spherical"):
            self.assertIn("--lenient", problem(f'Camera "{kind}"' + _END))
            camera_of(f'Camera "{kind}"', is_lenient=True)
        for text in ('"pinhole"', '"perspective" "float fov" 180', '"perspective" "float frameaspectratio" 0',
                     '"perspective" "float screenwindow" [1 -1 -1 1]', '"perspective" "float shutterclose" 0'):
            self.assertRegex(problem(f"Camera {text}" + _END), "must")
        for text in ('"integer xresolution" 0', '"integer xresolution" 1000000 "integer yresolution" 1000000',
                     '"float cropwindow" [.5 .5 0 1]', '"float cropwindow" [0 1]'):
            self.assertRegex(problem(f'Camera "perspective"\nFilm "rgb" {text}' + _END), "must")

    def test_exposure_brightens_all_lights(self) -> None:
        """ISO 50 over a shutter of 4: 2 of what the light sends (PixelSensor::Create: exposure time times ISO / 100)."""
        lights = (_END + 'LightSource "point" "rgb I" [1 2 3]\nLightSource "infinite" "rgb L" [1 1 1]\n'
                  'AreaLightSource "diffuse" "rgb L" [4 5 6]\n' + TRIANGLE)
        scene, _ = read('Camera "perspective" "float shutterclose" 4\nFilm "rgb" "float iso" 50' + lights)
        np.testing.assert_allclose(scene.lights[0].intensity, (2, 4, 6))
        np.testing.assert_allclose(scene.sky.radiance, (2, 2, 2))
        np.testing.assert_allclose(scene.parts[0].material.radiance, (8, 10, 12))
        scene, notes = read('Camera "perspective" "float shutterclose" 4\nFilm "image" "float scale" 3' + lights)
        np.testing.assert_allclose(scene.lights[0].intensity, (3, 6, 9))
        self.assertIn("the exposure of the film as brighter or darker lights", said(notes))


class Options(unittest.TestCase):
    def test_path_length(self) -> None:
        for text, bounces in (("", 5), ('Integrator "path" "integer maxdepth" 7\n', 7), ('Integrator "bdpt"\n', 5),
                              ('Integrator "volpath" "integer maxdepth" 0\n', 0)):
            self.assertEqual(read(text + 'Camera "perspective"\nWorldBegin')[0].max_bounces, bounces)
        self.assertIn("--lenient", problem('Integrator "ao"\nCamera "perspective"\nWorldBegin'))
        self.assertIn("no integrator", problem('Integrator "magic"\nCamera "perspective"\nWorldBegin'))

    def test_pixel_filters(self) -> None:
        for text, is_noted in (("", True), ('PixelFilter "box"\n', False), ('PixelFilter "box" "float xradius" 1\n', True),
                               ('PixelFilter "triangle"\n', True), ('Film "image"\n', False)):
            notes = said(read(text + 'Camera "perspective"\nWorldBegin')[1])
            self.assertEqual(any("pixel filter" in note for note in notes), is_noted, text)

    def test_options(self) -> None:
        self.assertIn("forcediffuse", problem('Option "bool forcediffuse" true\nCamera "perspective"\nWorldBegin'))
        notes = said(read('Option "string strange" "x"\nOption "bool disablepixeljitter" false\nCamera "perspective"\n'
                          "WorldBegin")[1])
        self.assertIn('the option "strange"', notes)
        self.assertEqual(sum("option" in note for note in notes), 1)


if __name__ == "__main__":
    unittest.main()
