"""A disk that is full at random moments: a clear message, nothing damaged, and on it goes when there is room again."""

import contextlib
import os
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from sweep import command, differences, run, run_whole, unreadable, write_config

MOMENTS = int(os.environ.get("QTRACE_MOMENTS", "20"))
SEED = 11
SIZE_MB = 24


def fill(file: Path) -> None:
    """Takes all that is left."""
    with contextlib.suppress(OSError), file.open("wb", buffering=0) as stream:
        block = 1 << 20
        while block >= 512:
            try:
                stream.write(bytes(block))
            except OSError:
                block //= 2


class DiskTest(unittest.TestCase):
    def test_full_at_random_moments(self) -> None:
        with tempfile.TemporaryDirectory(prefix="qtrace-disk-") as name:
            subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SIZE_MB}m", "qtrace-test", name], check=True)
            try:
                self.fill_at_random_moments(Path(name))
            finally:
                subprocess.run(["umount", "-l", name], check=True)

    def fill_at_random_moments(self, folder: Path) -> None:
        whole_s = run_whole(folder)
        moments = random.Random(SEED)
        filled = sweeps = 0
        while filled < MOMENTS:
            sweeps += 1
            write_config(folder, "full")
            while True:
                process = subprocess.Popen(command("full"), cwd=folder, stdout=subprocess.DEVNULL,
                                           stderr=subprocess.PIPE, text=True)
                try:
                    process.wait(moments.uniform(0.3, whole_s * 0.6))
                    self.assertEqual(process.returncode, 0, process.communicate()[1])
                    break
                except subprocess.TimeoutExpired:
                    pass
                fill(folder / "filler")
                message = process.communicate()[1]
                (folder / "filler").unlink()
                if process.returncode == 0:
                    break  # it had nothing left to write
                filled += 1
                self.assertEqual(process.returncode, 1, message)
                self.assertRegex(message, "the disk is full|are free: make room", message)
                self.assertEqual(unreadable(folder / "results/full"), [])
            self.assertEqual(differences(folder / "results/whole", folder / "results/full"), [])
            subprocess.run(["rm", "-r", str(folder / "results/full")], check=True)
        print(f"{filled} moments in {sweeps} sweeps")

    def test_a_sweep_that_cannot_fit_is_refused_before_it_begins(self) -> None:
        with tempfile.TemporaryDirectory(prefix="qtrace-disk-") as name:
            subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "qtrace-test", name], check=True)
            try:
                write_config(Path(name), "large")
                done = run(Path(name), "large")
                self.assertEqual(done.returncode, 1)
                self.assertRegex(done.stderr, "what is left to do needs up to .* and .* are free: make room")
                self.assertEqual(list(Path(name).rglob("*.exr")), [])
            finally:
                subprocess.run(["umount", "-l", name], check=True)


if __name__ == "__main__":
    # Mounting takes root, or a name space of one's own.
    if os.geteuid() != 0 and "QTRACE_UNSHARED" not in os.environ:
        os.environ["QTRACE_UNSHARED"] = "1"
        os.execvp("unshare", ["unshare", "--map-root-user", "--mount", sys.executable, *sys.argv])
    unittest.main()
