"""How every configuration compares with the config's baseline: a line per scene, a point per method, from `ratios.csv`. At
the left the baseline's relMSE over the configuration's after as many samples, in the middle the same after as many seconds,
at the right how much sooner the configuration has the MSE that the baseline ends with. Right of 1 it is better. Results of
programs that did not compare errors after equal seconds have relMSE × seconds in the middle, which is the same for errors
that fall as 1/seconds."""

from __future__ import annotations

from typing import Iterator

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis import style
from analysis.command import MissingError, check_one_of
from analysis.kinds.request import Drawing, Request
from analysis.load import Results

AT_EQUAL_SECONDS = "ratio_equal_s_relmse_corrected"
PANELS = {"ratio_relmse": "relMSE at equal samples", AT_EQUAL_SECONDS: "relMSE at equal seconds (learning included)",
          "ratio_time_to_mse": "time to the baseline's MSE"}
EARLIER = {"ratio_relmse_x_s": "relMSE × s (learning included)"}  # in place of AT_EQUAL_SECONDS
SPREAD = 0.5  # of a scene's line, over which its methods are laid out


def panels(gains: pd.DataFrame) -> dict[str, str]:
    """Columns that are drawn, and what they are called."""
    if AT_EQUAL_SECONDS in gains:
        return PANELS
    left, _, right = PANELS.items()
    return dict([left, *EARLIER.items(), right])


def read_gains(results: Results, methods: list[str]) -> pd.DataFrame:
    """The rows of ratios.csv with their `method`, and the scene as the sweep calls it, which may be a label. `methods`:
    which; empty: all."""
    ratios = results.ratios
    missing = [f"{column}{end}" for column in panels(ratios) for end in ("", "_low", "_high") if f"{column}{end}" not in ratios]
    if missing:
        raise MissingError(f"{results.folder}: its ratios.csv has no column '{missing[0]}'")
    summary = results.summary
    called = dict(zip(summary.configuration, summary["axis:scene"])) if "axis:scene" in summary else {}
    gains = ratios.assign(method=ratios.label, scene=ratios.configuration.map(called).fillna(ratios.scene))
    for method in methods:
        check_one_of("method", method, list(dict.fromkeys(gains.method)))
    return gains[gains.method.isin(methods)] if methods else gains


def _draw(axes: Axes, gains: pd.DataFrame, column: str) -> None:
    scenes, methods = (list(dict.fromkeys(gains[key])) for key in ("scene", "method"))
    looks = style.line_styles(methods)
    axes.axvline(1, **style.FLOOR)
    for place, method in enumerate(methods):
        own = gains[(gains.method == method) & (gains[column] > 0)]
        lines = [scenes.index(scene) + SPREAD * ((place + 0.5) / len(methods) - 0.5) for scene in own.scene]
        low, high = (own[f"{column}_{end}"].fillna(own[column]) for end in ("low", "high"))
        axes.errorbar(own[column], lines, xerr=np.array([own[column] - low, high - own[column]]), capsize=2.5, elinewidth=1,
                      label=method, **{**looks[method], "linestyle": "none"})
    axes.set_xscale("log")
    values = gains[[column, f"{column}_low", f"{column}_high"]].to_numpy(float)
    values = values[np.isfinite(values) & (values > 0)]
    axes.set_xlim(min(values.min(initial=1), 1) / 1.15, max(values.max(initial=1), 1) * 1.15)
    style.format_log_axis(axes.xaxis, *axes.get_xlim())
    axes.grid(axis="y", visible=False)


def gain_figure(gains: pd.DataFrame, name: str, look: style.Look = style.SCREEN) -> Figure:
    scenes = list(dict.fromkeys(gains.scene))
    lines = len(scenes) * max(2, 0.6 * gains.method.nunique())
    with matplotlib.rc_context(look.rc):
        figure = Figure(figsize=(look.width, look.line_height * lines + 1.3), layout="constrained")
        if look.words:
            figure.suptitle(f"{name}: times better than {', '.join(sorted(set(gains.baseline_label)))}", fontsize=13)
            figure.supxlabel("Bars: 95 % confidence interval over seeds. No point: the baseline's MSE was never reached.",
                             fontsize=look.note_size, color="0.25")
        row = figure.subplots(1, len(PANELS), sharey=True)
        for axes, (column, label) in zip(row, panels(gains).items()):
            _draw(axes, gains, column)
            axes.set_xlabel(label)
        row[0].set_yticks(np.arange(len(scenes)), scenes)
        row[0].set_ylim(len(scenes) - 0.5, -0.5)  # the sweep's first scene on top
        share = style.legend_below(figure, row[0].get_legend_handles_labels()[0], look)
        style.fix_layout(figure, share)
    return figure


def draw(request: Request, medium: style.Medium) -> Iterator[Drawing]:
    gains = read_gains(request.results, request.methods)
    yield Drawing("gains", gain_figure(gains, request.results.name, medium.page))
