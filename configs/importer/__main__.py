"""Reads a scene of Mitsuba or pbrt and writes a .glb, a config beside it, and an image of its sky where it has one."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator

import numpy as np

from importer.output.config import config_of, write_config
from importer.output.glb import Totals, write_glb
from importer.output.inputs import Inputs, format_of
from importer.output.sky import write_sky
from importer.output.terminal import one_line, progress, report
from importer.output.world import world_of
from importer.problems import ImportProblem, Notes
from importer.scene import Scene


def _definition(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not (name and equals):
        raise argparse.ArgumentTypeError(f"{text} is no definition; NAME=VALUE would be right")
    return name, value


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./dev import", description=__doc__, epilog="docs/importing.md says more.")
    parser.add_argument("scene", type=Path, metavar="SCENE", help="Mitsuba XML (0.5, 0.6, 3) or pbrt (v3, v4)")
    parser.add_argument("out", type=Path, metavar="OUT.glb",
                        help="the scene; OUT.json beside it is the config, OUT_sky.exr the image of the sky")
    parser.add_argument("--lenient", action="store_true",
                        help="leave out what has no meaning here, such as hair and media, instead of refusing the scene")
    parser.add_argument("--define", type=_definition, action="append", default=[], metavar="NAME=VALUE",
                        help="a value for $NAME in Mitsuba's XML; more than once for several")
    parser.add_argument("--force", action="store_true", help="write over files that are there")
    options = parser.parse_args(arguments)
    if options.out.suffix != ".glb":
        parser.error(f"OUT.glb is {options.out}; a name that ends in .glb would be right")
    return options


def _read(options: argparse.Namespace, format_name: str, notes: Notes) -> Scene:
    """Each format's reader is loaded where it is needed."""
    if format_name == "Mitsuba":
        from importer.mitsuba.read import read_mitsuba
        return read_mitsuba(options.scene, notes, dict(options.define))
    if options.define:
        raise ImportProblem(f"{options.scene}: --define is for Mitsuba's XML, and this is pbrt; leave it out")
    from importer.pbrt.read import read_pbrt
    return read_pbrt(options.scene, notes)


class Outputs:
    """The three files beside each other."""

    def __init__(self, out: Path, may_replace: bool) -> None:
        self.glb, self.config = out, out.with_suffix(".json")
        self.sky = out.with_name(f"{out.stem}_sky.exr")
        self._may_replace = may_replace

    def check(self, *files: Path) -> None:
        for file in files:
            if file.is_dir():
                raise ImportProblem(f"{file}: it is a folder; another name would be right")
            if file.exists() and not self._may_replace:
                raise ImportProblem(f"{file}: it is there already; --force writes over it")
        if not self.glb.parent.is_dir():
            raise ImportProblem(f"{self.glb.parent}: there is no such folder to write to; make it first")

    def move_from(self, folder: Path) -> list[Path]:
        """The config comes last, so that whatever it names is there."""
        files = [file for file in (self.sky, self.glb, self.config) if (folder / file.name).exists()]
        self.check(*files)
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
        try:  # all of them, once it has begun
            for file in files:
                os.replace(folder / file.name, file)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        return files

    @contextmanager
    def prepared(self) -> Iterator[Path]:
        """A folder beside them, to write into first; whatever goes wrong there went wrong with theirs."""
        folder = self.glb.parent
        try:
            with tempfile.TemporaryDirectory(prefix=".import_", dir=folder) as temporary:
                yield Path(temporary)
        except OSError as error:
            raise ImportProblem(f"{folder}: the files cannot be written there ({error.strerror or error})") from error


def _write(scene: Scene, outputs: Outputs, notes: Notes, source: dict) -> tuple[Totals, dict, list[Path]]:
    """Whole or not at all: in a folder beside the others first. The .glb says what was noted of the rest, too."""
    with outputs.prepared() as folder:
        environment = write_sky(scene.sky, world_of(scene), folder / outputs.sky.name, outputs.sky.name, notes)
        config = config_of(scene, outputs.glb.name, environment, notes)
        write_config(config, folder / outputs.config.name, source["file"])
        totals = write_glb(scene, folder / outputs.glb.name, notes, source)
        return totals, config, outputs.move_from(folder)


def _check_names(*files: Path) -> None:
    """The .glb and the config name the files, and both are text in UTF-8."""
    for file in files:
        try:
            file.name.encode()
        except UnicodeEncodeError as error:
            raise ImportProblem(f"{file}: its name is no UTF-8; a name that is would be right") from error


def run(options: argparse.Namespace) -> None:
    start = time.monotonic()
    _check_names(options.scene, options.out)
    notes, outputs = Notes(options.lenient), Outputs(options.out, options.force)
    outputs.check(outputs.glb, outputs.config)
    format_name = format_of(options.scene)
    with Inputs(options.scene) as inputs, progress(lambda: f"{len(inputs.files)} files, {inputs.latest}"):
        scene = _read(options, format_name, notes)
        source = inputs.describe(format_name, scene.source_version)
        totals, config, files = _write(scene, outputs, notes, source)
    print(report(totals, config, source, notes, time.monotonic() - start))
    print("\nwritten     " + one_line(", ".join(map(str, files))))


def main(arguments: list[str] | None = None) -> int:
    options = _options(arguments)
    try:
        with np.errstate(all="ignore"):  # what comes of numbers that are too large is checked where it is written
            run(options)
    except ImportProblem as problem:
        print(f"import: {one_line(str(problem))}", file=sys.stderr)
        return 1
    except BrokenPipeError:  # who reads the report has seen enough, and the files are there
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        print(one_line(f"import: {error.filename or options.out}: {error.strerror or error}"), file=sys.stderr)
        return 1
    except MemoryError:
        print(one_line(f"import: {options.scene}: it needs more memory than there is; a smaller scene would be right"),
              file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("import: stopped", file=sys.stderr)
        return 130  # of a program that SIGINT ends
    return 0


if __name__ == "__main__":
    if sys.stdout is not None:  # which may be closed
        sys.stdout.reconfigure(errors="backslashreplace")  # of terminals that do not know all letters
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # which leaves no more behind than SIGINT
    sys.exit(main())
