"""Sheets of pictures: which image stands where, under which words, and what happens where one is missing."""

import json

from support import FolderTest, METHODS, SNAPSHOTS, relmse, write_exr, write_results

import matplotlib.image
import numpy as np
from matplotlib.figure import Figure

from analysis.command import AnalysisError
from analysis.figures import main
from analysis.kinds.sheets import equal_time_sheet, scene_sheet
from analysis.load import load
from analysis.tonemap import tonemap

SCENES = ("simple", "occluded")
SIDE = 240  # pixels of a panel, as written
REFERENCE = {"simple": 0.9, "occluded": 0.8}  # radiance


def radiance(method: str, frame: int, seed: int) -> float:
    """Tells every image from every other."""
    return 0.02 * frame + 0.2 * list(METHODS).index(method) + 0.005 * seed


def grey(value: float, exposure: float = 0) -> int:
    return int(tonemap(np.full((1, 1, 3), value, np.float32), exposure)[0, 0, 0])


class PicturesTest(FolderTest):
    """An experiment with its images and references."""

    def setUp(self) -> None:
        super().setUp()
        write_results(self.results, seeds=(2, 1))
        self.references = self.folder / "references"
        for _, run in load(self.results).summary.iterrows():
            folder = self.results / run.run
            for frame in SNAPSHOTS:
                write_exr(folder / f"frame_{frame:06d}.exr", radiance(run.label, frame, run.seed), frame)
            file = self.references / f"{run.scene}.exr"
            write_exr(file, REFERENCE[run.scene], 512)
            (folder / "manifest.json").write_text(json.dumps({"reference": {"file": str(file)}}))

    def run_of(self, scene: str, method: str, seed: int) -> str:
        runs = load(self.results).summary
        return runs[(runs.scene == scene) & (runs.label == method) & (runs.seed == seed)].run.iloc[0]


class SheetTest(PicturesTest):
    def panels(self, scene: str = "simple", frames: list[int] | None = None, exposure: float = 0) -> list:
        """(words, grey level) of every panel, row by row."""
        figure: Figure = scene_sheet(load(self.results), scene, frames, exposure)
        return [(axes.get_title(), int(axes.images[0].get_array()[0, 0, 0])) for axes in figure.axes]

    def expected(self, scene: str, frames: list[int], exposure: float = 0) -> list:
        rows = []
        for i, method in enumerate(METHODS):
            rows += [(f"{method}\n{frame} spp, relMSE {relmse(method, 2, frame, scene):.3g}",
                      grey(radiance(method, frame, 2), exposure)) for frame in frames]
            rows.append(("reference\n512 spp", grey(REFERENCE[scene], exposure)) if i == 0 else ("", 255))
        return rows

    def test_a_row_per_method_of_the_first_seed_a_column_per_snapshot_and_the_reference(self) -> None:
        for scene in SCENES:
            self.assertEqual(self.panels(scene), self.expected(scene, SNAPSHOTS))

    def test_rows_and_columns_stand_where_they_should(self) -> None:
        axes = scene_sheet(load(self.results), "simple", [1, 8], 0).axes
        left = [round(a.get_position().x0, 6) for a in axes]
        top = [round(a.get_position().y1, 6) for a in axes]
        self.assertEqual((left[:3], left[3:6]), (sorted(set(left)), left[:3]))
        self.assertEqual([top[0], top[3], top[6]], sorted(set(top), reverse=True))

    def test_chosen_frames_and_one_exposure_for_all(self) -> None:
        self.assertEqual(self.panels("simple", [8, 2], -1.5), self.expected("simple", [8, 2], -1.5))

    def test_at_equal_seconds_methods_stand_side_by_side_with_what_they_have_by_then(self) -> None:
        figure = equal_time_sheet(load(self.results), "simple", 4.5, 0)
        words = [axes.get_title() for axes in figure.axes]
        self.assertEqual([title.split(" spp")[0] for title in words[:3]], ["NEE, two rays\n8", "BSDF\n8", "RL\n4"])
        self.assertTrue(words[2].endswith(", 4.02 s"), words[2])
        self.assertEqual(len(words), 4)
        self.assertEqual(int(figure.axes[2].images[0].get_array()[0, 0, 0]), grey(radiance("RL", 4, 2)))
        with self.assertRaisesRegex(AnalysisError, "its first snapshot is at"):
            equal_time_sheet(load(self.results), "simple", 0.9, 0)

    def test_default_columns_are_the_snapshots_that_all_methods_have(self) -> None:
        run = self.run_of("simple", "RL", 2)
        self.edit(f"{run}/convergence.csv", lambda text: "".join(
            line for line in text.splitlines(keepends=True) if not line.startswith("2,")))
        self.assertEqual(self.panels(), self.expected("simple", [1, 4, 8]))
        self.assertEqual(self.panels("occluded"), self.expected("occluded", SNAPSHOTS))

    def test_a_run_that_failed_is_replaced_by_the_next_seed(self) -> None:
        self.edit("summary.csv", lambda text: text.replace("simple,2,finished", "simple,2,failed"))
        self.assertEqual(self.panels(frames=[4])[0],
                         (f"NEE, two rays\n4 spp, relMSE {relmse('NEE, two rays', 1, 4):.3g}",
                          grey(radiance("NEE, two rays", 4, 1))))

    def test_methods_with_references_of_their_own_show_them(self) -> None:
        other = self.folder / "references" / "other.exr"
        write_exr(other, 0.3, 64)
        run = self.run_of("simple", "BSDF", 2)
        (self.results / run / "manifest.json").write_text(json.dumps({"reference": {"file": str(other)}}))
        last = self.panels(frames=[1])[1::2]
        self.assertEqual(last, [("reference\n512 spp", grey(0.9)), ("reference\n64 spp", grey(0.3)),
                                ("reference\n512 spp", grey(0.9))])

    def test_results_that_were_moved_find_their_references(self) -> None:
        moved = self.folder / "elsewhere"
        moved.mkdir()
        self.results = self.results.rename(moved / "study")
        self.references.rename(moved / "references")
        self.assertEqual(self.panels(), self.expected("simple", SNAPSHOTS))


