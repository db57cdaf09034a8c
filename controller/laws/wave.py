"""One coordinate along a circular arc: centre + cosine · cos u + sine · sin u + rate · u, and where it turns.

u is the angle from the start of the arc [rad], growing along the path. Axes of the plane have a cosine and a
sine, axes that go along in proportion (a helix) a rate; a slide of an inclined pair is a sum of both.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

_TURN = 2.0 * math.pi
_HALVINGS = 60
"""of an interval of a few radians: down to the last bit of a float"""


@dataclass(frozen=True, slots=True)
class Wave:
    """A coordinate as a function of u."""

    centre: float
    """[mm]"""
    cosine: float = 0.0
    """[mm]"""
    sine: float = 0.0
    """[mm]"""
    rate: float = 0.0
    """[mm/rad]"""

    def at(self, u: float) -> float:
        """The coordinate [mm]."""
        return self.centre + self.cosine * math.cos(u) + self.sine * math.sin(u) + self.rate * u

    def slope(self, u: float) -> float:
        """Its derivative [mm/rad]."""
        return self.sine * math.cos(u) - self.cosine * math.sin(u) + self.rate

    def plus(self, other: "Wave", factor: float) -> "Wave":
        """This coordinate and `factor` times another one."""
        return Wave(
            self.centre + factor * other.centre,
            self.cosine + factor * other.cosine,
            self.sine + factor * other.sine,
            self.rate + factor * other.rate,
        )

    def bounds(self, sweep: float) -> tuple[float, float]:
        """Values [mm] that it neither falls below nor exceeds, 0 <= u <= sweep; of a short arc wide ones."""
        amplitude, drift = math.hypot(self.cosine, self.sine), self.rate * sweep
        return self.centre - amplitude + min(drift, 0.0), self.centre + amplitude + max(drift, 0.0)

    def turning(self, sweep: float) -> list[float]:
        """Where the coordinate is stationary, ascending, 0 < u < sweep."""
        amplitude = math.hypot(self.cosine, self.sine)
        if amplitude <= abs(self.rate):
            return []  # it never turns back, or only rests for an instant
        phase = math.atan2(self.sine, self.cosine)
        lean = math.asin(self.rate / amplitude)
        return _repeated((phase + lean, phase + math.pi - lean), sweep)

    def reaches(self, value: float, sweep: float) -> list[float]:
        """Where the coordinate has a value [mm], ascending, 0 <= u <= sweep."""
        amplitude = math.hypot(self.cosine, self.sine)
        if self.rate == 0.0:
            if amplitude == 0.0 or abs(value - self.centre) > amplitude:
                return []
            phase = math.atan2(self.sine, self.cosine)
            half = math.acos((value - self.centre) / amplitude)
            return _repeated((phase - half, phase + half), sweep)
        ends = [0.0, *self.turning(sweep), sweep]
        return [
            self._crossing(value, low, high)
            for low, high in pairwise(ends)
            if (self.at(low) - value) * (self.at(high) - value) <= 0.0
        ]

    def _crossing(self, value: float, low: float, high: float) -> float:
        """The one place between two turns where a value lies, by halving."""
        rising = self.at(low) < value
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if (self.at(middle) < value) is rising:
                low = middle
            else:
                high = middle
        return high


def circle(start: float, offset: float, other: float, sense: int) -> Wave:
    """A coordinate of an arc's plane.

    `start` is where it begins [mm]; `offset` and `other` lead from there to the centre, along this and along
    the other axis of the plane [mm]; `sense` is +1 where the arc turns from this axis towards the other.
    """
    return Wave(start + offset, -offset, sense * other)


def _repeated(angles: tuple[float, float], sweep: float) -> list[float]:
    """All angles that are one of two modulo a turn, ascending, 0 <= u <= sweep."""
    found: list[float] = []
    for angle in angles:
        u = angle % _TURN
        while u <= sweep:
            found.append(u)
            u += _TURN
    return sorted(found)
