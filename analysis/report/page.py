"""Puts the page together: one file of HTML with its style, its programs and its data inside."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from analysis import style
from analysis.report import curves, findings, table
from analysis.report.sweep import Sweep

ASSETS = Path(__file__).parent / "assets"
STYLES = ["base.css", "findings.css", "table.css", "plot.css"]
PROGRAMS = ["tip.js", "theme.js", "sort.js", "plot.js", "points.js", "legend.js", "curves.js"]


def _joined(names: list[str]) -> str:
    return "\n".join((ASSETS / name).read_text(encoding="utf-8") for name in names)


def _colours() -> list[str]:
    """Those of the figures; black turns white where the page is dark."""
    return [f"light-dark({colour}, #FFFFFF)" if colour == "#000000" else colour for colour in style.COLOURS]


def _as_script(value: Any) -> str:
    """JSON that no end tag inside can end."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _data(sweep: Sweep) -> dict[str, Any]:
    """What the page's programs read."""
    points = curves.curves(sweep)
    labels = list(dict.fromkeys(cell["label"] for cell in sweep.cells))
    return {"scenes": sweep.scenes, "labels": labels,
            "cells": [{"cell": cell["cell"], "scene": cell["scene"], "label": cell["label"]} for cell in sweep.cells],
            "metrics": curves.metric_names(list(points)), "curves": points, "floors": curves.floors(sweep)}


def _lead(sweep: Sweep) -> str:
    device = (sweep.manifest.get("device") or {}).get("renderer", "unknown device")
    finished = sum(row["status"] == "finished" for row in sweep.summary)
    text = f"{finished} of {len(sweep.planned)} runs finished, {len(sweep.cells)} cells, on {device}"
    ended = sweep.manifest.get("ended")
    return f"{text}; ended {str(ended).replace('T', ' ').rstrip('Z')} UTC" if ended else text


def render(sweep: Sweep) -> str:
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(ASSETS), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    found = findings.findings(sweep)
    counts = {level: sum(finding.level == level for finding in found) for level in ("failed", "flagged", "noted")}
    sections = {"findings": "What to know first"}
    main = table.main_table(sweep)
    if main.rows:
        sections |= {"table": "Time and error", "curves": "Convergence"}
    program = f'"use strict";\n(() => {{\n{_joined(PROGRAMS)}\n}})();'
    return environment.get_template("page.html").render(
        sweep=sweep, lead=_lead(sweep), found=found, counts=counts, sections=sections, main_table=main,
        css=Markup(_joined(STYLES)), js=Markup(program), colours=_colours(),
        data=Markup(_as_script(_data(sweep)))).lstrip()
