"""Small Mitsuba scenes in folders of their own, for the tests of their import."""

from __future__ import annotations

import io
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from PIL import Image as Pillow

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "configs"))

from importer.mitsuba.read import read_mitsuba
from importer.problems import ImportProblem, Notes
from importer.scene import Material, Part, Scene, Texture

FILM = '<film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="2"/><rfilter type="box"/></film>'
SENSOR = f'<sensor type="perspective"><float name="fov" value="90"/>{FILM}</sensor>'
BALL = '<shape type="sphere"/>'
GREY = '<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>'


class MitsubaTest(unittest.TestCase):
    """With a folder for the scene, its meshes and pictures."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.notes = Notes()

    def write(self, name: str, content: str | bytes) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def read_file(self, text: str, is_lenient: bool = False, **parameters: str) -> Scene:
        self.notes = Notes(is_lenient)
        return read_mitsuba(self.write("scene.xml", text), self.notes, parameters)

    def read(self, body: str, version: str = "3.0.0", is_lenient: bool = False) -> Scene:
        """A scene of a camera and what `body` holds; with a ball where that has no shape."""
        sensor = "" if "<sensor" in body else SENSOR
        ball = "" if "<shape" in body else BALL
        return self.read_file(f'<scene version="{version}">{sensor}{body}{ball}</scene>', is_lenient)

    def problem(self, body: str, version: str = "3.0.0") -> str:
        with self.assertRaises(ImportProblem) as caught:
            self.read(body, version)
        return str(caught.exception)

    def noted(self) -> list[str]:
        return [f"{row['kind']}: {row['what']}" for row in self.notes.rows()]

    def assert_noted(self, part: str) -> None:
        self.assertTrue(any(part in text for text in self.noted()), f"{part} is not among {self.noted()}")

    def assert_close(self, actual: object, expected: object, tolerance: float = 1e-9) -> None:
        np.testing.assert_allclose(np.asarray(actual, float), np.asarray(expected, float), atol=tolerance, rtol=0)


def world_positions(part: Part) -> np.ndarray:
    return part.mesh.positions @ part.to_world[:3, :3].T + part.to_world[:3, 3]


def world_fronts(part: Part) -> np.ndarray:
    """Unit normals of the triangles' fronts in the world; a mirroring matrix does not change which side the front is."""
    corners = world_positions(part)[part.mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals *= np.sign(np.linalg.det(part.to_world[:3, :3]))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def area(part: Part) -> float:
    corners = world_positions(part)[part.mesh.triangles]
    return float(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2)


def png(pixels: list[list[tuple[int, int, int]]]) -> bytes:
    data = io.BytesIO()
    Pillow.fromarray(np.array(pixels, np.uint8)).save(data, "PNG")
    return data.getvalue()


def linear(byte: int) -> float:
    value = byte / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def looked_up(texture: Texture, u: float, v: float) -> np.ndarray:
    """The nearest texel at a point of the surface: row 0 of the image at v = 0."""
    x, y = texture.image_from_uv @ (u, v, 1)
    pixels = texture.image.pixels
    height, width = pixels.shape[:2]
    texel = pixels[int(np.floor(y * height)) % height, int(np.floor(x * width)) % width, :3]
    values = np.array([linear(byte) for byte in texel]) if pixels.dtype == np.uint8 else texel
    return values * texture.scale


class MaterialsTest(MitsubaTest):
    def part(self, bsdf: str, version: str = "3.0.0", shape: str = "rectangle", is_lenient: bool = False) -> Part:
        return self.read(f'<shape type="{shape}">{bsdf}</shape>', version, is_lenient).parts[0]

    def material(self, bsdf: str, version: str = "3.0.0") -> Material:
        return self.part(bsdf, version).material
