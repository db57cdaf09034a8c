"""Closed-form motion: pieces in time, one after the other, and the time-optimal way along a path.

Nothing is ever accumulated from tick to tick: a position at any time is the value of one piece, a polynomial
or a point that goes round a circle.
"""

import bisect
import math
from collections.abc import Iterable
from typing import NamedTuple

from controller.laws.wave import Wave


class Phase(NamedTuple):
    """A stretch of constant acceleration along a path."""

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


def trapezoid(
    length: float, *, speed: float, acceleration: float, start_speed: float = 0.0, start: float = 0.0
) -> list[Phase]:
    """The quickest way to standstill `length` > 0 behind path position `start`, at most at `speed` > 0.

    Begins with `start_speed` >= 0. A start speed above `speed` is braked first; one that cannot stop within
    `length` is braked harder, to end exactly there.
    """
    braking = start_speed * start_speed / (2.0 * acceleration)
    if braking >= length:
        rate = start_speed * start_speed / (2.0 * length)
        return [Phase(2.0 * length / start_speed, start, start_speed, -rate)]
    peak = min(speed, math.sqrt(acceleration * length + 0.5 * start_speed * start_speed))
    peak = max(peak, min(start_speed, speed))
    phases: list[Phase] = []
    position = 0.0
    if peak != start_speed:
        change = acceleration if peak > start_speed else -acceleration
        phases.append(Phase((peak - start_speed) / change, start, start_speed, change))
        position = (peak * peak - start_speed * start_speed) / (2.0 * change)
    cruise = length - position - peak * peak / (2.0 * acceleration)
    if cruise > 0.0:
        phases.append(Phase(cruise / peak, start + position, peak, 0.0))
        position += cruise
    phases.append(Phase(peak / acceleration, start + position, peak, -acceleration))
    return phases


def clip(phases: Iterable[Phase], duration: float) -> list[Phase]:
    """The first `duration` seconds of a motion."""
    kept: list[Phase] = []
    for phase in phases:
        if duration <= 0.0:
            break
        kept.append(phase if phase.duration <= duration else phase._replace(duration=duration))
        duration -= phase.duration
    return kept


Straight = tuple[float, float, float]
"""position, speed, half the acceleration"""
Round = tuple[Wave, float, float, float]
"""coordinate over the angle, and the angle's position [rad], speed, half its acceleration"""


class Track:
    """Position of one axis over time: each knot holds a piece that is valid until the next knot."""

    __slots__ = ("knots", "times")

    def __init__(self) -> None:
        self.times: list[float] = [0.0]
        self.knots: list[Straight | Round] = [(0.0, 0.0, 0.0)]
        """each counts from its own time"""

    def add(self, time: float, position: float, speed: float = 0.0, acceleration: float = 0.0) -> None:
        """From `time` on follow this polynomial; a knot at or after `time` is replaced."""
        times = self.times
        while times and times[-1] >= time:
            times.pop()
            self.knots.pop()
        times.append(time)
        self.knots.append((position, speed, 0.5 * acceleration))

    def add_round(self, time: float, wave: Wave, angle: float, speed: float, acceleration: float) -> None:
        """From `time` on go round: the coordinate `wave` at an angle [rad] of this start, speed and rate."""
        self.add(time, 0.0)
        self.knots[-1] = (wave, angle, speed, 0.5 * acceleration)

    @property
    def rest(self) -> float:
        """Where the axis comes to rest, as far as its motion is planned."""
        knot = self.knots[-1]
        return knot[0] if len(knot) == 3 else knot[0].at(knot[1])

    def at(self, time: float) -> float:
        """Position at one time."""
        if time >= self.times[-1]:
            tau, knot = time - self.times[-1], self.knots[-1]
        else:
            k = bisect.bisect_right(self.times, time) - 1
            tau, knot = time - self.times[k], self.knots[k]
        if len(knot) == 3:
            return knot[0] + tau * (knot[1] + tau * knot[2])
        wave, angle, speed, half = knot
        return wave.at(angle + tau * (speed + tau * half))

    def speed(self, time: float) -> float:
        """Speed at one time; at a knot that of the piece that begins there."""
        k = len(self.times) - 1 if time >= self.times[-1] else bisect.bisect_right(self.times, time) - 1
        tau, knot = time - self.times[k], self.knots[k]
        if len(knot) == 3:
            return knot[1] + 2.0 * knot[2] * tau
        wave, angle, speed, half = knot
        return wave.slope(angle + tau * (speed + tau * half)) * (speed + 2.0 * half * tau)

    def still_until(self, time: float) -> float:
        """End of the standstill that holds at `time`; `time` itself where the axis moves, inf for ever."""
        k = bisect.bisect_right(self.times, time) - 1
        while k < len(self.times):
            if any(self.knots[k][-2:]):
                return max(time, self.times[k])
            k += 1
        return math.inf

    def forget(self, before: float) -> None:
        """Drop the knots that no time from `before` on needs."""
        k = bisect.bisect_right(self.times, before) - 1
        if k > 0:
            del self.times[:k]
            del self.knots[:k]
