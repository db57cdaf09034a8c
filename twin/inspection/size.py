"""Sizes of a gear: tip and root diameter, and the span as parallel jaws feel it."""

import math

import numpy as np

from twin.inspection.reading import Placed
from twin.inspection.sections import points_between
from twin.inspection.solid import Floats, Ints, Solid

FACING = 0.1
"""[rad] a flank touches a jaw where it faces it up to this"""


def tip_and_root_radii(solid: Solid, placed: Placed, *, root_radius: float) -> tuple[Floats, Floats]:
    """Return the largest radius of every tooth and the smallest of every gap, (z,) each [mm].

    `root_radius` [mm] is about where the gaps end: what lies well inside, a bore, is left out.
    """
    points = points_between(solid, placed.low, placed.high)
    radius = np.hypot(points[:, 0], points[:, 1])
    outer = radius >= 0.95 * root_radius
    points, radius = points[outer], radius[outer]
    angle = placed.turned_back(np.arctan2(points[:, 1], points[:, 0]), points[:, 2])
    teeth = placed.gear.teeth
    tips = np.full(teeth, -np.inf)
    np.maximum.at(tips, placed.tooth(angle)[0], radius)
    gaps = np.full(teeth, np.inf)
    np.minimum.at(gaps, placed.tooth(angle + math.pi / teeth)[0], radius)
    return tips, gaps


def measure_span(
    solid: Solid, placed: Placed, k: int, *, form_radius: float, tip_radius: float
) -> tuple[float | None, str]:
    """Return the mean span [mm] over every group of k teeth, or None and the reason.

    `form_radius` and `tip_radius` [mm] are where the usable flanks begin and end.

    Two parallel planes, inclined by the base helix angle and square to the middle of the group, are closed
    on the outer flanks until they touch where these face them: the teeth of a wide helical gear turn away
    from the jaws, and through their planes again.
    """
    gear = placed.gear
    if k > gear.teeth / 2:
        return None, f"a span over {k} of {gear.teeth} teeth does not lie between parallel jaws"
    needed = gear.span(k) * math.sin(abs(gear.base_helix))
    if placed.high - placed.low <= needed:
        return None, f"the span over {k} teeth of this helix needs a face wider than {needed:.2f} mm"
    points, ends = _by_flank(points_between(solid, placed.low, placed.high), placed, form_radius, tip_radius)
    radius = np.hypot(points[:, 0], points[:, 1])
    side = np.repeat(np.tile([-1.0, 1.0], gear.teeth), np.diff(ends))
    facing = np.arctan2(points[:, 1], points[:, 0]) + side * np.arcsin(
        np.minimum(gear.base_radius / radius, 1.0)
    )
    spans = []
    for first in range(gear.teeth):
        middle = placed.phase - 2 * math.pi * (first + (k - 1) / 2) / gear.teeth + math.pi / 2
        normal = np.array(
            [
                math.cos(gear.base_helix) * math.cos(middle),
                math.cos(gear.base_helix) * math.sin(middle),
                -math.sin(gear.base_helix),
            ]
        )
        last = (first + k - 1) % gear.teeth
        sides = (slice(*ends[2 * first + 1 : 2 * first + 3]), slice(*ends[2 * last : 2 * last + 2]))
        span = 0.0
        for flank, towards, sense in zip(sides, (middle, middle + math.pi), (1.0, -1.0), strict=True):
            if flank.start == flank.stop:
                return None, f"tooth {first + 1} or {last + 1} has no flank to touch"
            away = np.abs(np.mod(facing[flank] - towards + math.pi, 2 * math.pi) - math.pi)
            near = flank.start + np.flatnonzero(away <= max(FACING, 2 * float(away.min())))
            reach = sense * (points[near] @ normal)
            touch = int(np.argmax(reach))
            if radius[near[touch]] > tip_radius - 0.02 * gear.module:
                return None, f"jaws over {k} teeth touch the tips, not the flanks"
            span += float(reach[touch])
        spans.append(span)
    return float(np.mean(spans)), ""


def _by_flank(points: Floats, placed: Placed, low: float, high: float) -> tuple[Floats, Ints]:
    """Sort points between two radii [mm] by flank: a tooth's right one, then its left one.

    Returns the points (n, 3), and where each flank's begin and the last one's end (2 z + 1,).
    """
    radius = np.hypot(points[:, 0], points[:, 1])
    points = points[(radius >= low) & (radius <= high)]
    tooth, offset = placed.tooth(placed.turned_back(np.arctan2(points[:, 1], points[:, 0]), points[:, 2]))
    flank = (2 * tooth + (offset > 0)).astype(np.uint16)  # no more than 20 000, and sorted by digits
    order = np.argsort(flank, kind="stable")
    return points[order], np.searchsorted(flank[order], np.arange(2 * placed.gear.teeth + 1))
