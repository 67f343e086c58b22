"""Radiance pictures and portable float maps, packed here by hand."""

from __future__ import annotations

import struct
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.images.radiance import read_hdr, read_pfm  # noqa: E402
from importer.problems import ImportProblem  # noqa: E402


def hdr(width: int, height: int, body: bytes, head: str = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n") -> bytes:
    return f"{head}\n-Y {height} +X {width}\n".encode() + body


class RadianceTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "sky.hdr"

    def hdr(self, data: bytes) -> np.ndarray:
        self.path.write_bytes(data)
        return read_hdr(self.path)

    def pfm(self, data: bytes) -> np.ndarray:
        self.path.write_bytes(data)
        return read_pfm(self.path)

    def refused(self, read: object, data: bytes) -> str:
        with self.assertRaises(ImportProblem) as caught:
            read(data)
        self.assertIn(str(self.path), str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        return str(caught.exception)

    def test_pixels_as_they_are(self) -> None:
        body = bytes([128, 64, 32, 129]) + bytes([255, 1, 0, 128]) + bytes([10, 20, 30, 0]) + bytes([200, 0, 0, 140])
        found = self.hdr(hdr(2, 2, body))
        self.assertEqual(found.dtype, np.float32)
        # mantissa / 256 * 2^(exponent - 128)
        np.testing.assert_array_equal(found, [[(1, 0.5, 0.25), (255 / 256, 1 / 256, 0)], [(0, 0, 0), (3200, 0, 0)]])

    def test_lines_packed_by_component(self) -> None:
        line = bytes([2, 2, 0, 9])
        line += bytes([128 + 9, 100])  # nine times 100
        line += bytes([3, 1, 2, 3, 128 + 6, 7])  # 1, 2, 3 and six times 7
        line += bytes([9, *range(9)])
        line += bytes([128 + 4, 128, 5, 129, 130, 131, 132, 133])
        red, green, blue = [100] * 9, [1, 2, 3, 7, 7, 7, 7, 7, 7], list(range(9))
        scale = 2.0 ** (np.array([128] * 4 + [129, 130, 131, 132, 133]) - 136)
        wanted = np.stack([red, green, blue], axis=1) * scale[:, None]
        found = self.hdr(hdr(9, 2, line * 2))
        np.testing.assert_array_equal(found, [wanted, wanted])

    def test_packed_lines_before_plain_ones(self) -> None:
        packed = bytes([2, 2, 0, 8]) + bytes([136, 64]) * 3 + bytes([136, 128])
        plain = bytes([32, 32, 32, 128]) * 8
        np.testing.assert_array_equal(self.hdr(hdr(8, 2, packed + plain))[:, :, 0], [[0.25] * 8, [0.125] * 8])

    def test_old_runs_of_pixels(self) -> None:
        # One pixel and two more of it, then another and 257 more: 1 + 1 * 256.
        body = bytes([128, 0, 0, 128]) + bytes([1, 1, 1, 2]) + bytes([64, 0, 0, 128]) + bytes([1, 1, 1, 1]) * 2
        found = self.hdr(hdr(261, 1, body))[0, :, 0]
        np.testing.assert_array_equal(found, [0.5] * 3 + [0.25] * 258)

    def test_faults_of_radiance_pictures(self) -> None:
        pixel = bytes([1, 2, 3, 128])
        for data, part in (
                (b"GIF89a", "not a Radiance picture"),
                (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "header has no end"),
                (hdr(1, 1, pixel, "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n"), "not of the format 32-bit_rle_rgbe"),
                (hdr(1, 1, pixel).replace(b"-Y 1 +X 1", b"+Y 1 +X 1"), "run as '+Y 1 +X 1'"),
                (hdr(999999, 999999, pixel), "has 999999 x 999999 pixels"),
                (hdr(2, 2, pixel), "truncated"),
                (hdr(8, 1, bytes([2, 2, 0, 8, 136, 1, 136, 1])), "truncated"),
                (hdr(8, 1, bytes([2, 2, 0, 8, 137, 1] + [136, 1] * 3)), "truncated"),
                (hdr(8, 1, bytes([2, 2, 0, 8, 0, 0] + [136, 1] * 3)), "truncated"),
                (hdr(8, 1, bytes([1, 1, 1, 8])), "truncated"),
                (hdr(8, 1, pixel + bytes([1, 1, 1, 8])), "truncated"),
                (hdr(8, 1, pixel + bytes([1, 1, 1, 255]) * 9), "truncated"),
        ):
            with self.subTest(part=part, data=data):
                self.assertIn(part, self.refused(self.hdr, data))

    def test_float_maps(self) -> None:
        values = np.arange(12, dtype=np.float32).reshape(2, 2, 3)  # the file's first row is the lowest one
        found = self.pfm(b"PF\n2 2\n-1.0\n" + values.astype("<f4").tobytes())
        np.testing.assert_array_equal(found, values[::-1])
        self.assertEqual(found.dtype, np.float32)
        np.testing.assert_array_equal(self.pfm(b"PF 2 2 2.0\n" + values.astype(">f4").tobytes()), 2 * values[::-1])
        grey = self.pfm(b"Pf\n2 1\n-1\n" + struct.pack("<2f", 0.25, 4))
        np.testing.assert_array_equal(grey, [[(0.25,) * 3, (4,) * 3]])

    def test_faults_of_float_maps(self) -> None:
        for data, part in ((b"P6\n2 2\n255\n", "not a .pfm"), (b"PF\n2 2\n-1\n" + bytes(47), "truncated"),
                           (b"PF\n2 2\n-.e\n" + bytes(48), "not a number"), (b"PF\n0 2\n-1\n", "has 0 x 2 pixels"),
                           (b"PF\n40000 40000\n-1\n", "has 40000 x 40000 pixels")):
            with self.subTest(part=part):
                self.assertIn(part, self.refused(self.pfm, data))


if __name__ == "__main__":
    unittest.main()
