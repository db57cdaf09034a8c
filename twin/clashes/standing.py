"""How much metal stands about points of the blank after some of its cuts."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.fields import Field

Floats = NDArray[np.float64]
FIRST, PAIRS = 8, 200_000
"""passes that are looked at first, and pairs of points and passes that are looked at together"""
FAR = 1e6
"""[mm]"""


def below_surface(blank: Blank, points: Floats, aside: float) -> Floats:
    """(n,) how deep points (n, 3) lie under the turned surface of the blank [mm], not above 0 outside; in a
    blank that is cut already 0 where nothing stands `aside` [mm] of them."""
    x, y, z = points.T
    r, (low, high) = np.hypot(x, y), blank.z_range
    depth = np.minimum(np.minimum(blank.outer_radius(z) - r, r - blank.bore_mm / 2.0), high - z)
    depth = np.minimum(depth, z - low)
    if blank.section is None:
        return depth
    under = np.flatnonzero(depth > aside)
    x, y, z = points[under].T
    across = np.column_stack([-y, x, np.zeros(len(z))]) * (aside / np.maximum(r[under], aside))[:, None]
    places = points[under]
    solid = blank.section.contains(places + across) & blank.section.contains(places - across)
    depth[under[~solid]] = 0.0
    return depth


def standing(points: Floats, cuts: list[tuple[Field, float]], *, enough: float) -> Floats:
    """(n,) how deep points (n, 3) lie under the surface that passes have left [mm], as far as it is above
    `enough`; `cuts` are fields, and up to which sample of their motion they count."""
    depth = np.full(len(points), FAR)
    if not len(points):
        return depth
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    radius = float(np.linalg.norm(points - middle, axis=1).max()) + enough
    for field, until in reversed(cuts):
        # the latest cuts are those that have been where the tool is now
        near = field.near(middle, radius)[::-1]
        first, size = 0, FIRST
        while first < len(near) and len(rows := np.flatnonzero(depth > enough)):
            some = near[first : first + min(size, max(1, PAIRS // len(rows)))]
            first, size = first + len(some), 2 * size
            met = field.evaluate(np.repeat(points[rows], len(some), axis=0), np.tile(some, len(rows)))
            cut = np.where(met.instant < until, met.depth, -FAR).reshape(len(rows), -1).max(axis=1)
            depth[rows] = np.minimum(depth[rows], -cut)
    return depth
