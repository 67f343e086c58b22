"""What the figures of the results are called. The manifest of an experiment says it: a metric that the program gains needs no
change here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable

# Of results of schema 1, whose manifests have formulas alone. Errors of the image: name, label, unit.
ERRORS_OF_SCHEMA_1 = {
    "mse": ("MSE", "squared radiance"),
    "relmse": ("relMSE", ""),
    "relmse_trimmed": ("relMSE trimmed", ""),
    "mse_corrected": ("MSE without the reference's noise", "squared radiance"),
    "relmse_corrected": ("relMSE without the reference's noise", ""),
    "mape": ("MAPE", ""),
    "smape": ("SMAPE", ""),
    "psnr_db": ("PSNR", "dB"),
    "flip": ("FLIP", ""),
    "bias": ("bias", "radiance"),
}
# And what else configurations.csv has.
OTHERS_OF_SCHEMA_1 = {
    "host_ms_median": ("host ms/frame", "ms"),
    "gpu_ms_median": ("GPU ms/frame", "ms"),
    "elapsed_s": ("s", "s"),
    "relmse_x_s": ("relMSE × s", "s"),
    "slope_mse": ("slope of MSE", ""),
    "slope_relmse": ("slope of relMSE", ""),
    "filtered_relmse": ("relMSE filtered (biased)", ""),
    "fireflies_per_million": ("fireflies / M samples", ""),
    "clamp_bias": ("bias of clamping", "radiance"),
}
SIGNED_OF_SCHEMA_1 = {"psnr_db", "bias", "mse_corrected", "relmse_corrected", "slope_mse", "slope_relmse", "clamp_bias"}


@dataclass(frozen=True)
class Metric:
    name: str  # of its columns
    label: str
    unit: str = ""
    is_signed: bool = False
    per_configuration: bool = False  # averaged over seeds in configurations.csv
    is_error: bool = False           # of the image against the reference
    formula: str = ""

    @property
    def axis(self) -> str:
        return f"{self.label} ({self.unit})" if self.unit else self.label


def _metric(entry: dict[str, Any]) -> Metric:
    return Metric(str(entry.get("name", "")), str(entry.get("label", "")), str(entry.get("unit", "")),
                  bool(entry.get("signed")), bool(entry.get("per_configuration")), bool(entry.get("error")),
                  str(entry.get("formula", "")))


def _metrics_of_schema_1(entries: list[dict[str, Any]]) -> list[Metric]:
    formulas = {str(entry.get("name", "")): str(entry.get("formula", "")) for entry in entries}
    named = ERRORS_OF_SCHEMA_1 | OTHERS_OF_SCHEMA_1
    known = [Metric(name, label, unit, name in SIGNED_OF_SCHEMA_1, True, name in ERRORS_OF_SCHEMA_1, formulas.get(name, ""))
             for name, (label, unit) in named.items()]
    return known + [Metric(name, name, formula=formula) for name, formula in formulas.items() if name not in named]


def metrics_of(manifest: dict[str, Any]) -> dict[str, Metric]:
    """By name, in the order of the experiment's manifest."""
    entries = manifest.get("metrics") or []
    is_named = any("label" in entry for entry in entries)
    return {metric.name: metric for metric in (map(_metric, entries) if is_named else _metrics_of_schema_1(entries))}


def errors(metrics: Iterable[Metric]) -> list[Metric]:
    """Those above zero, which logarithmic axes and ratios can have."""
    return [metric for metric in metrics if metric.is_error and not metric.is_signed]


def floor_column(metric: str) -> str:
    """Of convergence.csv: the reference's own noise in the norm of a metric, where it is known."""
    return f"reference_{metric}"
