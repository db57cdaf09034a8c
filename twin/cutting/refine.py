"""Where the cut surface runs, and which bites can make it there.

Blocks of the grid are halved from coarse to fine. A bite is convex, so its depth is concave in its
rake plane: its tangent bounds it from above, its corner values from below (`DepthField.bound` adds what the
map to the rake plane and hollow arcs bend). One bite, the block's judge, is evaluated at the corners. The
others are held against it by the tangents that the parent block had, which hold in its children too; what
then has a chance is evaluated at the block's own middle and held against it once more. That decides: a block
that the judge removes whole, a block that no bite touches, or a block to halve, with the bites that can be
the deepest in it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.grid import BLOCK, Grid
from twin.cutting.local import ROUNDING, Tangents, can_matter, joined, without_bites
from twin.cutting.meeting import Meeting
from twin.cutting.pairs import LISTED, Candidates, batches, in_parallel, leaders
from twin.cutting.sweep import Sweep
from twin.errors import PartError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

LEAF = 2
"""Cells along the edge of the finest block."""
PER_PAIR = 120
"""[bytes] of a pair of block and bite while it is searched: its tangent, a copy, and what it is made of"""


@dataclass(frozen=True, slots=True)
class Leaves:
    """The finest blocks that the cut surface may pass, and what is known of the others."""

    low: Ints
    """(n, 3) lowest cell of each block"""
    tangents: Tangents
    """of the bites of each block, its edges included"""
    removed: list[tuple[Ints, int]]
    """(low (m, 3), size) of the blocks that are cut away whole"""
    pairs: int
    """pairs of block and bite that were evaluated"""


@dataclass(frozen=True, slots=True)
class Culled:
    """What became of some blocks."""

    whole: Bools
    """(n,) which of them are cut away whole"""
    alive: Ints
    """(a,) which of them the surface may pass"""
    tangents: Tangents
    """of the bites that can matter, for each of `alive`"""
    pairs: int
    """pairs of block and bite that were evaluated"""


def refine(sweep: Sweep, grid: Grid, *, allowed: float = math.inf) -> Leaves:
    """Halve the grid's blocks down to the cut surface.

    Raises PartError where the bites that may matter there would take more than `allowed` [bytes].
    """
    nr, nt, nz = grid.cells
    axes = (np.arange(0, nr, BLOCK), np.arange(0, nt, BLOCK), np.arange(0, nz, BLOCK))
    low = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    removed: list[tuple[Ints, int]] = []
    closing = [np.zeros((0, 3), dtype=np.int64)]
    size = BLOCK
    middle, corners = grid.hulls(low, size)
    done = first_cull(sweep, middle, corners)
    pairs = done.pairs
    while True:
        _check_memory(done.tangents, allowed)
        removed.append((low[done.whole], size))
        closing.append(_closing(grid, low[done.whole], size))
        low, tangents = low[done.alive], done.tangents
        if size == LEAF:
            break
        size //= 2
        low, parent = grid.halved(low, size)
        done = cull(sweep, *grid.hulls(low, size), parent, tangents)
        pairs += done.pairs
    shut = np.concatenate(closing)
    tangents = joined([tangents, without_bites(grid.hulls(shut, LEAF)[0])])
    return Leaves(np.concatenate([low, shut]), tangents, removed, pairs)


def _check_memory(tangents: Tangents, allowed: float) -> None:
    """Raise PartError where so many bites leave no memory for the blocks' eighths."""
    pairs, blocks = len(tangents.lists.bites), tangents.lists.count
    if pairs * PER_PAIR > allowed:
        raise PartError(
            f"the search for the cut surface outgrows the {allowed / 2**30:.2g} GiB of memory it may take: "
            f"{blocks} blocks with {pairs / blocks:.0f} bites each that may have made it, as where a tool "
            "stands in the stock and trembles",
            remedy="valid: a tool that leaves the stock before it stops, or a larger --cell-mm",
        )


def _closing(grid: Grid, low: Ints, size: int) -> Ints:
    """The leaves (m, 3) of removed blocks that the closing faces of the removed solid run through.

    No bite makes those faces: the leaves need none.
    """
    low = low[_outermost(grid, low, size)]
    while size > LEAF:
        size //= 2
        low, _ = grid.halved(low, size)
        low = low[_outermost(grid, low, size)]
    return low


def _outermost(grid: Grid, low: Ints, size: int) -> Bools:
    """Blocks with a cell in the outermost layer of the grid."""
    nr, _, nz = grid.cells
    i, _, k = low.T
    return (i == 0) | (i + size >= nr) | (k == 0) | (k + size >= nz)


