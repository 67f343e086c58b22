"""OpenEXR files: some that the library itself wrote, from formulas that are worked out here again, and our own.

The files in `exr` were written by OpenEXR 3.1.5 with channels R, G and B (k = 0, 1, 2) from `waves`, `tiles` and `bits`.
"""

from __future__ import annotations

import struct
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "configs"), str(ROOT)]

from analysis import exr  # noqa: E402
from importer.images import exr_chunks, huffman  # noqa: E402
from importer.images.exr_file import read_exr, write_exr  # noqa: E402
from importer.problems import ImportProblem  # noqa: E402

FOLDER = Path(__file__).parent / "exr"


def grid(width: int, height: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    y, x, k = np.mgrid[0:height, 0:width, 0:3]
    return x, y, k


def waves(width: int, height: int) -> np.ndarray:
    x, y, k = grid(width, height)
    return (7 * x + 13 * y + 5 * k) % 64 / 16 + np.where(x > width // 2, 0, y / 8)


def tiles(width: int, height: int) -> np.ndarray:
    x, y, _ = grid(width, height)
    return np.where((x // 9 + y // 5) % 2, 1.5, 0.25)


def bits(width: int, height: int) -> np.ndarray:
    """The half floats of these patterns: 17 thousand different ones, which PIZ packs in another way than few."""
    x, y, k = grid(width, height)
    return (96 * x + 3 * y + k).astype(np.uint16).view(np.float16)


FILES = {"rle": waves(19, 37), "zip_tiles": waves(23, 17), "piz_half": waves(19, 37),
         "pxr24_half": waves(19, 37), "pxr24_float": tiles(23, 35), "piz_float": tiles(23, 35),
         "piz_levels": waves(23, 17), "piz_many_values": bits(180, 32)}


def changed(data: bytes, name: str, value: bytes) -> bytes:
    """With another value of an attribute of the same size."""
    at = data.index(name.encode() + b"\0")
    at = data.index(b"\0", at + len(name) + 1) + 5
    return data[:at] + value + data[at + len(value):]


class ExrTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "a.exr"

    def refused(self, data: bytes) -> str:
        self.path.write_bytes(data)
        with self.assertRaises(ImportProblem) as caught:
            read_exr(self.path)
        self.assertIn(str(self.path), str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        return str(caught.exception)

    def test_files_of_the_library(self) -> None:
        for name, wanted in FILES.items():
            with self.subTest(name=name):
                np.testing.assert_array_equal(read_exr(FOLDER / f"{name}.exr"), wanted.astype(np.float32))

    def test_written_files_come_back(self) -> None:
        rng = np.random.default_rng(1)
        for height, width in ((1, 1), (16, 5), (17, 40), (50, 3)):
            for rgb in (rng.random((height, width, 3)) * 1e5, np.zeros((height, width, 3)), waves(width, height)):
                write_exr(self.path, rgb)
                wanted = rgb.astype(np.float32)
                np.testing.assert_array_equal(read_exr(self.path), wanted)
                np.testing.assert_array_equal(exr.read_exr(self.path).rgb(self.path), wanted)

    def test_grey_alone(self) -> None:
        write_exr(self.path, np.full((2, 2, 3), 0.5))
        data = self.path.read_bytes()
        three = b"".join(name + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in (b"B", b"G", b"R"))
        self.path.write_bytes(data.replace(three, three.replace(b"B", b"X").replace(b"G", b"Y").replace(b"R", b"Z")))
        np.testing.assert_array_equal(read_exr(self.path), np.full((2, 2, 3), np.float32(0.5)))
        self.assertIn("neither R, G and B nor Y, but 'X', 'A', 'Z'", self.refused(
            data.replace(three, three.replace(b"B", b"X").replace(b"G", b"A").replace(b"R", b"Z"))))

    def test_other_primaries(self) -> None:
        """White of Rec. 2020 is that of sRGB; its red is (1.6605, -0.1246, -0.0182) there (ITU-R BT.2087, inverse of M2)."""
        rgb = np.zeros((1, 2, 3))
        rgb[0, 0], rgb[0, 1] = 1, (1, 0, 0)
        write_exr(self.path, rgb)
        data = self.path.read_bytes()
        value = struct.pack("<8f", 0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290)
        attribute = b"chromaticities\0chromaticities\0" + struct.pack("<i", 32) + value
        end = data.index(b"screenWindowWidth")
        offset = data.index(b"\0", end + 18) + 9  # behind the last attribute
        (old,) = struct.unpack_from("<Q", data, offset + 1)
        self.path.write_bytes(data[:offset] + attribute + b"\0" + struct.pack("<Q", old + len(attribute)) + data[old:])
        found = read_exr(self.path)
        np.testing.assert_allclose(found[0, 0], 1, atol=1e-6)
        np.testing.assert_allclose(found[0, 1], (1.6605, -0.1246, -0.0182), atol=1e-4)

    def test_faults_are_one_sentence(self) -> None:
        write_exr(self.path, waves(19, 37))
        good = self.path.read_bytes()
        piz = (FOLDER / "piz_half.exr").read_bytes()
        channel = struct.pack("<iIii", 2, 0, 1, 1)
        flagged = [good[:4] + struct.pack("<I", 2 | flag) + good[8:] for flag in (0x800, 0x1000)]
        for data, part in (
                (b"", "truncated or damaged"),
                (b"x" * 500, "does not begin as one"),
                (good[:300], "truncated or damaged"),
                (good[:-30], "truncated or damaged"),
                (piz[:-100], "truncated or damaged"),
                (flagged[0], "deep images are not read"),
                (flagged[1], "files of several parts are not read"),
                (changed(good, "compression", b"\x08"), "compression DWAA is not read; 'oiiotool"),
                (changed(good, "compression", b"\x63"), "compression 99 is not read"),
                (changed(good, "dataWindow", struct.pack("<4i", 0, 0, 99999, 99999)), "has 100000 x 100000 pixels"),
                (changed(good, "dataWindow", struct.pack("<4i", 0, 0, 30000, 30000)), "it may have"),
                (changed(good, "dataWindow", struct.pack("<4i", 0, 0, -1, 5)), "has 0 x 6 pixels"),
                (good.replace(channel, struct.pack("<iIii", 2, 0, 2, 2)), "fewer samples than pixels"),
                (good.replace(channel, struct.pack("<iIii", 7, 0, 1, 1)), "unknown type 7"),
                (good.replace(b"G\0" + struct.pack("<i", 2), b"R\0" + struct.pack("<i", 2)), "named twice"),
        ):
            with self.subTest(part=part):
                self.assertIn(part, self.refused(data))

    def test_blocks_are_limited(self) -> None:
        """A file of a few bytes could ask for any amount of memory."""
        for module, name, file in ((exr_chunks, "_LARGEST", "zip_tiles"), (huffman, "_MOST_BITS", "piz_half")):
            self.addCleanup(setattr, module, name, getattr(module, name))
            setattr(module, name, 100)
            self.assertIn("a block of", self.refused((FOLDER / f"{file}.exr").read_bytes()))

    def test_damage_anywhere_is_a_problem_or_a_picture(self) -> None:
        rng = np.random.default_rng(2)
        for name in FILES:
            good = (FOLDER / f"{name}.exr").read_bytes()
            for _ in range(60):
                data = bytearray(good)
                for at in rng.integers(0, len(data), 4):
                    data[at] = rng.integers(0, 256)
                self.path.write_bytes(data)
                try:
                    read_exr(self.path)
                except ImportProblem:
                    pass


if __name__ == "__main__":
    unittest.main()
