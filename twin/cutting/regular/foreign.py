"""Passes that are not part of the steady motion, near strips that are images of a template."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from twin.cutting.regular.chart import Chart
from twin.cutting.regular.patches import Blocks, Patches, blocks, patches, quarters
from twin.cutting.regular.tiles import judged
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


def matter(
    sweep: Sweep,
    chart: Chart,
    strips: Patches,
    *,
    passes: Sequence[Sequence[Ints]],
    judges: Ints,
    sizes: Sequence[tuple[tuple[int, int], float]],
) -> Bools:
    """Whether any of the passes, given for each strip and tool, may cut what its template does not.

    `judges` (gaps, nu, nz) is a bite that reaches the surface in each cell, or −1; the passes are held
    against it on ever smaller patches (`Tiling.sizes`).
    """
    found = np.zeros(len(strips.gap), dtype=bool)
    rows = np.flatnonzero([any(len(numbers) for numbers in tools) for tools in passes])
    if not len(rows):
        return found
    parts = [patches(chart.cells[0], strips.gap[[row]], strips.k[[row]], sizes[0][0]) for row in rows]
    strip = np.repeat(rows, [len(part.gap) for part in parts])
    patch = Patches(*(np.concatenate([getattr(p, name) for p in parts]) for name in Patches.__slots__))
    block = blocks(chart, patch, sizes[0][1])
    lists = sweep.near_of(block.middle, block.radius + block.depth, [passes[int(row)] for row in strip])
    held = judged(
        sweep, block, lists, np.zeros(len(lists.bites), dtype=bool), _floors(sweep, block, judges, patch)
    )
    for size, thick in sizes[1:]:
        lists = held.tangents.lists
        some = np.flatnonzero(np.diff(lists.start))
        if not len(some):
            return found
        patch, parent = quarters(patch.of(some), size)
        own = some[parent]
        strip, block = strip[own], blocks(chart, patch, thick)
        floors = _floors(sweep, block, judges, patch)
        held = judged(sweep, block, lists.of(own), held.safe[lists.pairs(own)], floors)
    found[strip[np.diff(held.tangents.lists.start) > 0]] = True
    return found


def _floors(sweep: Sweep, block: Blocks, judges: Ints, patch: Patches) -> Floats:
    """Lower bounds at the blocks' corners, of what the judge in the middle of each patch removes."""
    i, k = (edges.sum(axis=1) // 2 for edges in (patch.i, patch.k))
    judge = judges[patch.gap, i, k]
    floors = sweep.floors(block.middle, block.corners, np.maximum(judge, 0), block.radius)
    floors[:, judge < 0] = -np.inf
    return floors
