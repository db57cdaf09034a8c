"""Which way the rays of the stock are to lean: off the walls that tools leave standing.

An edge that is fed along the work axis, as the side of an insert, leaves a wall in front of it. Rays along
the wall would be met row by row; rays that rise away from it are met one by one, each across the chip. They
may lean only so far as nothing hangs over them: a wall on the other side would.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.motion import CutterMotion
from twin.load.stock import Lean

Floats = NDArray[np.float64]

STEP = 0.05
"""[mm] between two places of a tool, and two heights"""
PLACES = 50_000
"""looked at, at most"""
HANGS = 2.0 * STEP
"""[mm] of metal over a ray of slope 1 that counts as a wall"""


def lean_of(blank: Blank, motions: Sequence[tuple[Cutter, CutterMotion]]) -> Lean:
    """Of the rays for a blank that tools go through, one after the other: by 1 along z per radius where walls
    face +z alone, by −1 where they face −z alone, and to either side of where metal is met first, where those
    below it face +z and those above it −z. Else straight.

    Asked of the whole space that each tool turns in, and of every moment, for a wall may go again.
    """
    low, high = blank.z_range
    z = np.linspace(low, high, max(math.ceil((high - low) / STEP), 2) + 1)
    metal = blank.outer_radius(z)
    floor = metal.copy()
    above = below = crossed = False
    first: int | None = None
    for cutter, motion in motions:
        for x, middle in _places(cutter, motion, blank):
            reach = x - _outline(cutter, motion.basis[2], z - middle)
            if not (reach < floor).any():
                continue
            floor = np.minimum(floor, reach)
            cut = floor < metal
            if first is None:
                first = int(np.flatnonzero(cut).mean())
            above = above or _stands(floor, z, cut)
            below = below or _stands(floor[::-1], -z[::-1], cut[::-1])
            lower, upper = slice(first + 1), slice(first, None)
            crossed = crossed or _stands(floor[lower], z[lower], cut[lower])
            crossed = crossed or _stands(floor[upper][::-1], -z[upper][::-1], cut[upper][::-1])
    if not (above and below) or crossed or first is None or not low < z[first] < high:
        return Lean(slope=float(below) - float(above))
    return Lean(split=float(z[first]))


def _outline(cutter: Cutter, axis: Floats, off: Floats) -> Floats:
    """(n,) how far the tool's sides stand from its axis towards the work, `off` (n,) its middle along z;
    −inf beside it."""
    half = cutter.half_length if math.isfinite(cutter.profile.pitch) else cutter.profile.half_width
    square = cutter.radius**2 - (1.0 - axis[2] ** 2) * off * off
    inside = (square > 0.0) & (np.abs(off * axis[2]) <= half)
    return np.where(inside, np.sqrt(np.maximum(square, 0.0)), -np.inf)


def _places(cutter: Cutter, motion: CutterMotion, blank: Blank) -> Floats:
    """(k, 2) x and z of the tool's centre, near the work, not closer together than STEP."""
    place = motion.centre[:, [0, 2]]
    place = place[place[:, 0] - cutter.radius < blank.radius]
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(place, axis=0).T))])
    step = max(STEP, float(way[-1]) / PLACES)
    _, first = np.unique(np.floor(way[: len(place)] / step), return_index=True)
    return place[first]


def _stands(floor: Floats, z: Floats, cut: NDArray[np.bool_]) -> bool:
    """Whether metal stands on a ray of slope 1, at higher z than where it has left the `floor`."""
    height = floor - z
    over = np.maximum.accumulate(height[::-1])[::-1] - height
    return bool((over[cut] > HANGS).any())
