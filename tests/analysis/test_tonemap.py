"""Reading OpenEXR, tone mapping against hand values, and what the script writes."""

import base64
import unittest
from pathlib import Path

from support import FolderTest

import matplotlib.image
import numpy as np

from analysis.exr import ExrError, read_exr
from analysis.tonemap import main, tonemap

# Written by OpenEXR 3.1.5: 3 x 20 pixels, ZIP in two chunks; floats R = x + 100 y, G = x / 2, B = -y and a
# half channel "a.half" of 0.5 and 1 in turns; text attribute spp = 64.
EXR = base64.b64decode("""
di8xAQIAAABjaGFubmVscwBjaGxpc3QATgAAAEIAAgAAAAAAAAABAAAAAQAAAEcAAgAAAAAAAAABAAAAAQAAAFIAAgAAAAAAAAABAAAAAQAAAG
EuaGFsZgABAAAAAAAAAAEAAAABAAAAAGNvbXByZXNzaW9uAGNvbXByZXNzaW9uAAEAAAADZGF0YVdpbmRvdwBib3gyaQAQAAAAAAAAAAAAAAAC
AAAAEwAAAGRpc3BsYXlXaW5kb3cAYm94MmkAEAAAAAAAAAAAAAAAAgAAABMAAABsaW5lT3JkZXIAbGluZU9yZGVyAAEAAAAAcGl4ZWxBc3BlY3
RSYXRpbwBmbG9hdAAEAAAAAACAP3NjcmVlbldpbmRvd0NlbnRlcgB2MmYACAAAAAAAAAAAAAAAc2NyZWVuV2luZG93V2lkdGgAZmxvYXQABAAA
AAAAgD9zcHAAc3RyaW5nAAIAAAA2NABxAQAAAAAAAGsCAAAAAAAAAAAAAPIAAAB4XmNogAMGBggGM0EAwvLY4bXNZwtCGVjwhMVJ81NmQOYBBx
CECIq9Ensl/hLMRNbuscNzO5Cp8AAEIYJVbVVt1a1AJlj3AYjgtCwQBDITFoAgRHB9IAiC2HAAsh0EgcwJBSAIEXwoD4JAJlh3AkTwFxsIApkb
AkAQIsj5HQQbMB0v9grIvGAAghBBpXsgCGSC3a4AEdS/CIJA5gcBEIQIWh8FQTATBBoa9jvudwSRBypaajzsD4IgRPCQHRCWAQVhfgcJHrYFwl
J0wb3OlAgeqWnZ41KCS9ARxNtPDcGDLndU/rBgqIxZUtNCuUoAO481yBAAAABTAAAAeF5jYACDBiBgYPDYAYJAJscPEIQIhqwBQSBT4AMIQgQT
54MgkCnxAgQhgrmTQRDIdNwPgg0NIOpIzJKalpKWGg8kwYMud1T+sKAJ4lcJAIozTLk=
""")


class ExrTest(FolderTest):
    def write(self, data: bytes) -> Path:
        file = self.folder / "image.exr"
        file.write_bytes(data)
        return file

    def test_values_of_a_file_by_the_library(self) -> None:
        image = read_exr(self.write(EXR))
        y, x = np.mgrid[0:20, 0:3]
        for name, values in {"R": x + 100 * y, "G": x / 2, "B": -y, "a.half": np.where(x % 2, 1, 0.5)}.items():
            np.testing.assert_array_equal(image.channels[name], values)
        self.assertEqual(image.metadata, {"spp": "64"})

    def test_damage_is_an_error_and_nothing_else(self) -> None:
        for size in range(len(EXR)):
            with self.assertRaises(ExrError):
                read_exr(self.write(EXR[:size]))
        for place in range(len(EXR)):
            try:
                read_exr(self.write(EXR[:place] + bytes([EXR[place] ^ 0x81]) + EXR[place + 1:]))
            except ExrError:
                pass

    def test_refusals_by_name(self) -> None:
        for words, data in {"no such file": None, "does not begin as one": b"RIFFxxxxWEBP",
                            "tiled": EXR[:5] + b"\x02" + EXR[6:],
                            "compression PIZ": EXR.replace(b"compression\0compression\0\x01\0\0\0\x03",
                                                           b"compression\0compression\0\x01\0\0\0\x04"),
                            "channels R, G, B; it has B, G, Q, a.half": EXR.replace(b"R\0\x02", b"Q\0\x02")}.items():
            file = self.folder / "none.exr" if data is None else self.write(data)
            with self.assertRaisesRegex(ExrError, f"(?i){file}: .*{words}"):
                read_exr(file).rgb(file)


class TonemapTest(unittest.TestCase):
    def test_hand_values(self) -> None:
        """The linear part, its end, middle grey (18 % is 118 of 255), white and beyond."""
        linear = np.array([[[0.0, 0.001, 0.0031308], [0.18, 1.0, 50.0], [-1.0, 0.5, 0.25]]])
        np.testing.assert_array_equal(tonemap(linear), [[[0, 3, 10], [118, 255, 255], [0, 188, 137]]])

    def test_exposure_is_in_stops(self) -> None:
        grey = np.full((1, 1, 3), 0.045)
        np.testing.assert_array_equal(tonemap(grey, 2), [[[118] * 3]])
        np.testing.assert_array_equal(tonemap(grey * 16, -2), [[[118] * 3]])

    def test_pixels_that_are_not_finite_are_magenta(self) -> None:
        pixels = tonemap(np.array([[[np.nan, 0, 0], [0, np.inf, 0], [0.18, 0.18, 0.18]]]))
        np.testing.assert_array_equal(pixels, [[[255, 0, 255], [255, 0, 255], [118, 118, 118]]])


class CommandTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        self.image = self.folder / "frame_000064.exr"
        self.image.write_bytes(EXR)
        self.out = self.folder / "out.png"

    def test_one_image_pixel_for_pixel(self) -> None:
        code, out, _ = self.run_script(main, self.image, self.out, "--exposure", -7)
        self.assertEqual((code, out), (0, f"{self.out}\n"))
        pixels = np.rint(matplotlib.image.imread(self.out)[..., :3] * 255)
        np.testing.assert_array_equal(pixels, tonemap(read_exr(self.image).rgb(self.image), -7))

    def test_sheet(self) -> None:
        code, _, _ = self.run_script(main, self.image, self.image, self.image, self.out, "--columns", 2,
                                     "--label", "a", "--label", "b", "--label", "c")
        height, width, _ = matplotlib.image.imread(self.out).shape
        self.assertEqual(code, 0)
        self.assertTrue(2 * 240 < width < 2 * 240 + 60, width)          # two columns of 3 pixels times 80
        self.assertTrue(2 * 1600 < height < 2 * 1600 + 150, height)     # two rows of 20 times 80

    def test_failures(self) -> None:
        for words, arguments in {
            "must end in .png": (self.image, self.image),
            "3 images need as many labels, not 1": (*[self.image] * 3, self.out, "--label", "a"),
            "between -100 and 100 stops": (self.image, self.out, "--exposure", "nan"),
            "one column at least": (self.image, self.out, "--columns", 0),
            "no such file": (self.folder / "none.exr", self.out),
        }.items():
            code, out, err = self.run_script(main, *arguments)
            self.assertEqual((code, out), (1, ""))
            self.assertRegex(err, f"(?i)^error: .*{words}.*\n$")
        self.assertFalse(self.out.exists())
