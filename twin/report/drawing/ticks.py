"""Round figures along an axis."""

import math

from twin.report.scale import nice_ceiling, nice_floor


def ticks(low: float, high: float, most: int = 6) -> tuple[float, ...]:
    """Multiples of the finest 1, 2 or 5 × 10ⁿ of which at most `most` (≥ 2) lie from `low` to `high`.

    Empty where the range is empty or not finite.
    """
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        return ()
    step = nice_floor((high - low) / most)
    while len(marks := _multiples(low, high, step)) > most:
        step = nice_ceiling(1.5 * step)
    return marks


def _multiples(low: float, high: float, step: float) -> tuple[float, ...]:
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return tuple(k * step for k in range(first, last + 1))


def tick_text(value: float, step: float) -> str:
    """Word a tick with as many digits as its step has, with a real minus."""
    digits = max(0, -math.floor(math.log10(step) + 1e-9)) if step > 0 else 0
    return f"{value:.{digits}f}".replace("-", "−") if round(value, digits) else "0"
