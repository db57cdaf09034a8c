"""How much of a cutting edge stands in metal, instant by instant: the width of its undeformed chip.

Each pass is looked at whenever its tool has turned a little further, alike for all pieces of a tooth. There
places of the edge are asked whether they are still metal when it comes, and between one that is and one that
is not the end is searched for.
"""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from twin.cutting.edge_line import EdgeLine, edge_lines
from twin.cutting.field import DepthField
from twin.cutting.metal import Metal
from twin.cutting.pairs import batches

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
N = TypeVar("N", np.float64, np.int64)

ABOVE = 1e-4
"""[mm] above the edge where is asked for metal: it may slide along a wall that it made before"""
MORE = 4
"""places beyond those next to known pieces of a chip; as often more as the last of them is in metal"""
ROUNDS = 6
INSTANTS = 6
"""of a chip at which its edge is looked at, at least"""
HALVINGS = 4
TOGETHER = 1 << 15
"""rows of places at once have about as many"""


class Edges:
    """The cutting edges of one tool's passes; bites are numbered within the tool."""

    def __init__(self, field: DepthField) -> None:
        self._field = field
        self._lines = edge_lines(field.cutter.profile, field.spread)
        self.radius: float = field.cutter.radius
        """of the tips [mm]"""

    def foot(self, bite: Ints, s: Floats, rho: Floats, instant: Floats) -> tuple[Floats, Floats]:
        """Where on the bites' lines (n,) places of their rake faces have their nearest one, and the turn (n,)
        of the tool when they do."""
        piece, middle = self._field.piece(bite)
        along = np.zeros(len(bite))
        for rows, line in self._each(piece):
            along[rows] = line.nearest(np.column_stack([s[rows] - middle[rows], rho[rows]]))
        return along, self._field.turn(bite, instant)

    def length(self, bite: Ints) -> Floats:
        """Of the bites' lines (n,) [mm]."""
        return np.array([line.length for line in self._lines])[self._field.piece(bite)[0]]

    def at(self, bite: Ints, along: Floats, turn: Floats) -> tuple[Floats, Bools]:
        """Points (n, 3) of the part close above places of the bites' lines, when the tool has turned that
        far, and whether there is an edge at all."""
        piece, middle = self._field.piece(bite)
        place, cuts = np.zeros((len(bite), 2)), np.zeros(len(bite), dtype=bool)
        for rows, line in self._each(piece):
            place[rows], cuts[rows] = line.at(along[rows], ABOVE), line.cuts(along[rows])
        instant = self._field.instant(bite, turn)
        some = np.isfinite(instant)
        s = place[:, 0] + middle
        cuts &= some & self._field.on_tool(bite, s)
        return self._field.placed(bite, np.where(some, instant, 0.0), s, place[:, 1]), cuts

    def _each(self, piece: Ints) -> list[tuple[Ints, EdgeLine]]:
        return [(np.flatnonzero(piece == number), line) for number, line in enumerate(self._lines)]


@dataclass(frozen=True, slots=True)
class Engaged:
    """Lengths of edge that stand in metal."""

    bite: Ints
    """(n,) numbered within their tool"""
    row: Ints
    """(n,) number of the instant in its pass"""
    length: Floats
    """(n,) [mm]"""


