"""All tools' depth fields as one: their bites numbered through."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.fields import Field
from twin.cutting.local import ROUNDING, Tangents
from twin.cutting.meeting import Meeting
from twin.cutting.pairs import LISTED, Candidates, batches, in_parallel, join, leaders

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BEYOND = 1.0
"""[mm] that a tool may stay away from a point and still count in `unculled`"""

TOGETHER = 16
"""points that are evaluated at once there"""


@dataclass(frozen=True, slots=True)
class Deepest:
    """The deepest bite at some points."""

    depth: Floats
    """(n,) [mm]; −inf where a block has no bites"""
    gradient: Floats
    """(n, 3) of the depth; (0, 3) unless asked for"""
    bite: Ints
    """(n,) −1 where a block has none"""

    def of(self, rows: Ints | NDArray[np.bool_]) -> "Deepest":
        """That at some of the points."""
        return Deepest(self.depth[rows], self.gradient[rows], self.bite[rows])


class Sweep:
    """The union of everything that the tools of a run sweep."""

    def __init__(self, fields: tuple[Field, ...]) -> None:
        self.fields = fields
        counts = [f.count for f in fields]
        self._first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)

    @property
    def passes(self) -> int:
        """Number of passes."""
        return sum(f.passes.count for f in self.fields)

    def unculled(self, points: Floats) -> Floats:
        """Largest depths (n,) at points (n, 3) of all passes whose tool comes within BEYOND of them.

        Nothing else of the search for the surface is relied on.
        """

        def work(part: slice) -> Floats:
            depth = np.full(part.stop - part.start, -np.inf)
            for f in self.fields:
                lists = [f.near(point, BEYOND) for point in points[part]]
                row = np.repeat(np.arange(len(lists)), [len(index) for index in lists])
                found = f.evaluate(points[part][row], np.concatenate(lists)).depth
                np.maximum.at(depth, row, found)
            return depth

        slices = (slice(row, min(row + TOGETHER, len(points))) for row in range(0, len(points), TOGETHER))
        return np.concatenate([np.zeros(0), *in_parallel(work, slices)])

    def evaluate(self, points: Floats, bite: Ints, *, gradient: bool = False) -> Meeting:
        """As `DepthField.evaluate_bite`, for bites of any tool."""
        if len(self.fields) == 1:
            return self.fields[0].evaluate_bite(points, bite, gradient=gradient)
        pieces = [
            (here, f.evaluate_bite(points[here], bite[here] - self._first[n], gradient=gradient))
            for n, f in enumerate(self.fields)
            if (here := self._of(n, bite)).any()
        ]
        m = len(points)
        out = Meeting(np.zeros(m), np.zeros((m if gradient else 0, 3)), *(np.zeros(m) for _ in range(4)))
        for here, piece in pieces:
            for name in ("depth", "s", "rho", "instant"):
                getattr(out, name)[here] = getattr(piece, name)
            if gradient:
                out.gradient[here] = piece.gradient
                out.slack[here] = piece.slack if len(piece.slack) else 0.0
        return out

    def bound(self, meeting: Meeting, index: Ints, radius: Floats) -> tuple[Floats, Floats]:
        """As `DepthField.bound`, for bites of any tool."""
        if len(self.fields) == 1:
            return self.fields[0].bound(meeting, index, radius)
        out = (np.zeros(len(index)), np.zeros(len(index)))
        for n, f in enumerate(self.fields):
            here = self._of(n, index)
            bounds = f.bound(meeting.of(here), index[here] - self._first[n], radius[here])
            for whole, piece in zip(out, bounds, strict=True):
                whole[here] = piece
        return out

    def floors(self, points: Floats, corners: Floats, index: Ints, radius: Floats) -> Floats:
        """As `DepthField.floors`, for bites of any tool."""
        out = np.zeros((corners.shape[1], len(index)))
        for n, f in enumerate(self.fields):
            here = self._of(n, index)
            out[:, here] = f.floors(points[here], corners[here], index[here] - self._first[n], radius[here])
        return out

    def near(self, points: Floats, radius: Floats) -> Candidates:
        """Bites that may cut within `radius` (n,) of points (n, 3)."""

        def work(part: slice) -> Candidates:
            row = part.start
            found = []
            for n, f in enumerate(self.fields):
                index = f.near(points[row], float(radius[row]))
                at = np.broadcast_to(points[row], (len(index), 3))
                found.append(f.bites_near(at, index, np.full(len(index), radius[row]))[1] + self._first[n])
            bites = np.concatenate(found)
            return Candidates(np.array([0, len(bites)]), bites)

        return join(in_parallel(work, (slice(row, row + 1) for row in range(len(points)))))

    def deepest(
        self, points: Floats, block: Ints, tangents: Tangents, *, gradient: bool = False, sign: bool = False
    ) -> Deepest:
        """The deepest of the bites of each point's `block` (n,) in `tangents`.

        The bite whose tangent stands highest is evaluated, and then those whose upper bound is above it.
        Where only the `sign` is asked for, it comes with a depth and a bite that are about right.
        """
        depth = np.full(len(points), -np.inf)
        slope = np.zeros((len(points) if gradient else 0, 3))
        winner = np.full(len(points), -1, dtype=np.int64)
        lists = tangents.lists
        length = np.diff(lists.start)[block]
        some = np.flatnonzero(length)

        def work(part: slice) -> None:
            items = some[part]
            own = block[items]
            count = length[items]
            pairs = lists.pairs(own)
            owner = np.repeat(np.arange(len(items)), count)
            way = points[items] - tangents.middle[own]
            level, over = tangents.plane.take(pairs, axis=1), tangents.over.take(pairs)
            height = level[0]
            for x in range(3):
                height += level[1 + x] * way[:, x].take(owner)
            _, first = leaders(height, np.concatenate([[0], np.cumsum(count)]))
            upper = height + over
            out = np.einsum("nx,nx->n", way, way) > (tangents.radius[own] * (1.0 + ROUNDING)) ** 2
            if out.any():
                upper[out[owner]] = np.inf
            best = self.evaluate(points[items], lists.bites[pairs[first]], gradient=gradient)
            floor, leading = best.depth, pairs[first]
            if gradient:
                slope[items] = best.gradient
            rivals = upper > floor[owner]
            rivals[first] = False
            if sign:
                rivals &= (floor <= 0)[owner]
                rivals &= upper > 0
            rivals = np.flatnonzero(rivals)
            if len(rivals):
                who = owner[rivals]
                other = self.evaluate(points[items[who]], lists.bites[pairs[rivals]], gradient=gradient)
                start = np.concatenate([[0], np.flatnonzero(np.diff(who)) + 1, [len(who)]])
                deepest, at = leaders(other.depth, start)
                who = who[start[:-1]]
                higher = deepest > floor[who]
                floor[who[higher]] = deepest[higher]
                leading[who[higher]] = pairs[rivals[at[higher]]]
                if gradient:
                    slope[items[who[higher]]] = other.gradient[at[higher]]
            depth[items] = floor
            winner[items] = lists.bites[leading]

        in_parallel(work, batches(np.concatenate([[0], np.cumsum(length[some])]), LISTED))
        return Deepest(depth, slope, winner)

    def tool(self, bite: Ints) -> Ints:
        """Number (m,) of the tool that each bite belongs to."""
        return np.searchsorted(self._first, bite, side="right") - 1

    def _of(self, n: int, index: Ints) -> NDArray[np.bool_]:
        return (index >= self._first[n]) & (index < self._first[n + 1])
