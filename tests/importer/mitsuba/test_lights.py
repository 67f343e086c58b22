"""Lights: which way they shine, from where and how strongly, by the formulas of Mitsuba's emitters."""

from __future__ import annotations

import unittest

import numpy as np

from mitsuba_scenes import MitsubaTest, world_fronts, world_positions
from importer.scene import LightKind, Part, Sky, Texture

_TURN = '<transform name="to_world"><rotate x="0.3" y="1" z="-0.2" angle="40"/></transform>'


def rotation(axis: tuple[float, float, float], degrees: float) -> np.ndarray:
    """Columns by quaternions, as another way than the reader's."""
    x, y, z = np.array(axis) / np.linalg.norm(axis) * np.sin(np.radians(degrees) / 2)
    w = np.cos(np.radians(degrees) / 2)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def pfm(pixels: np.ndarray) -> bytes:
    """Rows from the bottom, little-endian."""
    height, width, _ = pixels.shape
    return f"PF\n{width} {height}\n-1.0\n".encode() + pixels[::-1].astype("<f4").tobytes()


class PunctualTest(MitsubaTest):
    def test_point(self) -> None:
        light = self.read('<emitter type="point"><point name="position" x="1" y="2" z="3"/>'
                          '<rgb name="intensity" value="4, 5, 6"/></emitter>').lights[0]
        self.assertIs(light.kind, LightKind.POINT)
        self.assert_close(light.intensity, (4, 5, 6))
        self.assert_close(light.position, (1, 2, 3))
        old = self.read('<emitter type="point"><transform name="toWorld"><translate x="1"/><scale value="2"/></transform>'
                        '<spectrum name="intensity" value="7"/><float name="samplingWeight" value="3"/></emitter>', "0.6.0")
        self.assert_close(old.lights[0].position, (2, 0, 0))
        self.assert_close(old.lights[0].intensity, (7, 7, 7))
        self.assertEqual([text for text in self.noted() if "point" in text], [])

    def test_spot(self) -> None:
        """Along +z of its own space; a beam of 3/4 of the cutoff where none is given (SpotLight::SpotLight)."""
        light = self.read('<emitter type="spot"><transform name="to_world"><lookat origin="1, 1, 1" target="1, 2, 1" '
                          'up="1,0,0"/>'
                          '</transform><float name="cutoff_angle" value="40"/></emitter>').lights[0]
        self.assert_close(light.position, (1, 1, 1))
        self.assert_close(light.direction, (0, 1, 0))
        self.assert_close((light.inner_cone, light.outer_cone), np.radians((30, 40)))
        self.assert_close(light.intensity, (1, 1, 1))
        self.assert_noted("a spot light's fading")
        light = self.read('<emitter type="spot"/>', "0.5.0").lights[0]
        self.assert_close((light.inner_cone, light.outer_cone), np.radians((15, 20)))
        self.assert_close(light.direction, (0, 0, 1))
        self.assertIn("within its cutoff", self.problem('<emitter type="spot"><float name="beam_width" '
                                                        'value="30"/></emitter>'))

    def test_directional(self) -> None:
        light = self.read('<emitter type="directional"><vector name="direction" x="0" y="-2" z="0"/>'
                          '<rgb name="irradiance" value="3"/></emitter>').lights[0]
        self.assertIs(light.kind, LightKind.DIRECTIONAL)
        self.assert_close(light.direction, (0, -1, 0))
        self.assert_close(light.intensity, (3, 3, 3))
        light = self.read(f'<emitter type="directional">{_TURN}</emitter>').lights[0]
        self.assert_close(light.direction, rotation((0.3, 1, -0.2), 40) @ (0, 0, 1))
        self.assertIn("is zero", self.problem('<emitter type="directional"><vector name="direction" x="0" y="0" '
                                              'z="0"/></emitter>'))

    def test_what_is_refused(self) -> None:
        for kind in ("sunsky", "sky", "sun", "projector", "collimated"):
            self.assertIn(f'"{kind}"', self.problem(f'<emitter type="{kind}"/>'))
        self.read('<emitter type="sunsky"/>', is_lenient=True)
        self.assert_noted('left out: an emitter of type "sunsky"')
        self.assertIn("belongs into a <shape>", self.problem('<emitter type="area"/>'))
        self.assertIn("known are", self.problem('<emitter type="torch"/>'))
        self.assertIn("negative", self.problem('<emitter type="point"><rgb name="intensity" value="1, -1, 1"/></emitter>'))


