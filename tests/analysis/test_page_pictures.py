"""The images of the page: what a browser unpacks is what the files hold, and the page stays within its bound."""

import base64
import json
import re
import unittest
import zlib

import numpy as np
from support import FolderTest, write_exr_channels
from page_results import FIREFLY, picture, write_page_results

from analysis.report import pictures
from analysis.report.page import render
from analysis.report.sweep import read_sweep


def unpack(text: str, width: int, height: int) -> np.ndarray:
    """What halves.js does."""
    data = np.cumsum(np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8), dtype=np.uint8)
    low, high = np.split(data.astype(np.uint16), 2)
    return np.moveaxis((low | high << 8).view(np.float16).reshape(3, height, width), 0, -1)


class PackTest(unittest.TestCase):
    def test_round_trip_to_the_bit(self) -> None:
        image = np.random.default_rng(1).exponential(3, (5, 7, 3)).astype(np.float32)
        image[0, 0] = [np.nan, np.inf, -np.inf]
        packed, clipped = pictures.pack(image)
        self.assertEqual(clipped, 0)
        np.testing.assert_array_equal(unpack(packed, 7, 5), image.astype(np.float16))

    def test_values_beyond_a_half_float_are_cut_and_counted(self) -> None:
        packed, clipped = pictures.pack(np.array([[[1e6, 65504, -7e4]]]))
        self.assertEqual(clipped, 2)
        np.testing.assert_array_equal(unpack(packed, 1, 1), [[[65504, 65504, -65504]]])

    def test_reduced_pixels_are_means_of_blocks_also_at_the_edge(self) -> None:
        image = np.arange(15.0).reshape(3, 5)[..., None] * [1, 2, 3]
        reduced = pictures.reduce(image, 2)
        np.testing.assert_allclose(reduced[..., 0], [[3, 5, 6.5], [10.5, 12.5, 14]])
        np.testing.assert_allclose(reduced[..., 2], 3 * reduced[..., 0])

    def test_the_smallest_factor_within_the_bound(self) -> None:
        self.assertEqual(pictures.reduction(4_000_000, 24), 1)   # 24 MB at six bytes each
        self.assertEqual(pictures.reduction(4_000_001, 24), 2)
        self.assertEqual(pictures.reduction(36_000_001, 24), 4)


class GalleryTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        write_page_results(self.results)
        self.sweep = read_sweep(self.results)

    def test_reference_first_then_the_first_seed_of_each_configuration(self) -> None:
        galleries = pictures.galleries(self.sweep)
        self.assertEqual([gallery.name for gallery in galleries], ["simple", "occluded"])
        found = galleries[1]
        self.assertEqual([p.name for p in found.pictures], ["reference", "NEE, two rays", "BSDF", "RL"])
        self.assertEqual(found.pictures[3].source, "scene=occluded,method=rl,seed=1, frame 8, relMSE 0.9")
        data = pictures.gallery_data(found)
        self.assertEqual([p["reference"] for p in data["pictures"]], [None, 0, 0, 0])
        self.assertEqual(data["pictures"][3]["fireflies"], [FIREFLY])
        self.assertEqual(self.sweep.gaps, [])

    def test_the_page_holds_the_pixels_of_the_files(self) -> None:
        text = render(self.sweep)
        packed = re.findall(r'data-picture="0-(\d)">([^<]*)<', text)
        self.assertEqual([index for index, _ in packed], ["0", "1", "2", "3"])
        expected = np.stack([picture(8, 0, 0)[name] for name in "RGB"], axis=-1).astype(np.float32).astype(np.float16)
        np.testing.assert_array_equal(unpack(packed[0][1], 8, 8), expected)
        self.assertIn("Images are shown at their full size. They take 0.00307 MB; at most 24 MB are put into a page.", text)

    def test_a_small_bound_reduces_and_says_so(self) -> None:
        bound = pictures.BOUND_MB
        self.addCleanup(setattr, pictures, "BOUND_MB", bound)
        pictures.BOUND_MB = 0.001
        text = render(self.sweep)
        self.assertIn("each pixel is the mean of 2 × 2", text)
        self.assertIn("at most 0.001 MB", text)

    def test_lost_and_damaged_images_are_gaps(self) -> None:
        (self.folder / "references" / "simple.exr").unlink()
        for seed in (1, 2, 3):
            (self.results / f"scene=simple,method=bsdf,seed={seed}" / "frame_000008.exr").unlink()
        damaged = self.results / "scene=simple,method=rl,seed=1" / "frame_000008.exr"
        damaged.write_bytes(damaged.read_bytes()[:300])
        found = pictures.galleries(self.sweep)[0]
        self.assertEqual([p.name for p in found.pictures], ["NEE, two rays"])
        self.assertIsNone(pictures.gallery_data(found)["pictures"][0]["reference"])
        gaps = "\n".join(self.sweep.gaps)
        for sentence in ("no run of 'simple / BSDF' has an image", "the reference image of 'simple / RL' is not found",
                         "frame_000008.exr: cannot be read as an OpenEXR image"):
            self.assertEqual(gaps.count(sentence), 1)

    def test_an_image_of_another_size_than_its_run_is_a_gap(self) -> None:
        file = self.results / "scene=simple,method=rl,seed=1" / "frame_000008.exr"
        write_exr_channels(file, picture(6, 1, 0), {})
        pictures.galleries(self.sweep)
        self.assertIn("has 6x6 pixels where its run has 8x8", self.sweep.gaps[0])

    def test_runs_of_two_sizes_and_two_references_stand_apart(self) -> None:
        for seed in (1, 2, 3):
            run = self.results / f"scene=simple,method=rl,seed={seed}"
            write_exr_channels(run / "frame_000008.exr", picture(6, seed, 0), {})
            manifest = json.loads((run / "manifest.json").read_text())
            manifest["config"].update(width=6, height=6)
            manifest["reference"]["file"] = "results/references/small.exr"
            (run / "manifest.json").write_text(json.dumps(manifest))
        write_exr_channels(self.folder / "references" / "small.exr", picture(6, 0, 0), {})
        found = pictures.galleries(read_sweep(self.results))
        self.assertEqual([(g.name, [p.name for p in g.pictures]) for g in found[:2]],
                         [("simple, 8×8", ["reference", "NEE, two rays", "BSDF"]), ("simple, 6×6", ["reference", "RL"])])


if __name__ == "__main__":
    unittest.main()
