"""What the metrics are called. The manifest of an experiment says it: a metric that the program gains needs no change
here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable

# Name, label and unit of results of schema 1, whose manifests have the formulas alone; signed ones below.
LABELS_OF_SCHEMA_1 = {
    "mse": ("MSE", "squared radiance"),
    "relmse": ("relMSE", ""),
    "relmse_trimmed": ("relMSE, worst 0.1 % of pixels left out", ""),
    "mape": ("MAPE", ""),
    "smape": ("SMAPE", ""),
    "psnr_db": ("PSNR", "dB"),
    "flip": ("HDR-FLIP", ""),
    "bias": ("bias", "radiance"),
    "mse_corrected": ("MSE without the reference's noise", "squared radiance"),
    "relmse_corrected": ("relMSE without the reference's noise", ""),
    "clamp_bias": ("bias of clamping", "radiance"),
}
SIGNED_OF_SCHEMA_1 = {"psnr_db", "bias", "mse_corrected", "relmse_corrected", "clamp_bias"}


@dataclass(frozen=True)
class Metric:
    name: str  # of its columns
    label: str
    unit: str = ""
    signed: bool = False
    per_configuration: bool = False  # averaged over seeds in configurations.csv
    formula: str = ""

    @property
    def axis(self) -> str:
        return f"{self.label} ({self.unit})" if self.unit else self.label


def _metric(entry: dict[str, Any]) -> Metric:
    name, formula = str(entry.get("name", "")), str(entry.get("formula", ""))
    if "label" in entry:
        return Metric(name, str(entry["label"]), str(entry.get("unit", "")), bool(entry.get("signed")),
                      bool(entry.get("per_configuration")), formula)
    label, unit = LABELS_OF_SCHEMA_1.get(name, (name, ""))
    return Metric(name, label, unit, name in SIGNED_OF_SCHEMA_1, name in LABELS_OF_SCHEMA_1, formula)


def metrics_of(manifest: dict[str, Any]) -> dict[str, Metric]:
    """By name, in the order of the experiment's manifest."""
    return {metric.name: metric for metric in map(_metric, manifest.get("metrics") or [])}


def errors(metrics: Iterable[Metric]) -> list[Metric]:
    """Those above zero, which logarithmic axes and ratios can have."""
    return [metric for metric in metrics if metric.per_configuration and not metric.signed]


def floor_column(metric: str) -> str:
    """Of convergence.csv: the reference's own noise in the norm of a metric, where it is known."""
    return f"reference_{metric}"
