"""The metrics of `qtrace compare` against implementations of their own, from the formulas alone."""

import os
import re
import subprocess
import unittest

import matplotlib
import numpy as np

import flip_oracle
from support import ROOT, FolderTest, write_exr_channels

BINARY = os.environ.get("QTRACE_BINARY")  # ctest sets it
CHANNELS = "RGB"


def images(width: int, height: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A smooth reference with a light and a dark edge, and a noisy image of it; exact in 32 bits."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[:height, :width] / max(width, height)
    reference = np.stack([0.05 + x * y, 0.02 + y ** 2, 0.01 + 0.3 * x], axis=-1)
    reference[:2, 2:7] = 400
    reference[:, : width // 3] *= 0.1
    image = reference * random.gamma(4, 0.25, reference.shape)
    image[-1, -1] = -0.01
    return image.astype(np.float32).astype(float), reference.astype(np.float32).astype(float)


def expected(a: np.ndarray, r: np.ndarray) -> dict[str, float]:
    """Of arrays of height x width x 3."""
    square = (a - r) ** 2
    relative = np.sort((square / (r ** 2 + 0.01)).mean(axis=2), axis=None)
    return {"mse": square.mean(),
            "relmse": relative.mean(),
            "relmse_trimmed": relative[:-int(np.ceil(0.001 * relative.size))].mean(),
            "mape": (np.abs(a - r) / (np.abs(r) + 0.01)).mean(),
            "smape": (np.abs(a - r) / (np.abs(a) + np.abs(r) + 0.01)).mean(),
            "psnr_db": 20 * np.log10(r.max()) - 10 * np.log10(square.mean()),
            "flip": flip_oracle.hdr_flip(a, r).mean(),
            "bias": (a - r).mean()}


@unittest.skipUnless(BINARY, "needs QTRACE_BINARY, the program; ctest names it")
class CompareTest(FolderTest):
    def compare(self, *options: str) -> str:
        done = subprocess.run([BINARY, "compare", str(self.folder / "a.exr"), str(self.folder / "r.exr"), *options],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def write(self, image: np.ndarray, reference: np.ndarray) -> None:
        for name, pixels in (("a.exr", image), ("r.exr", reference)):
            write_exr_channels(self.folder / name, {c: pixels[..., i] for i, c in enumerate(CHANNELS)}, {})

    def test_every_metric(self) -> None:
        for width, height, seed in ((23, 17, 1), (5, 31, 2), (3, 1, 3)):
            pair = images(width, height, seed)
            self.write(*pair)
            printed = dict(re.findall(r"^(\w+) +(\S+) ", self.compare(), re.MULTILINE))
            for metric, value in expected(*pair).items():
                with self.subTest(metric, size=(width, height)):
                    self.assertTrue(np.isclose(float(printed[metric]), value, rtol=1e-7, atol=1e-9),
                                    f"{printed[metric]} is not {value}")

    def test_the_map_of_flip_pixel_by_pixel(self) -> None:
        from analysis.exr import read_exr
        pair = images(23, 17, 4)
        self.write(*pair)
        self.compare("--heat", str(self.folder / "heat.exr"), "--heat-metric", "flip")
        np.testing.assert_allclose(read_exr(self.folder / "heat.exr").channels["Y"], flip_oracle.hdr_flip(*pair),
                                   rtol=1e-5)


class OracleTest(unittest.TestCase):
    """What the papers say of FLIP holds for the implementation that the program is compared with."""

    def test_bounds(self) -> None:
        a, r = images(9, 8, 5)
        self.assertEqual(flip_oracle.hdr_flip(r, r).max(), 0)
        self.assertLessEqual(flip_oracle.hdr_flip(a, r).max(), 1)
        green, blue = np.zeros((2, 1, 1, 3))
        green[..., 1], blue[..., 2] = 1, 1
        self.assertAlmostEqual(float(flip_oracle.ldr_flip(green, blue)[0, 0]), 1)


class ColourMapTest(unittest.TestCase):
    def test_magma_is_matplotlibs(self) -> None:
        table = (ROOT / "experiments" / "images" / "magma.h").read_text(encoding="utf-8")
        entries = [int(entry, 16) for entry in re.findall(r"0x[0-9a-f]{6}", table)]
        colours = np.rint(np.array(matplotlib.colormaps["magma"].colors) * 255).astype(int)
        self.assertEqual(entries, [int(r << 16 | g << 8 | b) for r, g, b in colours.tolist()])
