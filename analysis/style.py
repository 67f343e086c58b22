"""How curves look: told apart by colour, by marker and, from the ninth on, by their dashes; and logarithmic axes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Iterable

from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

# Okabe and Ito 2008, "Color Universal Design"; dark and distant ones first, as yellow is faint on white.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#F0E442"]
MARKERS = ["o", "s", "^", "D", "v", "<", ">", "p", "P", "X", "h"]
DASHES = ["-", (0, (6, 2)), (0, (4, 1.5, 1, 1.5)), (0, (1, 1.5))]
FLOOR = {"color": "0.35", "linestyle": (0, (2, 2)), "linewidth": 1.0}

# Of logarithmic axes, here and on the report page.
FLOOR_REACH = 100  # a floor this much below all curves is named rather than drawn, to leave them room
BAND_REACH = 4     # bands may widen the axis by this factor; few seeds can give bands of many decades

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

# For paper: a serif face like the text's, thin lines; every glyph in the file itself.
PRINT_RC = {
    **RC,
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.linewidth": 0.6,
    "axes.labelpad": 2,
    "grid.linewidth": 0.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.pad": 2,
    "ytick.major.pad": 2,
    "legend.fontsize": 7.5,
    "lines.linewidth": 1.1,
    "lines.markersize": 3.6,
    "svg.fonttype": "path",
}


@dataclass(frozen=True)
class Look:
    """Where a figure is to be seen."""

    rc: dict[str, Any]
    width: float       # inches
    row_height: float  # of a row of panels
    line_height: float  # of one line where configurations are listed
    note_size: float
    words: bool        # title and caption inside the figure: a paper sets its own


SCREEN = Look(RC, 11.0, 3.7, 0.3, 8.5, True)
NARROW = Look(RC, 7.5, 3.7, 0.3, 8.5, True)  # for one panel
COLUMN = Look(PRINT_RC, 3.33, 2.1, 0.145, 7, False)  # of two, as ACM's and IEEE's papers have
PAGE = Look(PRINT_RC, 7.0, 2.1, 0.145, 7, False)     # both columns


@dataclass(frozen=True)
class Medium:
    """What figures are made for: the look of those that take the whole width, and of those that a column can hold."""

    page: Look
    column: Look

    @property
    def is_print(self) -> bool:
        return not self.page.words


ON_SCREEN = Medium(SCREEN, NARROW)
IN_PRINT = Medium(PAGE, COLUMN)


def line_styles(labels: Iterable[str]) -> dict[str, dict[str, Any]]:
    """One style per label, the same in all panels. 8 colours, 11 markers and 4 dashes do not repeat together
    before the 353rd label."""
    return {label: {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)],
                    "linestyle": DASHES[i // len(COLOURS) % len(DASHES)]}
            for i, label in enumerate(dict.fromkeys(labels))}


def format_log_axis(axis: Axis, low: float, high: float) -> None:
    """Plain numbers; 1, 2, 5 or more as ticks where whole decades would be too few to read values from."""
    steps = (1, 1.5, 2, 3, 4, 5, 6, 8) if high / low < 10 else (1, 2, 5) if high / low < 1000 else (1,)
    axis.set_major_locator(LogLocator(10, subs=steps, numticks=12))
    axis.set_minor_locator(NullLocator() if len(steps) > 1 else LogLocator(10, subs=range(2, 10), numticks=12))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(FuncFormatter(lambda *_: ""))


def legend_below(figure: Figure, entries: list, look: Look) -> float:
    """As few rows as fit; the figure grows by the legend's height, keeps its width, and the share that the legend
    takes of the new height is handed back. For a figure with constrained layout."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    for rows in range(1, len(entries) + 1):
        legend = figure.legend(handles=entries, loc="lower center", ncol=math.ceil(len(entries) / rows), frameon=False,
                               handlelength=2.6, columnspacing=1.4, borderpad=0.2, borderaxespad=0.1)
        size = legend.get_window_extent(renderer)
        if size.width / figure.dpi <= look.width or rows == len(entries):
            break
        legend.remove()
    height = figure.get_figheight() + size.height / figure.dpi
    share = size.height / figure.dpi / height
    figure.set_figheight(height)
    figure.get_layout_engine().set(rect=(0, share, 1, 1 - share))
    return share


def fix_layout(figure: Figure, share: float = 0) -> None:
    """Lays out once, as each drawing would move everything a little: all formats shall agree. The caption is moved
    above a legend that takes `share` of the height, which the layout does not do."""
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    if figure._supxlabel is not None:
        figure._supxlabel.set_y(figure._supxlabel.get_position()[1] + share)
