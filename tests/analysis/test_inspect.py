"""The figure of `qtrace inspect` shows what its files hold: cells, visits, hemispheres, the pixel, one scale."""

from support import FolderTest, write_exr_channels

import numpy as np
from matplotlib.text import Text

from analysis.figures import main
from analysis.kinds.inspect import hemisphere_panels, inspection_figure, radiance_scale, read_inspection, table_note

SIDE = 6
PIXEL = (3, 1)  # x, y
FACTS = {"pixel": "3,1", "cell": "7", "frame": "64", "samples": "16"}


def cell_channels() -> dict[str, np.ndarray]:
    cells = np.repeat([[7.0, 9.0, -1.0, 4.0]], 4, axis=0)
    visits = np.repeat([[1000.0, 10.0, 0.0, 0.0]], 4, axis=0)
    return {"cell": cells, "visits": visits, **{name: cells / 10 + 0.1 for name in "RGB"}}


def hemisphere_channels() -> dict[str, np.ndarray]:
    """Two bins: the upper half and the lower one; corners outside the disk."""
    bins = np.where(np.arange(SIDE)[:, None] < SIDE // 2, 0.0, 1.0) * np.ones((SIDE, SIDE))
    bins[0, 0] = bins[-1, -1] = -1
    true = np.where(bins == 0, 6.0, 0.3)
    true[1, 1] = 90
    return {"bin": bins, "learned": np.where(bins == 0, 4.0, 0.5), "true.R": true * 2, "true.G": true,
            "true.B": true * 0, "true_bin": np.where(bins == 0, 8.0, 0.3)}


def texts(figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(Text) if text.get_visible())


class InspectTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        self.run_folder = self.folder / "study" / "seed=1"
        write_exr_channels(self.run_folder / "inspect" / "cells.exr", cell_channels(), FACTS)
        write_exr_channels(self.run_folder / "inspect" / "hemisphere_3_1.exr", hemisphere_channels(), FACTS)

    def figure(self):
        return inspection_figure(*read_inspection(self.run_folder), "study/seed=1")

    def test_five_panels_and_what_they_hold(self) -> None:
        images = {axes.get_title(): axes.images[0].get_array() for axes in self.figure().axes if axes.images}
        self.assertEqual(list(images), ["cells in false colour: 3 in view", "visits per cell (grey: none)", "learned",
                                        "true, averaged over bins", "true"])
        channels = hemisphere_channels()
        inside = channels["bin"] >= 0
        np.testing.assert_array_equal(images["learned"].mask, ~inside)
        np.testing.assert_allclose(images["learned"].data[inside], channels["learned"][inside])
        np.testing.assert_allclose(images["true, averaged over bins"].data[inside], channels["true_bin"][inside])
        mean = channels["true.G"]  # of 2, 1 and 0 times it
        np.testing.assert_allclose(images["true"].data[inside], mean[inside], rtol=1e-6)
        visits = images["visits per cell (grey: none)"]
        np.testing.assert_array_equal(visits.mask, cell_channels()["visits"] == 0)

    def test_says_where_a_table_holds_less_than_all_light(self) -> None:
        rest = {"nee": "one_ray", "rl": {"learns": "beyond_nee"}}
        figure = inspection_figure(*read_inspection(self.run_folder), "study/seed=1", table_note(rest))
        self.assertIn("what next event estimation leaves", texts(figure))
        for whole in ({"nee": "none", "rl": {"learns": "beyond_nee"}}, {"nee": "one_ray", "rl": {"learns": "all"}}, {}):
            self.assertEqual(table_note(whole), "")

    def test_hemispheres_share_a_scale_up_to_the_brightest_bin(self) -> None:
        figure = self.figure()
        norms = {id(axes.images[0].norm) for axes in figure.axes if axes.get_title() in ("learned", "true")}
        self.assertEqual(len(norms), 1)
        scale = radiance_scale(hemisphere_panels(read_inspection(self.run_folder)[1]))
        self.assertEqual((scale.vmin, scale.vmax), (0, 8))

    def test_the_pixel_is_marked_on_both_pictures(self) -> None:
        for axes in self.figure().axes[:2]:
            marks = {(line.get_xdata()[0], line.get_ydata()[0]) for line in axes.lines}
            self.assertEqual(marks, {PIXEL})

    def test_words(self) -> None:
        words = texts(self.figure())
        for part in ("study/seed=1", "after frame 64", "pixel 3, 1", "cell 7", "16 paths per pixel", "targets so far"):
            self.assertIn(part, words)

    def test_an_empty_table_and_darkness_are_drawn_too(self) -> None:
        dark = {name: plane * (name in ("cell", "bin")) for name, plane in
                {**cell_channels(), **hemisphere_channels()}.items()}
        write_exr_channels(self.run_folder / "inspect" / "cells.exr", {k: dark[k] for k in cell_channels()}, FACTS)
        write_exr_channels(self.run_folder / "inspect" / "hemisphere_3_1.exr",
                           {k: dark[k] for k in hemisphere_channels()}, FACTS)
        code, _, err = self.run_script(main, self.run_folder, "--only", "inspect")
        self.assertEqual((code, err), (0, ""))

    def test_writes_beside_its_files(self) -> None:
        code, out, err = self.run_script(main, self.run_folder, "--only", "inspect")
        file = self.run_folder / "inspect" / "inspect.png"
        self.assertEqual((code, out, err), (0, f"inspect: {file}\n", ""))
        self.assertTrue(file.read_bytes().startswith(b"\x89PNG"))

    def test_all_runs_of_an_experiment(self) -> None:
        other = self.folder / "study" / "seed=2" / "inspect"
        for name, channels in (("cells", cell_channels()), ("hemisphere_3_1", hemisphere_channels())):
            write_exr_channels(other / f"{name}.exr", channels, FACTS)
        code, out, _ = self.run_script(main, self.folder / "study", "--only", "inspect")
        files = [self.folder / "study" / f"seed={seed}" / "inspect" / "inspect.png" for seed in (1, 2)]
        self.assertEqual((code, out), (0, "".join(f"inspect: {file}\n" for file in files)))
        _, out, _ = self.run_script(main, self.folder / "study", "--only", "inspect", "--out", self.folder)
        self.assertEqual([line.rpartition("/")[2] for line in out.splitlines()], ["inspect_seed=1.png", "inspect_seed=2.png"])

    def check_fails(self, words: str) -> None:
        code, out, err = self.run_script(main, self.run_folder, "--only", "inspect")
        self.assertEqual((code, out), (1, ""))
        self.assertRegex(err, f"^error: inspect: .*{words}.*\n$")

    def test_failures(self) -> None:
        (self.run_folder / "inspect" / "hemisphere_3_1.exr").unlink()
        self.check_fails("hemisphere_3_1.exr: no such file; `qtrace inspect` writes it")
        channels = cell_channels()
        write_exr_channels(self.run_folder / "inspect" / "cells.exr", channels, {})
        self.check_fails("cells.exr: does not say which pixel")
        del channels["visits"]
        write_exr_channels(self.run_folder / "inspect" / "cells.exr", channels, FACTS)
        self.check_fails("cells.exr: has no channel 'visits'")
