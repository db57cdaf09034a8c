"""What lies on lines between two places that are not of the same bite."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blocks import Blocks
from twin.cutting.cells import points
from twin.cutting.first import NOBODY, TOGETHER, first_of
from twin.cutting.landing import between
from twin.cutting.pairs import in_parallel
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Found = tuple[Ints, Floats, Floats, Ints]
"""Numbers (m,) of lines, from and to (m,) on them, and whose bite's (m,) that is"""

BITES = 12
"""that own something between two places, at most"""
ASIDE = 1e-3
"""of the way between two places: how far beyond an end is asked who comes next"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lines:
    """Lines along r, the angle or z, from a place of one owner to one of another."""

    low: Floats
    """(n, 3) radius [mm], angle [rad], z [mm]"""
    high: Floats
    """(n, 3)"""
    axis: Ints
    """(n,) the one that they differ in"""
    a: Ints
    """(n,) the owner at `low`"""
    b: Ints
    """(n,) the owner at `high`"""
    row: Ints
    """(n,) the block that the line lies in"""

    def of(self, rows: slice) -> "Lines":
        """Some of them."""
        return Lines(
            low=self.low[rows], high=self.high[rows], axis=self.axis[rows],
            a=self.a[rows], b=self.b[rows], row=self.row[rows],
        )  # fmt: skip

    def ends(self) -> tuple[Floats, Floats]:
        """From and to (n,) along their axes."""
        each = np.arange(len(self.axis))
        return self.low[each, self.axis], self.high[each, self.axis]

    def at(self, rows: Ints, where: Floats) -> Floats:
        """(m, 3) places on lines (m,)."""
        found = self.low[rows]
        found[np.arange(len(rows)), self.axis[rows]] = where
        return found


def met(sweep: Sweep, blocks: Blocks, lines: Lines) -> Found:
    """What bites own of lines, piece by piece.

    From the end of the earlier of the two on, the first bite that comes there owns what it removes, and so
    on, until it is the later, or nobody comes.
    """

    def work(part: slice) -> Found:
        line, low, high, bite = _met(sweep, blocks, lines.of(part))
        return line + part.start, low, high, bite

    slices = (slice(low, low + TOGETHER) for low in range(0, max(len(lines.axis), 1), TOGETHER))
    return _joined(*in_parallel(work, slices))


def _joined(*found: Found) -> Found:
    line, low, high, bite = (np.concatenate(column) for column in zip(*found, strict=True))
    return line, low, high, bite


def _met(sweep: Sweep, blocks: Blocks, lines: Lines) -> Found:
    low, high = lines.ends()
    a, b = lines.a, lines.b
    flip = (a == NOBODY) | ((b != NOBODY) & (b < a))
    inner, outer = np.where(flip, high, low), np.where(flip, low, high)
    early, late = np.where(flip, b, a), np.where(flip, a, b)
    march = _March(sweep, blocks, lines)
    rows = np.arange(len(flip))
    edge = march.ends(rows, inner, outer, early)
    begin = outer.copy()
    some = np.flatnonzero(late != NOBODY)
    begin[some] = march.ends(some, outer[some], inner[some], late[some])
    reached, onward = march.onward(rows, (edge, outer), late, begin)
    # a hole between them: others may come from the later's side
    ahead = np.abs(outer - reached) > np.abs(outer - begin)
    hole = np.flatnonzero((late != NOBODY) & ahead)
    nobody = np.full(len(hole), NOBODY)
    _, back = march.onward(hole, (begin[hole], reached[hole]), nobody, reached[hole])
    begin = np.where(ahead, begin, reached)
    line, one, other, bite = _joined(
        (rows, inner, edge, early), (some, begin[some], outer[some], late[some]), onward, back
    )
    return line, np.minimum(one, other), np.maximum(one, other), bite


class _March:
    """From owner to owner along lines; asked are the bites that may come to each."""

    def __init__(self, sweep: Sweep, blocks: Blocks, lines: Lines) -> None:
        self._sweep, self._lines = sweep, lines
        self._from, to = lines.ends()
        self._width = to - self._from
        item, pairs, (low, high) = blocks.uppers((points(lines.low), points(lines.high)), lines.row)
        # the chord between them keeps that close to an arc
        bow = np.where(lines.axis == 1, lines.low[:, 0] * self._width**2 / 8.0, 0.0)[item]
        near = np.maximum(low, high) > -2.0 * bow
        self._start = np.searchsorted(item[near], np.arange(len(lines.axis) + 1))
        self._bite = blocks.tangents.lists.bites.take(pairs[near])
        self._low, self._high = low[near] + 2.0 * bow[near], high[near] + 2.0 * bow[near]

    def onward(
        self, rows: Ints, span: tuple[Floats, Floats], late: Ints, begin: Floats
    ) -> tuple[Floats, Found]:
        """How far (n,) bites remove one after the other on a way on lines `rows` (n,), and what each owns.

        They leave to the bites `late` (n,) what those remove before them, from `begin` on.
        """
        at, to = span[0].copy(), span[1]
        step = ASIDE * self._width[rows]
        way = np.sign(to - at)
        left = np.flatnonzero(np.abs(to - at) > step)
        found = [(rows[:0], at[:0], at[:0], late[:0])]
        for _ in range(BITES):
            if not len(left):
                break
            probe = at[left] + way[left] * step[left]
            owner = self._first(rows[left], probe)
            some = (owner != NOBODY) & (owner != late[left])
            left, probe, owner = left[some], probe[some], owner[some]
            end = self.ends(rows[left], probe, to[left], owner)
            over = (late[left] != NOBODY) & (owner > late[left]) & (way[left] * (end - begin[left]) > 0)
            end[over] = begin[left[over]]
            found.append((rows[left], at[left], end, owner))
            at[left] = end
            left = left[np.abs(to[left] - end) > step[left]]
        return at, _joined(*found)

    def _first(self, rows: Ints, at: Floats) -> Ints:
        """The first bites (n,) that remove angles in cells `rows` (n,)."""
        count = np.diff(self._start)[rows]
        item = np.repeat(np.arange(len(rows)), count)
        pairs = np.arange(len(item)) + np.repeat(self._start[rows] - np.cumsum(count) + count, count)
        share = ((at - self._from[rows]) / self._width[rows]).take(item)
        low = self._low.take(pairs)
        with np.errstate(invalid="ignore"):
            near = ~(low + share * (self._high.take(pairs) - low) <= 0.0)
        return first_of(
            self._sweep, points(self._lines.at(rows, at)), item[near], self._bite.take(pairs[near])
        )

    def ends(self, rows: Ints, inner: Floats, outer: Floats, bite: Ints) -> Floats:
        """Angles (n,) where bites end on the way from `inner`, which they remove, to `outer`, or that."""
        lines = self._lines

        def depth(at: Floats, of: Ints) -> Floats:
            return self._sweep.evaluate(points(at), bite[of]).depth

        ends = lines.at(rows, inner), lines.at(rows, outer)
        beyond = depth(ends[1], np.arange(len(rows)))
        some = np.flatnonzero(beyond <= 0)
        near, far = ends[0][some], ends[1][some]
        place = between(lambda at, of: depth(at, some[of]), (near, far), (depth(near, some), beyond[some]))
        at = outer.copy()
        at[some] = place[np.arange(len(some)), lines.axis[rows[some]]]
        return at
