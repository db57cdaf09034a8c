"""Whether the sampled drives are stable, before anything moves; a refusal names the limit."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from twin.errors import InputError
from twin.machine.loops import Loops
from twin.machine.spec import MachineSpec

GENTLE = 1e-3
"""Kv times period of a position loop that leaves the velocity loop as it is"""


def position_gain_limit(loop: Loops) -> float:
    """Kv [1/s] at which one axis alone becomes unstable; 0 if its velocity loop is unstable by itself."""

    def stable(kv: float) -> bool:
        return _at(loop, kv).spectral_radius() < 1.0

    low = high = GENTLE / loop.period_s
    if not stable(low):
        return 0.0
    while stable(high):  # ends: a high enough Kv destabilises every sampled loop
        low, high = high, 2.0 * high
    return _edge(stable, low, high)


def velocity_gain_limit(loop: Loops) -> float:
    """Velocity gain [1/s] at which the velocity loop of one axis alone becomes unstable with its reset
    time; 0 if every one is unstable."""
    (gains,) = loop.gains
    inertia, reset = float(loop.mass[0, 0]), gains.proportional / gains.integral

    def stable(gain: float) -> bool:
        tuned = replace(
            gains,
            position=GENTLE / loop.period_s,
            proportional=gain * inertia,
            integral=gain * inertia / reset,
        )
        return replace(loop, gains=[tuned]).spectral_radius() < 1.0

    low, high = 1e-2 / loop.period_s, 10.0 / loop.period_s
    return _edge(stable, low, high) if stable(low) else 0.0


def require_stable(joints: Sequence[str], loops: Loops, spec: MachineSpec) -> None:
    """Raise InputError, with the limit, where an axis or the coupled axes together would diverge."""
    for k, (joint, gain) in enumerate(zip(joints, loops.gains, strict=True)):
        loop = loops.alone(k)
        if loop.spectral_radius() < 1.0 and _at(loop, GENTLE / loop.period_s).spectral_radius() < 1.0:
            continue
        limit = position_gain_limit(loop)
        if limit == 0.0:
            reset = gain.proportional / gain.integral
            highest = velocity_gain_limit(loop)
            raise InputError(
                f"drives.{joint}: the velocity loop is unstable (velocity_gain "
                f"{gain.proportional / loop.mass[0, 0]:.4g} 1/s, integral_time_s {reset:.4g} s, "
                f"period {spec.control_period_s:g} s)",
                place=spec.place_of(("drives", joint, "velocity_gain"), ("drives", joint, "integral_time_s")),
                remedy=f"stable below {highest:.4g} 1/s" if highest else "lengthen integral_time_s",
            )
        if gain.position >= limit:
            raise InputError(
                f"drives.{joint}: position_gain {gain.position:.4g} 1/s makes the loop unstable",
                place=spec.place_of(("drives", joint, "position_gain")),
                remedy=f"stable below {limit:.4g} 1/s",
            )
    if (radius := loops.spectral_radius()) >= 1.0:
        raise InputError(
            f"the drives of {', '.join(joints)} are stable one by one but not together "
            f"(spectral radius {radius:.4g})",
            place=spec.place,
            remedy="lower velocity_gain on the coupled slides",
        )


def _at(loop: Loops, position_gain: float) -> Loops:
    """One axis alone with another Kv."""
    (gains,) = loop.gains
    return replace(loop, gains=[replace(gains, position=position_gain)])


def _edge(stable: Callable[[float], bool], low: float, high: float) -> float:
    """Where stability ends between a stable and an unstable value."""
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low
