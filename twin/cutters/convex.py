"""A convex part of a cutting tooth: what depths, and the bounds of the kernel, rest on."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Point = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Side:
    """A straight side of the outline."""

    normal: Point
    """unit, outwards"""
    height: float
    """`normal · p` on the side [mm]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Round:
    """An arc of the outline, or the sharp corner between two sides (radius 0)."""

    centre: Point
    """(x, rho) [mm]"""
    radius: float
    """+ bulging, − hollow [mm]"""
    first: Point
    """outward normal at its upper end"""
    last: Point
    """outward normal at its lower end"""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConvexPiece:
    """A convex region of the rake half-plane, symmetric about x = 0: the right half of its outline.

    Depth is the signed distance to the outline, positive inside. It is the smallest distance from a
    supporting line, hence concave and 1-Lipschitz.
    """

    sides: tuple[Side, ...]
    rounds: tuple[Round, ...]
    half_width: float
    """half its width at its widest above the land [mm]"""

    @property
    def hollow(self) -> float:
        """The least radius of its hollow arcs [mm]: it has none."""
        return math.inf

    def depth(self, x: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
        """Depth at `x` >= 0 from the middle and `rho` from the tool axis, and its derivatives by both."""
        depth = np.full(x.shape, np.inf)
        by_x, by_rho = np.zeros(x.shape), np.zeros(x.shape)
        for side in self.sides:
            across, along = side.normal
            inside = side.height - across * x - along * rho
            nearer = inside < depth
            np.copyto(depth, inside, where=nearer)
            np.copyto(by_x, -across, where=nearer)
            np.copyto(by_rho, -along, where=nearer)
        for arc in self.rounds:
            dx, dy = x - arc.centre[0], rho - arc.centre[1]
            below = dx * arc.first[1] > dy * arc.first[0]
            faced = np.flatnonzero(below & (dy * arc.last[0] > dx * arc.last[1]))
            if len(faced):
                dx, dy = dx.take(faced), dy.take(faced)
                reach = np.hypot(dx, dy)
                inside = arc.radius - reach
                nearer = inside < depth.take(faced)
                depth[faced] = np.where(nearer, inside, depth.take(faced))
                by_x[faced] = np.where(nearer, -dx / reach, by_x.take(faced))
                by_rho[faced] = np.where(nearer, -dy / reach, by_rho.take(faced))
        return depth, by_x, by_rho
