"""Textures and skies from files of all kinds."""

from __future__ import annotations

import io
import struct
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy as np
from PIL import Image as Pillow

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.images.exr_file import write_exr  # noqa: E402
from importer.images.load import load_image, load_radiance, load_scaled  # noqa: E402
from importer.problems import ImportProblem  # noqa: E402
from importer.scene import Image  # noqa: E402

# IEC 61966-2-1 at the byte 128: ((128 / 255 + 0.055) / 1.055)^2.4.
MIDDLE = 0.21586050011389926


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png16(values: np.ndarray, kind: int, filter_type: int = 0) -> bytes:
    """PNG of 16 bits a channel (Pillow writes none of colours); filters: 0 none, 2 the difference from the line above."""
    height, width = values.shape[:2]
    rows = values.astype(">u2").reshape(height, -1).view(np.uint8)
    packed = np.diff(rows, axis=0, prepend=np.zeros((1, rows.shape[1]), np.uint8)) if filter_type == 2 else rows
    lines = b"".join(bytes([filter_type]) + line.tobytes() for line in packed)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, kind, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def encoded(picture: Pillow.Image, kind: str, **options: object) -> bytes:
    file = io.BytesIO()
    picture.save(file, kind, **options)
    return file.getvalue()


RGB = np.array([[(255, 0, 0), (0, 128, 0)], [(0, 0, 255), (10, 20, 30)], [(1, 2, 3), (4, 5, 6)]], np.uint8)


class LoadTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def load(self, data: bytes, name: str = "wood.png", is_linear: bool | None = None) -> Image:
        (self.folder / name).write_bytes(data)
        return load_image(self.folder / name, is_linear)

    def refused(self, data: bytes, name: str = "wood.png") -> str:
        with self.assertRaises(ImportProblem) as caught:
            self.load(data, name)
        self.assertIn(str(self.folder / name), str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        return str(caught.exception)

    def test_bytes_are_kept_with_their_file(self) -> None:
        data = encoded(Pillow.fromarray(RGB), "PNG")
        for is_linear in (None, False):
            image = self.load(data, is_linear=is_linear)
            np.testing.assert_array_equal(image.pixels, RGB)
            self.assertEqual((image.name, image.encoded, image.mime_type), ("wood", data, "image/png"))
            self.assertEqual(image.pixels.dtype, np.uint8)

    def test_linear_bytes(self) -> None:
        image = self.load(encoded(Pillow.fromarray(RGB), "PNG"), is_linear=True)
        np.testing.assert_array_equal(image.pixels, RGB / 255)
        self.assertIsNone(image.encoded)  # who reads it as a colour would take it for sRGB

    def test_jpeg_by_content(self) -> None:
        grey = np.full((8, 8), 77, np.uint8)
        data = encoded(Pillow.fromarray(grey), "JPEG", quality=100)
        image = self.load(data, "named_wrongly.png")
        np.testing.assert_array_equal(image.pixels, np.full((8, 8, 3), 77))
        self.assertEqual((image.encoded, image.mime_type), (data, "image/jpeg"))

    def test_four_inks(self) -> None:
        inks = Pillow.new("CMYK", (8, 8), (0, 255, 255, 0))  # no cyan, all magenta and yellow: red
        image = self.load(encoded(inks, "JPEG", quality=100), "a.jpg")
        np.testing.assert_allclose(image.pixels.astype(int), np.tile((255, 0, 0), (8, 8, 1)), atol=3)
        self.assertIsNone(image.encoded)  # the engine reads no such JPEG

    def test_palettes_grey_and_alpha(self) -> None:
        palette = Pillow.fromarray(RGB).quantize(6)
        np.testing.assert_array_equal(self.load(encoded(palette, "PNG")).pixels, RGB)
        grey = Pillow.fromarray(RGB[..., 1])
        np.testing.assert_array_equal(self.load(encoded(grey, "PNG")).pixels, np.repeat(RGB[..., 1:2], 3, axis=2))
        bits = Pillow.fromarray(RGB[..., 0] > 100).convert("1")
        np.testing.assert_array_equal(self.load(encoded(bits, "PNG")).pixels[..., 0], [(255, 0), (0, 0), (0, 0)])
        alpha = np.dstack([RGB, np.arange(6, dtype=np.uint8).reshape(3, 2)])
        np.testing.assert_array_equal(self.load(encoded(Pillow.fromarray(alpha), "PNG")).pixels, alpha)
        pair = Pillow.fromarray(alpha[..., 2:])
        np.testing.assert_array_equal(self.load(encoded(pair, "PNG")).pixels, alpha[..., [2, 2, 2, 3]])
        clear = encoded(palette, "PNG", transparency=palette.getpixel((1, 0)))
        np.testing.assert_array_equal(self.load(clear).pixels[..., 3], [(255, 0), (255, 255), (255, 255)])

    def test_targa_and_bitmap(self) -> None:
        for kind in ("TGA", "BMP"):
            image = self.load(encoded(Pillow.fromarray(RGB), kind), f"a.{kind.lower()}")
            np.testing.assert_array_equal(image.pixels, RGB)
            self.assertIsNone(image.encoded)  # glTF knows PNG and JPEG

    def test_sixteen_bits(self) -> None:
        values = np.random.default_rng(1).integers(0, 65536, (5, 7, 4))
        for kind, channels, wanted in ((2, (0, 1, 2), (0, 1, 2)), (6, (0, 1, 2, 3), (0, 1, 2, 3)), (0, (0,), (0, 0, 0))):
            for filter_type in (0, 2):
                data = png16(values[..., channels], kind, filter_type)
                np.testing.assert_allclose(self.load(data, is_linear=True).pixels, values[..., wanted] / 65535, atol=1e-12)
        image = self.load(png16(np.full((1, 1, 4), 0x8080), 6))  # 0x8080 / 65535 = 128 / 255
        np.testing.assert_allclose(image.pixels[0, 0], (MIDDLE, MIDDLE, MIDDLE, 128 / 255))  # alpha is linear
        self.assertIsNotNone(image.encoded)

    def test_sixteen_bits_of_grey_with_alpha(self) -> None:
        image = self.load(png16(np.array([[(0x8040, 0xC0FF)]]), 4), is_linear=True)
        np.testing.assert_allclose(image.pixels[0, 0], (0x80 / 255,) * 3 + (0xC0 / 255,))  # to eight bits

    def test_floats_are_linear_whatever_is_asked_for(self) -> None:
        path = self.folder / "a.exr"
        write_exr(path, np.array([[(0.5, 2, -1), (0, 0.25, 1)]]))
        for is_linear in (None, True, False):
            image = load_image(path, is_linear)
            self.assertEqual(image.pixels.dtype, np.float64)
            np.testing.assert_array_equal(image.pixels, [[(0.5, 1, 0), (0, 0.25, 1)]])
        image, scale = load_scaled(path)
        self.assertEqual(scale, 2)
        np.testing.assert_array_equal(image.pixels, [[(0.25, 1, 0), (0, 0.125, 0.5)]])
        np.testing.assert_array_equal(load_radiance(path), [[(0.5, 2, 0), (0, 0.25, 1)]])

    def test_radiance_of_bytes(self) -> None:
        (self.folder / "a.png").write_bytes(encoded(Pillow.fromarray(np.full((1, 1, 3), 128, np.uint8)), "PNG"))
        radiance = load_radiance(self.folder / "a.png")
        self.assertEqual(radiance.dtype, np.float32)
        np.testing.assert_allclose(radiance, np.full((1, 1, 3), MIDDLE), rtol=1e-6)
        self.assertEqual(load_scaled(self.folder / "a.png")[1], 1)

    def test_large_images_take_little_memory(self) -> None:
        """Linear bytes are exact in single precision, and a sky of more texels than the program reads is not unpacked."""
        grey = np.arange(256, dtype=np.uint8)
        large = self.load(encoded(Pillow.fromarray(np.tile(grey, (2100, 8))), "PNG"), is_linear=True)
        self.assertEqual((large.pixels.dtype, large.pixels.shape), (np.float32, (2100, 2048, 3)))
        np.testing.assert_array_equal(np.rint(large.pixels[7, :256, 1] * np.float32(255)), grey)
        path = self.folder / "sky.png"
        path.write_bytes(encoded(Pillow.new("L", (8192, 4097)), "PNG"))
        with self.assertRaisesRegex(ImportProblem, "sky.png: the image has 8192 x 4097 pixels; it may have .* 32 Mi in all"):
            load_radiance(path)

    def test_numbers_that_are_none(self) -> None:
        path = self.folder / "a.exr"
        for value in (np.nan, np.inf):
            rgb = np.zeros((3, 4, 3))
            rgb[2, 1, 0] = value
            write_exr(path, rgb)
            for load in (load_image, load_radiance, load_scaled):
                with self.assertRaisesRegex(ImportProblem, "the pixel in column 1 and row 2 is not a finite number"):
                    load(path)

    def test_faults_are_one_sentence(self) -> None:
        good = encoded(Pillow.fromarray(np.random.default_rng(1).integers(0, 256, (64, 64, 3), dtype=np.uint8)), "PNG")
        large, larger = (good[:8] + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)) + good[33:]
                         for side in (12000, 40000))
        for data, part in ((b"", "none of PNG"), (b"GIF89a" + bytes(99), "none of PNG"), (good[:2000], "damaged"),
                           (larger, "more than the 128 Mi pixels"),
                           (large, "has 12000 x 12000 pixels"),
                           (png16(np.random.default_rng(1).integers(0, 65536, (9, 9, 3)), 2)[:200], "damaged")):
            with self.subTest(part=part, size=len(data)):
                self.assertIn(part, self.refused(data))
        with self.assertRaisesRegex(ImportProblem, "no.png: the image cannot be read: No such file"):
            load_image(self.folder / "no.png")


if __name__ == "__main__":
    unittest.main()