class CommandTest(PicturesTest):
    def test_writes_a_sheet_per_scene_and_says_which(self) -> None:
        out = self.folder / "figures"
        code, printed, err = self.run_script(main, self.results, "--only", "sheets", "--frames", "1,8", "--exposure", 1, "--out", out)
        files = [out / f"sheet_{scene}.png" for scene in SCENES]
        self.assertEqual((code, printed, err), (0, "".join(f"sheets: {file}\n" for file in files), ""))
        height, width, _ = matplotlib.image.imread(files[0]).shape
        self.assertTrue(3 * SIDE < width < 3 * SIDE + 60, width)
        self.assertTrue(3 * SIDE < height < 3 * SIDE + 240, height)

    def test_without_its_reference_a_sheet_has_one_column_less_and_a_warning(self) -> None:
        (self.references / "simple.exr").unlink()
        code, printed, err = self.run_script(main, self.results, "--only", "sheets", "--frames", "1,8")
        self.assertEqual((code, len(printed.splitlines())), (0, 2))
        self.assertRegex(err, "^warning: .*scene=simple.*: its reference image is not found, .*\n$")
        widths = [matplotlib.image.imread(self.results / "figures" / f"sheet_{scene}.png").shape[1] for scene in SCENES]
        self.assertTrue(widths[0] < 2 * SIDE + 60 < widths[1], widths)

    def check_fails(self, words: str, *arguments: object) -> None:
        code, out, err = self.run_script(main, *arguments, "--only", "sheets")
        self.assertEqual((code, out), (1, ""))
        self.assertRegex(err, f"^error: .*{words}.*\n$")

    def test_failures(self) -> None:
        self.check_fails("no such folder", self.folder / "nowhere")
        for frames in ("", "0", "1,x", "-4"):
            self.check_fails("--frames must be whole numbers from 1 on", self.results, f"--frames={frames}")
        self.check_fails("between -100 and 100 stops", self.results, "--exposure", "inf")
        self.check_fails("scene=simple,method=nee-two-rays,seed=2: has no snapshot of frame 3, only of 1, 2, 4, 8",
                         self.results, "--frames", "1,3")
        (self.results / self.run_of("simple", "RL", 2) / "frame_000004.exr").unlink()
        self.check_fails("frame_000004.exr: cannot be read: No such file", self.results)
        self.assertFalse((self.results / "figures").exists())

    def test_without_any_image(self) -> None:
        for file in self.results.glob("*/frame_*.exr"):
            file.unlink()
        self.check_fails(r"sheets: .*no run of simple has images \(frame_NNNNNN.exr\)", self.results)

    def test_a_seed_without_images_is_replaced_by_the_next(self) -> None:
        for file in (self.results / self.run_of("simple", "RL", 2)).glob("frame_*.exr"):
            file.unlink()
        figure = scene_sheet(load(self.results), "simple", [4], 0)
        self.assertEqual(figure.axes[-2].get_title(), f"RL\n4 spp, relMSE {relmse('RL', 1, 4):.3g}")

    def test_runs_without_a_common_snapshot(self) -> None:
        run = self.run_of("simple", "RL", 2)
        self.edit(f"{run}/convergence.csv", lambda text: text.splitlines()[0] + "\n")
        self.check_fails("the runs of simple share no snapshot", self.results)

    def test_manifest_without_a_reference(self) -> None:
        run = self.run_of("simple", "RL", 2)
        for text in ("{}", '{"reference": "x"}', '{"reference": {"hash": "abc"}}'):
            (self.results / run / "manifest.json").write_text(text)
            code, _, err = self.run_script(main, self.results, "--only", "sheets", "--frames", "1")
            self.assertEqual(code, 0)
            self.assertIn("its reference image is not found", err)
        (self.results / run / "manifest.json").write_text("no JSON")
        self.check_fails("manifest.json: cannot be read as JSON", self.results)
