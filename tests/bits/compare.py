"""Whether two programs render the same bits: ./dev bits OLD NEW [CONFIG...]. Every config is run at reduced size with
both, and every channel of every image and every saved table is compared. What names a program or a time may differ."""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from analysis.exr import read_exr  # noqa: E402

TOO_LARGE = ("stability_large",)  # its scene is made by ./dev stability
MOST = {"width": 64, "height": 64, "frames": 8, "seed": 1}


def reduced(value: object, key: str, folder: Path) -> object:
    """A config's value as it is run here: few pixels, frames and one seed, in the sweep as well; paths of `folder`."""
    if isinstance(value, dict):
        return {name: reduced(item, name, folder) for name, item in value.items()}
    key = key.rsplit(".", 1)[-1]
    if key in MOST:
        return [MOST[key]] if isinstance(value, list) else min(value, MOST[key])
    if key == "snapshots" and value != []:
        return "powers_of_two"
    if isinstance(value, list):
        return [reduced(item, key, folder) for item in value]
    if isinstance(value, str) and value.endswith((".glb", ".json")):
        return str(folder / value)
    return value


def write_reduced(config: Path, to: Path) -> Path:
    text = re.sub(r"^\s*//.*$", "", config.read_text(encoding="utf-8"), flags=re.MULTILINE)
    to.write_text(json.dumps(reduced(json.loads(text), "", config.resolve().parent)), encoding="utf-8")
    return to


def render(program: Path, config: Path, out: Path) -> str:
    """What went wrong, empty if nothing: a run whose verdict is `fail` (exit code 1, images there) is none."""
    command = [str(program), "run", str(config), "--out", str(out), "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace")
    if done.returncode in (0, 1) and any(out.rglob("*.exr")):
        return ""
    return f"{program} exits with {done.returncode}: {done.stderr.strip()[-400:]}"


def files_of(folder: Path) -> set[Path]:
    """Images and tables, by their names; a reference's holds a hash, which is the same for the same settings."""
    return {file.relative_to(folder) for kind in ("*.exr", "*.npy") for file in folder.rglob(kind)}


def difference(old: Path, new: Path) -> str:
    """In words, empty where the bits are the same."""
    if old.suffix == ".npy":
        return "" if old.read_bytes() == new.read_bytes() else "differs"
    a, b = read_exr(old).channels, read_exr(new).channels
    if a.keys() != b.keys():
        return f"has channels {', '.join(sorted(a))} and {', '.join(sorted(b))}"
    unlike = [name for name in sorted(a) if a[name].shape != b[name].shape or a[name].tobytes() != b[name].tobytes()]
    return f"differs in {', '.join(unlike)}" if unlike else ""


def compare(programs: tuple[Path, Path], config: Path) -> list[str]:
    """Prints a line; returns what differs."""
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="qtrace-bits-") as name:
        folders = Path(name) / "old", Path(name) / "new"
        small = write_reduced(config, Path(name) / config.name)
        faults = [fault for program, folder in zip(programs, folders) if (fault := render(program, small, folder))]
        old, new = map(files_of, folders)
        if not faults:
            faults = [f"{file} is of one program alone" for file in sorted(old ^ new)]
            faults += [f"{file} {unlike}" for file in sorted(old & new)
                       if (unlike := difference(folders[0] / file, folders[1] / file))]
        images = sum(file.suffix == ".exr" for file in old & new)
        tables = len(old & new) - images
    print(f"{config.stem}: {images} images, {tables} tables, {time.monotonic() - start:.0f} s: "
          f"{'differ' if faults else 'same bits'}", flush=True)
    for fault in faults[:10]:
        print(f"  {fault}", flush=True)
    return faults


def main() -> int:
    parser = argparse.ArgumentParser(prog="./dev bits", description=__doc__)
    parser.add_argument("old", type=Path, help="the program as it was")
    parser.add_argument("new", type=Path, help="the program as it is")
    parser.add_argument("configs", type=Path, nargs="*", help="all of configs/ if none is given")
    parser.add_argument("--skip", action="append", default=[], metavar="NAME", help="a config to leave out")
    arguments = parser.parse_args()
    configs = arguments.configs or sorted((ROOT / "configs").glob("*.json"))
    skipped = {*arguments.skip, *(() if arguments.configs else TOO_LARGE)}
    programs = arguments.old.resolve(), arguments.new.resolve()
    unlike = [config.stem for config in configs if config.stem not in skipped and compare(programs, config)]
    print("every bit is the same" if not unlike else f"not the same: {', '.join(unlike)}")
    return 1 if unlike else 0


if __name__ == "__main__":
    sys.exit(main())
