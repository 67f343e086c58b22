"""Pictures of Voronoi cells and learned hemispheres that `./dev inspect` has left in folders of runs."""

from __future__ import annotations

import base64
from dataclasses import dataclass

from analysis.report.sweep import Sweep

MOST = 12                  # pictures in a page
LARGEST_BYTES = 2_000_000  # of one


@dataclass(frozen=True)
class Inspection:
    run: str
    png: str  # base64


def saved_tables(sweep: Sweep) -> list[str]:
    """Runs that have left a table to inspect."""
    return [row["run"] for row in sweep.summary if next((sweep.folder / row["run"]).glob("q_values_*.npy"), None)]


def inspections(sweep: Sweep) -> tuple[list[Inspection], str]:
    """And one sentence about those that were left out, or an empty one."""
    files = [(row["run"], sweep.folder / row["run"] / "inspect" / "inspect.png") for row in sweep.summary]
    there = [(run, file) for run, file in files if file.is_file()]
    fitting = [(run, file) for run, file in there if file.stat().st_size <= LARGEST_BYTES][:MOST]
    left_out = len(there) - len(fitting)
    note = (f"{left_out} more {'is' if left_out == 1 else 'are'} in the runs' folders (inspect/inspect.png): a page has at most "
            f"{MOST} of 2 MB.") if left_out else ""
    return [Inspection(run, base64.b64encode(file.read_bytes()).decode()) for run, file in fitting], note
