"""Stored stroke limits: where a straight path leaves the allowed box."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
TOLERANCE = 1e-9
"""[mm] far below the least increment: a path that ends on the limit is inside"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Crossing:
    """The first stroke limit on a path."""

    fraction: float
    """of the path before the limit, 0 to 1"""
    axis: int
    """column"""
    upper: bool
    """which of the two limits"""


def first_crossing(start: Floats, travel: Floats, lower: Floats, upper: Floats) -> Crossing | None:
    """Where the straight path from `start` (axes,) by `travel` (axes,) first leaves the box; None = never.

    An axis that is already outside may come back, but not go further out.
    """
    first: Crossing | None = None
    for axis in np.flatnonzero(travel):
        up = bool(travel[axis] > 0.0)
        limit = upper[axis] if up else lower[axis]
        beyond = start[axis] + travel[axis] - limit
        if (beyond if up else -beyond) <= TOLERANCE:
            continue
        fraction = max(0.0, float((limit - start[axis]) / travel[axis]))
        if first is None or fraction < first.fraction:
            first = Crossing(fraction=fraction, axis=int(axis), upper=up)
    return first
