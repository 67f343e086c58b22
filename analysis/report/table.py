"""The rows and columns of the page's tables."""

from __future__ import annotations

from typing import Iterable

from analysis import tolerances
from analysis.report import number
from analysis.report.fields import Column, Field, Table, figure, plain
from analysis.report.sweep import Row, Sweep


def total(rows: Iterable[Row], name: str) -> int:
    return sum(int(row[name]) for row in rows if row.get(name))


def _axes(sweep: Sweep) -> list[str]:
    """Those that tell the configurations of one scene apart, as in summary.md; the label where there are none."""
    axes = [name for name in next(iter(sweep.configurations), {}) if name.startswith("axis:") and name not in ("axis:scene", "axis:seed")]
    return axes or ["label"]


def _key_names(sweep: Sweep) -> list[str]:
    return (["scene"] if len(sweep.scenes) > 1 else []) + _axes(sweep)


def _key_columns(sweep: Sweep) -> list[Column]:
    return [Column(name.removeprefix("axis:"), "", False) for name in _key_names(sweep)]


def _key_fields(sweep: Sweep, row: Row) -> list[Field]:
    return [plain(row[name]) for name in _key_names(sweep)]


def _table(sweep: Sweep, columns: list[Column], rows: list[tuple[Row, list[Field]]]) -> Table:
    """With the keys of each configuration in front of its fields."""
    keys = _key_columns(sweep)
    return Table([*keys, *columns], [(row, [*_key_fields(sweep, row), *fields]) for row, fields in rows], len(keys) - 1)


def _has(sweep: Sweep, name: str) -> bool:
    return any(row.get(name) for row in sweep.configurations)


# Figures of configurations.csv that the main table has, with what is said of them; shown where some row has one.
FIGURES = {
    "host_ms_median": "Median over a run's frames by the host's clock, mean over seeds",
    "published": "What the publication that the config names has",
    "relmse": "At the last frame, mean over seeds",
    "filtered_relmse": "Of the filtered image",
    "elapsed_s": "Host time of all frames, learning included",
    "relmse_x_s": "Error times time, lower is better: what is left when both are taken together",
    "slope_relmse": "Of log relMSE against log spp; −1 where errors fall as 1/spp",
    "fireflies_per_million": "Samples brighter than firefly_multiple times their pixel's reference",
    "gpu_ms_median": "As host ms/frame, by the device's clock",
}
RATIOS = {
    "ratio_relmse_x_s": ("efficiency gain", "The baseline's relMSE × s divided by this configuration's; above 1, this one is better than the baseline"),
    "ratio_equal_s_relmse_corrected": ("gain at equal seconds", "The baseline's relMSE divided by this configuration's after the same seconds, those of whichever ends first, without the reference's noise; above 1, this one is better"),
    "ratio_time_to_relmse": ("time gain", "The baseline's time to its own final relMSE divided by this configuration's; – where it was never reached"),
}
STRIPS = ("host_ms_median", "relmse", "relmse_x_s")  # drawn on a scale besides


def slope_is_off(sweep: Sweep, row: Row, name: str) -> str:
    """'steep' or 'flat' where the interval of the slope lies beyond -1 by the tolerance; else ''. With Sobol' points steep
    is what is wanted."""
    _, low, high = number.estimate(row, name)
    if not low:
        return ""
    sobol = sweep.run_manifest(row["configuration"]).get("config", {}).get("random") == "sobol"
    return ("steep" if float(high) < -1 - tolerances.SLOPE and not sobol else
            "flat" if float(low) > -1 + tolerances.SLOPE else "")


def _figure_field(sweep: Sweep, row: Row, name: str) -> Field:
    if name == "published":
        value = (sweep.manifest.get("config", {}).get("published") or {}).get("ms_per_frame", {}).get(row["configuration"], "")
        return Field(number.short(str(value)), str(value))
    field = figure(sweep.ratios.get(row["configuration"], {}) if name in RATIOS else row, name)
    off = name.startswith("slope") and slope_is_off(sweep, row, name) != ""
    return Field(field.shown, field.value, field.low, field.high, off, _spread(sweep, row, name))


def _spread(sweep: Sweep, row: Row, name: str) -> str:
    """What a run's own frames spread over, where there is only one run to tell."""
    runs = sweep.members[row["configuration"]]
    clock = name.removesuffix("_ms_median")
    low, high = (runs[0].get(f"{clock}_ms_{end}", "") for end in ("p10", "p90")) if len(runs) == 1 else ("", "")
    return f"10th to 90th percentile of its frames: {low} to {high} ms" if name.endswith("_ms_median") and low else ""


def ratio_table(sweep: Sweep) -> Table:
    """All of ratios.csv that has an interval beside it, and its baselines."""
    names = [name for name in next(iter(sweep.ratios.values()), {}) if f"{name}_low" in next(iter(sweep.ratios.values()))]
    shown = [name for name in names if any(row[name] for row in sweep.ratios.values())]
    rows = [(row, sweep.ratios[row["configuration"]]) for row in sweep.configurations if row["configuration"] in sweep.ratios]
    columns = [Column("baseline", "", False),
               *(Column(name.removeprefix("ratio_").replace("_", " "), name) for name in shown)]
    return _table(sweep, columns, [(row, [plain(ratios["baseline"]), *(figure(ratios, name) for name in shown)])
                                   for row, ratios in rows])


