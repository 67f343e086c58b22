"""cells.csv of a real run, computed again from summary.csv: the program and analysis have one interval."""

import json
import math
import os
import subprocess
import unittest

from support import ROOT, FolderTest

from analysis.csv_file import read_csv
from analysis.load import LoadError, load
from analysis.statistics import estimate, signed_estimate

BINARY = os.environ.get("QTRACE_BINARY")  # ctest sets it
SIGNED = ("psnr_db", "bias", "clamp_bias", "slope_mse", "slope_relmse")


@unittest.skipUnless(BINARY, "needs QTRACE_BINARY, the program; ctest names it")
class CellsTest(FolderTest):
    def test_intervals_agree(self) -> None:
        config = {"name": "cells", "scene": str(ROOT / "configs/scenes/simple.glb"), "width": 8, "height": 8,
                  "frames": 4, "reference": {"frames": 8}, "baseline": "none",
                  "sweep": [{"nee": ["none", "one_ray"]}, {"seed": [1, 2, 3, 4]}]}
        (self.folder / "cells.json").write_text(json.dumps(config), encoding="utf-8")
        subprocess.run([BINARY, "run", "cells.json"], cwd=self.folder, check=True, capture_output=True)
        results = self.folder / "results" / "cells"
        summary = read_csv(results / "summary.csv", ["cell"])
        cells = read_csv(results / "cells.csv", ["cell"]).set_index("cell")
        figures = [name.removesuffix("_sd") for name in cells.columns if name.endswith("_sd")]
        self.assertGreater(len(figures), 15)
        compared = 0
        for cell, runs in summary.groupby("cell"):
            for figure in figures:
                values = runs[figure].dropna()
                if values.empty:
                    self.assertTrue(math.isnan(cells[figure][cell]), figure)
                    continue
                expected = (signed_estimate if figure in SIGNED else estimate)(values)
                found = cells.loc[cell]
                for name, value in (("", expected.mean), ("_sd", values.std()), ("_low", expected.low),
                                    ("_high", expected.high)):
                    scale = max(abs(value), abs(expected.mean))  # an end near zero has the others' rounding
                    self.assertLessEqual(abs(found[figure + name] - value), 1e-12 * scale, figure + name)
                    compared += 1
        self.assertGreater(compared, 2 * 4 * 12)
        loaded = load(results)
        self.assertEqual(list(loaded.cells.cell), list(cells.index))
        self.assertEqual([(row.cell, row.baseline) for row in loaded.ratios.itertuples()], [("one_ray", "none")])
        (results / "ratios.csv").unlink()
        with self.assertRaisesRegex(LoadError, "names no baseline"):
            load(results).ratios


if __name__ == "__main__":
    unittest.main()
