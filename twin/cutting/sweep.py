"""All tools' depth fields as one: their passes numbered through."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.field import DepthField
from twin.cutting.local import ROUNDING, Tangents
from twin.cutting.meeting import Meeting
from twin.cutting.pairs import LISTED, Candidates, batches, in_parallel, join, leaders

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Sweep:
    """The union of everything that the tools of a run sweep."""

    def __init__(self, fields: tuple[DepthField, ...]) -> None:
        self.fields = fields
        counts = [f.passes.count for f in fields]
        self._first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)

    @property
    def count(self) -> int:
        """Number of passes."""
        return int(self._first[-1])

    def evaluate(self, points: Floats, index: Ints, *, gradient: bool = False) -> Meeting:
        """As `DepthField.evaluate`, for passes of any tool."""
        if len(self.fields) == 1:
            return self.fields[0].evaluate(points, index, gradient=gradient)
        parts = [
            (here, f.evaluate(points[here], index[here] - self._first[n], gradient=gradient))
            for n, f in enumerate(self.fields)
            if (here := self._of(n, index)).any()
        ]
        m = len(points)
        out = Meeting(np.zeros(m), np.zeros((m if gradient else 0, 3)), *(np.zeros(m) for _ in range(3)))
        for here, part in parts:
            for name in ("depth", "s", "rho", "instant"):
                getattr(out, name)[here] = getattr(part, name)
            if gradient:
                out.gradient[here] = part.gradient
        return out

    def bound(self, meeting: Meeting, index: Ints, radius: Floats) -> tuple[Floats, Floats, Floats]:
        """As `DepthField.bound`, for passes of any tool."""
        if len(self.fields) == 1:
            return self.fields[0].bound(meeting, index, radius)
        out = (np.zeros(len(index)), np.zeros(len(index)), np.zeros(len(index)))
        for n, f in enumerate(self.fields):
            here = self._of(n, index)
            part = Meeting(
                *(getattr(meeting, name)[here] for name in ("depth", "gradient", "s", "rho", "instant"))
            )
            for whole, piece in zip(
                out, f.bound(part, index[here] - self._first[n], radius[here]), strict=True
            ):
                whole[here] = piece
        return out

    def floors(self, points: Floats, corners: Floats, index: Ints, radius: Floats) -> Floats:
        """As `DepthField.floors`, for passes of any tool."""
        out = np.zeros((corners.shape[1], len(index)))
        for n, f in enumerate(self.fields):
            here = self._of(n, index)
            out[:, here] = f.floors(points[here], corners[here], index[here] - self._first[n], radius[here])
        return out

    def near(self, points: Floats, radius: Floats) -> Candidates:
        """Passes whose tool may come within `radius` (n,) of each point (n, 3)."""
        found = [
            [f.near(p, r) + self._first[n] for n, f in enumerate(self.fields)]
            for p, r in zip(points, radius, strict=True)
        ]
        return join([Candidates(np.array([0, len(row)]), row) for row in (np.concatenate(f) for f in found)])

    def deepest(
        self, points: Floats, block: Ints, tangents: Tangents, *, gradient: bool = False, sign: bool = False
    ) -> tuple[Floats, Floats]:
        """Largest depth (n,) over the passes of each point's `block`, and its gradient.

        The pass whose tangent stands highest is evaluated, and then those whose upper bound is above it.
        Where only the `sign` is asked for, it comes with a depth that is about right. A point without
        passes has depth −inf.
        """
        depth = np.full(len(points), -np.inf)
        slope = np.zeros((len(points) if gradient else 0, 3))
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
            best = self.evaluate(points[items], lists.passes[pairs[first]], gradient=gradient)
            floor = best.depth
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
                other = self.evaluate(points[items[who]], lists.passes[pairs[rivals]], gradient=gradient)
                start = np.concatenate([[0], np.flatnonzero(np.diff(who)) + 1, [len(who)]])
                deepest, at = leaders(other.depth, start)
                who = who[start[:-1]]
                higher = deepest > floor[who]
                floor[who[higher]] = deepest[higher]
                if gradient:
                    slope[items[who[higher]]] = other.gradient[at[higher]]
            depth[items] = floor

        in_parallel(work, batches(np.concatenate([[0], np.cumsum(length[some])]), LISTED))
        return depth, slope

    def _of(self, n: int, index: Ints) -> NDArray[np.bool_]:
        return (index >= self._first[n]) & (index < self._first[n + 1])
