"""Blocks of a grid, and the bites that come to each before all of it is gone."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.grid import Grid
from twin.cutting.pairs import LISTED, Candidates, batches, in_parallel, join
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

COARSEST = 16
"""Cells along the edge of the blocks that the search begins with, and along z of a slab."""
FINEST = 2


@dataclass(frozen=True, slots=True)
class Blocks:
    """Blocks of a grid's cells in a slab, and the bites that may touch each before it is gone."""

    grid: Grid
    key: Ints
    """(n,) ascending; see `_key`"""
    low: Ints
    """(n, 3) their low corners [cells]"""
    lists: Candidates
    z_range: tuple[float, float]
    """of the slab [mm]"""

    @classmethod
    def of(cls, sweep: Sweep, grid: Grid, low: Ints) -> "Blocks":
        """The finest blocks within coarsest ones (n, 3) of one slab."""
        k = int(low[0, 2])
        z_range = float(grid.z[k]), float(grid.z[min(k + COARSEST, len(grid.z) - 1)])
        low, lists = _touched(sweep, grid, low)
        key = _key(grid, low)
        order = np.argsort(key)
        return cls(grid, key[order], low[order], lists.of(order), z_range)

    def rows(self, at: Floats) -> Ints:
        """The block of each place (m, 3): radius [mm], angle [rad], z [mm]; −1 where nothing comes."""
        grid = self.grid
        lowest = np.array([grid.r[0], 0.0, grid.z[0]])
        step = np.array([grid.r[1] - grid.r[0], 2.0 * math.pi / grid.sectors, grid.z[1] - grid.z[0]])
        cell = np.floor((at - lowest) / step).astype(np.int64)
        cell[:, 1] %= grid.sectors
        cell[:, [0, 2]] = np.clip(cell[:, [0, 2]], 0, np.array(grid.cells)[[0, 2]] - 1)
        key = _key(grid, cell)
        row = np.minimum(np.searchsorted(self.key, key), max(len(self.key) - 1, 0))
        return np.where(self.key[row] == key, row, -1) if len(self.key) else np.full(len(at), -1)

    def near(self, rows: Ints) -> tuple[Ints, Ints]:
        """Items and bites, in the items' order, of the lists of two blocks (m, 2) of each; a bite may come
        twice."""
        rows = rows.copy()
        rows[rows[:, 0] == rows[:, 1], 1] = -1
        item, column = np.nonzero(rows >= 0)
        pairs = self.lists.of(rows[item, column])
        return item[pairs.owner()], pairs.bites


def _key(grid: Grid, cell: Ints) -> Ints:
    """Number (n,) of the finest block that a cell (n, 3) is in."""
    i, j, k = (cell // FINEST).T
    return (i * grid.sectors + j) * len(grid.z) + k


def _touched(sweep: Sweep, grid: Grid, low: Ints) -> tuple[Ints, Candidates]:
    """The finest blocks that some bite may touch, and those bites."""
    size = COARSEST
    middle, radius = _balls(grid, low, size)
    lists = sweep.near(middle, radius)
    while True:
        some = np.flatnonzero(np.diff(lists.start))
        low, lists = low[some], lists.of(some)
        if size == FINEST:
            return low, lists
        size //= 2
        steps = size * np.stack(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), axis=-1).reshape(-1, 3)
        parent = np.repeat(np.arange(len(low)), 8)
        low = (low[:, None] + steps).reshape(-1, 3)
        inside = (low[:, 0] < grid.cells[0]) & (low[:, 2] < grid.cells[2])
        low = low[inside]
        lists = _culled(sweep, *_balls(grid, low, size), lists.of(parent[inside]))


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
        order = sweep.order(own.bites)
        gone = np.full(own.count, np.iinfo(np.int64).max)
        whole = meeting.depth - change > 0
        np.minimum.at(gone, owner[whole], order[whole])
        return own.where((meeting.depth + change > 0) & (order <= gone[owner]))

    return join(in_parallel(work, batches(lists.start, LISTED)))
