"""Results of schema 1, in which a configuration was called a cell: they keep loading through one map of names, and
everything that reads results takes them. results_of_schema_1 is what the program left of six runs of 8 x 8 pixels, but for
the images."""

import json
import shutil
import unittest
from pathlib import Path

from support import FolderTest

from analysis import figures, report_page
from analysis.comparison import compare
from analysis.csv_file import read_csv
from analysis.load import LoadError, load, read_manifest
from analysis.schema import SCHEMA

OLD = Path(__file__).with_name("results_of_schema_1")


class OldResultsTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        shutil.copytree(OLD, self.results)

    def set_schema(self, schema: object) -> None:
        file = self.results / "manifest.json"
        manifest = {**json.loads(file.read_text()), "schema": schema}
        file.write_text(json.dumps({key: value for key, value in manifest.items() if value is not None}))

    def test_frames_of_data(self) -> None:
        results = load(self.results)
        self.assertEqual((results.schema, results.name, len(results.summary)), (1, "schema_1", 6))
        self.assertEqual((len(results.convergence), len(results.frames)), (6 * 5, 6 * 16))
        for frame in (results.summary, results.convergence, results.frames, results.configurations, results.ratios):
            self.assertIn("configuration", frame)
            self.assertNotIn("cell", frame)
        self.assertEqual(list(results.configurations.configuration), ["bsdf", "rl"])
        self.assertEqual((list(results.ratios.label), list(results.ratios.baseline)), (["rl"], ["bsdf"]))
        written = read_csv(OLD / "cells.csv", ["cell"], labels=["cell"])
        self.assertEqual(list(results.configurations.relmse_high), list(written.relmse_high))

    def test_metrics_have_the_labels_that_their_manifests_lack(self) -> None:
        metrics = load(self.results).metrics
        self.assertEqual([metrics[name].axis for name in ("mse", "flip", "psnr_db")],
                         ["MSE (squared radiance)", "FLIP", "PSNR (dB)"])
        self.assertTrue(metrics["bias"].is_signed and not metrics["relmse"].is_signed and metrics["mape"].per_configuration)
        self.assertIn("(a - r)^2", metrics["mse"].formula)

    def test_manifests_of_runs(self) -> None:
        manifest = read_manifest(self.results / "sampler=rl,seed=1" / "manifest.json")
        self.assertEqual(manifest["configuration"], "rl")
        self.assertEqual(manifest["cells"], 2000)  # of the Voronoi kind, which keep their name

    def test_what_reads_results_takes_them(self) -> None:
        code, out, err = self.run_script(figures.main, self.results, "--format", "svg")
        self.assertEqual((code, err), (0, ""))
        for name in ("curves_relmse.svg", "cost_relmse_simple.svg", "ablation_simple.svg", "gains.svg", "ratios.tex"):
            self.assertIn(f"figures/{name}\n", out)
        self.assertIn("rl", (self.results / "figures" / "table.md").read_text())
        result = compare(load(self.results), load(OLD))
        self.assertEqual({row.verdict for row in result.rows}, {"same"})
        self.assertEqual({row.configuration for row in result.rows}, {"bsdf", "rl"})

    def test_the_page_has_their_configurations(self) -> None:
        code, out, err = self.run_script(report_page.main, self.results)
        self.assertEqual((code, err), (0, ""))
        page = Path(out.strip()).read_text(encoding="utf-8")
        for relmse in read_csv(OLD / "cells.csv", ["relmse"], labels=["cell", "relmse"]).relmse:
            self.assertIn(f'data-value="{relmse}"', page)
        self.set_schema(SCHEMA + 1)
        code, _, err = self.run_script(report_page.main, self.results)
        self.assertEqual(code, 1)
        self.assertIn(f"but this analysis reads {SCHEMA}", err)

    def test_the_names_are_those_of_the_schema(self) -> None:
        """A file of today in a folder of yesterday is not looked at, and the other way round."""
        (self.results / "cells.csv").rename(self.results / "configurations.csv")
        with self.assertRaisesRegex(LoadError, "cells.csv: no such file"):
            load(self.results).configurations
        self.set_schema(SCHEMA)
        with self.assertRaisesRegex(LoadError, "summary.csv: has no column 'configuration'"):
            load(self.results)

    def test_results_that_do_not_say_have_the_names_of_schema_1(self) -> None:
        self.set_schema(None)
        self.assertEqual((load(self.results).schema, len(load(self.results).configurations)), (1, 2))

    def test_other_contracts_are_refused_by_name(self) -> None:
        self.set_schema(SCHEMA + 1)
        with self.assertRaisesRegex(LoadError, f"has schema {SCHEMA + 1}, but this analysis reads {SCHEMA} and older"):
            load(self.results)
        for schema in ("new", 0):
            self.set_schema(schema)
            with self.assertRaisesRegex(LoadError, f"schema is {schema!r} but must be a whole number from 1 on"):
                load(self.results)


if __name__ == "__main__":
    unittest.main()
