"""The servo law of one axis: position loop, velocity loop, feed-forward, limits of speed and force.

    demand = Kv (r - m) + k_ff dr/dt, limited
    force  = Kp (demand - v) + Ki ∫(demand - v) dt + k_a J d²r/dt², limited

m is what the encoder reads, v its difference over the last period: a drive knows nothing else of its axis.
Position and speed are compared with the setpoint's of the same instant and the same period, so with full
feed-forward nothing lags and nothing overshoots.

In scalars, on MuJoCo's own memory: for so few axes several times faster than the same law on arrays.
"""

import copy
from collections.abc import Callable
from dataclasses import dataclass

from twin.machine.drive import AxisDrive
from twin.machine.encoder import encoder
from twin.machine.terminals import Terminals


@dataclass(frozen=True, slots=True, kw_only=True)
class Gains:
    """A drive tuned to the inertia it moves; SI, referred to the axis."""

    position: float
    """Kv [1/s]"""
    velocity_feedforward: float
    """k_ff"""
    acceleration_feedforward: float
    """k_a J [kg | kg m²]"""
    proportional: float
    """Kp [N s/m | N m s]"""
    integral: float
    """Ki [N/m | N m]"""
    limit: float
    """[N | N m]"""
    speed_limit: float
    """[m/s | rad/s]"""


def tune(axis: AxisDrive, inertia: float) -> Gains:
    """Gains of a drive that moves `inertia` [kg | kg m²], its own included."""
    drive = axis.drive
    proportional = drive.velocity_gain * inertia
    return Gains(
        position=drive.position_gain,
        velocity_feedforward=drive.velocity_feedforward,
        acceleration_feedforward=drive.acceleration_feedforward * inertia,
        proportional=proportional,
        integral=proportional / drive.integral_time_s,
        limit=axis.force_limit,
        speed_limit=axis.speed_limit,
    )


class Servo:
    """One drive at work; positions [m | rad], forces [N | N m]. A period is `force`, physics, `observe`."""

    __slots__ = (
        "_acceleration_feedforward",
        "_error",
        "_error_limit",
        "_force_integral",
        "_force_now",
        "_integral_step",
        "_limit",
        "_overload",
        "_per_period",
        "_periods_at_limit",
        "_position",
        "_position_now",
        "_previous",
        "_proportional",
        "_read",
        "_reading",
        "_reading_now",
        "_reference",
        "_speed_limit",
        "_step",
        "_trip",
        "_velocity_feedforward",
    )

    def __init__(
        self,
        axis: AxisDrive,
        gains: Gains,
        period_s: float,
        at: Terminals,
        *,
        trip: Callable[["Servo"], None],
    ) -> None:
        """`trip` is called in every period that ends beyond the limits of following error or overload."""
        self._position_now = at.position
        self._force_now = at.force
        self._reading_now = at.reading
        self._read = encoder(axis)
        self._trip = trip
        self._position = gains.position
        self._proportional = gains.proportional
        self._limit = gains.limit
        self._speed_limit = gains.speed_limit
        self._per_period = 1.0 / period_s
        self._velocity_feedforward = gains.velocity_feedforward / period_s
        self._acceleration_feedforward = gains.acceleration_feedforward / period_s**2
        self._integral_step = gains.integral * period_s
        self._error_limit = axis.error_limit
        self._overload = max(1, round(axis.drive.overload_time_s / period_s))
        self._force_integral = 0.0
        self._error = 0.0
        self._reading = 0.0
        self._step = 0.0
        self._previous = 0.0
        self._reference = 0.0
        self._periods_at_limit = 0

    def force(self, target: float) -> None:
        """Push over the coming period; `target` is the setpoint of its end."""
        reference = self._reference
        error = self._error
        integral = self._force_integral + self._integral_step * error
        force = (
            self._proportional * error
            + integral
            + self._acceleration_feedforward * (target - reference - self._step)
        )
        self._previous = reference
        self._reference = target
        limit = self._limit
        if -limit <= force <= limit:
            self._force_integral = integral
            self._periods_at_limit = 0
            self._force_now[0] = force
            return
        # At the limit the integral takes up no more than the limit leaves, else it would wind up.
        self._periods_at_limit += 1
        step, over = integral - self._force_integral, force - limit if force > limit else force + limit
        self._force_integral += (
            min(step, max(step - over, 0.0)) if over > 0 else max(step, min(step - over, 0.0))
        )
        self._force_now[0] = limit if force > limit else -limit
        if self._periods_at_limit >= self._overload:
            self._trip(self)

    def observe(self) -> None:
        """Read the encoder at the end of a period, and compare it with the setpoint of this instant."""
        reading = self._read(self._position_now[0])
        reference = self._reference
        self._step = step = reference - self._previous
        lag = reference - reading
        demand = self._position * lag + self._velocity_feedforward * step
        fastest = self._speed_limit
        if demand > fastest:
            demand = fastest
        elif demand < -fastest:
            demand = -fastest
        self._error = demand - self._per_period * (reading - self._reading)
        self._reading = reading
        self._reading_now[0] = reading
        limit = self._error_limit
        if not -limit <= lag <= limit:
            self._trip(self)

    def moved_to(self, at: Terminals, trip: Callable[["Servo"], None]) -> "Servo":
        """The same drive in the same state, wired to another machine."""
        other = copy.copy(self)
        other._position_now, other._force_now, other._reading_now = at.position, at.force, at.reading
        other._trip = trip
        return other

    def follow(self, setpoint: float) -> None:
        """Observe as the slave of a gear box, whose setpoint of this instant is known only now."""
        self._reference = setpoint
        self.observe()

    @property
    def extrapolated(self) -> float:
        """Next setpoint of a slave, whose master is known only as far as it has been measured."""
        return 2.0 * self._reference - self._previous

    @property
    def lag(self) -> float:
        """Following error now."""
        return self._reference - self._reading

    @property
    def moving(self) -> bool:
        """Whether the setpoint has moved in the last period."""
        return self._reference != self._previous

    def speed(self, period_s: float) -> float:
        """Commanded speed over the last period."""
        return (self._reference - self._previous) / period_s
