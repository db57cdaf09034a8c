"""An induction motor on a variable-frequency inverter: torque by slip, and no loop around it.

Kloss: M = 2 M_b / (s / s_b + s_b / s), s the speed lost against the field, M_b and s_b those at breakdown.
Under load the spindle runs slower than it is told; beyond M_b it stalls.
"""

from twin.machine.drive import AxisDrive


class Induction:
    """One spindle's motor at work; SI, referred to the axis."""

    __slots__ = ("_breakdown", "_limit", "_period", "_speed_limit", "previous", "reference")

    def __init__(self, axis: AxisDrive, period_s: float) -> None:
        self._breakdown = axis.breakdown_slip
        self._limit = axis.force_limit
        self._speed_limit = axis.speed_limit
        self._period = period_s
        self.reference = 0.0
        """setpoint of this instant; only its speed is obeyed"""
        self.previous = 0.0

    def force(self, target: float, speed: float) -> float:
        """Torque over the coming period at a shaft speed, when the setpoint moves on to `target`."""
        field = (target - self.reference) / self._period
        self.previous, self.reference = self.reference, target
        slip = min(max(field, -self._speed_limit), self._speed_limit) - speed
        return kloss(slip, self._breakdown, self._limit)

    def speed(self, period_s: float) -> float:
        """Commanded speed over the last period."""
        return (self.reference - self.previous) / period_s


def kloss(slip: float, breakdown_slip: float, breakdown_torque: float) -> float:
    """Torque of an induction motor at constant flux."""
    return 2.0 * breakdown_torque * slip * breakdown_slip / (slip**2 + breakdown_slip**2)


def steepest(axis: AxisDrive) -> float:
    """Largest slope of torque over speed [N m s/rad], at synchronous speed."""
    return 2.0 * axis.force_limit / axis.breakdown_slip
