"""The depth field of a disc cutter: a body of revolution, of which the whole outline cuts everywhere.

A point of the stock is removed if it comes inside the body at any time. Its depth in a window of the motion
is the largest over time of the depth in the outline, at the point's distance from the axis and its position
along it; there n · v = 0.

A *bite* is one convex piece of the outline in one window, within which points move nearly straight. The depth
in a convex body of revolution is concave in space, hence along a straight way as well: its largest is where
its rate changes sign. What a window's bow adds is known (`WheelField.bound`, docs/kernel.md).
"""

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.engagement import StockCylinder, turning_runs
from twin.cutting.meeting import Meeting
from twin.cutting.motion import CutterMotion
from twin.cutting.touch import Touch, deepest
from twin.cutting.windows import Way, Windows, straight_windows

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FAR = 1.0
"""[mm] off the body from which a distance need only be about right"""
ROUNDING = 3e-6
"""[mm] that the search for the deepest instant may leave"""


class WheelField:
    """The field of all windows of one disc cutter."""

    def __init__(
        self, cutter: Cutter, motion: CutterMotion, stock_radius: float, stock_z: tuple[float, float]
    ) -> None:
        self.cutter = cutter
        stock = StockCylinder.around(motion.mount, stock_radius, stock_z)
        way = Way.of(motion, stock.radius)
        windows = straight_windows(way, turning_runs(cutter, motion))
        centre = [np.interp(windows.first, way.length, column) for column in way.place[:, 1:].T]
        swept = windows.last - windows.first
        clear = stock.clear_of(np.stack(centre, axis=1), motion.basis, cutter.radius + swept)
        self.passes: Windows = windows.where(~clear)
        self.bites: int = len(cutter.profile.pieces)
        """of a window: the convex pieces of the outline"""
        self.tooth: Ints = np.zeros(self.bites, dtype=np.int64)
        """(bites,) a wheel has only one"""
        self._touch = Touch(cutter.profile, motion, way)

    @property
    def count(self) -> int:
        """Number of bites."""
        return self.passes.count * self.bites

    def evaluate(self, points: Floats, index: Ints, *, gradient: bool = False) -> Meeting:
        """Depth of `points[i]` (m, 3) in the sweep of window `index[i]`: that of its deepest piece.

        More than FAR off the body it is only about right.
        """
        m = len(points)
        best = Meeting(np.zeros(m), np.zeros((m if gradient else 0, 3)), *np.zeros((3, m)))
        miss = self._miss(points, index)
        best.depth[:] = np.where(miss < FAR, -np.inf, -miss)
        rows = np.flatnonzero(miss < FAR)
        names = ("depth", "s", "rho", "instant", *(["gradient"] if gradient else []))
        ceilings = self._ceilings(points[rows], index[rows])
        for piece in np.argsort(-ceilings.sum(axis=1), kind="stable"):
            here = rows[ceilings[piece] > best.depth[rows]]
            one = self.evaluate_bite(points[here], index[here] * self.bites + piece, gradient=gradient)
            deeper = np.flatnonzero(one.depth > best.depth[here])
            for name in names:
                getattr(best, name)[here[deeper]] = getattr(one, name)[deeper]
        return best

    def _ceilings(self, points: Floats, index: Ints) -> Floats:
        """Upper bounds (pieces, m) of the depth in each piece of the outline over a window.

        Depth is concave along the chord of a point's way, hence below its tangents at both ends; the way
        itself keeps within `bow` of the chord.
        """
        local = self._touch.clamped(points)
        first = self._touch.seen(local, self.passes.first[index])[0]
        last = self._touch.seen(local, self.passes.last[index], before=True)[0]
        way = last - first
        over = np.zeros((self.bites, len(points)))
        for number in range(self.bites):
            piece = np.full(len(points), number)
            (a, up), (b, down) = self._touch.depth(first, piece), self._touch.depth(last, piece)
            rise, fall = (up * way).sum(axis=0), -(down * way).sum(axis=0)
            peaked = (rise > 0) & (fall > 0)
            share = np.where(peaked, (b + fall - a) / np.where(peaked, rise + fall, 1.0), 0.0)
            over[number] = np.where(peaked, a + rise * np.clip(share, 0.0, 1.0), np.maximum(a, b))
        return over + self.passes.bow[index] + ROUNDING

    def evaluate_bite(self, points: Floats, bite: Ints, *, gradient: bool = False) -> Meeting:
        """Depth in one piece of the outline alone, at the instant when it is the largest."""
        index = bite // self.bites
        ends = self.passes.first[index], self.passes.last[index]
        return deepest(self._touch, points, bite - index * self.bites, ends, gradient=gradient)

    def floors(self, points: Floats, corners: Floats, bite: Ints, radius: Floats) -> Floats:
        """Lower bounds (c, m) of the bites' depths, in the convex hulls of `corners` (m, c, 3).

        As `DepthField.floors`: at any convex combination of the corners the depth is at least the same
        combination of these.
        """
        count = corners.shape[1]
        depth = self.evaluate_bite(corners.reshape(-1, 3), np.repeat(bite, count)).depth
        floors = depth.reshape(-1, count).T - 2.0 * self._bent(bite, radius)
        level = self.evaluate_bite(points, bite).depth - radius
        return np.where(level > floors.mean(axis=0), level, floors)

    def bound(self, meeting: Meeting, bite: Ints, radius: Floats) -> tuple[Floats, Floats]:
        """Proved bounds on the depths of bites within `radius` (m,) of the points of a meeting [mm].

        Returns, as `DepthField.bound`, how much the depth can change, and how far it can rise above its
        tangent. At a fixed instant space moves as a rigid body past the tool, so depth changes by no more
        than the distance. Over a window, p seen from the tool runs within `bow` of its chord, and p + d
        within bow + swing · |d| of that chord moved by d; along the chord the tangent rises by `slack`.
        """
        return radius + ROUNDING, meeting.slack + self._bent(bite, radius)

    def near(self, point: Floats, radius: float, among: Ints | None = None) -> Ints:
        """Windows, of all or `among` some (m,), in which the tool may come within `radius` of a point (3,) of
        the part [mm]."""
        index = np.arange(self.passes.count) if among is None else among
        return index[self._miss(np.broadcast_to(point, (len(index), 3)), index) < radius]

    def bites_near(self, points: Floats, index: Ints, radius: Floats) -> tuple[Ints, Ints]:
        """Rows and bites of the windows `index` (m,) that may cut within `radius` (m,) of `points` (m, 3)."""
        row = np.repeat(np.arange(len(index)), self.bites)
        bite = np.repeat(index, self.bites) * self.bites + np.tile(np.arange(self.bites), len(index))
        reach = self.evaluate_bite(points[row], bite).depth + radius[row] + ROUNDING
        return row[reach > 0], bite[reach > 0]

    def _bent(self, bite: Ints, radius: Floats) -> Floats:
        index = bite // self.bites
        return self.passes.bow[index] + self.passes.swing[index] * radius + ROUNDING

    def _miss(self, points: Floats, index: Ints) -> Floats:
        """How far at least points (m, 3) stay out of the tips' cylinder in the windows `index` (m,) [mm]."""
        local = self._touch.clamped(points)
        a, _, _ = self._touch.seen(local, self.passes.first[index])
        b, _, _ = self._touch.seen(local, self.passes.last[index])
        way = b[:2] - a[:2]
        square = np.maximum((way * way).sum(axis=0), 1e-300)
        share = np.clip(-(a[:2] * way).sum(axis=0) / square, 0.0, 1.0)
        nearest = np.hypot(*(a[:2] + share * way))
        return nearest - self.cutter.radius - self.passes.bow[index]
