"""Numbers for readers: three digits to look at, and beside them all that the files hold."""

from __future__ import annotations

import math

NOTHING = "–"


def short(text: str) -> str:
    """Three significant digits; plain where that is short."""
    if text == "":
        return NOTHING
    value = float(text)
    if value == 0 or not math.isfinite(value):
        return f"{value:g}".replace("-", "−")
    rounded = float(f"{value:.3g}")
    if 1e-4 <= abs(rounded) < 1e6:
        digits = max(0, 2 - math.floor(math.log10(abs(rounded))))
        plain = f"{rounded:.{digits}f}"
        return (plain.rstrip("0").rstrip(".") if "." in plain else plain).replace("-", "−")
    return f"{rounded:.3g}".replace("-", "−")


def estimate(row: dict[str, str], figure: str) -> tuple[str, str, str]:
    """Of a row of configurations.csv or ratios.csv: mean, low and high as they stand there."""
    return row.get(figure, ""), row.get(f"{figure}_low", ""), row.get(f"{figure}_high", "")
