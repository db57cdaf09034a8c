"""The sampled servo loops as one linear map, and their frequency response.

Between two control instants n physics steps of h = T/n (semi-implicit Euler, viscous friction D implicit)
act on the constant force u:

    v' = v + h (M + h D)⁻¹ (u - D v),   q' = q + h v'

which with the servo law of `twin.machine.servo` is one linear map of (q, v, z, p): z the integral of the
speed error, p the encoder's reading one period before. Coulomb friction, limits and counts are not linear
and are left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.machine.servo import Gains

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


@dataclass(frozen=True, slots=True, kw_only=True)
class Loops:
    """The loops of k axes on the bodies that they move; SI."""

    mass: Floats
    """(k, k) generalised inertia"""
    viscous: Floats
    """(k,) friction"""
    gains: Sequence[Gains]
    period_s: float
    substeps: int
    """physics steps in a control period"""

    def alone(self, axis: int) -> "Loops":
        """One axis while the others stand still."""
        return replace(
            self,
            mass=self.mass[axis : axis + 1, axis : axis + 1],
            viscous=self.viscous[axis : axis + 1],
            gains=[self.gains[axis]],
        )

    def closed(self) -> tuple[Floats, Floats]:
        """(4k, 4k) map of (q, v, z, p) over one control period, and (4k, 3k) of what the setpoints (before,
        now, at the end of the period) add to the state at its end."""
        k, period = len(self.gains), self.period_s
        one, nothing = np.eye(k), np.zeros((k, k))
        forward = self._diagonal("velocity_feedforward") / period
        inertial = self._diagonal("acceleration_feedforward") / period**2
        position = self._diagonal("position")
        error = np.hstack([-position - one / period, nothing, nothing, one / period])
        error_of_r = np.hstack([-forward, position + forward, nothing])
        z = np.hstack([nothing, nothing, one, nothing]) + period * error
        z_of_r = period * error_of_r
        proportional, integral = self._diagonal("proportional"), self._diagonal("integral")
        force = proportional @ error + integral @ z
        force_of_r = proportional @ error_of_r + integral @ z_of_r
        force_of_r = force_of_r + np.hstack([inertial, -2.0 * inertial, inertial])
        coasting, of_force = self._plant()
        motion = np.hstack([coasting, np.zeros((2 * k, 2 * k))]) + of_force @ force
        reading = np.hstack([one, nothing, nothing, nothing])
        return (
            np.vstack([motion, z, reading]),
            np.vstack([of_force @ force_of_r, z_of_r, np.zeros((k, 3 * k))]),
        )

    def spectral_radius(self) -> float:
        """Largest modulus of the closed loop's eigenvalues; below 1 it is stable."""
        state, _ = self.closed()
        return float(np.abs(np.linalg.eigvals(state)).max())

    def frequency_response(self, frequency_hz: Floats) -> Complexes:
        """(n, k, k) position of axis i over the setpoint of axis j of the same instant."""
        k = len(self.gains)
        state, given = self.closed()
        turn = np.exp(2j * np.pi * frequency_hz * self.period_s)[:, None, None]
        # position is due against the setpoint at the end of the period
        before, now, due = given[:, :k], given[:, k : 2 * k], given[:, 2 * k :]
        response = np.linalg.solve(np.eye(4 * k) - state / turn, before / turn**2 + now / turn + due)
        return np.asarray(response[:, :k], dtype=np.complex128)

    def step_response(self, axis: int, periods: int) -> Floats:
        """(n,) position of an axis at the end of each period after its setpoint has jumped from 0 to 1."""
        k = len(self.gains)
        state, given = self.closed()
        now, setpoints, found = np.zeros(4 * k), np.zeros(3 * k), np.zeros(periods)
        for period in range(periods):
            # before, now, due: the jump is due at the end of the first period
            setpoints[axis + (2 - min(period, 2)) * k] = 1.0
            now = state @ now + given @ setpoints
            found[period] = now[axis]
        return found

    def _plant(self) -> tuple[Floats, Floats]:
        """(2k, 2k) map of (q, v) and (2k, k) of the force over one control period."""
        k, h = len(self.mass), self.period_s / self.substeps
        one, nothing = np.eye(k), np.zeros((k, k))
        damping = np.diag(self.viscous)
        give = h * np.linalg.inv(self.mass + h * damping)
        keep = one - give @ damping
        step = np.block([[one, h * keep, h * give], [nothing, keep, give], [nothing, nothing, one]])
        whole = np.linalg.matrix_power(step, self.substeps)
        return whole[: 2 * k, : 2 * k], whole[: 2 * k, 2 * k :]

    def _diagonal(self, of: str) -> Floats:
        return np.diag([getattr(g, of) for g in self.gains])
