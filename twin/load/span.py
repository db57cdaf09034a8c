"""Some ticks of a run, and the motion around them: what a pass of an edge has to be seen in.

Behind and ahead the axes go on as evenly as they come and leave: metal that an edge meets there is not looked
at, but a pass is the whole way of an edge past the work, of which these ticks hold a part.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BEHIND = 3
"""[ticks] of the motion before that are looked at as they were"""
AHEAD = 4
"""[ticks] behind the last one in which axes go on evenly, tick by tick"""
NEXT = 3
"""[ticks] behind the last one whose forces are looked for as well: mounts feel them coming"""
FRINGE_DEG = 200.0
"""of the tool, in which axes go on to either side"""
STRIDE_DEG = 6.0
"""between two samples of that"""
STANDS_DEG = 1e-4
"""per tick, below which a tool stands"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Span:
    """Ticks `first` to `until`, `until` not included."""

    first: int
    until: int
    tick: Ints
    """(m,) of every row; those around are further apart where the tool is slow"""
    actual: Floats
    """(m, axes) at its end"""
    core: slice
    """rows one tick apart"""

    @property
    def last(self) -> int:
        """Tick behind the last one whose forces are looked for."""
        return self.until + NEXT

    def between(self, tick_s: float) -> tuple[float, float]:
        """Times [s] from a tick before the first one, for then edges may just have been, to the last."""
        return (self.first - 1) * tick_s, self.last * tick_s


def span_of(before: tuple[Ints, Floats], actual: Floats, first: int, tool: int) -> Span:
    """Ticks from `first` on in which the axes come to `actual` (n, axes), after the rows `before`.

    `tool` is the column of its spindle.
    """
    recent = before[0] >= first - BEHIND
    tick = np.concatenate([before[0][recent], first + np.arange(len(actual))])
    rows = np.vstack([before[1][recent], actual])
    until = first + len(actual)
    back, on = (_steps(rate, tool) for rate in (_rate(rows[:2]), _rate(rows[-2:])))
    behind = rows[0] - back[::-1, None] * _rate(rows[:2])
    ahead = rows[-1] + on[:, None] * _rate(rows[-2:])
    return Span(
        first=first,
        until=until,
        tick=np.concatenate([tick[0] - back[::-1], tick, tick[-1] + on]),
        actual=np.vstack([behind, rows, ahead]),
        core=slice(len(back), len(back) + len(rows) + AHEAD),
    )


def _rate(rows: Floats) -> Floats:
    """(axes,) travel in a tick."""
    return rows[-1] - rows[0]


def _steps(rate: Floats, tool: int) -> Ints:
    """(k,) ticks from the last row on to others: some single ones, then a stride of the tool each."""
    near = np.arange(1, AHEAD + 1)
    turn = abs(float(rate[tool]))
    if turn < STANDS_DEG:
        return near
    stride = max(1, round(STRIDE_DEG / turn))
    return np.concatenate([near, AHEAD + stride * np.arange(1, math.ceil(FRINGE_DEG / (turn * stride)) + 1)])
