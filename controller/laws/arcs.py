"""G02 and G03: the centre of an arc, and the displacements of all axes over its angle."""

import math
from collections.abc import Mapping

from controller.laws.wave import Wave, circle

Point = tuple[float, float]
"""[mm] in plane order, from the start of the arc"""
NOTHING = 1e-9
"""[mm] far below the least increment"""
_CLOSED = 1e-6
"""[mm] an end nearer to the start than this, a thousandth of an increment, makes a full circle"""


def arc_displacements(
    travel: Mapping[int, float], plane: tuple[int, int], centre: tuple[float, float], *, clockwise: bool
) -> tuple[float, float, dict[int, Wave]]:
    """Radius [mm], angle to go round [rad], and the displacement of every axis over that angle.

    `travel`: column -> from start to end; `centre` from the start, in plane order. Axes outside the plane go
    along in proportion. An end that is a little off the circle, as rounding of I and K leaves it, is reached
    by a shift that grows in proportion to the angle.
    """
    (first, second), (i, j) = plane, centre
    x, y = travel.get(first, 0.0), travel.get(second, 0.0)
    sense = -1 if clockwise else 1
    radius = math.hypot(i, j)
    if radius == 0.0:
        return 0.0, 0.0, {}
    if math.hypot(x, y) < _CLOSED:
        sweep = 2.0 * math.pi
    else:
        turn = math.atan2(-i * (y - j) + j * (x - i), -i * (x - i) - j * (y - j))
        sweep = (sense * turn) % (2.0 * math.pi)
    waves = {first: circle(0.0, i, j, sense), second: circle(0.0, j, i, -sense)}
    for axis, way in travel.items():
        wave = waves.get(axis, Wave(0.0))
        waves[axis] = Wave(wave.centre, wave.cosine, wave.sine, (way - wave.at(sweep)) / sweep)
    return radius, sweep, waves


def centre_from_radius(end: Point, radius: float, *, clockwise: bool, tolerance: float) -> Point | None:
    """The centre by R; half-way to an end up to `tolerance` [mm] too far; None where there is none."""
    over = math.hypot(*end) / 2.0 - abs(radius)
    if radius != 0.0 and 0.0 < over <= tolerance and math.hypot(*end) >= NOTHING:
        return end[0] / 2.0, end[1] / 2.0
    return centre_by_radius(end, radius, clockwise=clockwise)


def centre_from_offsets(centre: Point, end: Point, *, tolerance: float) -> Point | None:
    """The centre by I J K, as far from start and end alike; None where it is the start itself, or where the
    radii there and here differ by more than `tolerance` [mm]."""
    radius = math.hypot(*centre)
    if radius == 0.0 or abs(radius - math.hypot(end[0] - centre[0], end[1] - centre[1])) > tolerance:
        return None
    return equidistant(centre, end)


def centre_by_radius(end: Point, radius: float, *, clockwise: bool) -> Point | None:
    """Centre of the arc from the origin to `end` in a right-handed plane; None where there is none.

    A positive radius means the arc up to 180 degrees, a negative one the longer.
    """
    chord = math.hypot(*end)
    if chord < NOTHING or chord > 2.0 * abs(radius):
        return None  # also where the radius is 0
    height = math.sqrt(max(0.0, radius**2 - (chord / 2.0) ** 2))
    side = height / chord * (-1.0 if clockwise else 1.0) * math.copysign(1.0, radius)
    return end[0] / 2.0 - side * end[1], end[1] / 2.0 + side * end[0]


def equidistant(centre: Point, end: Point) -> Point:
    """The point nearest to `centre` as far from the origin as from `end`: rounded words, a true circle."""
    chord = math.hypot(*end)
    if chord < NOTHING:
        return centre
    along = (centre[0] * end[0] + centre[1] * end[1]) / chord - chord / 2.0
    return centre[0] - along * end[0] / chord, centre[1] - along * end[1] / chord
