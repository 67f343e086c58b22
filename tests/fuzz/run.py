#!/usr/bin/python3
"""Feeds the config reader, the glTF loader, the decoders of images and the reader of Radiance's pictures with bytes that
libFuzzer makes up, and the importer with scenes that import_fuzz.py does.

    ./dev fuzz [SECONDS] [--only config|gltf|image|hdr|import] [--corpus FOLDER] [--seed N]

SECONDS for each of them (60). They start from the shipped configs and scenes and from tests/fuzz/corpus. Exit code 1
where one crashes, hangs, leaks, takes more than 512 MB at once or 1 GB in all (the importer: 1 GB, or 10 s), or answers
with anything but a result or a clear error; the input that made it do so is kept in build/fuzz/findings. --corpus keeps
what was learned for another time.
"""

from __future__ import annotations

import argparse
import base64
import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from collections import deque
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FINDINGS = ROOT / "build/fuzz/findings"
QTRACE = ROOT / "build/release/qtrace"
LARGEST_SCENE = 20_000  # bytes; larger ones teach the loader nothing new and slow each try
LIMITS = ["-rss_limit_mb=1024", "-malloc_limit_mb=512", "-timeout=5", "-max_len=65536"]
# What libFuzzer writes once in a while, and at the end: tries, code reached, memory, speed.
PROGRESS = re.compile(r"^(#\d+\s+(INITED|pulse|DONE)|stat::)")
SHOWN_OF_A_FINDING = 100  # lines


def as_gltf(glb: bytes) -> bytes:
    """A .glb as a .gltf with its binary chunk in a data URI."""
    size = struct.unpack_from("<I", glb, 12)[0]
    document = json.loads(glb[20:20 + size])
    binary = glb[28 + size:]
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    return json.dumps(document, separators=(",", ":")).encode()


def key_rows() -> list[list[str]]:
    """Key, type, default and more, as `qtrace keys` prints them."""
    listing = subprocess.run([QTRACE, "keys"], capture_output=True, text=True, check=True).stdout
    return [re.split(r"\s{2,}", line) for line in listing.splitlines()[1:]]


def config_seeds() -> dict[str, bytes]:
    seeds = {file.name: file.read_bytes() for file in sorted(ROOT.glob("configs/*.json"))}
    defaults = {key: json.loads(default) for key, _, default, *_ in key_rows()}
    named = defaults | {"name": "defaults", "scene": "a.glb", "published.ms_per_frame": {"all": 1}}
    return seeds | {"defaults.json": json.dumps(named).encode()}


def gltf_seeds() -> dict[str, bytes]:
    seeds = {}
    for file in sorted(ROOT.glob("configs/scenes/**/*.glb")):
        glb = file.read_bytes()
        if len(glb) <= LARGEST_SCENE:
            seeds[file.name] = glb
            seeds[file.stem + ".gltf"] = as_gltf(glb)
    return seeds


def hdr_seeds() -> dict[str, bytes]:
    """A row of each kind of encoding."""
    header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\nCOLORCORR=1 2 3\n\n-Y 2 +X 9\n"
    plain, runs = bytes((5, 6, 7, 136)) * 9, bytes((2, 2, 0, 9, 137, 5, 5, 1, 2, 3, 4, 5, 132, 6, 137, 7, 137, 136))
    return {"plain": header + plain * 2, "runs": header + runs * 2, "older": header + (plain[:4] + bytes((1, 1, 1, 8))) * 2}


def config_words() -> set[str]:
    """Keys, their last parts, and the words that values may be."""
    words = set()
    for key, kind, *_ in key_rows():
        words |= {key, key.split(".")[-1]}
        if kind.startswith("one of "):
            words |= set(kind.removeprefix("one of ").split(", "))
    return words | {"powers_of_two", "ms_per_frame"}


def gltf_words() -> set[str]:
    """The properties that the loader reads, and the words that their values may be."""
    rules = (ROOT / "engine/gltf_document/rules.h").read_text()
    words = set()
    for text in re.findall(r'"([^"\n]+)"', rules):
        words |= set(re.split(r"[/! ]+", text)) - {"", "[]", "{}"}
    return words | {"asset", "version", "2.0", "POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0", "sparse", "extras",
                    "data:application/octet-stream;base64,", "data:application/gltf-buffer;base64,"}


def image_words() -> set[str]:
    """The chunks of PNG that count; the markers of JPEG are no text."""
    return {"IHDR", "PLTE", "IDAT", "IEND", "tRNS", "JFIF", "Adobe"}


def hdr_words() -> set[str]:
    return {"#?RADIANCE", "FORMAT=32-bit_rle_rgbe", "EXPOSURE=", "COLORCORR=", "-Y ", "+X "}


SEEDS = {"config": config_seeds, "gltf": gltf_seeds, "image": dict, "hdr": hdr_seeds}
WORDS = {"config": config_words, "gltf": gltf_words, "image": image_words, "hdr": hdr_words}


def prepare(target: str, corpus: Path, dictionary: Path) -> None:
    corpus.mkdir(parents=True, exist_ok=True)
    for name, content in SEEDS[target]().items():
        (corpus / name).write_bytes(content)
    for file in (ROOT / "tests/fuzz/corpus" / target).glob("*"):
        shutil.copy(file, corpus / file.name)
    quoted = sorted(json.dumps(word) for word in WORDS[target]())
    dictionary.write_text("".join(f"{word}\n" for word in quoted))


def fuzz(target: str, options: argparse.Namespace, folder: Path) -> bool:
    corpus = Path(options.corpus, target) if options.corpus else folder / target
    dictionary = folder / f"{target}.dict"
    prepare(target, corpus, dictionary)
    FINDINGS.mkdir(parents=True, exist_ok=True)
    print(f"fuzz: {target}: {options.seconds} s from {len(list(corpus.iterdir()))} inputs", flush=True)
    command = [ROOT / f"build/fuzz/tests/fuzz/qtrace_{target}_fuzz", corpus, f"-dict={dictionary}", *LIMITS,
               f"-max_total_time={options.seconds}", f"-seed={options.seed}", "-print_final_stats=1",
               f"-artifact_prefix={FINDINGS}/{target}-"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          errors="replace") as process:
        last = deque(maxlen=SHOWN_OF_A_FINDING)
        for line in process.stderr:
            last.append(line)
            if PROGRESS.search(line):
                print(f"fuzz: {target}: {line}", end="", flush=True)
    if process.returncode != 0:
        print("".join(last), end="", flush=True)
    return process.returncode == 0


def fuzz_import(options: argparse.Namespace) -> bool:
    """Needs no build: the importer is Python, and so is what makes up its scenes."""
    corpus = ["--corpus", Path(options.corpus, "import")] if options.corpus else []
    command = [sys.executable, ROOT / "tests/fuzz/import_fuzz.py", str(options.seconds), "--seed", str(options.seed),
               "--findings", FINDINGS / "import", *corpus]
    return subprocess.run(command).returncode == 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seconds", metavar="SECONDS", nargs="?", type=int, default=60)
    parser.add_argument("--only", choices=[*sorted(SEEDS), "import"])
    parser.add_argument("--corpus", help="folder that inputs are kept in and read from")
    parser.add_argument("--seed", type=int, default=0, help="of the random numbers; 0: another one each time")
    options = parser.parse_args()
    targets = [options.only] if options.only else [*sorted(SEEDS), "import"]
    with tempfile.TemporaryDirectory() as folder:
        passed = [fuzz_import(options) if target == "import" else fuzz(target, options, Path(folder)) for target in targets]
    return 0 if all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())
