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

from sweep import CHECKPOINT_S, command, differences, run, unreadable, write_config

KILLS = int(os.environ.get("QTRACE_KILLS", "100"))
SEED = 7


class KillTest(unittest.TestCase):
    def test_kills_at_random_moments(self) -> None:
        with tempfile.TemporaryDirectory(prefix="qtrace-kill-") as name:
            folder = Path(name)
            write_config(folder, "whole")
            start = time.monotonic()
            self.assertEqual(run(folder, "whole").returncode, 0)
            whole_s = time.monotonic() - start
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
                        process.send_signal(signal.SIGKILL)
                        process.wait()
                        kills += 1
                    results = folder / "results" / f"killed{sweeps}"
                    self.assertEqual(unreadable(results) if results.is_dir() else [], [])
                    most_lost = max(most_lost, lost_seconds(results))
                self.assertEqual(differences(folder / "results/whole", folder / f"results/killed{sweeps}"), [])
                self.assertEqual(list((folder / f"results/killed{sweeps}").rglob("*.state")).__len__(), 6)
            print(f"{kills} kills in {sweeps} sweeps of {whole_s:.1f} s; largest time between the checkpoint and the "
                  f"last frame that a killed run's own files tell of: {most_lost:.2f} s (checkpoint_s {CHECKPOINT_S})")


def lost_seconds(results: Path) -> float:
    """Render time in frames.csv of the run that was killed, after the frame of its checkpoint."""
    lost = 0.0
    for manifest in results.glob("*/manifest.json"):
        content = json.loads(manifest.read_text(encoding="utf-8"))
        if content["status"] != "running":
            continue
        frames = manifest.with_name("frames.csv")
        if not frames.is_file():
            continue
        lines = frames.read_text(encoding="utf-8").splitlines()[1:]
        after = lines[content.get("checkpoint_frame", 0):]
        lost = max(lost, sum(float(line.split(",")[2]) for line in after) / 1e3)
    return lost


if __name__ == "__main__":
    unittest.main()
