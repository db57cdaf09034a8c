"""Balls in the gaps: their runout and the size over two of them.

A ball that touches both flanks of a gap has its centre on the involutes that lie one ball radius outside the
flanks, so the two flanks' deviations where it touches them give the pressure angle at its centre, and with it
how deep it lies. Exact for flanks that are shifted as a whole, first order for anything else.
"""

import math

import numpy as np

from twin.inspection.involute import Involute
from twin.inspection.reading import Placed, read_flanks
from twin.inspection.solid import Floats, Solid

# fmt: off
BALLS = (
    0.5, 0.55, 0.62, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.4, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5,
    3.75, 4.0, 4.25, 4.5, 5.0, 5.25, 5.5, 6.0, 6.5, 7.0, 7.5, 8.0, 9.0, 10.0, 10.5, 11.0, 12.0, 14.0, 16.0,
    18.0, 20.0, 22.0, 25.0, 28.0, 30.0, 35.0, 40.0, 45.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0,
)
# fmt: on
"""usual ball diameters [mm]"""
SMALLEST = 1.68
"""a ball smaller than this many modules is not looked at"""


def choose_ball(gear: Involute, *, tip_radius: float) -> float | None:
    """Return the smallest usual ball [mm] that touches between form and tip circle, if any does."""
    fitting = (b for b in BALLS if b >= SMALLEST * gear.module and _touches(gear, b, tip_radius=tip_radius))
    return next(fitting, None)


def measure_balls(
    solid: Solid, placed: Placed, ball: float, *, tip_radius: float
) -> tuple[tuple[Floats, Floats] | None, str]:
    """Return where balls lie in the gaps, or None and why.

    Args:
        solid: the gear.
        placed: its geometry in place.
        ball: diameter [mm].
        tip_radius: where the shortest tooth ends [mm].

    Returns:
        the radius (z,) [mm] of a ball's centre in every gap, from tooth 1 clockwise, and (z,) [mm] how much
        of it the mesh's chords make.

    """
    gear = placed.gear
    if not _touches(gear, ball, tip_radius=tip_radius):
        return None, f"a ball of {ball:g} mm does not touch the flanks between form and tip diameter"
    radius, above = _contact(gear, ball)
    heights = np.array([placed.middle - abs(above), placed.middle + abs(above)])
    if heights[0] <= placed.low or heights[1] >= placed.high:
        return None, f"a ball of {ball:g} mm does not touch both flanks within this face width"
    read = read_flanks(solid, placed, np.unique(heights), np.array([radius]))
    left_plane, right_plane = (-1, 0) if above > 0 else (0, -1)

    def lift(table: Floats) -> Floats:
        """A gap lies between a tooth's right flank and the next one's left."""
        facing = np.roll(table[0, left_plane, 0], -1)
        return (table[1, right_plane, 0] + facing) / 2000 / gear.base_radius

    found = lift(read.deviation)
    if not np.isfinite(found).all():
        return None, "the flanks have holes where the balls touch"
    centres, smooth = (
        gear.base_radius / np.cos(gear.ball_angle(ball, each)) for each in (found, found - lift(read.facet))
    )
    return (centres, centres - smooth), ""


def over_balls(centres: Floats, ball: float) -> float:
    """Return the mean size [mm] over two balls as opposite as the number of gaps allows."""
    teeth = len(centres)
    other = np.roll(centres, teeth // 2)
    apart = 2 * math.pi * (teeth // 2) / teeth
    return float(np.mean(np.sqrt(centres**2 + other**2 - 2 * centres * other * math.cos(apart)))) + ball


def _touches(gear: Involute, ball: float, *, tip_radius: float) -> bool:
    try:
        radius, _ = _contact(gear, ball)
    except ValueError:
        return False
    return gear.form_diameter / 2 < radius < tip_radius


def _contact(gear: Involute, ball: float) -> tuple[float, float]:
    """Return the radius [mm] where a ball touches, and how far above its centre on a left flank."""
    roll = gear.base_radius * math.tan(float(gear.ball_angle(ball))) - ball / 2 * math.cos(gear.base_helix)
    if roll <= 0:
        raise ValueError(f"a ball of {ball} mm touches inside the base circle")
    return float(gear.radius_at(roll)), ball / 2 * math.sin(gear.base_helix)
