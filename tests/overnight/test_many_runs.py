"""Thousands of tiny runs: what the harness takes besides rendering, and whether its memory grows."""

import csv
import json
import os
import re
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from sweep import BINARY, ROOT

RUNS = int(os.environ.get("QTRACE_RUNS", "10000"))
MOST_MS = 5.0
MOST_GROWTH_MB = 64


def memory_mb(pid: int) -> float:
    text = Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    return int(re.search(r"VmRSS:\s+(\d+)", text)[1]) / 1024


class ManyRunsTest(unittest.TestCase):
    def test_overhead_and_memory(self) -> None:
        with tempfile.TemporaryDirectory(prefix="qtrace-many-") as name:
            folder = Path(name)
            config = {"name": "many", "scene": str(ROOT / "configs/scenes/furnace.glb"), "width": 8, "height": 8,
                      "frames": 2, "sampler": "bsdf", "reference": {"frames": 4}, "snapshots": [],
                      "sweep": [{"max_bounces": list(range(1, 11))}, {"seed": list(range(RUNS // 10))}]}
            (folder / "many.json").write_text(json.dumps(config), encoding="utf-8")
            start = time.monotonic()
            process = subprocess.Popen([BINARY, "run", "many.json", "--quiet"], cwd=folder, stdout=subprocess.DEVNULL)
            memory = []
            while process.poll() is None:
                try:
                    memory.append(memory_mb(process.pid))
                except (OSError, TypeError):
                    pass
                time.sleep(0.1)
            wall = time.monotonic() - start
            self.assertEqual(process.returncode, 0)
            with (folder / "results/many/summary.csv").open(encoding="utf-8", newline="") as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual(len(rows), RUNS)
            # Setup is the tracer's: acceleration, cells, and the driver's compilation of shaders.
            rendering = sum(float(row["elapsed_s"]) + float(row["setup_s"]) for row in rows)
            overhead = (wall - rendering) / RUNS * 1e3
            tenth = max(1, len(memory) // 10)
            growth = max(memory[-tenth:]) - max(memory[tenth:2 * tenth])
            print(f"{RUNS} runs in {wall:.1f} s, {rendering:.1f} s of it frames and setup: {overhead:.2f} ms per run "
                  f"besides; memory {memory[tenth]:.0f} MB after a tenth, {memory[-1]:.0f} MB at the end")
            self.assertLess(overhead, MOST_MS)
            self.assertLess(growth, MOST_GROWTH_MB)


if __name__ == "__main__":
    unittest.main()
