"""A run in windows, one after the other: metal that earlier windows have left is final in the later ones.

A tooth meets metal for a part of its turn only, and bears on the machine no longer than that. So passes up to
some tick are known as soon as the motion is known a turn of the tool further, and the forces of all ticks
up to half a turn before it belong to these passes alone.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SHORTEST = 1000
"""[ticks] of a window, where a turn of the tool takes no longer"""
ROUNDING = 0.95
HALF_TURN = 180.0
"""[deg] of the tool in which a pass begins and ends, to either side of its middle"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Window:
    """Some turns of the tool, and what has to be known around them; ticks from the start of the run."""

    known: int
    """forces before it are final when the window is"""
    until: int | None
    """it ends with the passes before this tick; None = the last one"""
    end: int | None
    """motion is needed up to here, a turn of the tool later"""


def windows(tool_angle_deg: Floats, tick: Ints, *, shortest: int = SHORTEST) -> list[Window]:
    """Windows of whole turns of the tool, `shortest` ticks long or longer, of a motion that has the tool at
    angles (n,) at the ends of ticks (n,)."""
    found: list[Window] = []
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(tool_angle_deg)))])[: len(tick)]
    turns = int(way[-1] // (2.0 * HALF_TURN)) if len(way) else 0
    bounds = 2.0 * HALF_TURN * np.arange(1, turns + 1)
    at, back = np.searchsorted(way, bounds), np.searchsorted(way, bounds - HALF_TURN)
    ahead = np.searchsorted(way, bounds + 2.0 * HALF_TURN)
    known = begin = 0
    for row, low, high in zip(at, np.maximum(back - 1, 0), ahead, strict=True):
        if high >= len(tick):
            break
        until, end = int(tick[row]), int(tick[high])
        if until - begin < ROUNDING * shortest or tick[low] <= known:
            continue
        known, begin = int(tick[low]), until
        found.append(Window(known=known, until=until, end=end))
    return [*found, Window(known=known, until=None, end=None)]
