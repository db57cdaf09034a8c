"""The one clock that controller and machine share.

The controller proposes a chunk of setpoints; the machine advances by as much of it as it can without
telling the controller something new, and answers with feedback; the controller commits exactly that many
ticks. Axes stand in the order of their system axis numbers. Linear axes are slide travel in millimetres
(a diameter axis in radius), rotary axes are unwrapped degrees; both count from machine zero.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Load = Callable[[int, int], Floats]
"""`(first_tick, ticks) -> (ticks, dof)`: generalised forces [N, N m] that the cut puts on the axes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Follow:
    """A follow-type coupling (parameter 201#7 = 1), evaluated every tick on the measured master.

    slave setpoint = chunk.setpoint[tick, slave] + offset + numerator / denominator * actual[master]
    """

    slave: int
    """column of the slave axis"""
    master: int
    """column of the master axis"""
    numerator: int
    denominator: int
    offset: float
    """[deg]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Geared:
    """Rows of a chunk in which one gear box was engaged, for whoever watches how well it keeps."""

    first: int
    """row"""
    last: int
    """row behind the last one"""
    slave: int
    """column"""
    master: int
    """column"""
    numerator: int
    denominator: int
    follow: bool
    """on the measured master"""
    slides: tuple[tuple[int, float], ...] = ()
    """columns of slides that turn the slave, too, and by how much [deg/mm]: a helical gear box"""


class WatchKind(Enum):
    """What ends a chunk before its last tick."""

    SKIP = "skip"
    IN_POSITION = "in_position"
    SPEED_REACHED = "speed_reached"


@dataclass(frozen=True, slots=True, kw_only=True)
class Watch:
    """A condition that the machine observes for the controller."""

    kind: WatchKind
    latch_axes: tuple[int, ...] = ()
    timeout_ticks: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Chunk:
    """Setpoints for the coming ticks. `ticks == 0` means that the program has finished."""

    first_tick: int
    setpoint: Floats
    """(n, axes) [mm slide travel | deg unwrapped]; row k is due at the end of tick `first_tick` + k"""
    block: NDArray[np.int32]
    """(n,) index into `Controller.blocks`"""
    sync: NDArray[np.bool_]
    """(n,) whether the electronic gear box is engaged"""
    tool: NDArray[np.int16]
    """(n,) number of the tool in use, 0 = the one that is mounted without a T word"""
    rapid: NDArray[np.bool_] | None = None
    """(n,) whether the slides move at rapid; None = nowhere"""
    couplings: tuple[Follow, ...] = ()
    gears: tuple[Geared, ...] = ()
    watch: Watch | None = None

    @property
    def ticks(self) -> int:
        """Number of ticks n in the chunk."""
        return len(self.setpoint)


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineAlarm:
    """An alarm raised by the machine rather than by the program (servo, collision, overtravel)."""

    number: str
    """a key of the alarm table, for example "SV0410" """
    axis: int | None
    found: str
    """what was measured against what limit"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Feedback:
    """What a real control gets back from its machine, and beside it where the axes really stand."""

    ticks: int
    """ticks really advanced, at most `chunk.ticks`"""
    setpoint: Floats
    """(ticks, axes) setpoints as the drives saw them (couplings applied)"""
    actual: Floats
    """(ticks, axes) where the axes really stand [mm | deg]: what cuts the part"""
    measured: Floats | None = None
    """(ticks, axes) what the encoders read, which is all that a control knows; None = exactly `actual`"""
    latch: Floats | None = None
    """(axes,) positions latched at the skip trigger"""
    alarms: tuple[MachineAlarm, ...] = ()
    signals: dict[str, bool] = field(default_factory=dict)

    @property
    def readings(self) -> Floats:
        """(ticks, axes) what the encoders read [mm | deg]."""
        return self.actual if self.measured is None else self.measured


class Machine(Protocol):
    """The one thing a session needs of a machine: `twin.machine` has an ideal and a physical one."""

    def advance(self, chunk: Chunk, load: Load | None = None) -> Feedback:
        """Move along the chunk; stop early at a watch's trigger or an alarm."""
        ...

    def rest(self, ticks: int) -> None:
        """Let `ticks` pass in which nothing moves; the axes stay where they are."""
        ...
