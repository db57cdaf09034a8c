"""Round figures for scales, and words for numbers."""

import math

import numpy as np
from numpy.typing import ArrayLike

MISSING = "–"
"""stands where there is no value"""


def nice_ceiling(value: float) -> float:
    """Smallest of 1, 2, 5 × 10ⁿ that is not below `value`; 1 where the value is not positive and finite."""
    if not (math.isfinite(value) and value > 0):
        return 1.0
    decade = 10.0 ** math.floor(math.log10(value))
    return next(step * decade for step in (1.0, 2.0, 5.0, 10.0) if step * decade >= value * (1 - 1e-12))


def nice_floor(value: float) -> float:
    """Largest of 1, 2, 5 × 10ⁿ that is not above `value` (> 0)."""
    decade = 10.0 ** math.floor(math.log10(value))
    return next(step * decade for step in (10.0, 5.0, 2.0, 1.0) if step * decade <= value * (1 + 1e-12))


def largest(values: ArrayLike) -> float:
    """Largest finite magnitude; 0 where there is none."""
    array = np.abs(np.asarray(values, float))
    array = array[np.isfinite(array)]
    return float(array.max()) if array.size else 0.0


def number(value: float | None, digits: int = 1, unit: str = "") -> str:
    """`value` with a fixed number of digits and a real minus; a dash where it is missing or not finite."""
    if value is None or not math.isfinite(value):
        return MISSING
    text = f"{value:.{digits}f}"
    if float(text) == 0:
        text = text.lstrip("-")
    return _with_unit(text, unit)


def plain(value: float | None, unit: str = "") -> str:
    """`value` as short as four significant figures allow: 2, 17, 0.5."""
    if value is None or not math.isfinite(value):
        return MISSING
    return _with_unit(f"{value:.4g}", unit)


def _with_unit(text: str, unit: str) -> str:
    space = "" if unit in {"", "°"} else " "
    return text.replace("-", "−") + space + unit
