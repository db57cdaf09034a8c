"""Whose some points of the stock are: of the first bite that comes deeper than they are."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blocks import Blocks
from twin.cutting.pairs import in_parallel
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

NOBODY = -1
"""in place of a bite"""
TOGETHER = 1 << 14
"""points that are asked for at once"""


def first_owners(sweep: Sweep, blocks: Blocks, points: Floats, rows: Ints) -> Ints:
    """The first bites (n,) that remove points (n, 3) in the blocks `rows` (n,); NOBODY for none."""

    def work(part: slice) -> Ints:
        return first_of(sweep, points[part], *blocks.coming(points[part], rows[part]))

    slices = (slice(low, min(low + TOGETHER, len(points))) for low in range(0, len(points), TOGETHER))
    return np.concatenate([np.zeros(0, dtype=np.int64), *in_parallel(work, slices)])


def first_of(sweep: Sweep, points: Floats, item: Ints, bite: Ints) -> Ints:
    """For each point (n, 3) the first that removes it of the bites (m,) of `item` (m,), which ascends."""
    owner = np.full(len(points), NOBODY)
    at = np.searchsorted(item, np.arange(len(points)))
    end = np.searchsorted(item, np.arange(len(points)), side="right")
    left = np.flatnonzero(at < end)
    while len(left):
        asked = bite[at[left]]
        hit = sweep.evaluate(points[left], asked).depth > 0
        owner[left[hit]] = asked[hit]
        left = left[~hit]
        at[left] += 1
        left = left[at[left] < end[left]]
    return owner
