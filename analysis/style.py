"""How curves look: told apart by colour, by marker and, from the ninth on, by their dashes; and logarithmic axes."""

from __future__ import annotations

from typing import Any, Iterable

from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

# Okabe and Ito 2008, "Color Universal Design"; dark and distant ones first, as yellow is faint on white.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#F0E442"]
MARKERS = ["o", "s", "^", "D", "v", "<", ">", "p", "P", "X", "h"]
DASHES = ["-", (0, (6, 2)), (0, (4, 1.5, 1, 1.5)), (0, (1, 1.5))]
FLOOR = {"color": "0.35", "linestyle": (0, (2, 2)), "linewidth": 1.2}

RC = {
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "0.9",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.6,
    "lines.markersize": 5.5,
    "pdf.fonttype": 42,      # text stays text in print
    "svg.fonttype": "none",
    "svg.hashsalt": "qtrace",  # the same data give the same file
}


def line_styles(labels: Iterable[str]) -> dict[str, dict[str, Any]]:
    """One style per label, the same in all panels. 8 colours, 11 markers and 4 dashes do not repeat together
    before the 353rd label."""
    return {label: {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)],
                    "linestyle": DASHES[i // len(COLOURS) % len(DASHES)]}
            for i, label in enumerate(dict.fromkeys(labels))}


def format_log_axis(axis: Axis, low: float, high: float) -> None:
    """Plain numbers; 1, 2, 5 as ticks where whole decades would be too few to read values from."""
    steps = (1, 2, 5) if high / low < 1000 else (1,)
    axis.set_major_locator(LogLocator(10, subs=steps, numticks=12))
    axis.set_minor_locator(NullLocator() if len(steps) > 1 else LogLocator(10, subs=range(2, 10), numticks=12))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(FuncFormatter(lambda *_: ""))
