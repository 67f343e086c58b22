"""The page about a results folder: its figures are those of the files, names are text, what is missing is said."""

import base64
import html.parser
import json
import re
import shutil
import unittest
from pathlib import Path

from support import ROOT, FolderTest, relmse, write_csv
from page_results import fail_run, read_fields, write_configurations, write_page_results

from analysis import report_page, tolerances
from analysis.report import number
from analysis.report.findings import findings
from analysis.report.sweep import read_sweep
from analysis.report.table import COUNTS, FIGURES, main_table

RUN = "scene=simple,method=nee-two-rays,seed=1"


class Page(html.parser.HTMLParser):
    """What a browser would find: the fields of each table, the findings, the data, and what it would load."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.source = text
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
        elif tag in ("script", "style"):
            self._script = found.get("id", tag)

    def handle_endtag(self, tag: str) -> None:
        if tag in ("script", "style"):
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
        write_page_results(self.results)

    def page(self, *options: object) -> Page:
        code, out, err = self.run_script(report_page.main, self.results, *options)
        self.assertEqual((code, err), (0, ""))
        return Page(Path(out.strip()).read_text(encoding="utf-8"))


class FiguresTest(ReportTest):
    def test_the_table_has_the_digits_of_configurations_csv(self) -> None:
        rows = self.page().tables["configurations-table"]
        configurations = read_fields(self.results / "configurations.csv")
        self.assertEqual(len(rows), len(configurations))
        for fields, row in zip(rows, configurations):
            shown = [field["data-value"] for field in fields]
            self.assertEqual(shown[0], row["scene"])
            for name in ("host_ms_median", "relmse", "elapsed_s", "relmse_x_s"):
                self.assertIn(row[name], shown)
            tips = [field.get("data-tip") for field in fields]
            self.assertIn(f"{row['relmse']} [{row['relmse_low']}, {row['relmse_high']}]", tips)

    def test_the_curves_end_where_configurations_csv_does_and_begin_where_the_seeds_do(self) -> None:
        curves = self.page().data["curves"]["relmse"]
        configurations = read_fields(self.results / "configurations.csv")
        self.assertEqual(set(curves), {row["configuration"] for row in configurations})
        for row in configurations:
            last = curves[row["configuration"]][-1]
            self.assertEqual(last[2:6], [float(row[name]) for name in ("elapsed_s", "relmse", "relmse_low", "relmse_high")])
            scene, method = row["configuration"].split(" / ")
            first = curves[row["configuration"]][0]
            self.assertAlmostEqual(first[3], sum(relmse(method, seed, 1, scene) for seed in (1, 2, 3)) / 3, 12)

    def test_reference_floors(self) -> None:
        self.assertEqual(self.page().data["floors"]["relmse"], {"simple": [0.01], "occluded": [0.01]})

    def test_three_digits(self) -> None:
        self.assertEqual([number.short(text) for text in ("12.4274395", "0.0057667199", "1623.4", "", "-0.98593", "1e-9")],
                         ["12.4", "0.00577", "1620", "–", "−0.986", "1e−09"])

    def test_every_figure_of_the_manifest_stands_in_the_table_of_figures(self) -> None:
        entry = {"name": "mean_path_length", "label": "a new metric", "unit": "segments", "signed": False,
                 "per_configuration": True, "formula": "its <formula>", "source": "s"}
        self.edit("manifest.json", lambda text: text.replace('"metrics": [', f'"metrics": [{json.dumps(entry)}, '))
        page = self.page()
        self.assertEqual([field["data-value"] for field in page.tables["figures-table"][0]][2], "2.5")
        self.assertIn("a new metric", page.text)
        self.assertIn("its &lt;formula&gt;\nin segments", page.source)

    def test_ratios_stand_beside_and_below(self) -> None:
        write_csv(self.results / "ratios.csv", [
            {"configuration": "simple / RL", "baseline": "simple / BSDF", "scene": "simple", "ratio_relmse_x_s": "1.23456789012",
             "ratio_relmse_x_s_low": 1.1, "ratio_relmse_x_s_high": 1.3, "target_mse": 0.1, "ratio_time_to_relmse": "",
             "ratio_time_to_relmse_low": "", "ratio_time_to_relmse_high": ""}])
        tables = self.page().tables
        self.assertEqual([field["data-value"] for field in tables["ratios-table"][0]],
                         ["simple", "RL", "simple / BSDF", "1.23456789012"])
        self.assertEqual([field["data-value"] == "1.23456789012" for row in tables["configurations-table"] for field in row].count(True), 1)

    def test_path_statistics_are_sums_of_summary_csv(self) -> None:
        values = [field["data-value"] for field in self.page().tables["paths-table"][0]]
        self.assertEqual(values, ["simple", "NEE, two rays", "3000", "12963", "2.5", "0.1234567891234", "150", "6", "0", "3",
                                  "0", "0"])

    def test_a_single_seed_has_the_spread_of_its_frames(self) -> None:
        rows = [{**row, "host_ms_p10": "490.125", "host_ms_p90": "510.5"}
                for row in read_fields(self.results / "summary.csv") if row["seed"] == "1"]
        write_csv(self.results / "summary.csv", rows)
        write_configurations(self.results)
        page = self.page()
        self.assertIn("One seed per configuration, so there are no intervals", page.text)
        tips = [field.get("data-tip", "") for field in page.tables["configurations-table"][0]]
        self.assertIn(f"{rows[0]['host_ms_median']}\n10th to 90th percentile of its frames: 490.125 to 510.5 ms", tips)

    def test_the_ratios_that_were_published_are_those_of_the_table(self) -> None:
        line = "simple / NEE over simple / RL: 1.81 × the host time per frame (published: 2.30 ×); 0.0177 × the relMSE × s"
        (self.results / "summary.md").write_text(f"# study\n\n- {line}\n- something else\n", encoding="utf-8")
        self.assertIn(line, self.page().text)

    def test_figures_that_are_not_finite_are_shown_and_not_drawn(self) -> None:
        rows = read_fields(self.results / "configurations.csv")
        rows[0].update(relmse="nan", relmse_low="", relmse_high="", elapsed_s="inf")
        write_csv(self.results / "configurations.csv", rows)
        page = self.page()
        self.assertEqual(page.data["curves"]["relmse"][rows[0]["configuration"]][-1][2:4], [None, None])
        self.assertEqual(page.tables["configurations-table"][0][3]["data-value"], "nan")


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
        self.assertIn("3 runs not finished", page.text)
        self.assertLess(page.text.index("the device <was> reset"), page.text.index("relMSE"))
        self.assertEqual(page.data["curves"]["relmse"]["simple / NEE, two rays"][0][6], 1)  # seeds that count

    def test_a_configuration_of_partial_runs_alone_is_shown_and_marked(self) -> None:
        for seed, frames in ((1, 4), (2, 2), (3, 4)):
            fail_run(self.results, f"scene=simple,method=rl,seed={seed}", "partial", "", frames)
        page = self.page()
        self.assertEqual(page.data["curves"]["relmse"]["simple / RL"][0][6], 2)  # the two that came furthest
        fields = main_table(read_sweep(self.results)).rows[2][1]
        self.assertEqual([field.shown for field in fields if field.flag], ["3 partial"])

    def test_flags_of_configurations(self) -> None:
        write_configurations(self.results, {"simple / BSDF": (-1.3, -1.4, -1.2), "occluded / RL": (-0.75, -0.8, -0.7)},
                    at_floor={"simple / RL": 2})
        floor, slopes = findings(read_sweep(self.results))
        self.assertEqual((floor.level, floor.details), ("flagged", ["simple / RL: 2 of 3 seeds"]))
        self.assertIn("2 rows of 6", slopes.text)
        self.assertRegex(slopes.details[0], r"^simple / BSDF: relMSE −1.3 \[−1.4, −1.2\], steeper than −1")
        self.assertRegex(slopes.details[1], r"^occluded / RL: relMSE −0.75 .*, flatter than −1")

    def test_sobol_points_may_be_steep(self) -> None:
        write_configurations(self.results, {"simple / BSDF": (-1.3, -1.4, -1.2), "occluded / RL": (-0.75, -0.8, -0.7)})
        for file in self.results.glob("*/manifest.json"):
            manifest = json.loads(file.read_text(encoding="utf-8"))
            manifest["config"]["random"] = "sobol"
            file.write_text(json.dumps(manifest), encoding="utf-8")
        (slopes,) = findings(read_sweep(self.results))
        self.assertEqual(len(slopes.details), 1)
        self.assertIn("flatter", slopes.details[0])

    def test_noisy_machine_and_odd_samples(self) -> None:
        rows = read_fields(self.results / "summary.csv")
        rows[0].update(noisy="1", warmup_detected="9", non_finite="3")
        write_csv(self.results / "summary.csv", rows)
        samples, noisy, warmup = findings(read_sweep(self.results))
        self.assertIn("3 samples in 1 run were NaN or infinite", samples.text)
        self.assertIn("noisy in 1 of 18 runs", noisy.text)
        self.assertEqual((warmup.level, warmup.details), ("noted", [f"{RUN}: 9 slow frames"]))

    def test_the_tolerances_are_those_of_the_program(self) -> None:
        source = "".join(file.read_text() for room in ("records", "measure") for file in (ROOT / "experiments" / room).iterdir())
        self.assertIn(f"kSlopeTolerance = {tolerances.SLOPE};", source)
        self.assertIn(f"kReferenceFloor = {tolerances.REFERENCE_FLOOR:.1f};", source)


class ContractTest(unittest.TestCase):
    def test_every_column_shown_is_one_that_the_program_writes(self) -> None:
        declared = "".join(file.read_text(encoding="utf-8") for room in ("records", "measure")
                           for file in (ROOT / "experiments" / room).glob("*.cpp"))
        for name in [*FIGURES, *COUNTS, "seeds_at_reference_floor", "mean_path_length", "zero_path_fraction", "noisy",
                     "warmup_detected", "verdict_reason"]:
            # Columns of clocks, filter and slopes are put together from two parts.
            part = name.removeprefix("host").removeprefix("gpu").removeprefix("filtered_").removeprefix("slope_")
            self.assertTrue(name == "published" or f'"{name}"' in declared or f'"{part}"' in declared, name)


class NamesTest(ReportTest):
    def test_odd_names_are_text(self) -> None:
        odd = '</script><img src=x onerror="alert(1)">&\''
        for name in ("summary.csv", "configurations.csv"):
            rows = [{key: value.replace("BSDF", odd) for key, value in row.items()}
                    for row in read_fields(self.results / name)]
            write_csv(self.results / name, rows)
        page = self.page()
        self.assertEqual(page.loaded, [])
        self.assertIn(odd, page.text)
        self.assertIn(odd, page.data["labels"])
        self.assertEqual(page.tables["configurations-table"][1][1]["data-value"], odd)


class LearnedTest(ReportTest):
    def test_pictures_of_inspect(self) -> None:
        (self.results / RUN / "inspect").mkdir()
        (self.results / RUN / "inspect" / "inspect.png").write_bytes(b"a picture")
        page = self.page()
        self.assertIn(base64.b64encode(b"a picture").decode(), page.source)
        self.assertIn("Cells and hemispheres", page.text)

    def test_tables_that_nobody_looked_at(self) -> None:
        self.assertNotIn("Cells and hemispheres", self.page().text)
        (self.results / RUN / "q_values_000008.npy").touch()
        self.assertIn(f"1 run has saved the table, and none has been looked at: ./dev inspect study/{RUN}", self.page().text)


class MissingTest(ReportTest):
    def test_lost_files_of_runs_are_gaps_that_the_page_names(self) -> None:
        (self.results / RUN / "convergence.csv").unlink()
        (self.results / RUN / "manifest.json").write_text("{")
        text = self.page().text
        self.assertRegex(text, "1 flag .*convergence.csv: no such file.*manifest.json: cannot be read as JSON")

    def test_a_folder_without_its_runs_is_one_gap(self) -> None:
        """As results are published."""
        for run in self.results.iterdir():
            if run.is_dir():
                shutil.rmtree(run)
        page = self.page()
        self.assertIn("it was kept without the folders of its runs, so that there are no curves and no images", page.text)
        self.assertIn("1 flag", page.text)
        self.assertEqual((len(page.tables["configurations-table"]), page.data["curves"]), (6, {}))

    def test_no_finished_run(self) -> None:
        rows = [{**row, "status": "failed", "reason": "no room"} for row in read_fields(self.results / "summary.csv")]
        write_csv(self.results / "summary.csv", rows)
        (self.results / "configurations.csv").unlink()
        page = self.page()
        self.assertIn("18 of 18 runs failed", page.text)
        self.assertIn("configurations.csv: no such file", page.text)

    def test_no_experiment(self) -> None:
        for folder, sentence in ((self.folder / "nowhere", "no such folder"), (self.folder, "has no summary.csv")):
            code, out, err = self.run_script(report_page.main, folder)
            self.assertEqual((code, out), (1, ""))
            self.assertRegex(err, f"^error: .*{sentence}[^\n]*\n$")

    def test_a_sweep_that_goes_on(self) -> None:
        self.edit("manifest.json", lambda text: text.replace('"status": "finished", "experiment"', '"status": "running", "experiment"'))
        self.assertIn("18 of 18 runs finished, 6 configurations, on a device; status running", self.page().text)

    def test_a_word_among_numbers(self) -> None:
        self.edit("summary.csv", lambda text: text.replace(",8,", ",eight,", 1))
        code, out, err = self.run_script(report_page.main, self.results)
        self.assertEqual((code, out), (1, ""))
        self.assertRegex(err, r"^error: .*summary.csv: column 'frames' holds something that is not a number: .*'eight'\n$")

    def test_page_elsewhere(self) -> None:
        self.page("--out", self.folder / "new" / "page.html")
        self.assertFalse((self.results / "report.html").exists())


if __name__ == "__main__":
    unittest.main()