def engaged(
    metal: Metal, edges: Edges, first: int, seen: tuple[Ints, Floats, Floats], step: tuple[float, float]
) -> Engaged:
    """What of edges stands in the metal of a slab, near places that are `seen` to be chips: bites, along
    their lines and at turns of the tool.

    `first` is the number of the tool's first bite in all; `step` the distance of places along the edge,
    and the least one of instants along the way of the tips [mm].
    """
    bite, along, turn = seen
    if not len(bite):
        return Engaged(bite, bite, along)
    between = step[1] / edges.radius
    bites, number = np.unique(bite, return_inverse=True)
    count = np.ceil(edges.length(bites) / step[0]).astype(np.int64)
    column = np.floor(along / (edges.length(bites) / count)[number]).astype(np.int64)
    low = np.maximum(_least(number, column) - MORE, 0)
    high = np.minimum(-_least(number, -column) + MORE, count - 1)
    # instants go by powers of two, so that those of a chip in two slabs are the same
    begin, end = _least(number, turn / between), -_least(number, -turn / between)
    stride = 2 ** np.floor(np.log2(np.maximum((end - begin) / INSTANTS, 1.0))).astype(np.int64)
    begin, end = np.floor(begin / stride).astype(np.int64), np.ceil(end / stride).astype(np.int64)
    item = np.repeat(np.arange(len(bites)), end - begin + 1)
    row = np.arange(len(item)) - np.searchsorted(item, item) + begin[item]
    row *= stride[item]
    bite, low, high, count = bites[item], low[item], high[item], count[item]
    width = edges.length(bite) / count
    turns = np.asarray(row * between, dtype=np.float64)
    lengths, left = np.zeros(len(bite)), np.arange(len(bite))
    for _ in range(ROUNDS):
        size = high - low + 1
        start = np.concatenate([[0], np.cumsum(size[left])])
        open_ = np.zeros((2, len(bite)), dtype=bool)
        for part in batches(start, TOGETHER):
            rows = left[part]
            columns = low[rows], size[rows], width[rows]
            lengths[rows], open_[:, rows] = _lengths(metal, edges, first, (bite[rows], turns[rows]), columns)
        open_ &= np.stack([low > 0, high < count - 1])
        low = np.where(open_[0], np.maximum(low - size, 0), low)
        high = np.where(open_[1], np.minimum(high + size, count - 1), high)
        left = np.flatnonzero(open_.any(axis=0))
        if not len(left):
            break
    return Engaged(bite, row, lengths)


def _least(group: Ints, value: NDArray[N]) -> NDArray[N]:
    """The least (n,) of each group's values (m,)."""
    order = np.argsort(group, kind="stable")
    return np.minimum.reduceat(value[order], np.flatnonzero(np.diff(group[order], prepend=-1)))


def _lengths(
    metal: Metal, edges: Edges, first: int, of: tuple[Ints, Floats], columns: tuple[Ints, Ints, Floats]
) -> tuple[Floats, Bools]:
    """Lengths (n,) of the edges of bites (n,) in metal at turns (n,), and whether (2, n) the first and the
    last place is.

    `columns` (n,) are the first place, their number, and how far they are apart.
    """
    bite, turn = of
    low, size, width = columns
    item = np.repeat(np.arange(len(bite)), size)
    number = np.arange(len(item)) - np.repeat(np.cumsum(size) - size, size)
    along = (low[item] + number + 0.5) * width[item]

    def stands(rows: Ints, at: Floats) -> tuple[Bools, Bools]:
        """Whether (m,) places are in metal, and in this slab."""
        own = item[rows]
        points, cuts = edges.at(bite[own], at, turn[own])
        return metal.stands(bite[own] + first, points, cuts)

    inside, here = stands(np.arange(len(item)), along)
    length = np.bincount(item, inside * width[item], len(bite)).astype(np.float64)
    # from the middle between two places to the end that is searched for
    pairs = np.flatnonzero((item[1:] == item[:-1]) & here[1:] & here[:-1] & (inside[1:] != inside[:-1]))
    into = np.where(inside[pairs], pairs, pairs + 1)
    out = np.where(inside[pairs], pairs + 1, pairs)
    a, b = along[into], along[out]
    for _ in range(HALVINGS):
        middle = 0.5 * (a + b)
        still = stands(into, middle)[0]
        a, b = np.where(still, middle, a), np.where(still, b, middle)
    gain = np.abs(0.5 * (a + b) - along[into]) - 0.5 * width[item[into]]
    last = np.cumsum(size) - 1
    length += np.bincount(item[into], gain, len(bite))
    return length, np.stack([inside[last - size + 1], inside[last]])
