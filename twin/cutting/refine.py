"""Where the cut surface runs, and which passes can make it there.

Blocks of the grid are halved from coarse to fine. At each block's middle every candidate pass is evaluated,
and the deepest one at the block's corners too. A tooth is convex, so the depth of a pass is concave in its
rake plane: its tangent bounds it from above, its corner values from below (`DepthField.bound` adds what the
map to the rake plane bends). That decides: a block that one pass removes whole, a block that no pass touches,
or a block to halve, with the passes that the deepest one does not dominate in all of it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.grid import BLOCK, Grid
from twin.cutting.pairs import Candidates, batches, in_parallel, join, leaders
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

LEAF = 2
"""Cells along the edge of the finest block."""


@dataclass(frozen=True, slots=True)
class Leaves:
    """The finest blocks that the cut surface may pass, and what is known of the others."""

    low: Ints
    """(n, 3) lowest cell of each block"""
    candidates: Candidates
    """of each block, valid in all of it, edges included"""
    removed: list[tuple[Ints, int]]
    """(low (m, 3), size) of the blocks that are cut away whole"""
    pairs: int
    """pairs of block and pass that were evaluated"""


def refine(sweep: Sweep, grid: Grid) -> Leaves:
    """Halve the grid's blocks down to the cut surface."""
    nr, nt, nz = grid.cells
    axes = (np.arange(0, nr, BLOCK), np.arange(0, nt, BLOCK), np.arange(0, nz, BLOCK))
    low = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    middle, corners = grid.hulls(low, BLOCK)
    lists = sweep.near(middle, np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1))
    removed: list[tuple[Ints, int]] = []
    pairs = 0
    size = BLOCK
    while True:
        pairs += len(lists.passes)
        whole, lists = _cull(sweep, *grid.hulls(low, size), lists)
        whole &= ~_outermost(grid, low, size)  # the closing faces of the removed solid run there
        removed.append((low[whole], size))
        alive = np.flatnonzero(~whole & (np.diff(lists.start) > 0))
        low, lists = low[alive], lists.of(alive)
        if size == LEAF:
            return Leaves(low, lists, removed, pairs)
        size //= 2
        steps = size * np.stack(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), axis=-1).reshape(-1, 3)
        parent = np.repeat(np.arange(len(low)), 8)
        low = (low[:, None, :] + steps).reshape(-1, 3)
        inside = (low[:, 0] < nr) & (low[:, 2] < nz)
        low, lists = low[inside], lists.of(parent[inside])


def _outermost(grid: Grid, low: Ints, size: int) -> Bools:
    """Blocks with a cell in the outermost layer of the grid."""
    nr, _, nz = grid.cells
    i, _, k = low.T
    return (i == 0) | (i + size >= nr) | (k == 0) | (k + size >= nz)


def _cull(sweep: Sweep, middle: Floats, corners: Floats, lists: Candidates) -> tuple[Bools, Candidates]:
    """Which blocks are removed whole, and the lists without the passes that cannot matter."""
    some = np.flatnonzero(np.diff(lists.start))
    filled = lists.of(some)
    # one contiguous row per corner and coordinate: the loops below run along the pairs
    spokes = np.ascontiguousarray((corners - middle[:, None]).transpose(1, 2, 0)[:, :, some])
    radius = np.sqrt((spokes**2).sum(axis=1).max(axis=0))

    def work(part: slice) -> tuple[Bools, Candidates]:
        start = filled.start[part.start : part.stop + 1]
        index = filled.passes[start[0] : start[-1]]
        start = start - start[0]
        items = some[part]
        length = np.diff(start)
        where = np.repeat(items, length)
        meeting = sweep.evaluate(middle[where], index, gradient=True)
        change, bent, excess = sweep.bound(meeting, index, np.repeat(radius[part], length))
        _, best = leaders(meeting.depth, start)
        below = sweep.evaluate(corners[items].reshape(-1, 3), np.repeat(index[best], 8)).depth
        below = below.reshape(-1, 8).T - 2.0 * bent[best]
        # where another tooth or the land may take over, the corners prove nothing
        mixed = excess[best] > 0
        below[:, mixed] = (meeting.depth - change)[best[mixed]]
        highest = np.full(len(index), -np.inf)
        lead = np.full(len(index), -np.inf)
        slope = np.ascontiguousarray(meeting.gradient.T)
        for spoke, floor in zip(spokes[:, :, part], below, strict=True):
            tangent = meeting.depth + (np.repeat(spoke, length, axis=1) * slope).sum(axis=0)
            np.maximum(highest, tangent, out=highest)
            np.maximum(lead, tangent - np.repeat(floor, length), out=lead)
        over = bent + excess
        touches = np.minimum(highest + over, meeting.depth + change) > 0
        keep = lead + over >= 0
        keep[best] = True
        return below.min(axis=0) > 0, Candidates(start, index).where(keep & touches)

    done = in_parallel(work, batches(filled.start))
    whole = np.zeros(len(middle), dtype=bool)
    length = np.zeros(len(middle), dtype=np.int64)
    short = join([c for _, c in done])
    if done:
        whole[some] = np.concatenate([w for w, _ in done])
        length[some] = np.diff(short.start)
    return whole, Candidates(np.concatenate([[0], np.cumsum(length)]), short.passes)
