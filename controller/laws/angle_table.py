"""Corrections of axes against the angle of the work: a table at even angles, straight between its points.

What it adds to setpoints is in `motion/sampling.py`.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

RAMP_S = 0.5
"""[s] in which a table comes in, and goes out again: no axis may jump"""
TURN = 360.0


@dataclass(frozen=True, slots=True, kw_only=True)
class AngleTable:
    """What is added to axes as the work turns."""

    work: int
    """column of the work spindle, whose own angle counts"""
    values: Mapping[int, tuple[float, ...]]
    """column -> correction at 0, 360/n, 2 · 360/n … degrees [mm slide travel | deg]"""


@dataclass(slots=True, kw_only=True)
class TableInForce:
    """A table over time."""

    table: AngleTable
    start: float
    """[s] from when on it comes in"""
    end: float = math.inf
    """[s] from when on it goes out"""

    def still_until(self, time: float) -> float:
        """Until when it moves no axis of a machine at rest: not while it comes in or goes out."""
        for begin in (self.start, self.end):
            if time < begin:
                return begin
            if time < begin + RAMP_S:
                return time
        return math.inf
