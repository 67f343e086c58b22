"""Loading results: tidy frames with every digit, and one sentence for each way to fail."""

import unittest

import shutil

from support import ROOT, SNAPSHOTS, FolderTest, relmse, write_results

from analysis import csv_file
from analysis.load import (CONFIGURATIONS_COLUMNS, CONVERGENCE_COLUMNS, FRAMES_COLUMNS, RATIOS_COLUMNS, SUMMARY_COLUMNS,
                           LoadError, MissingError, load)

FIRST_RUN = "scene=simple,method=nee-two-rays,seed=1"


class ContractTest(unittest.TestCase):
    def test_every_column_used_is_one_that_the_program_writes(self) -> None:
        declared = "".join(file.read_text(encoding="utf-8") for room in ("records", "measure")
                           for file in (ROOT / "experiments" / room).glob("*.cpp"))
        for column in {*CONFIGURATIONS_COLUMNS, *RATIOS_COLUMNS, *SUMMARY_COLUMNS, *CONVERGENCE_COLUMNS, *FRAMES_COLUMNS, *csv_file.TEXT, *csv_file.BOOLEAN}:
            self.assertIn(f'"{column}"', declared)


class LoadTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        write_results(self.results)

    def test_rows_and_keys(self) -> None:
        results = load(self.results)
        self.assertEqual(results.name, "study")
        self.assertEqual(len(results.summary), 2 * 3 * 3)
        self.assertEqual(len(results.convergence), 2 * 3 * 3 * 4)
        self.assertEqual(len(results.frames), 2 * 3 * 3 * 8)
        for frame in (results.convergence, results.frames):
            self.assertEqual(list(frame.columns[:8]), ["run", "configuration", "label", "axis:scene", "axis:method",
                                                       "axis:seed", "scene", "seed"])
        self.assertEqual(list(dict.fromkeys(results.convergence.label)), ["NEE, two rays", "BSDF", "RL"])

    def test_values_are_exact(self) -> None:
        for row in load(self.results).convergence.itertuples():
            self.assertEqual(row.relmse, relmse(row.label, row.seed, row.frame, row.scene))

    def test_types(self) -> None:
        results = load(self.results)
        self.assertEqual(results.convergence.at_reference_floor.dtype, bool)
        self.assertEqual(results.frames.is_warmup.sum(), 18)
        self.assertEqual(results.frames.mean_path_length.isna().sum(), 18)  # empty fields
        self.assertEqual(results.convergence.spp.dtype, int)

    def test_large_seed_and_labels_that_look_like_numbers_or_nothing(self) -> None:
        self.edit("summary.csv", lambda text: text.replace('"NEE, two rays",1,simple,1,',
                                                           f"NA,1,simple,{2 ** 63 + 1},"))
        self.edit("summary.csv", lambda text: text.replace("axis:method", "axis:rl.sites").replace(",RL,", ",10,"))
        results = load(self.results)
        self.assertEqual(int(results.summary.seed[0]), 2 ** 63 + 1)
        self.assertEqual(results.summary.label[0], "NA")
        self.assertIn("sites=10", set(results.convergence.label))

    def test_without_axes_the_only_configuration_is_all(self) -> None:
        self.edit("summary.csv", lambda text: text.replace("axis:scene", "x").replace("axis:method", "y"))
        self.edit("summary.csv", lambda text: "\r\n".join(text.splitlines()[:1]) + "\r\n"
                  f'"{FIRST_RUN}",all,0,0,1,simple,1,finished,,8,5.5,0.1,,\r\n')
        self.assertEqual(set(load(self.results).convergence.label), {"all"})

    def test_failed_runs_stay_in_the_summary_alone(self) -> None:
        self.edit("summary.csv", lambda text: text.replace("simple,1,finished,,8,", "simple,1,failed,a reason,3,"))
        results = load(self.results)
        self.assertEqual(len(results.summary), 18)
        self.assertEqual(len(results.finished), 15)
        self.assertEqual(results.convergence.run.nunique(), 15)
        self.assertNotIn(FIRST_RUN, set(results.convergence.run))


    def test_files_of_runs_are_read_when_they_are_asked_for(self) -> None:
        for run in self.results.iterdir():
            if run.is_dir():
                shutil.rmtree(run)
        results = load(self.results)
        self.assertEqual((len(results.finished), len(results.configurations)), (18, 6))
        self.assertEqual(results.configurations.relmse[2], sum(relmse("RL", seed, SNAPSHOTS[-1]) for seed in (1, 2, 3)) / 3)
        for frame, name in (("convergence", "convergence.csv"), ("frames", "frames.csv")):
            with self.assertRaisesRegex(MissingError, f"no run's {name} is here; this folder was kept without"):
                getattr(results, frame)


