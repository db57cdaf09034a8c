"""A part of a cutting tooth with hollow arcs: not convex, but concave in depth but for a known bend.

Its outline never runs up again, its corners are convex, and its hollow arcs have radii of R or more. Then a
point outside that is less than R off has a single nearest place on it. For if there were two, a distance
d < R off in directions whose angles to the tool's axis are a < b, the outline would come down by
d (sin b − sin a) from the one to the other, and its normal turn from a to b. Only hollow arcs turn it that
way, and these come down by at least R (sin b − sin a) on the way. So a disc of radius R fits against any
place of it from outside.

At a point of depth D > −R that disc, against the nearest place, has its centre c at the distance D + R.
Nowhere is the depth more than the distance from c less R, and here it is just that. So anywhere in the rake
plane

    depth(p + w) <= depth(p) + gradient · w + w² / (2 (D + R)),

from which `DepthField.bound` follows. R is infinite for a convex piece.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.convex import Point, Round

Floats = NDArray[np.float64]

EDGE = 1e-6
"""[rad] by which a point may lie beside what faces it: between strokes that run on without a corner, rounding
leaves no gap"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Straight:
    """A straight stretch of the outline."""

    start: Point
    """(x, rho) of its upper end [mm]"""
    normal: Point
    """unit, outwards"""
    length: float
    """[mm]; inf = it goes on for ever"""


@dataclass(frozen=True, slots=True, kw_only=True)
class HollowPiece:
    """A region of the rake half-plane, symmetric about x = 0: the right half of its outline.

    Depth is the signed distance to the outline, positive inside. It is 1-Lipschitz.
    """

    parts: tuple[Straight | Round, ...]
    """from the middle of the tip down; corners are rounds of radius 0, hollow arcs such of a negative one"""
    hollow: float
    """the least radius of its hollow arcs [mm]"""
    half_width: float
    """half its width at its widest above the land [mm]"""

    def depth(self, x: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
        """Depth at `x` >= 0 from the middle and `rho` from the tool axis, and its derivatives by both."""
        near = np.full(x.shape, np.inf)
        depth = np.full(x.shape, np.inf)
        by_x, by_rho = np.zeros(x.shape), np.zeros(x.shape)
        for part in self.parts:
            if isinstance(part, Straight):
                _straight(part, (x, rho), (near, depth, by_x, by_rho))
            else:
                _round(part, (x, rho), (near, depth, by_x, by_rho))
        return depth, by_x, by_rho


def _straight(part: Straight, at: tuple[Floats, Floats], best: tuple[Floats, ...]) -> None:
    """Put a stretch's distances, and their derivatives, where they are the nearest so far."""
    near, depth, by_x, by_rho = best
    across, along = part.normal
    dx, dy = at[0] - part.start[0], at[1] - part.start[1]
    inside = -across * dx - along * dy
    away = np.abs(inside)
    way = along * dx - across * dy
    way += EDGE * away
    nearer = (away < near) & (way >= 0.0)
    if np.isfinite(part.length):
        way -= 2.0 * EDGE * away
        nearer &= way <= part.length
    np.copyto(near, away, where=nearer)
    np.copyto(depth, inside, where=nearer)
    np.copyto(by_x, -across, where=nearer)
    np.copyto(by_rho, -along, where=nearer)


def _round(part: Round, at: tuple[Floats, Floats], best: tuple[Floats, ...]) -> None:
    """The same of an arc or a corner."""
    near, depth, by_x, by_rho = best
    side = -1.0 if part.radius < 0.0 else 1.0
    upper, lower = (part.first, part.last) if side > 0.0 else (part.last, part.first)
    # outwards, whichever side the centre is on
    dx, dy = side * (at[0] - part.centre[0]), side * (at[1] - part.centre[1])
    beside = -EDGE * (np.abs(dx) + np.abs(dy)) if part.radius else 0.0
    below = dx * upper[1] - dy * upper[0] >= beside
    faced = np.flatnonzero(below & (dy * lower[0] - dx * lower[1] >= beside))
    if not len(faced):
        return
    dx, dy = dx.take(faced), dy.take(faced)
    reach = np.hypot(dx, dy)
    inside = part.radius - side * reach
    away = np.abs(inside)
    nearer = away < near.take(faced)
    faced, reach = faced[nearer], reach[nearer]
    near[faced], depth[faced] = away[nearer], inside[nearer]
    # in the centre itself any way out will do
    out = reach == 0.0
    reach[out] = 1.0
    by_x[faced] = -np.where(out, upper[0], dx[nearer] / reach)
    by_rho[faced] = -np.where(out, upper[1], dy[nearer] / reach)
