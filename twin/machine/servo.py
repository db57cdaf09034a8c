"""The servo law of one axis: position loop, velocity loop, feed-forward, limits of speed and force.

    demand = Kv (r - m) + k_ff dr/dt, limited
    force  = Kp (demand - v) + Ki ∫(demand - v) dt + k_a J d²r/dt², limited

m is what the encoder reads, v its difference over the last period: a drive knows nothing else of its axis.
In scalars: at one axis per call this is several times faster than the same law on arrays.
"""

from dataclasses import dataclass

from twin.machine.drive import AxisDrive


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
    """One drive at work; positions [m | rad], forces [N | N m]."""

    __slots__ = (
        "_acceleration_feedforward",
        "_force_integral",
        "_integral_step",
        "_limit",
        "_per_period",
        "_position",
        "_proportional",
        "_read",
        "_speed_limit",
        "_velocity_feedforward",
        "periods_at_limit",
        "previous",
        "reference",
    )

    def __init__(self, gains: Gains, period_s: float) -> None:
        self._position = gains.position
        self._proportional = gains.proportional
        self._limit = gains.limit
        self._speed_limit = gains.speed_limit
        self._per_period = 1.0 / period_s
        self._velocity_feedforward = gains.velocity_feedforward / period_s
        self._acceleration_feedforward = gains.acceleration_feedforward / period_s**2
        self._integral_step = gains.integral * period_s
        self._force_integral = 0.0
        self._read = 0.0
        self.reference = 0.0
        """setpoint of this instant"""
        self.previous = 0.0
        """setpoint of one period before"""
        self.periods_at_limit = 0
        """for how many periods on end the force has been at its limit"""

    def force(self, target: float, reading: float) -> float:
        """Force over the coming period; `target` is the setpoint of its end, `reading` the encoder's now.

        Position and speed are compared with the setpoint's of the same instant and the same period, so with
        full feed-forward nothing lags and nothing overshoots.
        """
        reference = self.reference
        step = reference - self.previous
        demand = self._position * (reference - reading) + self._velocity_feedforward * step
        fastest = self._speed_limit
        if demand > fastest:
            demand = fastest
        elif demand < -fastest:
            demand = -fastest
        error = demand - self._per_period * (reading - self._read)
        integral = self._force_integral + self._integral_step * error
        force = (
            self._proportional * error
            + integral
            + self._acceleration_feedforward * (target - reference - step)
        )
        self._read = reading
        self.previous = reference
        self.reference = target
        limit = self._limit
        if -limit <= force <= limit:
            self._force_integral = integral
            self.periods_at_limit = 0
            return force
        # At the limit the integral stands still, else it would wind up.
        self.periods_at_limit += 1
        return limit if force > limit else -limit

    def extrapolated(self) -> float:
        """Next setpoint of a follower, whose master is known only as far as it has been measured."""
        return 2.0 * self.reference - self.previous

    def speed(self, period_s: float) -> float:
        """Commanded speed over the last period."""
        return (self.reference - self.previous) / period_s
