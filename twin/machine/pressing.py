"""The load of one chunk as its axes feel it: by the clock, or by the angle of the spindle that causes it.

A cutting force belongs to an edge's place in the metal, not to a time: where the spindle comes late its force
comes late as well. A force by the clock would go on pushing a spindle that it has already stopped.
"""

from typing import Protocol, runtime_checkable

import numpy as np

from controller.clock import Floats, Load
from twin.machine.drive import SI_PER_DEG

REACH = 48
"""[ticks] by which a spindle may run ahead of, or behind, the motion that its load was found on"""


@runtime_checkable
class PhasedLoad(Protocol):
    """A load that was found on a motion, and comes again when the spindle passes the same angles."""

    @property
    def spindle(self) -> int:
        """Column of the causing spindle."""
        ...

    def angle_deg(self, first_tick: int, ticks: int) -> Floats:
        """(ticks,) of that spindle at the start of each tick, in the motion that the load was found on."""
        ...

    @property
    def parts(self) -> int:
        """Cells of a tick, in which its forces are constant on that motion."""
        ...

    def impulse(self, first_tick: int, ticks: int) -> Floats:
        """(ticks · parts + 1, axes) forces on that motion, summed up from the start of a tick on cell by cell
        [N · ticks, N m · ticks]."""
        ...

    def __call__(self, first_tick: int, ticks: int) -> Floats:
        """(ticks, axes) mean forces on that motion, a `controller.clock.Load`."""
        ...


class Pressing:
    """The forces of the coming ticks."""

    def __init__(self, load: Load, first_tick: int, ticks: int, axes: int) -> None:
        """Raise ValueError for a load of another shape, or one that is not finite."""
        self.spindle = 0
        """column of the spindle that has a say in them"""
        self.felt: list[list[float]] = []
        """(axes,) forces [N, N m] of every tick so far"""
        self._nothing = [0.0] * axes
        self._before = 0
        self._reference: list[float] = []
        self._rate: list[float] = []
        self._parts = 1
        self._impulse: list[list[float]] = []
        if not isinstance(load, PhasedLoad):
            self._forces = _rows(load, first_tick, ticks, axes)
            return
        self.spindle = load.spindle
        begin = max(first_tick - REACH, 0)
        self._before = first_tick - begin
        self._forces = _rows(load, begin, self._before + ticks + REACH, axes)
        self._parts = load.parts
        self._impulse = load.impulse(begin, len(self._forces)).tolist()
        angle = load.angle_deg(begin, len(self._forces) + 1) * SI_PER_DEG
        self._reference, self._rate = angle.tolist(), np.diff(angle).tolist()

    def feel(self, row: int, angle: float, speed: float) -> list[float]:
        """(axes,) forces [N, N m] of a tick of the chunk, `angle` [rad] and `speed` of the spindle now."""
        self.felt.append(self._at(row, angle, speed) if self._rate else self._forces[row])
        return self.felt[-1]

    def _at(self, row: int, angle: float, speed: float) -> list[float]:
        forces, place = self._forces, row + self._before
        step = self._rate[place]
        if not step:
            return forces[place]
        if speed * step <= 0.0:
            return self._nothing  # an edge that stands or goes back cuts nothing
        # the mean over the tick that begins at that angle, wherever the cells' bounds lie in it
        ahead = place + min(max((angle - self._reference[place]) / step, -REACH), REACH)
        ahead = min(max(ahead, 0.0), len(forces) - 1.0) * self._parts
        cell = min(int(ahead), len(self._impulse) - 2 - self._parts)
        share = ahead - cell
        begin, end = (
            self._impulse[cell : cell + 2],
            self._impulse[cell + self._parts : cell + self._parts + 2],
        )
        if not share:
            return [b - a for a, b in zip(begin[0], end[0], strict=True)]
        return [(c - a) + share * ((d - c) - (b - a)) for a, b, c, d in zip(*begin, *end, strict=True)]


def _rows(load: Load, first_tick: int, ticks: int, axes: int) -> list[list[float]]:
    forces = load(first_tick, ticks)
    if forces.shape != (ticks, axes):
        raise ValueError(f"load: expected ({ticks}, {axes}), got {forces.shape}")
    if not np.isfinite(forces).all():
        raise ValueError(f"load: not finite between ticks {first_tick} and {first_tick + ticks}")
    return forces.tolist()
