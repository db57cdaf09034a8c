"""The outline of half a cutting tooth as a chain of lines and arcs, from the tip down."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from twin.cutters.convex import Point
from twin.errors import InputError

CHORD = 1e-4
"""Where hollow arcs are replaced by chords, these stay this close to them [mm]."""
SAME = 1e-9
"""[mm] below which two points are one"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stroke:
    """A line, or an arc that never runs up again."""

    start: Point
    """(x, rho): half-width and distance from the tool axis [mm]"""
    end: Point
    radius: float = 0.0
    """of an arc, + bulging out of the tooth, − hollow; 0 = a line"""

    @property
    def centre(self) -> Point:
        """Of the arc [mm]."""
        (x0, y0), (x1, y1) = self.start, self.end
        chord = math.hypot(x1 - x0, y1 - y0)
        back = math.copysign(math.sqrt(max(self.radius**2 - chord**2 / 4.0, 0.0)), self.radius) / chord
        return (x0 + x1) / 2.0 + back * (y1 - y0), (y0 + y1) / 2.0 - back * (x1 - x0)

    @property
    def first_normal(self) -> Point:
        """Outward unit normal at the start."""
        return self._normal(self.start)

    @property
    def last_normal(self) -> Point:
        """Outward unit normal at the end."""
        return self._normal(self.end)

    def _normal(self, at: Point) -> Point:
        if self.radius:
            cx, cy = self.centre
            return (at[0] - cx) / self.radius, (at[1] - cy) / self.radius
        dx, dy = self.end[0] - self.start[0], self.end[1] - self.start[1]
        length = math.hypot(dx, dy)
        return -dy / length, dx / length

    def half_width(self, rho: float) -> float:
        """x at a distance `rho` from the axis between the ends' [mm]."""
        (x0, y0), (x1, y1) = self.start, self.end
        if self.radius:
            cx, cy = self.centre
            return cx + math.copysign(math.sqrt(max(self.radius**2 - (rho - cy) ** 2, 0.0)), self.radius)
        return x0 + (x1 - x0) * (rho - y0) / (y1 - y0)


def read_chain(points: Sequence[Sequence[float]], tip: float, *, chords: bool) -> tuple[Stroke, ...]:
    """The strokes of a tooth with its tip at `tip` [mm] from the axis.

    `points` are (half-width, depth below the tip) [mm], from the tip down, with the radius of the arc to
    the next point where there is one: + bulges out of the tooth, − is hollow. With `chords` a hollow arc
    becomes lines within CHORD of it. Raises InputError for a chain that runs up, back or across the middle,
    or an arc that cannot be.
    """
    _check(points, tip)
    strokes: list[Stroke] = []
    first = (points[0][0], tip)
    if first[0] > SAME:
        strokes.append(Stroke(start=(0.0, tip), end=first))
    for number, (here, there) in enumerate(pairwise(points), start=1):
        start, end = (here[0], tip - here[1]), (there[0], tip - there[1])
        radius = here[2] if len(here) > 2 else 0.0
        stroke = Stroke(start=start, end=end, radius=radius)
        _check_arc(number, stroke)
        strokes += _chords(stroke) if chords and radius < 0 else [stroke]
    return tuple(strokes)


def _check(points: Sequence[Sequence[float]], tip: float) -> None:
    """Raise InputError where the points alone make no chain."""
    if len(points) < 2:
        raise InputError("a profile needs at least two points", remedy="[[half-width, depth], …] in mm")
    for number, point in enumerate(points, start=1):
        if len(point) not in {2, 3}:
            raise InputError(
                f"profile point {number} has {len(point)} numbers",
                remedy="valid: [half-width, depth] or [half-width, depth, radius of the arc to the next]",
            )
        if not all(math.isfinite(value) for value in point):
            raise InputError(f"profile point {number} is not finite")
        if point[0] < 0:
            raise InputError(
                f"profile point {number} lies beyond the middle of the tooth, at half-width {point[0]:g} mm",
                remedy="valid: 0 or more",
            )
        if number > 1 and point[0] < SAME:
            raise InputError(f"the tooth has no width at profile point {number}", remedy="valid: above 0")
    if points[0][1] != 0:
        raise InputError(
            f"the profile begins at depth {points[0][1]:g} mm", remedy="valid: 0, the tip of the tooth"
        )
    if len(points[-1]) > 2:
        raise InputError("the radius of the last profile point leads to no other point")
    _check_steps(points)
    deepest = points[-1][1]
    if not 0 < deepest < tip:
        raise InputError(
            f"the profile ends at depth {deepest:g} mm",
            remedy=f"valid: above 0, less than the tip's radius {tip:g} mm",
        )


def _check_steps(points: Sequence[Sequence[float]]) -> None:
    """Raise InputError where the chain runs up, stands still, or back on itself."""
    flat = False
    for number, (here, there) in enumerate(pairwise(points), start=1):
        if there[1] < here[1]:
            raise InputError(
                f"the profile runs up again from depth {here[1]:g} to {there[1]:g} mm between its points "
                f"{number} and {number + 1}",
                remedy="valid: from the tip down, depths never less than before",
            )
        level = there[1] - here[1] < SAME
        if level and abs(there[0] - here[0]) < SAME:
            raise InputError(f"profile points {number} and {number + 1} are the same")
        if level and (flat or (number == 1 and there[0] < here[0])):
            raise InputError(f"the profile runs back on itself at depth {here[1]:g} mm, point {number}")
        flat = level


def _check_arc(number: int, stroke: Stroke) -> None:
    """Raise InputError for an arc that does not reach, turns back in depth, or crosses the middle."""
    start, end, radius = stroke.start, stroke.end, stroke.radius
    if radius == 0:
        return
    chord = math.hypot(end[0] - start[0], end[1] - start[1])
    if 2.0 * abs(radius) < chord - SAME:
        raise InputError(
            f"an arc of {radius:g} mm cannot reach from profile point {number} to the next, {chord:g} mm off",
            remedy=f"valid: {chord / 2:.6g} or more (− for a hollow arc)",
        )
    one, other = stroke.first_normal, stroke.last_normal
    if min(one[0], other[0]) < -SAME:
        raise InputError(
            f"the arc of {radius:g} mm from profile point {number} runs up again before the next",
            remedy="a larger radius, or a point more",
        )
    if radius < 0 and one[1] * other[1] < 0 and stroke.centre[0] + radius < 0:
        raise InputError(f"the hollow arc from profile point {number} crosses the middle of the tooth")


def _chords(hollow: Stroke) -> list[Stroke]:
    """Lines in place of a hollow arc."""
    start, end, radius = hollow.start, hollow.end, -hollow.radius
    cx, cy = hollow.centre
    first = math.atan2(start[1] - cy, start[0] - cx) % (2.0 * math.pi)
    last = math.atan2(end[1] - cy, end[0] - cx) % (2.0 * math.pi)
    step = 2.0 * math.acos(max(1.0 - CHORD / radius, 0.0))
    count = max(1, math.ceil(abs(last - first) / step))
    inner = [first + (last - first) * k / count for k in range(1, count)]
    points = [start, *((cx + radius * math.cos(a), cy + radius * math.sin(a)) for a in inner), end]
    return [Stroke(start=a, end=b) for a, b in pairwise(points)]
