"""An induction motor on a variable-frequency inverter: torque by slip, and no loop around it.

Kloss: M = 2 M_b / (s / s_b + s_b / s), s the speed lost against the field, M_b and s_b those at breakdown.
Under load the spindle runs slower than it is told; beyond M_b it stalls.
"""

import copy

from twin.machine.drive import AxisDrive
from twin.machine.encoder import encoder
from twin.machine.terminals import Terminals


class Induction:
    """One spindle's motor at work; SI, referred to the axis. Its encoder is read for others."""

    __slots__ = ("_at", "_breakdown", "_limit", "_period", "_previous", "_read", "_reference", "_speed_limit")

    def __init__(self, axis: AxisDrive, period_s: float, at: Terminals) -> None:
        self._at = at
        self._read = encoder(axis)
        self._breakdown = axis.breakdown_slip
        self._limit = axis.force_limit
        self._speed_limit = axis.speed_limit
        self._period = period_s
        self._reference = 0.0
        self._previous = 0.0

    def force(self, target: float) -> None:
        """Turn over the coming period, at whose end the setpoint is `target`; only its speed is obeyed."""
        field = (target - self._reference) / self._period
        self._previous, self._reference = self._reference, target
        slip = min(max(field, -self._speed_limit), self._speed_limit) - self._at.speed[0]
        self._at.force[0] = kloss(slip, self._breakdown, self._limit)

    def observe(self) -> None:
        """Read the encoder at the end of a period."""
        self._at.reading[0] = self._read(self._at.position[0])

    def moved_to(self, at: Terminals) -> "Induction":
        """The same motor in the same state, wired to another machine."""
        other = copy.copy(self)
        other._at = at
        return other

    def speed(self, period_s: float) -> float:
        """Commanded speed over the last period."""
        return (self._reference - self._previous) / period_s


def kloss(slip: float, breakdown_slip: float, breakdown_torque: float) -> float:
    """Torque of an induction motor at constant flux."""
    return 2.0 * breakdown_torque * slip * breakdown_slip / (slip**2 + breakdown_slip**2)


def steepest(axis: AxisDrive) -> float:
    """Largest slope of torque over speed [N m s/rad], at synchronous speed."""
    return 2.0 * axis.force_limit / axis.breakdown_slip
