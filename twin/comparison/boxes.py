"""A tree of boxes about triangles, searched for all points abreast."""

import numpy as np

from twin.inspection.solid import Floats, Ints

ARITY = 4
BITS = 10
"""of each coordinate in the order along which neighbours come to stand beside each other"""


class Boxes:
    """Boxes about triangles (m, 3, 3), boxes about eight of those, and so on."""

    def __init__(self, corner: Floats) -> None:
        """Triangles by their corners."""
        self._order = np.argsort(_interleaved(corner.mean(axis=1)))
        low, high = (np.ascontiguousarray(end(corner[self._order], axis=1).T) for end in (np.min, np.max))
        self._levels = [(low, high)]
        while low.shape[1] > ARITY:
            starts = np.arange(0, low.shape[1], ARITY)
            low, high = np.minimum.reduceat(low, starts, axis=1), np.maximum.reduceat(high, starts, axis=1)
            self._levels.append((low, high))

    def within(self, points: Floats, limit: Floats) -> tuple[Ints, Ints, Floats]:
        """Pairs of a point, by columns (3, k), and a triangle whose box is nearer than the limit (k,).

        Returns:
            rows of the points, rows of the triangles, and how near the boxes are, (n,) each.

        """
        top, count = self._levels[-1][0].shape[1], points.shape[1]
        point, node = np.repeat(np.arange(count), top), np.tile(np.arange(top), count)
        bound = np.zeros(len(point))
        for level in range(len(self._levels) - 1, -1, -1):
            low, high = self._levels[level]
            if level < len(self._levels) - 1:
                node = (ARITY * node[:, None] + np.arange(ARITY)).ravel()
                there = node < len(low[0])
                point, node = np.repeat(point, ARITY)[there], node[there]
            square = np.zeros(len(point))
            for axis in range(3):
                place = points[axis][point]
                off = np.maximum(low[axis][node] - place, place - high[axis][node])
                square += np.square(np.maximum(off, 0.0))
            near = np.flatnonzero(square < limit[point] ** 2)
            point, node, bound = point[near], node[near], np.sqrt(square[near])
        return point, self._order[node], bound


def _interleaved(points: Floats) -> Ints:
    """(n,) place of points (n, 3) on a Morton curve through their box."""
    low, extent = points.min(axis=0), float(np.ptp(points, axis=0).max()) or 1.0
    steps = ((points - low) / extent * ((1 << BITS) - 1)).astype(np.int64)
    word = np.zeros(len(points), dtype=np.int64)
    for bit in range(BITS):
        for axis in range(3):
            word |= (steps[:, axis] >> bit & 1) << (3 * bit + axis)
    return word
