"""Puts the page together: one file of HTML with its style, its programs and its data inside."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import jinja2
import matplotlib
from markupsafe import Markup

from analysis import schema, style, tolerances
from analysis.report import curves, findings, learned, number, pictures, provenance, table
from analysis.report.pictures import Gallery
from analysis.report.sweep import Row, Sweep

ASSETS = Path(__file__).parent / "assets"
STYLES = ["base.css", "findings.css", "table.css", "plot.css", "viewer.css"]
PROGRAMS = ["tip.js", "theme.js", "sort.js", "plot.js", "points.js", "legend.js", "curves.js", "speed.js", "halves.js",
            "pane.js", "readout.js", "fireflies.js", "viewer.js", "viewer_input.js"]


def _joined(names: list[str]) -> str:
    return "\n".join((ASSETS / name).read_text(encoding="utf-8") for name in names)


def _colours() -> list[str]:
    """Those of the figures; black turns white where the page is dark."""
    return [f"light-dark({colour}, #FFFFFF)" if colour == "#000000" else colour for colour in style.COLOURS]


def _without_nan(value: Any) -> Any:
    """JSON has no number that is not finite: null instead."""
    if isinstance(value, dict):
        return {key: _without_nan(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_nan(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _as_script(value: Any) -> str:
    """JSON that no end tag inside can end."""
    text = json.dumps(_without_nan(value), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _magma() -> list[list[int]]:
    """The colours of the error maps, dark for small; even in lightness, so that no colour vision is needed."""
    return [[round(255 * part) for part in colour] for colour in matplotlib.colormaps["magma"].colors]


def _image_note(found: list[Gallery]) -> str:
    used = sum(p.size[0] * p.size[1] for gallery in found for p in gallery.pictures) * pictures.BYTES_PER_PIXEL / 1e6
    factor = max((gallery.factor for gallery in found), default=1)
    note = "Images are shown at their full size" if factor == 1 else (
        f"Images are reduced: each pixel is the mean of {factor} × {factor}, so errors of single pixels are smaller than the "
        "renders' and only the tables have the true ones")
    note += f". They take {number.short(str(used))} MB; at most {pictures.BOUND_MB} MB are put into a page."
    clipped = sum(p.clipped for gallery in found for p in gallery.pictures)
    return note + (f" {clipped} values beyond 65504, the largest half float, are cut to it." if clipped else "")


# Of configurations.csv, for the plot of speed against error.
TIMES = ("elapsed_s", "host_ms_median", "gpu_ms_median")


def _configuration_data(row: Row, figures: list[str]) -> dict[str, Any]:
    return {"configuration": row["configuration"], "scene": row["scene"], "label": row["label"],
            "floor": int(row.get("seeds_at_reference_floor") not in (None, "", "0")),
            "figures": {name: number.estimate(row, name) for name in figures if row.get(name)}}


def _data(sweep: Sweep, found: list[Gallery]) -> dict[str, Any]:
    """What the page's programs read."""
    points = curves.curves(sweep)
    labels = list(dict.fromkeys(row["label"] for row in sweep.configurations))
    metrics = curves.metric_names(sweep)
    times = {name: "seconds, learning included" if name == "elapsed_s" else sweep.metrics[name].label
             for name in TIMES if name in sweep.metrics}
    axes = {axis: {key: {"name": name} for key, name in names.items() if any(row.get(key) for row in sweep.configurations)}
            for axis, names in (("x", times), ("y", metrics))}
    return {"scenes": sweep.scenes, "labels": labels, "figures": axes,
            "configurations": [_configuration_data(row, [*axes["x"], *axes["y"]]) for row in sweep.configurations],
            "metrics": {name: metrics[name] for name in points}, "curves": points, "floors": curves.floors(sweep),
            "galleries": [pictures.gallery_data(gallery) for gallery in found], "magma": _magma(),
            "reach": {"band": style.BAND_REACH, "floor": style.FLOOR_REACH}}


def _lead(sweep: Sweep) -> str:
    device = (sweep.manifest.get("device") or {}).get("renderer", "unknown device")
    finished = sum(row["status"] == "finished" for row in sweep.summary)
    text = f"{finished} of {len(sweep.planned)} runs finished, {len(sweep.configurations)} configurations, on {device}"
    status = sweep.manifest.get("status", "finished")
    text += f"; status {status}" if status != "finished" else ""
    ended = sweep.manifest.get("ended")
    return f"{text}; ended {str(ended).replace('T', ' ').rstrip('Z')} UTC" if ended else text


def _published_ratios(sweep: Sweep) -> list[str]:
    """What summary.md says of the publication's ratios, word by word."""
    try:
        file = schema.file_of(sweep.folder, schema.schema_of(sweep.folder, sweep.manifest), "summary.md")
        lines = file.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return []
    return [line[2:] for line in lines if re.match(r"- .+ over .+: .+ × the host time per frame", line)]


def _sections(has_rows: bool, has_images: bool, has_learned: bool) -> dict[str, str]:
    """Titles by id, in the order of the page."""
    titles = {"findings": ("What to know first", True), "table": ("Time and error", has_rows),
              "curves": ("Convergence", has_rows), "speed": ("Speed against error", has_rows),
              "images": ("Images", has_images), "paths": ("Path statistics", has_rows),
              "learned": ("Cells and hemispheres", has_learned), "runs": ("All runs", True), "provenance": ("Provenance", True)}
    return {key: title for key, (title, is_there) in titles.items() if is_there}


def render(sweep: Sweep) -> str:
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(ASSETS), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    images = pictures.galleries(sweep)
    inspections, learned_note = learned.inspections(sweep)
    means_file = schema.file_of(sweep.folder, schema.schema_of(sweep.folder, sweep.manifest), "configurations.csv").name
    found = findings.findings(sweep)  # after all has been read, as what could not be is among them
    program = f'"use strict";\n(() => {{\n{_joined(PROGRAMS)}\n}})();'
    tables = learned.saved_tables(sweep)
    return environment.get_template("page.html").render(
        sweep=sweep, means_file=means_file, tolerances=tolerances, lead=_lead(sweep), found=found, outcome=findings.outcome(sweep, found), main_table=table.main_table(sweep),
        sections=_sections(bool(sweep.configurations), bool(images), bool(inspections or tables)), galleries=images,
        image_note=_image_note(images), magma=_magma(), path_table=table.path_table(sweep), figure_table=table.figure_table(sweep), inspections=inspections,
        learned_note=learned_note, saved_tables=tables, published_ratios=_published_ratios(sweep),
        ratio_table=table.ratio_table(sweep), one_seed=all(row["seeds"] == "1" for row in sweep.configurations),
        run_table=table.run_table(sweep), facts=provenance.facts(sweep),
        formulas=provenance.formulas(sweep), config=provenance.config_text(sweep), colours=_colours(),
        css=Markup(_joined(STYLES)), js=Markup(program), data=Markup(_as_script(_data(sweep, images)))).lstrip()
