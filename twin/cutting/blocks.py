"""Blocks of a grid, and the bites that come to each before all of it is gone."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.cutting.grid import Grid
from twin.cutting.local import ROUNDING, Tangents, joined, without_bites
from twin.cutting.pairs import LISTED, Candidates, batches, in_parallel, join
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

COARSEST = 16
"""Cells along the edge of the blocks that the search begins with, and along z of a slab."""
TOUCHED = 4
"""of the blocks in which bites get their tangents"""
FINEST = 2
ROUNDED = 4e-6
"""[mm] that single precision may change of a tangent within a block, for one of depth: 30 roundings"""
BEYOND = 1.5
"""times their radius within which these tangents are proved: who leaves a block asks them still"""


@dataclass(frozen=True, slots=True)
class Blocks:
    """Blocks of a grid's cells in a slab, and the bites that may touch each before it is gone."""

    grid: Grid
    key: Ints
    """(n,) ascending: `node_id` of their low corners, counted in blocks"""
    low: Ints
    """(n, 3) their low corners [cells]"""
    tangents: Tangents
    """of their bites, in the order of time"""
    z_range: tuple[float, float]
    """of the slab [mm]"""

    @classmethod
    def of(cls, sweep: Sweep, grid: Grid, low: Ints) -> "Blocks":
        """The finest blocks within coarsest ones (n, 3) of one slab."""
        k = int(low[0, 2])
        z_range = float(grid.z[k]), float(grid.z[min(k + COARSEST, len(grid.z) - 1)])
        low, tangents = _finest(sweep, grid, *_touched(sweep, grid, low))
        key = grid.node_id(*(low // FINEST).T)
        order = np.argsort(key)
        return cls(grid, key[order], low[order], tangents.of(order), z_range)

    def rows(self, at: Floats) -> Ints:
        """The block of each place (m, 3): radius [mm], angle [rad], z [mm]; −1 where nothing comes."""
        grid = self.grid
        lowest = np.array([grid.r[0], 0.0, grid.z[0]])
        step = np.array([grid.r[1] - grid.r[0], 2.0 * math.pi / grid.sectors, grid.z[1] - grid.z[0]])
        cell = np.floor((at - lowest) / step).astype(np.int64)
        cell[:, 1] %= grid.sectors
        cell[:, [0, 2]] = np.clip(cell[:, [0, 2]], 0, np.array(grid.cells)[[0, 2]] - 1)
        key = grid.node_id(*(cell // FINEST).T)
        row = np.minimum(np.searchsorted(self.key, key), max(len(self.key) - 1, 0))
        return np.where(self.key[row] == key, row, -1) if len(self.key) else np.full(len(at), -1)

    def coming(
        self, points: Floats, rows: Ints, reach: Floats | float = 0.0, until: Ints | None = None
    ) -> tuple[Ints, Ints]:
        """Which of the points (m, 3) bites may be as near as `reach` (m,) to, and these bites, point by point
        in the order of time.

        Asked are the bites of the blocks `rows` (m,), none where that is −1, and only those before `until`
        (m,).
        """
        item, pairs, (upper,) = self.uppers((points,), rows, until)
        near = upper > -np.broadcast_to(reach, len(points))[item]
        return item[near], self.tangents.lists.bites.take(pairs[near])

    def uppers(
        self, points: tuple[Floats, ...], rows: Ints, until: Ints | None = None
    ) -> tuple[Ints, Ints, list[Floats]]:
        """Upper bounds on the depths of some points in the bites of blocks `rows` (m,): of each of several
        sets (m, 3) of points.

        Returns the items (k,), ascending, the places (k,) of their bites in `tangents`, and the bounds (k,).
        """
        some = np.flatnonzero(rows >= 0)
        block = rows[some]
        t = self.tangents
        pairs, owner = t.lists.pairs(block), np.repeat(np.arange(len(some)), np.diff(t.lists.start)[block])
        if until is not None:
            before = t.lists.bites.take(pairs) < until[some].take(owner)
            pairs, owner = pairs[before], owner[before]
        level, x, y, z = t.plane.take(pairs, axis=1)
        level += t.over.take(pairs)
        bounds: list[Floats] = []
        for where in points:
            way = where[some] - t.middle[block]
            upper = level.copy()
            for slope, off in zip((x, y, z), way.T.astype(level.dtype), strict=True):
                upper += slope * off.take(owner)
            out = np.einsum("nx,nx->n", way, way) > (t.radius[block] * (1.0 + ROUNDING)) ** 2
            if out.any():
                upper[out.take(owner)] = np.inf
            bounds.append(upper)
        return some.take(owner), pairs, bounds


def _touched(sweep: Sweep, grid: Grid, low: Ints) -> tuple[Ints, Tangents]:
    """The blocks of TOUCHED cells that some bite may touch, and those bites."""
    size = COARSEST
    lists = sweep.near(*_balls(grid, low, size))
    while True:
        some = np.flatnonzero(np.diff(lists.start))
        low, lists = low[some], lists.of(some)
        if size == TOUCHED:
            return low, _tangents(sweep, *_balls(grid, low, size), lists)
        size //= 2
        low, parent = grid.halved(low, size)
        lists = _culled(sweep, *_balls(grid, low, size), lists.of(parent))


def _finest(sweep: Sweep, grid: Grid, low: Ints, tangents: Tangents) -> tuple[Ints, Tangents]:
    """The finest blocks that bites may touch by their tangents in larger ones."""
    size = TOUCHED
    while size > FINEST:
        size //= 2
        low, parent = grid.halved(low, size)
        middle, radius = _balls(grid, low, size)
        starts = np.concatenate([[0], np.cumsum(np.diff(tangents.lists.start)[parent])])

        def work(
            part: slice, above: Tangents = tangents, parent: Ints = parent, middle: Floats = middle,
            radius: Floats = radius,
        ) -> Tangents:  # fmt: skip
            return _moved(sweep, above.of(parent[part]), middle[part], radius[part])

        parts = in_parallel(work, batches(starts, LISTED))
        tangents = _all(parts)
        some = np.flatnonzero(np.diff(tangents.lists.start))
        low, tangents = low[some], tangents.of(some)
    return low, tangents


def _moved(sweep: Sweep, above: Tangents, middle: Floats, radius: Floats) -> Tangents:
    """The tangents of larger blocks `above` that come to balls in them before these are gone."""
    owner = above.lists.owner()
    way = middle - above.middle
    plane = above.plane
    plane[0] += np.einsum("xm,mx->m", plane[1:], way.take(owner, axis=0))
    reach = np.sqrt(np.einsum("xm,xm->m", plane[1:], plane[1:])) * radius.take(owner)
    keep = plane[0] + above.over + reach > 0
    # the first that seems to take all of a ball is asked whether it does
    whole = np.flatnonzero(plane[0] - above.over - reach > 0)
    whole = whole[np.flatnonzero(np.diff(owner[whole], prepend=-1))]
    who, bites = owner[whole], above.lists.bites
    meeting = sweep.evaluate(middle[who], bites[whole])
    change, _ = sweep.bound(meeting, bites[whole], radius[who])
    sure = meeting.depth - change > 0
    gone = np.full(len(middle), np.iinfo(np.int64).max)
    gone[who[sure]] = bites[whole[sure]]
    keep &= bites <= gone.take(owner)
    left = above.radius - np.linalg.norm(way, axis=1)
    return Tangents(above.lists.where(keep), middle, left, plane[:, keep], above.over[keep])


def _all(parts: list[Tangents]) -> Tangents:
    return joined(parts) if parts else without_bites(np.zeros((0, 3)))


def _single(tangents: Tangents) -> Tangents:
    """The same in single precision: half the memory, and bounds by what rounding can take off them."""
    return replace(
        tangents,
        plane=tangents.plane.astype(np.float32),
        over=(tangents.over + ROUNDED * (1.0 + np.abs(tangents.plane[0]))).astype(np.float32),
    )


def _balls(grid: Grid, low: Ints, size: int) -> tuple[Floats, Floats]:
    """Middles (n, 3) of blocks and the distance (n,) of their farthest corners."""
    middle, corners = grid.hulls(low, size)
    return middle, np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)


def _culled(sweep: Sweep, middle: Floats, radius: Floats, lists: Candidates) -> Candidates:
    """The lists without the bites that cannot touch the balls, or that come when all of a ball is gone."""

    def work(part: slice) -> Candidates:
        own = lists.of(np.arange(part.start, part.stop))
        owner = own.owner()
        meeting = sweep.evaluate(middle[owner + part.start], own.bites)
        change, _ = sweep.bound(meeting, own.bites, radius[owner + part.start])
        gone = np.full(own.count, np.iinfo(np.int64).max)
        whole = meeting.depth - change > 0
        np.minimum.at(gone, owner[whole], own.bites[whole])
        return own.where((meeting.depth + change > 0) & (own.bites <= gone[owner]))

    return join(in_parallel(work, batches(lists.start, LISTED)))


def _tangents(sweep: Sweep, middle: Floats, radius: Floats, lists: Candidates) -> Tangents:
    """The bites' tangents in the middles of balls, proved BEYOND these."""

    def work(part: slice) -> Tangents:
        own = lists.of(np.arange(part.start, part.stop))
        owner = own.owner() + part.start
        meeting = sweep.evaluate(middle[owner], own.bites, gradient=True)
        _, over = sweep.bound(meeting, own.bites, BEYOND * radius[owner])
        plane = np.vstack([meeting.depth, meeting.gradient.T])
        return _single(Tangents(own, middle[part], BEYOND * radius[part], plane, over))

    return _all(in_parallel(work, batches(lists.start, LISTED)))
