"""The table of the comparison with the independent tracer, as a Markdown file that grows."""

from __future__ import annotations

import os
from pathlib import Path

SCENES = ["simple", "occluded", "cornell_box", "many_lights", "furnace", "door_ajar", "glossy_room", "open_sky",
          "sunlit_bath", "lamp_in_fixture", "corridor", "glossy"]
# What tests/slow/independent_test.cpp prints, and the commit.
COLUMNS = ["scene", "sampler", "nee", "χ² per pixel", "χ² of blocks", "mean ratio", "frames", "samples", "verdict",
           "commit"]
DEVICE = "Measured on "
HEAD = """# Beside the independent tracer

Every shipped scene (and `glossy`, the Cornell box in metal and plastic), sampler and kind of next event estimation,
compared with the path tracer of `tests/independent`, which shares no code with the renderer. χ² is that of the
difference and its variance, 1 if both show the same: per pixel, and of the means of blocks of 4 × 4. The mean ratio is
that of the two images. All with one standard error. `frames` are the renderer's samples per pixel, `samples` the
independent tracer's: as many as it takes for 0.1 % of the mean, or the most that are spent, where the error says what
was reached. "agrees": χ² per pixel within 0.9 to 1.1, the mean within three standard errors, and all three figures
within what chance makes of true ones but once in 10,000 comparisons; where the mean is known to less than 0.1 %, to what.
The methods of a scene share the independent tracer's image. Left out are door_ajar without next event estimation, where
chance finds the lamp too rarely to tell anything, and glossy_room with the uniform sampler, whose directions miss its
narrow lobes. `./dev independent` makes it again, `./dev independent SCENE` one scene. Of a file of one's own, which
`./dev independent FILE.glb` compares, the methods are those with next event estimation by one ray, without `uniform`.
"""


class Table:
    """Rows of `file`, in the order of SCENES, and then those of other files. Throws ValueError where the file is not such a table."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self._device = ""
        self._rows: list[list[str]] = []
        if not file.exists():
            return
        lines = file.read_text(encoding="utf-8").splitlines()
        rows = [self._cells(line) for line in lines if line.startswith("| ")]
        if not rows or rows[0] != COLUMNS or any(len(row) != len(COLUMNS) for row in rows[1:]):
            raise ValueError(f"{file} is not a table of this comparison; move it away")
        self._rows = rows[1:]
        self._device = next((line.removeprefix(DEVICE).rstrip(".") for line in lines if line.startswith(DEVICE)), "")

    @property
    def device(self) -> str:
        return self._device

    @device.setter
    def device(self, name: str) -> None:
        if self._device not in ("", name):
            raise ValueError(f"{self.file} was measured on {self._device}, but this is {name}; move it away, or choose "
                             "another folder with --out")
        self._device = name

    def forget(self, scene: str) -> None:
        """Only in memory: the file keeps a scene's rows until the first new one is there."""
        self._rows = [row for row in self._rows if row[0] != scene]

    def add(self, line: str, commit: str) -> None:
        row = [*self._cells(line), commit]
        if len(row) != len(COLUMNS):
            raise ValueError(f"the row has {len(row) - 1} cells, not {len(COLUMNS) - 1}: {line}")
        self._rows.append(row)
        # Stable: methods stay in their order.
        self._rows.sort(key=lambda r: (SCENES.index(r[0]), "") if r[0] in SCENES else (len(SCENES), r[0]))
        self._write()

    @staticmethod
    def _cells(line: str) -> list[str]:
        return [cell.strip() for cell in line.strip().strip("|").split("|")]

    def _write(self) -> None:
        lines = [HEAD, f"{DEVICE}{self._device}.", "",
                 f"| {' | '.join(COLUMNS)} |", "|---|---|---|---|---|---|--:|--:|---|---|"]
        lines += [f"| {' | '.join(row)} |" for row in self._rows]
        self.file.parent.mkdir(parents=True, exist_ok=True)
        new = self.file.with_suffix(".md.new")
        new.write_text("\n".join(lines) + "\n", encoding="utf-8")
        os.replace(new, self.file)
