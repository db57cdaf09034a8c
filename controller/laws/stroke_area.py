"""A box of stroke limits, allowed or forbidden, and where a straight path or an arc first offends against it.

A path may leave what is forbidden where it stands in it, but not go further in. Positions are slide travel or
Cartesian [mm], whichever frame the area is set in; axes by column.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

from controller.laws.inclined import Frame
from controller.laws.wave import Wave

TOLERANCE = 1e-9
"""[mm] far below the least increment: a path that ends on the limit is inside"""
Bounds = tuple[float, float]
FREE: Bounds = (-math.inf, math.inf)
"""of an axis that has no part in an area"""


class Limit(Enum):
    """What stops an axis: its alarms in the plus and in the minus direction, and its parameters."""

    STROKE_1 = ("OT0500", "OT0501", "1320", "1321")
    STROKE_2 = ("OT0502", "OT0503", "1322", "1323")
    STROKE_3 = ("OT0504", "OT0505", "1324", "1325")
    SWITCH = ("OT0506", "OT0507", "*+L", "*-L")

    def alarm(self, *, upper: bool) -> str:
        """The alarm number."""
        return self.value[0 if upper else 1]


PRE_CHECK = {True: "OT0510", False: "OT0511"}
"""alarms of the check before motion (parameter 1301#7), by direction"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Crossing:
    """The first limit on a path."""

    fraction: float
    """of the path before the limit, 0 to 1"""
    axis: int
    """column"""
    upper: bool
    """whether the axis runs in its plus direction there"""
    bound: float = math.nan
    """[mm] the limit"""
    limit: Limit = Limit.STROKE_1
    frame: Frame = Frame.SLIDES
    before: bool = False
    """the path stops on the limit; else it begins to brake there (1300#7, BFA)"""
    wall: float = 1.0
    """of the path before another limit, on which the path stops at the latest while it brakes for this one"""
    foreseen: bool = False
    """found by the check before motion: nothing moves"""

    @property
    def number(self) -> str:
        """The alarm number."""
        return PRE_CHECK[self.upper] if self.foreseen else self.limit.alarm(upper=self.upper)


@dataclass(frozen=True, slots=True, kw_only=True)
class Area:
    """A box that is allowed, or forbidden, for the axes that have a part in it."""

    limit: Limit
    frame: Frame
    lower: tuple[float, ...]
    """(axes,) -inf where an axis has no part [mm]"""
    upper: tuple[float, ...]
    """(axes,)"""
    forbidden: bool
    """the inside is forbidden; else the outside"""
    before: bool = False

    def straight(self, start: Sequence[float], travel: Sequence[float]) -> Crossing | None:
        """The first limit on the straight path from `start` (axes,) by `travel` (axes,)."""
        law = _entering if self.forbidden else _leaving
        found = law(start, travel, self.lower, self.upper)
        return self._crossing(*found) if found else None

    def arc(self, waves: Sequence[Wave], sweep: float) -> Crossing | None:
        """The first limit on an arc, its coordinates (axes,) over the angles 0 to `sweep` [rad]."""
        law = _entering_on_arc if self.forbidden else _leaving_on_arc
        found = law(waves, sweep, self.lower, self.upper)
        return self._crossing(*found) if found else None

    def forbids(self, position: Sequence[float]) -> bool:
        """Whether a position (axes,) is not allowed."""
        inside = _depth(position, self.lower, self.upper)
        return inside > TOLERANCE if self.forbidden else inside < -TOLERANCE

    def _crossing(self, fraction: float, axis: int, upper: bool) -> Crossing:
        """An area is left in the plus direction at its upper end, a forbidden one is entered at its lower."""
        bound = self.upper[axis] if upper != self.forbidden else self.lower[axis]
        return Crossing(
            fraction=fraction,
            axis=axis,
            upper=upper,
            bound=bound,
            limit=self.limit,
            frame=self.frame,
            before=self.before,
        )


_Found = tuple[float, int, bool]
"""fraction of the path, column, whether in the plus direction"""


def _leaving(
    start: Sequence[float], travel: Sequence[float], lower: Sequence[float], upper: Sequence[float]
) -> _Found | None:
    """Where a straight path leaves the box. An axis already outside may come back, not go further out."""
    first: _Found | None = None
    for axis, way in enumerate(travel):
        if not way:
            continue
        here = start[axis]
        limit = upper[axis] if way > 0.0 else lower[axis]
        beyond = here + way - limit
        if (beyond if way > 0.0 else -beyond) <= TOLERANCE:
            continue
        fraction = max(0.0, (limit - here) / way)
        if first is None or fraction < first[0]:
            first = (fraction, axis, way > 0.0)
    return first


def _entering(
    start: Sequence[float], travel: Sequence[float], lower: Sequence[float], upper: Sequence[float]
) -> _Found | None:
    """Where a straight path enters the box; from inside, 0 where it goes further in."""
    if _depth(start, lower, upper) > TOLERANCE:
        return _deeper(start, travel, lower, upper)
    enters, leaves, which = 0.0, 1.0, -1
    for axis, way in enumerate(travel):
        low, high = lower[axis] + TOLERANCE, upper[axis] - TOLERANCE
        here = start[axis]
        if not way:
            if not low < here < high:
                return None
            continue
        near, far = ((low if way > 0.0 else high) - here) / way, ((high if way > 0.0 else low) - here) / way
        if near >= enters:
            enters, which = near, axis
        leaves = min(leaves, far)
    if which < 0 or enters >= leaves:
        return None
    way = travel[which]
    face = lower[which] if way > 0.0 else upper[which]
    return max(0.0, (face - start[which]) / way), which, way > 0.0


def _depth(position: Sequence[float], lower: Sequence[float], upper: Sequence[float]) -> float:
    """How far a position lies inside the box; below zero outside [mm]."""
    return min(min(p - low, high - p) for p, low, high in zip(position, lower, upper, strict=True))


def _deeper(
    position: Sequence[float], slope: Sequence[float], lower: Sequence[float], upper: Sequence[float]
) -> _Found | None:
    """From inside the box: whether a motion with this slope (axes,) goes away from its nearest face."""
    depth = _depth(position, lower, upper)
    away = [
        (gain, axis)
        for axis, here in enumerate(position)
        for distance, gain in ((here - lower[axis], slope[axis]), (upper[axis] - here, -slope[axis]))
        if distance <= depth + TOLERANCE
    ]
    gain, axis = min(away)
    return (0.0, axis, slope[axis] > 0.0) if gain > 0.0 else None


def _leaving_on_arc(
    waves: Sequence[Wave], sweep: float, lower: Sequence[float], upper: Sequence[float]
) -> _Found | None:
    """Where an arc leaves the box; an axis already outside may come back, not go further out."""
    first: _Found | None = None
    for axis, wave in enumerate(waves):
        low, high = wave.bounds(sweep)
        if lower[axis] <= low and high <= upper[axis]:
            continue
        start = wave.at(0.0)
        for bound, sign in ((max(upper[axis], start), 1.0), (min(lower[axis], start), -1.0)):
            if not math.isfinite(bound):
                continue
            places = [0.0, *wave.reaches(bound, sweep), sweep]
            for low, high in pairwise(places):
                if sign * (wave.at(0.5 * (low + high)) - bound) > TOLERANCE:
                    if first is None or low / sweep < first[0]:
                        first = (low / sweep, axis, sign > 0.0)
                    break
    return first


def _entering_on_arc(
    waves: Sequence[Wave], sweep: float, lower: Sequence[float], upper: Sequence[float]
) -> _Found | None:
    """Where an arc enters the box; from inside, 0 where it sets out further in."""
    start = [wave.at(0.0) for wave in waves]
    within = _depth(start, lower, upper) > TOLERANCE
    if within and (found := _deeper(start, [wave.slope(0.0) for wave in waves], lower, upper)):
        return found
    faces = [
        u
        for axis, wave in enumerate(waves)
        for bound in (lower[axis], upper[axis])
        if math.isfinite(bound)
        for u in wave.reaches(bound, sweep)
    ]
    for low, high in pairwise(sorted([0.0, *faces, sweep])):
        middle = [wave.at(0.5 * (low + high)) for wave in waves]
        inside = _depth(middle, lower, upper) > TOLERANCE
        if inside and not within:
            here = [wave.at(low) for wave in waves]
            depths = [min(p - a, b - p) for p, a, b in zip(here, lower, upper, strict=True)]
            axis = depths.index(min(depths))
            return low / sweep, axis, middle[axis] > here[axis]
        within = inside
    return None
