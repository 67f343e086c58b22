"""SIGKILL at random moments over a sweep of RL and non-RL runs: the results are those of the uninterrupted sweep."""

import json
import os
import random
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from sweep import CHECKPOINT_S, command, differences, run_whole, unreadable, write_config

KILLS = int(os.environ.get("QTRACE_KILLS", "100"))
SEED = 7
WRITING_S = 1.0  # what a checkpoint may take on a busy machine, and a process to begin


class KillTest(unittest.TestCase):
    def test_kills_at_random_moments(self) -> None:
        with tempfile.TemporaryDirectory(prefix="qtrace-kill-") as name:
            folder = Path(name)
            whole_s = run_whole(folder)
            moments = random.Random(SEED)
            kills = sweeps = 0
            most_lost = 0.0
            while kills < KILLS:
                sweeps += 1
                write_config(folder, f"killed{sweeps}")
                while True:
                    process = subprocess.Popen(command(f"killed{sweeps}"), cwd=folder, stdout=subprocess.DEVNULL,
                                               stderr=subprocess.DEVNULL)
                    try:
                        # Starting takes its time as well: some kills fall into that.
                        code = process.wait(moments.uniform(0, whole_s * 0.35))
                        self.assertEqual(code, 0)
                        break
                    except subprocess.TimeoutExpired:
                        killed = time.time()
                        process.send_signal(signal.SIGKILL)
                        process.wait()
                        kills += 1
                    results = folder / "results" / f"killed{sweeps}"
                    self.assertEqual(unreadable(results) if results.is_dir() else [], [])
                    if results.is_dir():
                        most_lost = max(most_lost, lost_seconds(results, killed))
                self.assertEqual(differences(folder / "results/whole", folder / f"results/killed{sweeps}"), [])
                self.assertEqual(list((folder / f"results/killed{sweeps}").rglob("checkpoint.state")), [])
            print(f"{kills} kills in {sweeps} sweeps of {whole_s:.1f} s; at most {most_lost:.2f} s between a run's last "
                  f"checkpoint and its end (checkpoint_s {CHECKPOINT_S})")
            self.assertLess(most_lost, CHECKPOINT_S + WRITING_S)


def lost_seconds(results: Path, killed: float) -> float:
    """Time from the last checkpoint to the kill, of the run that was going on: all that it may have rendered since."""
    lost = 0.0
    for manifest in results.glob("*/manifest.json"):
        checkpoint = manifest.with_name("checkpoint.state")
        if json.loads(manifest.read_text(encoding="utf-8"))["status"] != "running" or not checkpoint.is_file():
            continue
        # A process that has gone on with it writes its manifest first.
        since = max(checkpoint.stat().st_mtime, manifest.stat().st_mtime)
        lost = max(lost, killed - since)
    return lost


if __name__ == "__main__":
    unittest.main()
