"""The page about a results folder: its figures are those of the files, names are text, what is missing is said."""

import html.parser
import json
import re
import unittest
from pathlib import Path

from support import ROOT, FolderTest, relmse, write_csv
from report_results import fail_run, read_fields, write_cells, write_report_results

from analysis import report_page
from analysis.report import number
from analysis.report.findings import findings
from analysis.report.sweep import read_sweep

RUN = "scene=simple,method=nee-two-rays,seed=1"


class Page(html.parser.HTMLParser):
    """What a browser would find: the fields of each table, the findings, the data, and what it would load."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: dict[str, list[list[dict[str, str]]]] = {}
        self.words: list[str] = []
        self.loaded: list[str] = []
        self.scripts: dict[str, str] = {}
        self._table = self._script = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        found = {key: value or "" for key, value in attributes}
        self.loaded += [found[key] for key in ("src", "href") if not found.get(key, "#").startswith(("#", "data:"))]
        if tag == "table":
            self._table = found.get("id", "")
            self.tables[self._table] = []
        elif tag == "tr" and "data-key" in found:
            self.tables[self._table].append([])
        elif tag in ("td", "th") and "data-value" in found:
            self.tables[self._table][-1].append(found)
        elif tag == "script":
            self._script = found.get("id", "program")

    def handle_endtag(self, tag: str) -> None:
        if tag == "script":
            self._script = ""

    def handle_data(self, data: str) -> None:
        if self._script:
            self.scripts[self._script] = self.scripts.get(self._script, "") + data
        else:
            self.words.append(data)

    @property
    def text(self) -> str:
        return re.sub(r"\s+", " ", " ".join(self.words))

    @property
    def data(self) -> dict:
        return json.loads(self.scripts["data"])


class ReportTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        write_report_results(self.results)

    def page(self, *options: object) -> Page:
        code, out, err = self.run_script(report_page.main, self.results, *options)
        self.assertEqual((code, err), (0, ""))
        return Page(Path(out.strip()).read_text(encoding="utf-8"))


class FiguresTest(ReportTest):
    def test_the_table_has_the_digits_of_cells_csv(self) -> None:
        rows = self.page().tables["cells-table"]
        cells = read_fields(self.results / "cells.csv")
        self.assertEqual(len(rows), len(cells))
        for fields, cell in zip(rows, cells):
            shown = [field["data-value"] for field in fields]
            self.assertEqual(shown[0], cell["scene"])
            for name in ("host_ms_median", "relmse", "elapsed_s", "relmse_x_s"):
                self.assertIn(cell[name], shown)
            tips = [field.get("data-tip") for field in fields]
            self.assertIn(f"{cell['relmse']} [{cell['relmse_low']}, {cell['relmse_high']}]", tips)

    def test_the_curves_end_where_cells_csv_does_and_begin_where_the_seeds_do(self) -> None:
        curves = self.page().data["curves"]["relmse"]
        cells = read_fields(self.results / "cells.csv")
        self.assertEqual(set(curves), {cell["cell"] for cell in cells})
        for cell in cells:
            last = curves[cell["cell"]][-1]
            self.assertEqual(last[2:6], [float(cell[name]) for name in ("elapsed_s", "relmse", "relmse_low", "relmse_high")])
            scene, method = cell["cell"].split(" / ")
            first = curves[cell["cell"]][0]
            self.assertAlmostEqual(first[3], sum(relmse(method, seed, 1, scene) for seed in (1, 2, 3)) / 3, 12)

    def test_reference_floors(self) -> None:
        self.assertEqual(self.page().data["floors"]["relmse"], {"simple": [0.01], "occluded": [0.01]})

    def test_three_digits(self) -> None:
        self.assertEqual([number.short(text) for text in ("12.4274395", "0.0057667199", "1623.4", "", "-0.98593", "1e-9")],
                         ["12.4", "0.00577", "1620", "–", "−0.986", "1e−09"])


class FindingsTest(ReportTest):
    def test_nothing_wrong(self) -> None:
        self.assertIn("Nothing failed and nothing is flagged: all 18 runs are finished.", self.page().text)

    def test_failed_partial_and_missing_runs_come_first(self) -> None:
        fail_run(self.results, RUN, "failed", "the device <was> reset", 3)
        fail_run(self.results, RUN.replace("seed=1", "seed=2"), "partial", "", 4)
        manifest = json.loads((self.results / "manifest.json").read_text())
        manifest["runs"].append({"run": "late", "status": "not begun"})
        (self.results / "manifest.json").write_text(json.dumps(manifest))
        found = findings(read_sweep(self.results))
        self.assertEqual([(one.level, one.text.split(";")[0].split(".")[0]) for one in found],
                         [("failed", "1 of 19 runs failed"), ("failed", "1 of 19 runs stopped on the way"),
                          ("failed", "1 of 19 runs is not begun")])
        self.assertEqual(found[0].details, [f"{RUN}: the device <was> reset"])
        self.assertEqual(found[1].details, [f"{RUN.replace('seed=1', 'seed=2')}: 4 frames"])
        page = self.page()
        self.assertIn(f"{RUN}: the device <was> reset", page.text)
        self.assertLess(page.text.index("the device <was> reset"), page.text.index("relMSE"))
        self.assertEqual(page.data["curves"]["relmse"]["simple / NEE, two rays"][0][6], 1)  # seeds that count

    def test_flags_of_cells(self) -> None:
        write_cells(self.results, {"simple / BSDF": (-1.3, -1.4, -1.2), "occluded / RL": (-0.75, -0.8, -0.7)},
                    at_floor={"simple / RL": 2})
        floor, slopes = findings(read_sweep(self.results))
        self.assertEqual((floor.level, floor.details), ("flagged", ["simple / RL: 2 of 3 seeds"]))
        self.assertIn("2 rows of 6", slopes.text)
        self.assertRegex(slopes.details[0], r"^simple / BSDF: relMSE −1.3 \[−1.4, −1.2\], steeper than −1")
        self.assertRegex(slopes.details[1], r"^occluded / RL: relMSE −0.75 .*, flatter than −1")

    def test_noisy_machine_and_odd_samples(self) -> None:
        rows = read_fields(self.results / "summary.csv")
        rows[0].update(noisy="1", warmup_detected="9", non_finite="3")
        write_csv(self.results / "summary.csv", rows)
        samples, noisy, warmup = findings(read_sweep(self.results))
        self.assertIn("3 samples in 1 run were NaN or infinite", samples.text)
        self.assertIn("noisy in 1 of 18 runs", noisy.text)
        self.assertEqual((warmup.level, warmup.details), ("noted", [f"{RUN}: 9 slow frames"]))

    def test_the_tolerance_is_that_of_the_table(self) -> None:
        from analysis.report.table import SLOPE_TOLERANCE
        self.assertIn(f"kSlopeTolerance = {SLOPE_TOLERANCE};", (ROOT / "experiments" / "table.cpp").read_text())


class NamesTest(ReportTest):
    def test_odd_names_are_text(self) -> None:
        odd = '</script><img src=x onerror="alert(1)">&\''
        for name in ("summary.csv", "cells.csv"):
            rows = [{key: value.replace("BSDF", odd) for key, value in row.items()}
                    for row in read_fields(self.results / name)]
            write_csv(self.results / name, rows)
        page = self.page()
        self.assertEqual(page.loaded, [])
        self.assertIn(odd, page.text)
        self.assertIn(odd, page.data["labels"])
        self.assertEqual(page.tables["cells-table"][1][1]["data-value"], odd)


class MissingTest(ReportTest):
    def test_lost_files_of_runs_are_gaps_that_the_page_names(self) -> None:
        (self.results / RUN / "convergence.csv").unlink()
        (self.results / RUN / "manifest.json").write_text("{")
        text = self.page().text
        self.assertRegex(text, "1 flagged.*convergence.csv: no such file.*manifest.json: cannot be read as JSON")

    def test_no_finished_run(self) -> None:
        rows = [{**row, "status": "failed", "reason": "no room"} for row in read_fields(self.results / "summary.csv")]
        write_csv(self.results / "summary.csv", rows)
        (self.results / "cells.csv").unlink()
        page = self.page()
        self.assertIn("18 of 18 runs failed", page.text)
        self.assertIn("cells.csv: no such file", page.text)

    def test_no_experiment(self) -> None:
        for folder, sentence in ((self.folder / "nowhere", "no such folder"), (self.folder, "has no summary.csv")):
            code, out, err = self.run_script(report_page.main, folder)
            self.assertEqual((code, out), (1, ""))
            self.assertRegex(err, f"^error: .*{sentence}[^\n]*\n$")

    def test_page_elsewhere(self) -> None:
        self.page("--out", self.folder / "new" / "page.html")
        self.assertFalse((self.results / "report.html").exists())


if __name__ == "__main__":
    unittest.main()
