"""Closed-form motion: polynomials in time, piece by piece, and the time-optimal way along a path.

Nothing is ever accumulated from tick to tick: a position at any time is the value of one polynomial.
"""

import bisect
import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of constant acceleration along a path. Positional, because a million of them are made."""

    duration: float
    """[s]"""
    start: float
    """path position [mm | deg]"""
    speed: float
    """at the start [1/s]"""
    acceleration: float
    """[1/s²]"""

    @property
    def end(self) -> float:
        """Path position at the end."""
        return self.start + self.duration * (self.speed + 0.5 * self.acceleration * self.duration)

    @property
    def end_speed(self) -> float:
        """Speed at the end."""
        return self.speed + self.acceleration * self.duration


def trapezoid(length: float, *, speed: float, acceleration: float, start_speed: float = 0.0) -> list[Phase]:
    """The quickest way to standstill at path position `length` > 0, never faster than `speed` > 0.

    Starts at position 0 with `start_speed` >= 0. A start speed above `speed` is braked first; one that
    cannot stop within `length` is braked harder, to end exactly there.
    """
    braking = start_speed * start_speed / (2.0 * acceleration)
    if braking >= length:
        return [
            Phase(2.0 * length / start_speed, 0.0, start_speed, -start_speed * start_speed / (2.0 * length))
        ]
    peak = min(speed, math.sqrt(acceleration * length + 0.5 * start_speed * start_speed))
    peak = max(peak, min(start_speed, speed))
    change = acceleration if peak >= start_speed else -acceleration
    phases: list[Phase] = []
    position = 0.0
    if peak != start_speed:
        phases.append(Phase((peak - start_speed) / change, 0.0, start_speed, change))
        position = (peak * peak - start_speed * start_speed) / (2.0 * change)
    cruise = length - position - peak * peak / (2.0 * acceleration)
    if cruise > 0.0:
        phases.append(Phase(cruise / peak, position, peak, 0.0))
        position += cruise
    phases.append(Phase(peak / acceleration, position, peak, -acceleration))
    return phases


def clip(phases: list[Phase], duration: float) -> list[Phase]:
    """The first `duration` seconds of a motion."""
    kept: list[Phase] = []
    for phase in phases:
        if duration <= 0.0:
            break
        kept.append(Phase(min(phase.duration, duration), phase.start, phase.speed, phase.acceleration))
        duration -= phase.duration
    return kept


@dataclass(slots=True)
class Track:
    """Position of one axis over time: each knot holds a polynomial that is valid until the next knot."""

    times: list[float] = field(default_factory=lambda: [0.0])
    knots: list[tuple[float, float, float]] = field(default_factory=lambda: [(0.0, 0.0, 0.0)])
    """position, speed, half the acceleration, each at the knot's time"""

    def add(self, time: float, position: float, speed: float = 0.0, acceleration: float = 0.0) -> None:
        """From `time` on follow this polynomial; a knot at or after `time` is replaced."""
        while self.times and self.times[-1] >= time:
            self.times.pop()
            self.knots.pop()
        self.times.append(time)
        self.knots.append((position, speed, 0.5 * acceleration))

    def at(self, time: float) -> float:
        """Position at one time."""
        return self._state(time)[0]

    def speed(self, time: float) -> float:
        """Speed at one time; at a knot that of the piece that begins there."""
        return self._state(time)[1]

    def _state(self, time: float) -> tuple[float, float]:
        k = bisect.bisect_right(self.times, time) - 1
        position, speed, half = self.knots[k]
        tau = time - self.times[k]
        return position + tau * (speed + tau * half), speed + 2.0 * half * tau

    def sample(self, time: Floats) -> Floats:
        """(n,) positions at the ascending times (n,)."""
        first = max(bisect.bisect_right(self.times, time[0]) - 1, 0)
        last = bisect.bisect_right(self.times, time[-1])
        if last - first == 1:
            position, speed, half = self.knots[first]
            tau = time - self.times[first]
            return position + tau * (speed + tau * half)
        times = np.array(self.times[first:last])
        knots = np.array(self.knots[first:last])
        k = np.searchsorted(times[1:], time, side="right")
        tau = time - times[k]
        position, speed, half = knots[k].T
        return position + tau * (speed + tau * half)

    def still_until(self, time: float) -> float:
        """End of the standstill that holds at `time`; `time` itself where the axis moves, inf for ever."""
        k = bisect.bisect_right(self.times, time) - 1
        while k < len(self.times):
            if self.knots[k][1] != 0.0 or self.knots[k][2] != 0.0:
                return max(time, self.times[k])
            k += 1
        return math.inf

    def forget(self, before: float) -> None:
        """Drop the knots that no time from `before` on needs."""
        k = bisect.bisect_right(self.times, before) - 1
        if k > 0:
            del self.times[:k]
            del self.knots[:k]