def first_cull(sweep: Sweep, middle: Floats, corners: Floats) -> Culled:
    """As `cull`, for blocks that have no parents."""
    lists = sweep.near(middle, _radius(middle, corners))
    some = np.flatnonzero(np.diff(lists.start))
    lists = lists.of(some)

    def work(part: slice) -> Culled:
        items = some[part]
        own = lists.of(np.arange(part.start, part.stop))
        meeting = sweep.evaluate(middle[items[own.owner()]], own.bites, gradient=True)
        judge = own.bites[leaders(meeting.depth, own.start)[1]]
        floors = sweep.floors(middle[items], corners[items], judge, _radius(middle[items], corners[items]))
        return _judged(sweep, middle[items], corners[items], own, floors, meeting=meeting)

    return _gathered(len(middle), some, lists.start, work)


def cull(sweep: Sweep, middle: Floats, corners: Floats, parent: Ints, tangents: Tangents) -> Culled:
    """Cull the bites of blocks with these middles (n, 3) and corners of their hulls (n, 8, 3).

    `tangents` are those of their parent blocks, `parent` (n,) tells which.
    """
    length = np.diff(tangents.lists.start)[parent]
    some = np.flatnonzero(length)

    def work(part: slice) -> Culled:
        items = some[part]
        above = tangents.of(parent[items])
        owner = above.lists.owner()
        way = np.ascontiguousarray((middle[items] - above.middle).T)
        height = above.plane[0] + (above.plane[1:] * way.take(owner, axis=1)).sum(axis=0)
        judge = above.lists.bites[leaders(height, above.lists.start)[1]]
        floors = sweep.floors(middle[items], corners[items], judge, _radius(middle[items], corners[items]))
        outside = _radius(above.middle, corners[items]) > above.radius * (1.0 + ROUNDING)
        spokes = _spokes(above.middle, corners[items])
        keep = can_matter(above.plane, above.over, owner, spokes, floors) | outside[owner]
        return _judged(sweep, middle[items], corners[items], above.lists.where(keep), floors)

    return _gathered(len(middle), some, np.concatenate([[0], np.cumsum(length[some])]), work)


def _judged(
    sweep: Sweep,
    middle: Floats,
    corners: Floats,
    lists: Candidates,
    floors: Floats,
    *,
    meeting: Meeting | None = None,
) -> Culled:
    """Cull by the tangents at the blocks' own middles, where the bites' `meeting` may be known."""
    whole = floors.min(axis=0) > 0
    rest = np.flatnonzero(~whole & (np.diff(lists.start) > 0))
    pairs = lists.pairs(rest)
    middle, corners, lists = middle[rest], corners[rest], lists.of(rest)
    radius = _radius(middle, corners)
    owner = lists.owner()
    if meeting is None:
        meeting = sweep.evaluate(middle.take(owner, axis=0), lists.bites, gradient=True)
    else:
        meeting = meeting.of(pairs)
    change, over = sweep.bound(meeting, lists.bites, radius[owner])
    plane = np.vstack([meeting.depth, meeting.gradient.T])
    keep = can_matter(plane, over, owner, _spokes(middle, corners), floors[:, rest])
    keep &= meeting.depth + change > 0
    rows = np.flatnonzero(keep)
    tangents = Tangents(lists.where(keep), middle, radius, plane.take(rows, axis=1), over.take(rows))
    some = np.flatnonzero(np.diff(tangents.lists.start))
    return Culled(whole, rest[some], tangents.of(some), len(owner))


def _gathered(count: int, items: Ints, start: Ints, work: Callable[[slice], Culled]) -> Culled:
    """`work` on slices of some of `count` blocks, whose lists of pairs begin at `start`."""
    slices = list(batches(start, LISTED))
    done = in_parallel(work, iter(slices))
    whole = np.zeros(count, dtype=bool)
    alive = [np.zeros(0, dtype=np.int64)]
    for part, culled in zip(slices, done, strict=True):
        whole[items[part]] = culled.whole
        alive.append(items[part][culled.alive])
    return Culled(
        whole,
        np.concatenate(alive),
        joined([without_bites(np.zeros((0, 3))), *(culled.tangents for culled in done)]),
        sum(culled.pairs for culled in done),
    )


def _radius(middle: Floats, corners: Floats) -> Floats:
    """(n,) distance of the farthest corner."""
    return np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)


def _spokes(middle: Floats, corners: Floats) -> Floats:
    """(8, 3, n) from the middles to the corners, one contiguous row per corner and coordinate."""
    return np.ascontiguousarray((corners - middle[:, None]).transpose(1, 2, 0))
