"""G02 and G03: the displacements of all axes over the angle of the arc."""

import math
from collections.abc import Mapping

from controller.laws.wave import Wave, circle

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
