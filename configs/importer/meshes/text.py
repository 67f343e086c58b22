"""Numbers in text, many at once."""

from __future__ import annotations

import warnings

import numpy as np


def parsed(text: bytes, kind: type) -> np.ndarray | None:
    """Numbers between white space, or None where there is something else. NumPy's parser is one loop in C that does
    not ask for the country's decimal point; it warns, or in later versions raises, where it stops early."""
    if not text.strip():
        return np.empty(0, kind)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            return np.fromstring(text, kind, sep=" ")
        except (DeprecationWarning, ValueError):
            return None
