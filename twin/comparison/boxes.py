"""A tree of boxes about triangles, searched for all points abreast."""

import numpy as np

from twin.inspection.solid import Floats, Ints

ARITY = 4
TOGETHER = 16
"""points that are searched for at once"""
APART = 2
"""level of boxes from which on each is searched for alone"""
BITS = 10
"""of each coordinate in the order along which neighbours come to stand beside each other"""


class Boxes:
    """Boxes about triangles (m, 3, 3), boxes about eight of those, and so on."""

    def __init__(self, corner: Floats) -> None:
        """Triangles by their corners."""
        self._order = along_curve(corner.mean(axis=1))
        low, high = (np.ascontiguousarray(end(corner[self._order], axis=1).T) for end in (np.min, np.max))
        self._levels = [(low, high)]
        while low.shape[1] > ARITY:
            starts = np.arange(0, low.shape[1], ARITY)
            low, high = np.minimum.reduceat(low, starts, axis=1), np.maximum.reduceat(high, starts, axis=1)
            self._levels.append((low, high))

    def within(self, points: Floats, limit: Floats) -> tuple[Ints, Ints, Floats]:
        """Pairs of a point (k, 3) and a triangle whose box is nearer than the limit (k,).

        Points that stand beside each other in `points` should do so in space: the upper boxes are searched
        for several of them at once.

        Returns:
            rows of the points, rows of the triangles, and how near the boxes are, (n,) each.

        """
        columns = np.ascontiguousarray(points.T)
        starts = np.arange(0, len(points), TOGETHER)
        many = len(starts)
        low, high = np.minimum.reduceat(columns, starts, axis=1), np.maximum.reduceat(columns, starts, axis=1)
        widest = np.maximum.reduceat(limit, starts)
        top = len(self._levels) - 1
        level = min(APART, top)
        count = self._levels[top][0].shape[1]
        item, node = np.repeat(np.arange(many), count), np.tile(np.arange(count), many)
        item, node, _ = self._near((top, level), (low, high), widest, (item, node))
        node, item = _children(node, item, TOGETHER, len(points))
        item, node, bound = self._near((level, 0), (columns, columns), limit, (item, node))
        return item, self._order[node], bound

    def _near(
        self, levels: tuple[int, int], items: tuple[Floats, Floats], limit: Floats, pairs: tuple[Ints, Ints]
    ) -> tuple[Ints, Ints, Floats]:
        """Go with pairs (n,) of an item and a node from one level down to another.

        Items are boxes, low and high by columns (3, k); what is not nearer than an item's limit (k,) is left
        behind. Returns what is left, and how near it is.
        """
        (level, last), (low, high), (item, node) = levels, items, pairs
        square_limit = limit**2
        while True:
            from_low, from_high = self._levels[level]
            square = np.zeros(len(item))
            for axis in range(3):
                off = from_low[axis].take(node) - high[axis].take(item)
                np.maximum(off, low[axis].take(item) - from_high[axis].take(node), out=off)
                np.maximum(off, 0.0, out=off)
                off *= off
                square += off
            near = np.flatnonzero(square < square_limit.take(item))
            item, node = item[near], node[near]
            if level == last:
                return item, node, np.sqrt(square[near])
            level -= 1
            item, node = _children(item, node, ARITY, self._levels[level][0].shape[1])


def _children(item: Ints, node: Ints, each: int, count: int) -> tuple[Ints, Ints]:
    """Pairs of the items (n,) and all children, `each` to a node and `count` in all, of their nodes (n,)."""
    child = (each * node[:, None] + np.arange(each)).ravel()
    there = child < count
    return np.repeat(item, each)[there], child[there]


def along_curve(points: Floats) -> Ints:
    """Order in which points (n, 3) that are neighbours come to stand beside each other."""
    return np.argsort(_interleaved(points))


def _interleaved(points: Floats) -> Ints:
    """(n,) place of points (n, 3) on a Morton curve through their box."""
    low, extent = points.min(axis=0), float(np.ptp(points, axis=0).max()) or 1.0
    steps = ((points - low) / extent * ((1 << BITS) - 1)).astype(np.int64)
    word = np.zeros(len(points), dtype=np.int64)
    for bit in range(BITS):
        for axis in range(3):
            word |= (steps[:, axis] >> bit & 1) << (3 * bit + axis)
    return word
