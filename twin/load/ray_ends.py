"""Where a pass cuts a ray of the stock off: where its depth along the ray is zero."""

import math

import numpy as np
from numpy.typing import NDArray

from twin.cutting.field import DepthField
from twin.load.stock import Stock

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STEPS = 20
"""towards the end of a ray, at most"""
HALVED = 3
"""steps after which the bound that has stood is taken to lie nearer"""
CLOSE = 1e-5
"""[mm] of depth at which the end of a ray counts as found"""
SLACK = 0.02
"""[mm] added to the way of the stock until it meets an edge"""


def cut_at(field: DepthField, rays: Stock, ray: Ints, index: Ints) -> Floats:
    """(n,) radii at which passes cut rays off; inf where they do not."""
    out = np.full(len(ray), np.inf)
    high = rays.end[ray]
    meeting = field.evaluate(rays.points(ray, high), index)
    cut = np.flatnonzero(meeting.depth > 0)
    ray, index, high, above = ray[cut], index[cut], high[cut], meeting.depth[cut]
    low = high - 2.0 * (field.cutter.radius - meeting.rho[cut]) - SLACK
    below = np.ones(len(cut))
    inside = np.arange(len(cut))
    while len(inside):
        # inclined rays may leave an edge further in than their ends stand in it
        low[inside] = np.maximum(low[inside], rays.inner[ray[inside]])
        below[inside] = field.evaluate(rays.points(ray[inside], low[inside]), index[inside]).depth
        inside = inside[(below[inside] >= 0) & (low[inside] > rays.inner[ray[inside]])]
        low[inside] -= high[inside] - low[inside]
    through = below >= 0  # the edge comes from below, or through to the bore
    below = np.where(through, -above, below)
    zero = _zero(field, rays, (ray, index), (low, below), (high, above))
    out[cut] = np.where(through, rays.inner[ray], zero)
    return out


def _zero(
    field: DepthField,
    rays: Stock,
    pairs: tuple[Ints, Ints],
    outside: tuple[Floats, Floats],
    inside: tuple[Floats, Floats],
) -> Floats:
    """(n,) radii between others, (n,) each with their depths below and above 0, where the depth is zero.

    Secants between the last two, which start from inside: depth grows no faster than the way along the ray,
    so nothing is passed over. A secant that leaves the bounds gives way to false position between them.
    """
    (low, below), (high, above) = (
        tuple(value.copy() for value in outside),
        tuple(value.copy() for value in inside),
    )
    before, depth_before = high.copy(), above.copy()
    at = np.maximum(high - above / math.hypot(1.0, rays.slope), low)
    rows = np.arange(len(at))
    for step in range(STEPS):
        depth = field.evaluate(rays.points(pairs[0][rows], at[rows]), pairs[1][rows]).depth
        cuts = depth > 0
        ins, outs = rows[cuts], rows[~cuts]
        high[ins], above[ins] = at[ins], depth[cuts]
        low[outs], below[outs] = at[outs], depth[~cuts]
        if step % HALVED == HALVED - 1:
            below[ins] *= 0.5
            above[outs] *= 0.5
        open_ = np.abs(depth) > CLOSE
        rows, depth = rows[open_], depth[open_]
        if not len(rows):
            break
        x, lower, upper = at[rows], low[rows], high[rows]
        change = depth - depth_before[rows]
        secant = x - depth * (x - before[rows]) / np.where(change == 0.0, 1.0, change)
        false = upper - above[rows] / (above[rows] - below[rows]) * (upper - lower)
        fits = (change != 0.0) & (secant > lower) & (secant < upper)
        before[rows], depth_before[rows] = x, depth
        at[rows] = np.where(fits, secant, false)
    return at
