"""Proof that a chart holds all of the cut, tile by tile, and the bites that can matter in each.

The *shell* is what lies within `thick` of the expected surface. A tile is a patch of it with the rays through
it. It is proved that
- what lies before the shell on the rays is removed: one bite takes all of a block there (`inside.py`);
- no bite touches what lies behind it: where a bite's tangent falls along the rays, so does its bound;
- in the shell only the tile's bites can be the deepest, by the culling of `refine`.
Charts cover the whole ring from below the root to the outside, so nothing else is removed.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.local import Tangents, can_matter, joined
from twin.cutting.meeting import Meeting
from twin.cutting.pairs import Candidates, batches, in_parallel, join, leaders
from twin.cutting.regular.chart import Chart
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.patches import Blocks, Patches, blocks, columns, quarters
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

LARGEST = 16
"""Cells of a tile across or along the gap at most."""
BENT = 0.5
"""What the map to the rake plane bends on a tile, at most, as a share of the shell's thickness and a tile's
size: edge² / (tip radius · thickness)."""
TILES = {4.0: 3.0, 2.0: 1.5, 1.0: 1.0, 0.5: 1.0}
"""Tiles along the edge of the blocks, from coarse to fine -> how much thicker the shell is taken there: in
large blocks the bounds are wider."""
ROUNDS = 3
"""How often patches are quartered for bites that may touch what lies behind the shell."""


ROUND = 3.5
"""Edge of a tile over the root of thickness and radius where the gap bends most: a quarter of it keeps to its
tangent within a third of the thickness."""
UNSURE = {2: 100, 3: 10}
"""Sizes that were searched -> bites of a block, on the average, that may touch what lies behind it, from
which on smaller blocks are not tried. On regular cuts 30 at most are left of two, and hardly one of three."""
UNCUT = "the gaps are not cut all along"
OUTSIDE = "something is cut outside of the gaps"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tiling:
    """Cells of a tile, even numbers."""

    across: int
    along: int

    @classmethod
    def of(cls, cell: tuple[float, float], thick: float, tip: float, bend: float) -> "Tiling":
        """For cells across and along [mm], a shell of a thickness, a tool of a tip radius [mm], and gaps that
        bend by so much at most [1/mm]."""
        edge = math.sqrt(BENT * tip * thick)
        edges = min(edge, ROUND * math.sqrt(thick / bend)), edge
        across, along = (
            min(max(2 * round(e / (2.0 * c)), 2), LARGEST) for e, c in zip(edges, cell, strict=True)
        )
        return cls(across=across, along=along)

    def sizes(self, thick: float, *, finest: bool) -> list[tuple[tuple[int, int], float]]:
        """Cells of blocks from coarse to fine, half a tile or the `finest`, and the shell's thickness."""
        found = [((int(n * self.across), int(n * self.along)), share * thick) for n, share in TILES.items()]
        while finest and max(found[-1][0]) > 1:
            across, along = found[-1][0]
            found.append((((across + 1) // 2, (along + 1) // 2), found[-1][1]))
        return found


@dataclass(frozen=True, slots=True)
class Held:
    """What is known of the bites of some blocks."""

    tangents: Tangents
    safe: Bools
    """(m,) which bites are proved not to touch what lies behind the shell"""
    pairs: int
    """pairs of block and bite that were evaluated"""


def search(
    sweep: Sweep, chart: Chart, patch: Patches, sizes: Sequence[tuple[tuple[int, int], float]]
) -> tuple[Patches, Held]:
    """Ever smaller patches, and for each the bites that can be the deepest in the shell on it.

    `sizes` are cells across and along at most, and how thick the shell is taken there. Raises IrregularError
    where a bite may touch what lies behind the shell, or where none reaches it.
    """
    block = blocks(chart, patch, sizes[0][1])
    held = first_held(sweep, block, sweep.near(*columns(block)))
    pairs = held.pairs
    for number, (size, thick) in enumerate(sizes[1:], 1):
        patch, parent = quarters(patch, size)
        held = refined(sweep, blocks(chart, patch, thick), parent, held)
        pairs += held.pairs
        if np.count_nonzero(~held.safe) > UNSURE.get(number, np.inf) * len(parent):
            raise IrregularError(OUTSIDE)
    _settle(sweep, chart, patch, held, sizes[-1][1])
    return patch, Held(held.tangents, held.safe, pairs)


def _settle(sweep: Sweep, chart: Chart, patch: Patches, held: Held, thick: float) -> None:
    """Raise IrregularError where a bite that is not known to be safe is not so on ever smaller patches."""
    lists = held.tangents.lists.where(~held.safe)
    for _ in range(ROUNDS):
        some = np.flatnonzero(np.diff(lists.start))
        if not len(some):
            return
        patch = patch.of(some)
        size = (int((np.ptp(edges, axis=1).max() + 1) // 2) for edges in (patch.i, patch.k))
        patch, parent = quarters(patch, (next(size), next(size)))
        lists = lists.of(some[parent])
        lists = _reaching_out(sweep, blocks(chart, patch, thick), lists)
    if len(lists.bites):
        raise IrregularError(OUTSIDE)


def _reaching_out(sweep: Sweep, block: Blocks, lists: Candidates) -> Candidates:
    """The bites of blocks that may touch what lies behind the shell."""

    def work(part: slice) -> Candidates:
        here, own = block.of(part), lists.of(np.arange(part.start, part.stop))
        owner = own.owner()
        meeting = sweep.evaluate(here.middle.take(owner, axis=0), own.bites, gradient=True)
        return own.where(~_stays_out(sweep, here, owner, own.bites, meeting))

    return join(in_parallel(work, batches(lists.start)))


def refined(sweep: Sweep, block: Blocks, parent: Ints, held: Held) -> Held:
    """The bites of smaller blocks, from those of their parents."""
    above = held.tangents
    length = np.diff(above.lists.start)[parent]

    def work(part: slice) -> Held:
        here = block.of(part)
        own = parent[part]
        safe = held.safe[above.lists.pairs(own)]
        mine = above.of(own)
        owner = mine.lists.owner()
        way = here.middle - mine.middle
        height = mine.plane[0] + np.einsum("xm,mx->m", mine.plane[1:], way[owner])
        floors = _floors(sweep, here, mine.lists, height)
        outside = here.outside(mine.middle, mine.radius)
        keep = can_matter(mine.plane, mine.over, owner, here.spokes(mine.middle), floors)
        keep |= outside[owner] | ~safe
        return judged(sweep, here, mine.lists.where(keep), safe[keep], floors)

    return _gathered(np.concatenate([[0], np.cumsum(length)]), work)


def first_held(sweep: Sweep, block: Blocks, lists: Candidates) -> Held:
    """The bites of blocks from all that come near."""

    def work(part: slice) -> Held:
        own = lists.of(np.arange(part.start, part.stop))
        return judged(sweep, block.of(part), own, np.zeros(len(own.bites), dtype=bool), None)

    if (np.diff(lists.start) == 0).any():
        raise IrregularError(UNCUT)
    return _gathered(lists.start, work)


def judged(sweep: Sweep, block: Blocks, lists: Candidates, safe: Bools, floors: Floats | None) -> Held:
    """Cull by the tangents at the blocks' own middles; what is not safe stays, if it is not found to be."""
    owner = lists.owner()
    meeting = sweep.evaluate(block.middle.take(owner, axis=0), lists.bites, gradient=True)
    change, over = sweep.bound(meeting, lists.bites, block.radius[owner])
    if floors is None:
        floors = _floors(sweep, block, lists, meeting.depth)
    plane = np.vstack([meeting.depth, meeting.gradient.T])
    keep = can_matter(plane, over, owner, block.spokes(block.middle), floors)
    keep &= meeting.depth + change > 0
    unsure = np.flatnonzero(~safe)
    safe = safe.copy()
    safe[unsure] = _stays_out(sweep, block, owner[unsure], lists.bites[unsure], meeting.of(unsure))
    keep |= ~safe
    some = np.flatnonzero(keep)
    tangents = Tangents(
        lists.where(keep), block.middle, block.radius, plane.take(some, axis=1), over.take(some)
    )
    return Held(tangents, safe[some], len(owner))


def _floors(sweep: Sweep, block: Blocks, lists: Candidates, height: Floats) -> Floats:
    """Lower bounds at the blocks' corners, of the bite that stands highest in each list."""
    judge = lists.bites[leaders(height, lists.start)[1]]
    return sweep.floors(block.middle, block.corners, judge, block.radius)


def _stays_out(sweep: Sweep, block: Blocks, owner: Ints, bite: Ints, meeting: Meeting) -> Bools:
    """Which bites (m,), met at their blocks' middles, touch nothing that lies behind the shell.

    At y + t w, y in the shell's back and w the way behind it, a bite's depth is at most tangent(y) +
    t g · w + what the tangent may be wrong by that far out: a convex function of t, which is below zero if it
    is so at both ends.
    """
    over = sweep.bound(meeting, bite, block.radius[owner])[1]
    change, beyond = sweep.bound(meeting, bite, (block.radius + block.depth)[owner])
    gradient = meeting.gradient.T
    steep = np.linalg.norm(meeting.gradient, axis=1)
    here, there = np.full((2, len(bite)), -np.inf)
    for face, behind in zip(block.face, block.behind, strict=True):
        height = _along(gradient, face, owner)
        np.maximum(here, height, out=here)
        height += _along(gradient, behind, owner)
        np.maximum(there, height, out=there)
    here += meeting.depth + steep * block.slack[0].take(owner) + over
    there += meeting.depth + steep * block.slack[1].take(owner) + beyond
    return ((here < 0) & (there < 0)) | (meeting.depth + change < 0)


def _along(gradient: Floats, way: Floats, owner: Ints) -> Floats:
    """Scalar products (m,) of gradients (3, m) with their blocks' ways (3, n)."""
    total = gradient[0] * way[0].take(owner)
    total += gradient[1] * way[1].take(owner)
    total += gradient[2] * way[2].take(owner)
    return total


def _gathered(start: Ints, work: Callable[[slice], Held]) -> Held:
    """`work` on slices of blocks, whose lists of pairs begin at `start`."""
    done = in_parallel(work, batches(start))
    tangents = joined([h.tangents for h in done])
    if (np.diff(tangents.lists.start) == 0).any():
        raise IrregularError(UNCUT)
    return Held(tangents, np.concatenate([h.safe for h in done]), sum(h.pairs for h in done))
