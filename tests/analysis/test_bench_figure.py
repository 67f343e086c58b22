"""The benchmark's page holds what its files say."""

from support import FolderTest, write_csv

import json

from matplotlib.text import Text

from analysis.bench_figure import bench_figure, load_parts, main


def spread(name: str, value: float) -> dict[str, float]:
    return {name: value, f"{name}_low": 0.9 * value, f"{name}_high": 1.2 * value}


class BenchFigureTest(FolderTest):
    def write(self, software: bool = True) -> None:
        (self.folder / "manifest.json").write_text(json.dumps({"device": {"software": software}}))
        write_csv(self.folder / "rays.csv", [
            {"scene": "simple", "kind": kind, "tracer": tracer, **spread("mrays_per_s", speed),
             "speed_over_embree": speed / 10, "cpu_speed_over_embree": speed / 20}
            for kind in ("primary", "shadow") for tracer, speed in (("Embree", 10), ("qtrace", 6))])
        write_csv(self.folder / "frames.csv", [
            {"scene": scene, "method": method, "size": 64, **spread("wall_ms", ms), "over_plain": ms / 10,
             "cpu_over_plain": ms / 8}
            for scene in ("simple", "occluded") for method, ms in (("BSDF", 10), ("RL", 17))])
        write_csv(self.folder / "steps.csv", [
            {"scene": "simple", "method": "RL", "step": step, "share": share, "cpu_share": share / 2}
            for step, share in (("learning", 0.4), ("cell look-up", -0.1), ("rest", 0.7), ("whole frame", 1))])
        write_csv(self.folder / "growth.csv", [
            {"axis": "bins", "method": "RL", "value": value, **spread("wall_ms", 2 * value), "over_first": value / 4,
             "cpu_over_first": value / 4} for value in (4, 64, 1024, 1_002_510)])

    def axes(self, title: str = "", label: str = ""):
        figure = bench_figure(load_parts(self.folder))
        return next(axes for axes in figure.axes
                    if axes.get_title(loc="left").startswith(title) and axes.get_xlabel() == label)

    def texts(self, axes) -> list[str]:
        return [text.get_text() for text in axes.findobj(Text) if text.get_visible()]

    def test_bars_of_rays_with_their_ratio_to_embree(self) -> None:
        self.write()
        axes = self.axes("simple")
        heights = [bar.get_height() for bars in axes.containers if hasattr(bars, "patches") for bar in bars.patches]
        self.assertEqual(heights, [10, 10, 6, 6])
        self.assertEqual(self.texts(axes).count("0.30"), 2)  # by processor time

    def test_on_hardware_ratios_are_those_of_the_clock(self) -> None:
        self.write(software=False)
        self.assertEqual(self.texts(self.axes("simple")).count("0.60"), 2)
        self.assertIn("1.70", self.texts(self.axes("The table of Goswami 2020, 64²")))

    def test_steps_stand_one_after_another_without_the_whole(self) -> None:
        self.write(software=False)
        axes = self.axes(label="% of the frame")
        bars = [(round(bar.get_x()), round(bar.get_width())) for bar in axes.patches]
        self.assertEqual(bars, [(0, 40), (40, 0), (40, 70)])

    def test_growth_has_its_points_as_ticks(self) -> None:
        self.write()
        axes = self.axes(label="bins")
        self.assertEqual(axes.lines[0].get_ydata().tolist(), [8, 128, 2048, 2_005_020])
        self.assertEqual([tick.get_text() for tick in axes.get_xticklabels()], ["4", "64", "1024", "1M"])

    def test_the_command(self) -> None:
        self.write()
        code, out, err = self.run_script(main, self.folder)
        self.assertEqual((code, out, err), (0, f"{self.folder / 'bench.png'}\n", ""))
        (self.folder / "rays.csv").write_text("scene\r\nsimple\r\n")
        self.assertIn("rays.csv: has no column 'kind'", self.run_script(main, self.folder)[2])
        self.assertIn("holds none of rays.csv", self.run_script(main, self.folder / "absent")[2])
