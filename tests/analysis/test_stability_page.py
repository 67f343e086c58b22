"""The page about hard cases: a row per case, the furthest method, and the exit code."""

import json

from support import FolderTest, write_csv

from analysis.stability_page import main

CASES = {"moved": "far from the origin", "tiny light": "too small to be met"}


class StabilityTest(FolderTest):
    def setUp(self) -> None:
        super().setUp()
        rows = []
        for case, note in CASES.items():
            for method, z in (("BSDF", 1.5), ("RL", 2.5)):
                run = f"case={case.replace(' ', '-')},method={method.lower()}"
                rows.append({"run": run, "axis:case": case, "axis:method": method, "status": "finished", "reason": "",
                             "verdict": "pass", "verdict_reason": "", "mean": 0.5 + z / 100, "mean_error": 0.01,
                             "expected_mean": 0.5, "worst_z": z, "non_finite": 0})
                (self.results / run).mkdir(parents=True)
                manifest = {"config": {"expect": {"note": note}}}
                (self.results / run / "manifest.json").write_text(json.dumps(manifest))
        self.rows = rows
        self.tests = self.folder / "tests.json"
        self.write_tests([])

    def write_tests(self, failures: list[dict[str, str]]) -> None:
        test = {"name": "Counters", "result": "COMPLETED", "hard": "a counter | at its end", "expected": "5",
                "measured": "5.2", **({"failures": failures} if failures else {})}
        self.tests.write_text(json.dumps({"testsuites": [{"testsuite": [test]}]}))

    def report(self) -> tuple[int, str]:
        write_csv(self.results / "summary.csv", self.rows)
        code, _, _ = self.run_script(main, self.results, "--tests", self.tests)
        return code, (self.results / "stability.md").read_text(encoding="utf-8")

    def test_all_cases_pass(self) -> None:
        self.rows[2]["verdict"] = "unseen"
        self.rows[2]["worst_z"] = float("inf")
        code, page = self.report()
        self.assertEqual(code, 0)
        self.assertIn("All 3 cases pass.", page)
        self.assertIn("| moved | far from the origin | mean 0.5 | furthest: RL, 0.525 ± 0.01, z 2.5; non-finite 0 "
                      "| pass 2 |", page)
        self.assertIn("| furthest: RL, 0.525 ± 0.01, z 2.5; non-finite 0 | unseen 1, pass 1 |", page)
        self.assertIn("| Counters | a counter \\| at its end | 5 | 5.2 | pass 1 |", page)

    def test_a_failed_run_fails_its_case(self) -> None:
        self.rows[0].update(verdict="fail", worst_z=float("inf"), non_finite=3)
        code, page = self.report()
        self.assertEqual(code, 1)
        self.assertIn("**Failed: moved.**", page)
        self.assertIn("furthest: BSDF, 0.515 ± 0.01, z ∞; non-finite 3 | fail 1, pass 1 |", page)

    def test_a_run_that_did_not_finish_fails(self) -> None:
        self.rows[3].update(status="failed", reason="no memory", verdict="", mean="", mean_error="", worst_z="")
        code, page = self.report()
        self.assertEqual(code, 1)
        self.assertIn("**Failed: tiny light.**", page)
        self.assertIn("RL: no memory; furthest: BSDF", page)

    def test_a_failed_test_fails(self) -> None:
        self.write_tests([{"failure": "wrong"}])
        code, page = self.report()
        self.assertEqual(code, 1)
        self.assertIn("**Failed: Counters.**", page)
