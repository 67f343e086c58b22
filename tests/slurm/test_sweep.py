"""A sweep on a real Slurm, with tasks that are killed, preempted and out of time, against the same on one machine."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

from cluster import Cluster, missing_programs

ROOT = Path(__file__).resolve().parents[2]
QTRACE = os.environ.get("QTRACE_BINARY", str(ROOT / "build/release/qtrace"))
SHARDS = 3
RUNS = 6

CONFIG = {"name": "night", "scene": str(ROOT / "configs/scenes/cornell_box.glb"), "width": 48, "height": 48,
          "frames": 300, "max_bounces": 4, "checkpoint_s": 0.2, "reference": {"frames": 64},
          "rl": {"sites_per_object": 20, "bins_theta": 4, "bins_phi": 4},
          "sweep": [{"method": {"NEE": {"sampler": "bsdf", "nee": "one_ray"}, "RL": {"sampler": "rl"}}},
                    {"seed": [1, 2, 3]}]}

# host_ms_median, elapsed_s, relmse_x_s, ..., and what else follows from clocks.
OF_TIME = re.compile(r"_(ms|s)(_|$)|^(started|warmup_detected|noisy)$")


def rows_without_times(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return [{name: value for name, value in row.items() if not OF_TIME.search(name)}
                for row in csv.DictReader(stream)]


def processes_of(*words: str) -> list[int]:
    """Of qtrace, with all these words on their command lines."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            line = (folder / "cmdline").read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue  # just gone
        if line[0].endswith("qtrace") and all(word in line for word in words):
            found.append(int(folder.name))
    return found


