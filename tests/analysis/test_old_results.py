"""Results that an early version of the program wrote, before manifests had a schema: they keep loading, and everything
that reads results takes them. results_of_schema_0 is what it left of four runs of 8 x 8 pixels, but for the images."""

import json
import shutil
import unittest
from pathlib import Path

from support import FolderTest

from analysis import figures, report_page
from analysis.comparison import compare
from analysis.load import SCHEMA, LoadError, load
from analysis.statistics import estimate

OLD = Path(__file__).with_name("results_of_schema_0")


class OldResultsTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        shutil.copytree(OLD, self.results)

    def test_frames_of_data(self) -> None:
        results = load(self.results)
        self.assertEqual((results.schema, results.name, len(results.summary)), (0, "schema_0", 4))
        self.assertEqual((len(results.convergence), len(results.frames)), (4 * 3, 4 * 4))
        self.assertEqual(list(results.convergence.label.unique()), ["bsdf", "rl"])
        # Not written then: computed from the summary.
        cells = results.cells.set_index("cell")
        expected = estimate(results.summary[results.summary.cell == "rl"].relmse)
        self.assertEqual((cells.relmse["rl"], cells.relmse_high["rl"], cells.seeds["rl"]),
                         (expected.mean, expected.high, 2))
        self.assertEqual(list(cells.label), ["bsdf", "rl"])

    def test_what_reads_results_takes_them(self) -> None:
        code, _, err = self.run_script(figures.main, self.results, "--format", "svg")
        self.assertEqual((code, err), (0, ""))
        self.assertIn("rl", (self.results / "figures" / "table.md").read_text())
        result = compare(load(self.results), load(OLD))
        self.assertEqual({row.verdict for row in result.rows}, {"same"})

    def test_the_page_has_their_cells(self) -> None:
        code, out, err = self.run_script(report_page.main, self.results)
        self.assertEqual((code, err), (0, ""))
        page = Path(out.strip()).read_text(encoding="utf-8")
        self.assertIn("means over seeds come from summary.csv", page)
        for relmse in load(self.results).cells.relmse:
            self.assertIn(f'data-value="{relmse}"', page)
        self.set_schema(SCHEMA + 1)
        code, _, err = self.run_script(report_page.main, self.results)
        self.assertEqual(code, 1)
        self.assertIn(f"but this analysis reads {SCHEMA}", err)

    def set_schema(self, schema: object) -> None:
        file = self.results / "manifest.json"
        file.write_text(json.dumps({**json.loads(file.read_text()), "schema": schema}))

    def test_cells_may_not_be_missing_later(self) -> None:
        self.set_schema(1)
        with self.assertRaisesRegex(LoadError, "cells.csv: no such file"):
            load(self.results).cells

    def test_newer_results_are_refused_by_name(self) -> None:
        self.set_schema(SCHEMA + 1)
        with self.assertRaisesRegex(LoadError, f"has schema {SCHEMA + 1}, but this analysis reads {SCHEMA} and older"):
            load(self.results)
        self.set_schema("new")
        with self.assertRaisesRegex(LoadError, "schema is 'new' but must be a whole number"):
            load(self.results)


if __name__ == "__main__":
    unittest.main()