class SkyTest(MitsubaTest):
    def test_constant(self) -> None:
        sky = self.read('<emitter type="constant"><rgb name="radiance" value="0.5, 1, 2"/></emitter>').sky
        self.assert_close(sky.radiance, (0.5, 1, 2))
        self.assertIsNone(sky.image)
        self.assertIn("second environment", self.problem('<emitter type="constant"/><emitter type="constant"/>'))

    def test_constant_of_all_wavelengths(self) -> None:
        """0.6 takes one number as white; 3 as equal at all wavelengths, whose sRGB is the sum of the matrix's rows."""
        body = '<emitter type="constant"><spectrum name="radiance" value="2"/></emitter>'
        self.assert_close(self.read(body, "0.6.0").sky.radiance, (2, 2, 2))
        self.assert_close(self.read(body).sky.radiance, (2 * 1.2048, 2 * 0.9483, 2 * 0.9089), 1e-3)
        plugin = ('<emitter type="constant"><spectrum type="uniform" name="radiance"><float name="value" value="2"/>'
                  "</spectrum></emitter>")
        self.assert_close(self.read(plugin).sky.radiance, (2, 2, 2))
        self.assert_close(self.read(body.replace("spectrum", "float")).sky.radiance, (2, 2, 2))

    def environment(self, body: str = "", version: str = "3.0.0") -> tuple[Sky, np.ndarray]:
        pixels = np.random.default_rng(3).uniform(0, 5, (8, 16, 3)).astype(np.float32)
        self.write("sky.pfm", pfm(pixels))
        text = f'<emitter type="envmap"><string name="filename" value="sky.pfm"/>{body}</emitter>'
        return self.read(text, version).sky, pixels

    def seen(self, sky: Sky, direction: np.ndarray) -> np.ndarray:
        """The texel of scene.Sky in a direction: its middle is -z, its right half +x, its top +y."""
        x, y, z = np.linalg.inv(sky.to_world) @ direction
        height, width, _ = sky.image.shape
        u, v = 0.5 + np.arctan2(x, -z) / (2 * np.pi), np.arccos(y) / np.pi
        return sky.image[int(v * height), int(u * width) % width] * sky.scale

    def of_source(self, pixels: np.ndarray, to_world: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """u = atan2(x, -z) / 2 pi, v = acos(y) / pi of the direction in the map's own space (envmap.cpp of 0.6 and 3)."""
        x, y, z = np.linalg.inv(to_world) @ direction
        height, width, _ = pixels.shape
        u, v = np.arctan2(x, -z) / (2 * np.pi) % 1, np.arccos(y) / np.pi
        return pixels[int(v * height), int(u * width) % width]

    def test_directions_of_an_environment_map(self) -> None:
        mirror = '<transform name="to_world"><scale x="-1"/></transform>'
        twice = _TURN.replace("<rotate", '<scale value="2"/><rotate')
        turned = rotation((0.3, 1, -0.2), 40)
        cases = {"": np.eye(3), _TURN: turned, mirror: np.diag([-1.0, 1, 1]), twice: turned}
        directions = np.random.default_rng(4).normal(size=(60, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        for body, to_world in cases.items():
            for version in ("3.0.0", "0.6.0"):
                sky, pixels = self.environment(body.replace("to_world", "toWorld") if version < "1" else body, version)
                with self.subTest(body=body, version=version):
                    for direction in directions:
                        self.assert_close(self.seen(sky, direction), self.of_source(pixels, to_world, direction), 1e-6)

    def test_middle_of_an_environment_map(self) -> None:
        """By hand: u = 1/2 lies at atan2(x, -z) = pi, that is +z, and u = 1/4 at +x."""
        sky, pixels = self.environment()
        self.assert_close(self.seen(sky, np.array([0.01, 0.05, 1])), pixels[3, 7], 1e-6)
        self.assert_close(self.seen(sky, np.array([1, 0.05, 0.01])), pixels[3, 4], 1e-6)

    def test_scale_and_notes(self) -> None:
        sky, _ = self.environment('<float name="scale" value="3"/>')
        self.assert_close(sky.scale, (3, 3, 3))
        self.assert_noted("the rows of an environment map")
        self.assertIn("must be a rotation", self.problem('<emitter type="envmap"><string name="filename" value="sky.pfm"/>'
                                                         '<transform name="to_world"><scale x="2"/></transform></emitter>'))
        self.assertIn("no file", self.problem('<emitter type="envmap"><string name="filename" value="none.exr"/></emitter>'))


def irradiance(part: Part, point: np.ndarray, normal: np.ndarray, cells: int = 60) -> np.ndarray:
    """Of a lamp whose front alone shines, by the middles of small triangles: the sum of L cos cos' dA / r^2."""
    steps = np.arange(cells)
    i, j = (x.ravel() for x in np.meshgrid(steps, steps))
    upper = np.stack([i + 1 / 3, j + 1 / 3], axis=1)[i + j < cells] / cells
    lower = np.stack([i + 2 / 3, j + 2 / 3], axis=1)[i + j < cells - 1] / cells
    total = np.zeros(3)
    for corners, front in zip(world_positions(part)[part.mesh.triangles], world_fronts(part)):
        edges = np.stack([corners[1] - corners[0], corners[2] - corners[0]])
        points = corners[0] + np.concatenate([upper, lower]) @ edges
        rays = points - point
        distance = np.linalg.norm(rays, axis=1)
        cosines = np.maximum(rays @ normal / distance, 0) * np.maximum(-rays @ front / distance, 0)
        area = np.linalg.norm(np.cross(*edges)) / 2 / len(points)
        total += np.array(part.material.radiance) * (cosines / distance**2).sum() * area
    return total


class AreaLightTest(MitsubaTest):
    LAMP = '<emitter type="area"><rgb name="radiance" value="10, 20, 30"/></emitter>'

    def test_radiance_and_its_side(self) -> None:
        """Light leaves on the side of the shading normal, which is +z of a rectangle, whatever twosided is around."""
        body = f'<shape type="rectangle"><bsdf type="twosided"><bsdf type="diffuse"/></bsdf>{self.LAMP}</shape>'
        part = self.read(body).parts[0]
        self.assert_close(part.material.radiance, (10, 20, 30))
        self.assertFalse(part.material.emits_both_sides)
        self.assert_close(world_fronts(part), [(0, 0, 1)] * 2)

    def test_irradiance_of_a_lamp(self) -> None:
        """A square of 2 x 2 at a height of 2 over the point: four times the factor of one whose corner is above it,
        (A atan(A / sqrt(1 + A^2)) / sqrt(1 + A^2)) / pi with A = 1/2 (Howell's catalogue of view factors, an element and a
        parallel rectangle)."""
        root = np.sqrt(1.25)
        expected = np.pi * np.array([10, 20, 30]) * 4 * 0.5 / root * np.arctan(0.5 / root) / np.pi
        up, down = '<translate z="2"/>', '<rotate x="1" angle="180"/><translate z="2"/>'
        for steps, flip, factor in ((down, "false", 1), (up, "false", 0), (up, "true", 1), (down, "true", 0),
                                    ('<scale z="-1"/>' + up, "false", 1), ('<scale x="-1"/>' + down, "false", 1)):
            with self.subTest(steps, flip=flip):
                part = self.read(f'<shape type="rectangle"><transform name="to_world">{steps}</transform>'
                                 f'<boolean name="flip_normals" value="{flip}"/>{self.LAMP}</shape>').parts[0]
                self.assert_close(irradiance(part, np.zeros(3), np.array([0, 0, 1.0])), factor * expected, 1e-2)

    def test_irradiance_of_a_ball(self) -> None:
        """L pi r^2 / d^2 above a surface that faces the ball (Howell, an element and a sphere) of radius 2 at a
        distance of 5."""
        part = self.read('<shape type="sphere"><point name="center" x="0" y="0" z="5"/><float name="radius" value="2"/>'
                         f"{self.LAMP}</shape>").parts[0]
        expected = np.pi * np.array([10, 20, 30]) * 4 / 25
        self.assert_close(irradiance(part, np.zeros(3), np.array([0, 0, 1.0]), 1) / expected, (1, 1, 1), 3e-3)

    def test_without_a_bsdf_a_lamp_is_black(self) -> None:
        part = self.read(f'<shape type="rectangle">{self.LAMP}</shape>').parts[0]
        self.assert_close(part.material.base_colour, (0, 0, 0))
        self.assert_close(self.read('<shape type="rectangle"/>').parts[0].material.base_colour, (0.5, 0.5, 0.5))

    def test_default_and_shared_materials(self) -> None:
        scene = self.read('<bsdf type="twosided" id="white"><bsdf type="diffuse"/></bsdf>'
                          '<shape type="rectangle"><ref id="white"/><emitter type="area"/></shape>'
                          '<shape type="rectangle"><ref id="white"/></shape>')
        self.assert_close(scene.parts[0].material.radiance, (1, 1, 1))
        self.assert_close(scene.parts[1].material.radiance, (0, 0, 0))

    def test_textured(self) -> None:
        self.write("glow.pfm", pfm(np.array([[[8.0, 4, 2], [1, 1, 1]]])))
        part = self.read('<shape type="rectangle"><emitter type="area"><texture name="radiance" type="bitmap">'
                         '<string name="filename" value="glow.pfm"/></texture></emitter></shape>').parts[0]
        radiance = part.material.radiance
        self.assertIsInstance(radiance, Texture)
        self.assert_close(radiance.image.pixels[0] * radiance.scale, [(8, 4, 2), (1, 1, 1)], 1e-6)

    def test_masked_lamps(self) -> None:
        """A mask does not dim a lamp's light in Mitsuba; here a surface emits its radiance times its opacity."""
        mask = '<bsdf type="mask"><float name="opacity" value="0.25"/><bsdf type="diffuse"/></bsdf>'
        material = self.read(f'<shape type="rectangle">{mask}{self.LAMP}</shape>').parts[0].material
        self.assert_close(np.array(material.radiance) * material.opacity, (10, 20, 30))
        material = self.read(f'<shape type="rectangle"><bsdf type="null"/>{self.LAMP}</shape>').parts[0].material
        self.assertEqual(material.opacity, 1)
        self.assert_close(material.radiance, (10, 20, 30))
        self.assert_close(material.base_colour, (0, 0, 0))
        self.assert_noted("a lamp that light passes through")

    def test_a_lamp_that_shapes_refer_to(self) -> None:
        scene = self.read('<emitter type="area" id="lamp"><rgb name="radiance" value="1 2 3"/></emitter>'
                          '<shape type="rectangle"><ref id="lamp"/></shape><shape type="sphere"/>')
        self.assertEqual([part.material.radiance for part in scene.parts], [(1.0, 2.0, 3.0), (0.0, 0.0, 0.0)])
        self.assertEqual(scene.lights, [])
        self.assertIn("belongs into a <shape>", self.problem('<emitter type="area"/>'))

    def test_two_emitters(self) -> None:
        self.assertIn("has 2 <emitter>", self.problem(f'<shape type="rectangle">{self.LAMP}{self.LAMP}</shape>'))


if __name__ == "__main__":
    unittest.main()
