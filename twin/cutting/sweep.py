"""All tools' depth fields as one: their bites numbered through."""

from collections.abc import Iterator, Sequence
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
FEW = 4
"""points whose passes are looked for at once: a point has up to thousands"""


@dataclass(frozen=True, slots=True)
class Deepest:
    """The deepest bite at some points."""

    depth: Floats
    """(n,) [mm]; −inf where a block has no bites"""
    gradient: Floats
    """(n, 3) of the depth; (0, 3) unless asked for"""
    bite: Ints
    """(n,) −1 where a block has none"""
    instant: Floats
    """(n,) sample (fractional) of its tool's motion at which it meets the point"""

    def of(self, rows: Ints | NDArray[np.bool_]) -> "Deepest":
        """That at some of the points."""
        return Deepest(self.depth[rows], self.gradient[rows], self.bite[rows], self.instant[rows])


@dataclass(frozen=True, slots=True)
class Images:
    """Points seen from the blocks that stand for theirs, some passes earlier (`regular/screw.py`)."""

    points: Floats
    """(n, 3) their places in those blocks"""
    later: Ints
    """(n,) bites by which the points' own come after the blocks'"""
    bites: Ints
    """(2, n) first and last of those that there are"""


class Sweep:
    """The union of everything that the tools of a run sweep."""

    def __init__(self, fields: tuple[Field, ...], margin: float = 0.0) -> None:
        self.fields = fields
        self.margin = margin
        """what all bounds leave for a motion that is a little off the recorded one [mm of depth]"""
        counts = [f.count for f in fields]
        self._first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)

    @property
    def count(self) -> int:
        """Number of bites."""
        return int(self._first[-1])

    @property
    def passes(self) -> int:
        """Number of passes."""
        return sum(f.passes.count for f in self.fields)

    def widened(self, margin: float) -> "Sweep":
        """The same with bounds that leave room for a motion by which depths differ up to `margin` [mm]."""
        return Sweep(self.fields, margin)

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
                start = np.searchsorted(row, np.arange(len(lists) + 1))
                some = np.flatnonzero(np.diff(start))
                depth[some] = np.maximum(depth[some], np.maximum.reduceat(found, start[some]))
            return depth

        return np.concatenate([np.zeros(0), *in_parallel(work, _groups(len(points), TOGETHER))])

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
            change, bent = self.fields[0].bound(meeting, index, radius)
            return change + self.margin, bent + self.margin
        out = (np.zeros(len(index)), np.zeros(len(index)))
        for n, f in enumerate(self.fields):
            here = self._of(n, index)
            bounds = f.bound(meeting.of(here), index[here] - self._first[n], radius[here])
            for whole, piece in zip(out, bounds, strict=True):
                whole[here] = piece + self.margin
        return out

    def floors(self, points: Floats, corners: Floats, index: Ints, radius: Floats) -> Floats:
        """As `DepthField.floors`, for bites of any tool."""
        if len(self.fields) == 1:
            return self.fields[0].floors(points, corners, index, radius) - self.margin
        out = np.zeros((corners.shape[1], len(index)))
        for n, f in enumerate(self.fields):
            here = self._of(n, index)
            out[:, here] = f.floors(points[here], corners[here], index[here] - self._first[n], radius[here])
        return out - self.margin

    def near(self, points: Floats, radius: Floats) -> Candidates:
        """Bites that may cut within `radius` (n,) of points (n, 3)."""

        reach = radius + 2.0 * self.margin

        def work(part: slice) -> Candidates:
            places, within = points[part], reach[part]
            owners, bites = [], []
            for n, f in enumerate(self.fields):
                lists = [f.near(place, float(far)) for place, far in zip(places, within, strict=True)]
                own = np.repeat(np.arange(len(places)), [len(index) for index in lists])
                row, found = f.bites_near(places[own], np.concatenate(lists), within[own])
                owners.append(own[row])
                bites.append(found + self._first[n])
            owner = np.concatenate(owners)
            order = np.argsort(owner, kind="stable")
            start = np.searchsorted(owner[order], np.arange(len(places) + 1))
            return Candidates(start, np.concatenate(bites)[order])

        return join(in_parallel(work, _groups(len(points), FEW)))

    def near_of(self, points: Floats, radius: Floats, passes: Sequence[Sequence[Ints]]) -> Candidates:
        """As `near`, of some passes only: given for each point and each tool."""
        found = []
        for point, reach, tools in zip(points, radius, passes, strict=True):
            own = [np.zeros(0, dtype=np.int64)]
            for n, (f, index) in enumerate(zip(self.fields, tools, strict=True)):
                at = np.broadcast_to(point, (len(index), 3))
                own.append(f.bites_near(at, index, np.full(len(index), reach))[1] + self._first[n])
            bites = np.concatenate(own)
            found.append(Candidates(np.array([0, len(bites)]), bites))
        return join(found)

    def deepest(
        self,
        points: Floats,
        block: Ints,
        tangents: Tangents,
        *,
        gradient: bool = False,
        sign: bool = False,
        images: Images | None = None,
    ) -> Deepest:
        """The deepest of the bites of each point's `block` (n,) in `tangents`, or of their `images`.

        The bite whose tangent stands highest is evaluated, and then those whose upper bound is above it.
        Where only the `sign` is asked for, it comes with a depth and a bite that are about right.
        """
        home = points if images is None else images.points
        depth = np.full(len(points), -np.inf)
        slope = np.zeros((3, len(points) if gradient else 0)).T
        winner = np.full(len(points), -1, dtype=np.int64)
        instant = np.zeros(len(points))
        lists = tangents.lists
        length = np.diff(lists.start).take(block)
        some = np.flatnonzero(length)
        whole = len(some) == len(points)

        def work(part: slice) -> None:
            items = part if whole else some[part]
            own, count = block[items], length[items]
            start = np.concatenate([[0], np.cumsum(count)])
            owner = np.repeat(np.arange(len(own)), count)
            pairs = (lists.start.take(own) - start[:-1]).take(owner)
            pairs += np.arange(len(pairs))
            way = np.ascontiguousarray((home[items] - tangents.middle.take(own, axis=0)).T)
            height, *gradients = tangents.plane.take(pairs, axis=1)
            for x in range(3):
                rise = way[x].take(owner)
                rise *= gradients[x]
                height += rise
            upper = height + tangents.over.take(pairs)
            way *= way
            out = way.sum(axis=0) > (tangents.radius.take(own) * (1.0 + ROUNDING)) ** 2
            if out.any():
                upper[out.take(owner)] = np.inf
            bites = lists.bites.take(pairs)
            if images is not None:
                bites += images.later[items].take(owner)
                first, last = images.bites[:, items]
                if bites.min() < first.max() or bites.max() > last.min():
                    missing = (bites < first.take(owner)) | (bites > last.take(owner))
                    height[missing] = upper[missing] = -np.inf
            found = self._highest(
                points[items], (bites, height, upper), (start, owner), gradient=gradient, sign=sign
            )
            depth[items], winner[items], instant[items] = found.depth, found.bite, found.instant
            if gradient:
                slope[items] = found.gradient

        in_parallel(work, batches(np.concatenate([[0], np.cumsum(length[some])]), LISTED))
        return Deepest(depth, slope, winner, instant)

    def _highest(
        self,
        points: Floats,
        pairs: tuple[Ints, Floats, Floats],
        lists: tuple[Ints, Ints],
        *,
        gradient: bool,
        sign: bool,
    ) -> Deepest:
        """The deepest of the bites (m,) in the lists of points (n, 3).

        `pairs` are the bites, how high their tangents stand, −inf where there is none, and upper bounds;
        `lists` is where each point's begins (n + 1,), and whose each pair is (m,).
        """
        bites, height, upper = pairs
        start, owner = lists
        level, first = leaders(height, start, owner)
        leading, none = bites.take(first), np.flatnonzero(level == -np.inf)
        leading[none] = 0
        best = self.evaluate(points, leading, gradient=gradient)
        floor, slope, instant = best.depth, best.gradient, best.instant
        floor[none], leading[none] = -np.inf, -1
        rivals = upper > floor.take(owner)
        rivals[first] = False
        if sign:
            rivals &= (floor <= 0).take(owner)
            rivals &= upper > 0
        rivals = np.flatnonzero(rivals)
        if len(rivals):
            who = owner.take(rivals)
            other = self.evaluate(points.take(who, axis=0), bites.take(rivals), gradient=gradient)
            begin = np.concatenate([[0], np.flatnonzero(np.diff(who)) + 1, [len(who)]])
            deepest, at = leaders(other.depth, begin)
            who = who[begin[:-1]]
            higher = deepest > floor[who]
            who, at = who[higher], at[higher]
            floor[who], leading[who] = deepest[higher], bites[rivals[at]]
            instant[who] = other.instant[at]
            if gradient:
                slope[who] = other.gradient[at]
        return Deepest(floor, slope, leading, instant)

    def pass_begin(self, bite: Ints) -> Ints:
        """First bite of each bite's pass: at any one place those before it come earlier."""
        begin = np.zeros_like(bite)
        for n, f in enumerate(self.fields):
            here = self._of(n, bite)
            begin[here] = bite[here] - (bite[here] - self._first[n]) % f.bites
        return begin

    def first(self, tool: Ints) -> Ints:
        """Number (m,) of the first bite of each tool."""
        return self._first.take(tool)

    def tool(self, bite: Ints) -> Ints:
        """Number (m,) of the tool that each bite belongs to."""
        return np.searchsorted(self._first, bite, side="right") - 1

    def _of(self, n: int, index: Ints) -> NDArray[np.bool_]:
        return (index >= self._first[n]) & (index < self._first[n + 1])


def _groups(count: int, size: int) -> Iterator[slice]:
    """Slices of `count` items with `size` each."""
    return (slice(low, min(low + size, count)) for low in range(0, count, size))