def figure_table(sweep: Sweep) -> Table:
    """Every figure of configurations.csv that the manifest names."""
    metrics = [metric for metric in sweep.metrics.values() if metric.per_configuration and _has(sweep, metric.name)]
    columns = [Column(metric.label, "\n".join(filter(None, [metric.formula, metric.unit and f"in {metric.unit}"])))
               for metric in metrics]
    return _table(sweep, columns, [(row, [figure(row, metric.name) for metric in metrics]) for row in sweep.configurations])


def _main_column(sweep: Sweep, name: str) -> Column:
    label, help_text = RATIOS.get(name) or (sweep.metrics[name].label if name in sweep.metrics else name, FIGURES[name])
    return Column(label, help_text, strip=name in STRIPS)


def main_table(sweep: Sweep) -> Table:
    published = (sweep.manifest.get("config", {}).get("published") or {}).get("ms_per_frame")
    chosen = [name for name in FIGURES if _has(sweep, name) or (name == "published" and published)]
    ratios = [name for name in RATIOS if any(row.get(name) for row in sweep.ratios.values())]
    place = chosen.index("relmse_x_s") + 1 if "relmse_x_s" in chosen else len(chosen)
    chosen[place:place] = ratios
    verdicts = any(row.get("verdict") for row in sweep.summary)
    columns = [*(_main_column(sweep, name) for name in chosen),
               Column("frames", "One sample per pixel each"), Column("seeds", "Finished runs"), Column("non-finite", "Samples that were NaN or infinite"),
               Column("at floor", f"Seeds whose error is within {tolerances.REFERENCE_FLOOR} times the reference's own noise"),
               *([Column("verdict", "Against what the config expects", False)] if verdicts else [])]
    return _table(sweep, columns, [(row, _main_fields(sweep, row, chosen, verdicts)) for row in sweep.configurations])


def _main_fields(sweep: Sweep, row: Row, chosen: list[str], verdicts: bool) -> list[Field]:
    runs = sweep.members[row["configuration"]]
    floor, seeds = row.get("seeds_at_reference_floor", ""), row["seeds"]
    bad = total(runs, "non_finite")
    words = sorted({run["verdict"] for run in runs if run.get("verdict")})
    few = row.get("runs", seeds) != seeds
    partial = bool(runs) and all(run["status"] == "partial" for run in runs)
    seeds_text = f"{seeds} of {row['runs']}" if few else seeds
    return [*(_figure_field(sweep, row, name) for name in chosen), plain(row["frames"]),
            Field(seeds_text + (" partial" if partial else ""), seeds, flag=few or partial), plain(str(bad), bad > 0),
            Field("no" if floor in ("", "0") else f"{floor} of {seeds}", floor or "0", flag=floor not in ("", "0")),
            *([plain(", ".join(words), any(word not in ("pass", "unseen") for word in words))] if verdicts else [])]


# Whole numbers of summary.csv, and whether one above zero is worth a look.
COUNTS = {"paths": False, "rays": False, "cell_lookups": False, "cell_fallbacks": False, "saturated_updates": True,
          "fireflies": False, "clamped_samples": True, "non_finite": True}


def path_table(sweep: Sweep) -> Table:
    """Path statistics: totals over the runs of a configuration are sums of whole numbers of summary.csv."""
    columns = [Column("paths", "Of all seeds"), Column("rays", "Of all seeds"),
               Column("mean length", "Segments per path"), Column("zero paths", "Fraction that brought nothing"),
               Column("cell look-ups", ""), Column("fallbacks", "Look-ups where no site's normal fitted"),
               Column("saturated", "Updates of the table beyond its range"), Column("fireflies", ""),
               Column("clamped", "Samples scaled down by clamp_radiance (biased)"), Column("non-finite", "")]
    rows = []
    for row in sweep.configurations:
        runs = sweep.members[row["configuration"]]
        count = {name: total(runs, name) for name in COUNTS}
        fields = {name: Field(f"{value:,}".replace(",", " "), str(value), flag=COUNTS[name] and value > 0)
                  for name, value in count.items()}
        rows.append((row, [fields["paths"], fields["rays"],
                            figure(row, "mean_path_length"), figure(row, "zero_path_fraction"),
                            fields["cell_lookups"], fields["cell_fallbacks"], fields["saturated_updates"],
                            fields["fireflies"], fields["clamped_samples"], fields["non_finite"]]))
    return _table(sweep, columns, rows)


def run_table(sweep: Sweep) -> Table:
    """Every run, those not begun as well."""
    names = {"seed": "", "frames": "", "host_ms_median": "host ms/frame", "elapsed_s": "seconds", "relmse": "relMSE",
             "noisy": "noisy times", "started": "started (UTC)", "reason": "reason"}
    known = {row["run"]: row for row in sweep.summary}
    columns = [Column("run", "", False), Column("status", "", False),
               *(Column(shown or name, "", name not in ("started", "reason")) for name, shown in names.items())]
    rows = []
    for planned in sweep.planned:
        run = str(planned.get("run", ""))
        row = known.get(run, {})
        status = row.get("status") or str(planned.get("status", "not begun"))
        fields = [plain(run), plain(status, status != "finished")]
        for name in names:
            text = row.get(name, "")
            is_figure = name in ("host_ms_median", "elapsed_s", "relmse")
            shown = {"0": "no", "1": "yes"}.get(text, text) if name == "noisy" else text
            fields.append(Field(number.short(text) if is_figure else shown or number.NOTHING, text,
                                flag=name == "noisy" and text == "1"))
        rows.append(({"configuration": row.get("configuration", "")}, fields))
    return Table(columns, rows)