class SweepTest(unittest.TestCase):
    """One cluster and one truth for all tests."""

    cluster: Cluster
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        if missing := missing_programs():
            raise RuntimeError(f"not installed: {', '.join(missing)}; ./dev test-slow installs packages-slurm.txt")
        temporary = tempfile.TemporaryDirectory(prefix="qtrace_slurm_")
        cls.addClassCleanup(temporary.cleanup)
        # A name that a script must quote.
        cls.folder = Path(temporary.name) / "it's 100% \"shared\" $HOME"
        cls.folder.mkdir()
        (cls.folder / "night.json").write_text(json.dumps(CONFIG), encoding="utf-8")
        slurm = Path(temporary.name) / "slurm"
        slurm.mkdir(mode=0o755)
        cls.cluster = Cluster(slurm)
        cls.addClassCleanup(cls.cluster.stop)
        cls.cluster.start()
        done = cls.qtrace("run", "night.json", "--out", "alone", "--quiet")
        if done.returncode != 0:
            raise RuntimeError(f"the sweep on one machine: {done.stderr}")

    def tearDown(self) -> None:
        self.cluster.command("scancel", "--partition", "main", check=False)
        self.cluster.wait(lambda: not self.cluster.jobs(), "an empty queue")

    @classmethod
    def qtrace(cls, *words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([QTRACE, *words], cwd=cls.folder, env=cls.cluster.environment, capture_output=True,
                              text=True, check=False)

    def submit(self, out: str, *more: str) -> list[str]:
        """The ids of references, shards and merge."""
        done = self.qtrace("submit", "night.json", "--slurm", "--shards", str(SHARDS), "--out", out, *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        jobs = re.findall(r"job (\d+)", done.stdout)
        self.assertEqual(len(jobs), 3, done.stdout)
        return jobs

    def log(self, out: str, name: str) -> str:
        file = self.folder / out / "night/slurm" / f"{name}.log"
        return file.read_text(encoding="utf-8") if file.exists() else ""

    def logs(self, out: str) -> str:
        folder = self.folder / out / "night/slurm"
        return "\n".join(f"--- {file.name}\n{file.read_text()}" for file in sorted(folder.glob("*.log")))

    def runs_of(self, shard: int) -> list[str]:
        listed = self.qtrace("run", "night.json", "--shard", f"{shard}/{SHARDS}", "--list").stdout.split()
        self.assertEqual(len(listed), RUNS // SHARDS)
        return listed

    def wait_for_checkpoint(self, out: str, shard: int) -> None:
        """Until the shard is in the middle of a run."""
        files = [self.folder / out / "night" / run / "checkpoint.state" for run in self.runs_of(shard)]
        self.cluster.wait(lambda: any(file.exists() for file in files) and bool(self.shard_processes(out, shard)),
                          f"a checkpoint of shard {shard}")

    def resumed_runs(self, out: str, shard: int) -> list[str]:
        manifests = {run: json.loads((self.folder / out / "night" / run / "manifest.json").read_text())
                     for run in self.runs_of(shard)}
        return [run for run, manifest in manifests.items() if manifest.get("resumed_after_frame", 0) > 0]

    def shard_processes(self, out: str, shard: int) -> list[int]:
        return processes_of(str(self.folder / out), f"{shard}/{SHARDS}")

    def wait_for_end(self, job: str, seconds: float = 120) -> dict[str, str]:
        self.cluster.wait(lambda: self.cluster.job(job)["JobState"] not in ("PENDING", "RUNNING", "COMPLETING"),
                          f"the end of job {job}", seconds)
        return self.cluster.job(job)

    def assert_same_results(self, out: str) -> None:
        alone, merged = self.folder / "alone", self.folder / out
        images = sorted(file.relative_to(alone) for file in alone.rglob("*.exr"))
        self.assertEqual(images, sorted(file.relative_to(merged) for file in merged.rglob("*.exr")))
        self.assertGreaterEqual(len(images), 2 * RUNS)
        for image in images:
            self.assertTrue((alone / image).read_bytes() == (merged / image).read_bytes(), f"{image} differs")
        tables = ["night/summary.csv", *(str(file.relative_to(alone)) for file in alone.glob("night/*/*.csv"))]
        self.assertEqual(len(tables), 1 + 2 * RUNS)
        for table in tables:
            self.assertEqual(rows_without_times(alone / table), rows_without_times(merged / table), table)
        summary = rows_without_times(merged / "night/summary.csv")
        self.assertEqual([row["status"] for row in summary], ["finished"] * RUNS)
        self.assertIn("relmse", summary[0])
        for name in ("summary.md", "configurations.csv"):
            self.assertTrue((merged / "night" / name).exists(), name)
        self.assertEqual(json.loads((merged / "night/manifest.json").read_text())["status"], "finished")

    def test_killed_preempted_and_out_of_time(self) -> None:
        out = "rough"
        _, shards, merge = self.submit(out)
        # The program of one task is killed; its job has failed, and its user wants it again.
        self.wait_for_checkpoint(out, 1)
        os.kill(self.shard_processes(out, 1)[0], signal.SIGKILL)
        self.cluster.wait(lambda: self.cluster.job(f"{shards}_1")["JobState"] == "FAILED", "a failed task")
        self.assertEqual(self.cluster.job(f"{shards}_1")["ExitCode"], "137:0")
        self.cluster.command("scontrol", "requeue", f"{shards}_1")
        # The time of the next is up.
        self.wait_for_checkpoint(out, 2)
        self.cluster.command("scancel", "--batch", "--signal=USR1", f"{shards}_2")
        self.cluster.wait(lambda: self.cluster.job(f"{shards}_2")["Restarts"] == "1", "shard 2 back in the queue")
        # Something more important needs both processors.
        self.wait_for_checkpoint(out, 3)
        self.cluster.command("sbatch", "--partition=urgent", "--ntasks=2", "--chdir", str(self.cluster.folder),
                             "--output=urgent.log", "--wrap", "sleep 1")
        self.cluster.wait(lambda: self.cluster.job(f"{shards}_3")["Restarts"] == "1", "shard 3 preempted")

        self.assertEqual(self.wait_for_end(merge)["ExitCode"], "0:0", self.logs(out))
        for shard in range(1, SHARDS + 1):
            task = self.cluster.job(f"{shards}_{shard}")
            self.assertEqual(task["JobState"], "COMPLETED", self.logs(out))
            self.assertGreaterEqual(int(task["Restarts"]), 1, shard)
            self.assertTrue(self.resumed_runs(out, shard), self.logs(out))
        for shard in (2, 3):  # were asked to end, once
            self.assertIn("interrupted by SIGTERM", self.log(out, f"shard-{shard}"))
        self.assert_same_results(out)

    def test_the_last_task_that_is_out_of_time_queues_itself_alone(self) -> None:
        """The job id of an array's last task is that of the array."""
        out = "late"
        _, shards, merge = self.submit(out)
        for shard in range(1, SHARDS):
            self.wait_for_checkpoint(out, shard)
        self.wait_for_checkpoint(out, SHARDS)
        self.cluster.command("scancel", "--batch", "--signal=USR1", f"{shards}_{SHARDS}")
        self.cluster.wait(lambda: self.cluster.job(f"{shards}_{SHARDS}")["Restarts"] == "1", "the last shard back in the queue")
        self.assertEqual(self.wait_for_end(merge)["ExitCode"], "0:0", self.logs(out))
        restarts = [self.cluster.job(f"{shards}_{shard}")["Restarts"] for shard in range(1, SHARDS + 1)]
        self.assertEqual(restarts, ["0"] * (SHARDS - 1) + ["1"], self.logs(out))
        self.assert_same_results(out)

    def test_what_is_cancelled_stays_so_until_it_is_submitted_again(self) -> None:
        out = "cancelled"
        _, shards, merge = self.submit(out)
        self.wait_for_checkpoint(out, 1)
        self.cluster.command("scancel", f"{shards}_1")
        self.assertEqual(self.wait_for_end(f"{shards}_1")["JobState"], "CANCELLED")
        # The merge says what is missing.
        self.assertEqual(self.wait_for_end(merge)["ExitCode"], "1:0", self.logs(out))
        finished = [row["status"] for row in rows_without_times(self.folder / out / "night/summary.csv")]
        self.assertLess(finished.count("finished"), RUNS)

        _, _, merge = self.submit(out)
        self.assertEqual(self.wait_for_end(merge)["ExitCode"], "0:0", self.logs(out))
        self.assertTrue(self.resumed_runs(out, 1), self.logs(out))
        self.assert_same_results(out)

    def test_nothing_is_rendered_without_references(self) -> None:
        out = "blind"
        references, shards, merge = self.submit(out, "--device", "no-such-device")
        self.assertEqual(self.wait_for_end(references)["ExitCode"], "1:0")
        self.assertIn("no-such-device", self.log(out, "references"))
        self.assertEqual(self.wait_for_end(shards)["JobState"], "CANCELLED")
        self.assertEqual(self.wait_for_end(merge)["ExitCode"], "1:0")
        self.assertFalse(list((self.folder / out).rglob("*.exr")))

    def test_slurms_own_refusal_is_passed_on(self) -> None:
        done = self.qtrace("submit", "night.json", "--slurm", "--shards", "1", "--out", "refused", "--partition",
                           "no such partition")
        self.assertEqual(done.returncode, 1)
        self.assertIn("references.sbatch: Slurm refuses the job: sbatch: error: invalid partition specified: no such "
                      "partition", done.stderr)
        self.assertEqual(self.cluster.jobs(), {})


if __name__ == "__main__":
    unittest.main()
