"""A page about 500 runs: built in under a minute, opened in under three seconds, within its bound."""

import time
import unittest
from pathlib import Path

import browser  # first: it puts the others on the path
import support
from page_results import fail_run, write_page_results

from analysis import report_page
from analysis.report import pictures

METHODS, SEEDS, SIDE = 50, 5, 192
BUILD_S, OPEN_S = 60, 3


def write_sweep(folder: Path) -> Path:
    """2 scenes, 50 methods, 5 seeds at 192 x 192; one run failed. 102 noisy images of 0.22 MB each almost fill the bound."""
    for i in range(METHODS):
        support.METHODS[f"method {i}"] = 1 + i / 5
        support.SECONDS[f"method {i}"] = 0.5 + i / 20
    methods = tuple(f"method {i}" for i in range(METHODS))
    write_page_results(folder, side=SIDE, methods=methods, seeds=tuple(range(1, SEEDS + 1)))
    fail_run(folder, "scene=occluded,method=method-7,seed=3", "failed", "the device was lost", 2)
    return folder


class LargePageTest(browser.BrowserTest):
    @classmethod
    def make_page(cls) -> Path:
        results = write_sweep(cls.folder / "study")
        page = cls.folder / "report.html"
        begin = time.monotonic()
        report_page.main([str(results), "--out", str(page)])
        cls.build_s = time.monotonic() - begin
        return page

    def test_time_and_size(self) -> None:
        self.open()
        # Until the first image can be seen, which is later than the load event.
        self.until("return document.querySelector('.pane.second')?.dataset.painted")
        open_s = self.run_js("return performance.now()") / 1000
        megabytes = self.page.stat().st_size / 1e6
        print(f"500 runs: built in {self.build_s:.1f} s, {megabytes:.1f} MB, opened in {open_s:.2f} s")
        self.assertLess(self.build_s, BUILD_S)
        self.assertLess(open_s, OPEN_S)
        # Base64 takes 4 bytes for 3; 4 MB are room for all that is not images.
        self.assertLess(megabytes, pictures.BOUND_MB * 4 / 3 + 4)
        self.assertEqual(self.complaints(), [])
        self.assertEqual(len(self.find_all("#configurations-table tbody tr")), 2 * METHODS)
        self.assertEqual(len(self.find_all("#runs-table tbody tr")), 2 * METHODS * SEEDS)
        self.assertIn("full size. They take 22.6 MB", self.find(".readout").text)
        self.assertIn("1 of 500 runs failed", self.find(".findings li").text)


if __name__ == "__main__":
    unittest.main()
