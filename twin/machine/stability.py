"""Whether the sampled servo loops are stable, before anything moves.

Between two control instants n physics steps of T/n (semi-implicit Euler) act on the constant force u:

    v' = v + T a,   q' = q + T v + T² (n + 1) / (2 n) a,   M a = u

which with the servo law of `twin.machine.servo` is one linear map of (q, v, z), z the integral of the
speed error: stable while its spectral radius is below one. Friction only damps it further and is left out.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from twin.errors import InputError
from twin.machine.servo import Gains
from twin.machine.spec import MachineSpec

Floats = NDArray[np.float64]


def closed_loop(mass: Floats, gains: Sequence[Gains], period_s: float, substeps: int) -> Floats:
    """(3k, 3k) map of (q, v, z) over one control period at rest setpoints; `mass` (k, k) inertia matrix."""
    one = np.eye(len(gains))
    proportional = np.diag([g.proportional for g in gains])
    integral = np.diag([g.integral for g in gains])
    error = np.hstack([-np.diag([g.position for g in gains]), -one, 0 * one])
    z = np.hstack([0 * one, 0 * one, one]) + period_s * error
    acceleration = np.linalg.solve(mass, proportional @ error + integral @ z)
    half = period_s**2 * (substeps + 1) / (2 * substeps)
    q = np.hstack([one, period_s * one, 0 * one]) + half * acceleration
    v = np.hstack([0 * one, one, 0 * one]) + period_s * acceleration
    return np.vstack([q, v, z])


def spectral_radius(mass: Floats, gains: Sequence[Gains], period_s: float, substeps: int) -> float:
    """Largest modulus of the closed loop's eigenvalues; below 1 it is stable."""
    return float(np.abs(np.linalg.eigvals(closed_loop(mass, gains, period_s, substeps))).max())


def position_gain_limit(inertia: float, gains: Gains, period_s: float, substeps: int) -> float:
    """Kv [1/s] at which one axis alone becomes unstable; 0 if its velocity loop is unstable by itself."""
    mass = np.array([[inertia]])

    def stable(kv: float) -> bool:
        return spectral_radius(mass, [replace(gains, position=kv)], period_s, substeps) < 1.0

    low = high = 1e-3 / period_s
    if not stable(low):
        return 0.0
    while stable(high):  # ends: a high enough Kv destabilises every sampled loop
        low, high = high, 2.0 * high
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low


def require_stable(
    joints: Sequence[str],
    mass: Floats,
    gains: Sequence[Gains],
    spec: MachineSpec,
) -> None:
    """Raise InputError, with the limit, where an axis or the coupled axes together would diverge."""
    for joint, inertia, gain in zip(joints, mass.diagonal(), gains, strict=True):
        limit = position_gain_limit(float(inertia), gain, spec.control_period_s, spec.substeps)
        if limit == 0.0:
            raise InputError(
                f"drives.{joint}: the velocity loop is unstable (velocity_gain "
                f"{gain.proportional / inertia:.4g} 1/s, integral_time_s "
                f"{gain.proportional / gain.integral:.4g} s, period {spec.control_period_s:g} s)",
                place=spec.place,
                remedy="lower velocity_gain or lengthen integral_time_s",
            )
        if gain.position >= limit:
            raise InputError(
                f"drives.{joint}: position_gain {gain.position:.4g} 1/s makes the loop unstable",
                place=spec.place,
                remedy=f"stable below {limit:.4g} 1/s",
            )
    if (radius := spectral_radius(mass, gains, spec.control_period_s, spec.substeps)) >= 1.0:
        raise InputError(
            f"the drives of {', '.join(joints)} are stable one by one but not together "
            f"(spectral radius {radius:.4g})",
            place=spec.place,
            remedy="lower velocity_gain on the coupled slides",
        )