class PublishedTest(unittest.TestCase):
    def test_every_experiment_loads(self) -> None:
        folders = sorted(file.parent for file in (ROOT / "results/published").glob("**/summary.csv"))
        self.assertGreater(len(folders), 10)
        for folder in folders:
            with self.subTest(folder.name):
                results = load(folder)
                self.assertGreater(len(results.finished), 0)
                self.assertTrue(results.finished.relmse.notna().any())
                with self.assertRaisesRegex(MissingError, "kept without the files of its runs"):
                    results.convergence
                if results.has_ratios:
                    self.assertTrue(set(results.ratios.configuration) < set(results.configurations.configuration))


class LoadErrorTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        write_results(self.results)

    def check(self, pattern: str) -> None:
        with self.assertRaisesRegex(LoadError, pattern) as caught:
            results = load(self.results)
            results.convergence, results.frames
        self.assertNotIn("\n", str(caught.exception))

    def test_missing_folder(self) -> None:
        with self.assertRaisesRegex(LoadError, "nowhere: no such folder"):
            load(self.folder / "nowhere")

    def test_folder_of_something_else(self) -> None:
        with self.assertRaisesRegex(LoadError, "no summary.csv"):
            load(self.folder)

    def test_no_finished_run(self) -> None:
        self.edit("summary.csv", lambda text: text.replace("finished", "failed"))
        self.check("none of its 18 runs is finished")

    def test_no_run_at_all(self) -> None:
        self.edit("summary.csv", lambda text: text.splitlines()[0] + "\r\n")
        self.check("none of its 0 runs is finished")

    def test_missing_file_of_a_finished_run(self) -> None:
        (self.results / FIRST_RUN / "convergence.csv").unlink()
        self.check("convergence.csv: no such file")

    def test_missing_column(self) -> None:
        self.edit(f"{FIRST_RUN}/convergence.csv", lambda text: text.replace("elapsed_s", "elapsed_h"))
        self.check("convergence.csv: has no column 'elapsed_s'")

    def test_word_among_numbers(self) -> None:
        self.edit(f"{FIRST_RUN}/convergence.csv", lambda text: text.replace("0.9,", "much,", 1))
        self.check("convergence.csv: column 'relmse' holds something that is not a number: .*'much'")

    def test_short_record(self) -> None:
        self.edit(f"{FIRST_RUN}/frames.csv", lambda text: text + "9,0,1.5")
        self.check("frames.csv: record 10 has 3 fields, but the header has 5")

    def test_empty_and_binary_files(self) -> None:
        self.edit("summary.csv", lambda text: "")
        self.check("summary.csv: is empty")
        (self.results / "summary.csv").write_bytes(b"\xff\xfe\x00")
        self.check("summary.csv: cannot be read as CSV")

    def test_broken_manifest(self) -> None:
        self.edit("manifest.json", lambda text: text[:-5])
        self.check("manifest.json: cannot be read as JSON")
        self.edit("manifest.json", lambda text: "[]")
        self.check("manifest.json: must hold a JSON object")
