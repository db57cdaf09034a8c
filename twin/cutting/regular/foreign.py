"""Passes that are not part of the steady motion, near strips that are images of a template."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from twin.cutting.local import can_matter
from twin.cutting.pairs import Candidates
from twin.cutting.regular.chart import Chart
from twin.cutting.regular.patches import Blocks, Patches, blocks, patches, quarters
from twin.cutting.regular.tiles import stays_out
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
    lists, safe = (
        Candidates(np.zeros(1, dtype=np.int64), np.zeros(0, dtype=np.int64)),
        np.zeros(0, dtype=bool),
    )
    for number, (size, thick) in enumerate(sizes):
        if number == 0:
            block = blocks(chart, patch, thick)
            lists = sweep.near_of(
                block.middle, block.radius + block.depth, [passes[int(row)] for row in strip]
            )
            safe = np.zeros(len(lists.bites), dtype=bool)
        else:
            some = np.flatnonzero(np.diff(lists.start))
            patch, parent = quarters(patch.of(some), size)
            own = some[parent]
            strip, safe, lists = strip[own], safe[lists.pairs(own)], lists.of(own)
            block = blocks(chart, patch, thick)
        keep, safe = _left(sweep, block, lists, safe, _judges(judges, patch))
        lists = lists.where(keep)
        safe = safe[keep]
        if not len(lists.bites):
            return found
    found[strip[np.diff(lists.start) > 0]] = True
    return found


def _judges(judges: Ints, patch: Patches) -> Ints:
    """Of patches (n,): that of the cell in their middle."""
    i, k = (edges.sum(axis=1) // 2 for edges in (patch.i, patch.k))
    return judges[patch.gap, i, k]


def _left(sweep: Sweep, block: Blocks, lists: Candidates, safe: Bools, judge: Ints) -> tuple[Bools, Bools]:
    """Which bites of blocks may cut more than the `judge` (n,), or behind the shell; which do not there."""
    owner = lists.owner()
    meeting = sweep.evaluate(block.middle.take(owner, axis=0), lists.bites, gradient=True)
    change, over = sweep.bound(meeting, lists.bites, block.radius[owner])
    known = judge >= 0
    floors = sweep.floors(block.middle, block.corners, np.maximum(judge, 0), block.radius)
    floors[:, ~known] = -np.inf
    plane = np.vstack([meeting.depth, meeting.gradient.T])
    keep = can_matter(plane, over, owner, block.spokes(block.middle), floors)
    keep &= meeting.depth + change > 0
    unsure = np.flatnonzero(~safe)
    safe = safe.copy()
    safe[unsure] = stays_out(sweep, block, owner[unsure], lists.bites[unsure], meeting.of(unsure))
    return keep | ~safe, safe
