"""The labelled error map shows what the file holds, on the file's own scale."""

from support import FolderTest, write_exr_channels

import numpy as np

from analysis.exr import read_exr
from analysis.heat_figure import heat_figure, main

SCALE = {"metric": "relmse", "heatBottom": "0.01", "heatTop": "100"}


class HeatFigureTest(FolderTest):
    def write(self, errors: list[list[float]], metadata: dict[str, str]):
        file = self.folder / "heat.exr"
        write_exr_channels(file, {"Y": np.array(errors)}, metadata)
        return file

    def figure(self, errors: list[list[float]], metadata: dict[str, str]):
        file = self.write(errors, metadata)
        return heat_figure(read_exr(file), file)

    def colours(self, figure) -> np.ndarray:
        shown = figure.axes[0].images[0]
        return np.rint(shown.to_rgba(shown.get_array(), norm=True)[..., :3] * 255).astype(int)

    def test_a_logarithmic_scale(self) -> None:
        figure = self.figure([[0.01, 1, 100], [0, 1e4, np.nan]], SCALE)
        colours = self.colours(figure)
        self.assertEqual(colours[0].tolist(), [[0, 0, 4], [0xb7, 0x37, 0x79], [0xfc, 0xfd, 0xbf]])
        self.assertEqual(colours[1].tolist(), [[0, 0, 4], [0xfc, 0xfd, 0xbf], [0, 255, 0]])
        self.assertEqual(figure.axes[1].get_ylabel(), "relmse per pixel")
        self.assertEqual(figure.axes[1].get_yscale(), "log")
        self.assertIn("not finite (green): 1", figure.axes[0].get_title())

    def test_a_linear_scale(self) -> None:
        figure = self.figure([[0, 0.5, 1]], {**SCALE, "metric": "flip", "heatBottom": "0", "heatTop": "1"})
        self.assertEqual(self.colours(figure)[0].tolist(), [[0, 0, 4], [0xb7, 0x37, 0x79], [0xfc, 0xfd, 0xbf]])
        self.assertEqual(figure.axes[1].get_ylim(), (0, 1))
        self.assertEqual(figure.axes[0].get_title(), "mean 0.5")

    def test_the_command(self) -> None:
        file = self.write([[1, 2]], SCALE)
        code, out, err = self.run_script(main, file, self.folder / "heat.png")
        self.assertEqual((code, out, err), (0, f"{self.folder / 'heat.png'}\n", ""))
        self.assertTrue((self.folder / "heat.png").read_bytes().startswith(b"\x89PNG"))
        self.assertIn("is written as .png", self.run_script(main, file, self.folder / "heat.pdf")[2])
        self.assertIn("is no heat map", self.run_script(main, self.write([[1]], {}), self.folder / "b.png")[2])
