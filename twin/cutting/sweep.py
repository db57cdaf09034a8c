"""All tools' depth fields as one: their passes numbered through."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.field import DepthField, Meeting
from twin.cutting.pairs import Candidates, batches, in_parallel, join, leaders

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

    def near(self, points: Floats, radius: Floats) -> Candidates:
        """Passes whose tool may come within `radius` (n,) of each point (n, 3)."""
        found = [
            [f.near(p, r) + self._first[n] for n, f in enumerate(self.fields)]
            for p, r in zip(points, radius, strict=True)
        ]
        return join([Candidates(np.array([0, len(row)]), row) for row in (np.concatenate(f) for f in found)])

    def deepest(
        self, points: Floats, candidates: Candidates, *, gradient: bool = False
    ) -> tuple[Floats, Ints, Floats]:
        """Largest depth over each point's candidates, the pass that has it, and its gradient there.

        A point without candidates has depth −inf and pass −1.
        """
        depth = np.full(len(points), -np.inf)
        winner = np.full(len(points), -1, dtype=np.int64)
        slope = np.zeros((len(points) if gradient else 0, 3))
        some = np.flatnonzero(np.diff(candidates.start))
        lists = candidates.of(some) if len(some) < len(points) else candidates

        def work(part: slice) -> None:
            start = lists.start[part.start : part.stop + 1]
            index = lists.passes[start[0] : start[-1]]
            items = some[part]
            where = np.repeat(items, np.diff(start))
            meeting = self.evaluate(points[where], index, gradient=gradient)
            depth[items], first = leaders(meeting.depth, start - start[0])
            winner[items] = index[first]
            if gradient:
                slope[items] = meeting.gradient[first]

        in_parallel(work, batches(lists.start))
        return depth, winner, slope

    def _of(self, n: int, index: Ints) -> NDArray[np.bool_]:
        return (index >= self._first[n]) & (index < self._first[n + 1])
