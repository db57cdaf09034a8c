"""Corrections of axes against the angle of the work: a table at even angles, straight between its points."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

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

    def at(self, column: int, angle: Floats) -> Floats:
        """(n,) corrections of an axis at angles (n,) of the work [deg]."""
        values = np.array(self.values[column])
        place = np.mod(angle, TURN) * (len(values) / TURN)
        k = np.floor(place).astype(np.int64) % len(values)
        share = place - np.floor(place)
        return values[k] + share * (values[(k + 1) % len(values)] - values[k])


@dataclass(slots=True, kw_only=True)
class TableInForce:
    """A table over time."""

    table: AngleTable
    start: float
    """[s] from when on it comes in"""
    end: float = math.inf
    """[s] from when on it goes out"""

    def weight(self, time: Floats) -> Floats:
        """(n,) share of it that counts at times (n,), 0 to 1."""
        came = np.clip((time - self.start) / RAMP_S, 0.0, 1.0)
        return came * np.clip(1.0 - (time - self.end) / RAMP_S, 0.0, 1.0)

    def still_until(self, time: float) -> float:
        """Until when it moves no axis of a machine at rest: not while it comes in or goes out."""
        for begin in (self.start, self.end):
            if time < begin:
                return begin
            if time < begin + RAMP_S:
                return time
        return math.inf
