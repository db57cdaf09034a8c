"""The largest thickness of chips: the highest place above a bite's edge that is still metal when it comes.

Pieces of cells say about where that is. From there it is climbed to. What earlier bites have left is what
lies outside of convex bodies; a linear program in a box about the last place says where to go next
(`climb.py`). The height above an edge is that above the nearest of its lines and arcs, a concave function:
the tangents of the last places that were tried bound it all. Hollow arcs bend both by a share of the box
that is as small as the box is to their radius; what counts is the height at the places themselves.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.climb import highest
from twin.cutting.metal import Metal
from twin.cutting.pairs import in_parallel

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

STARTS = 3
"""places of each bite that are climbed from"""
WORTH = 0.5
"""share of the highest that a place must have for that"""
APART = 2.0
"""boxes between them at least"""
STEPS = 20
"""boxes after each other, at most"""
SHRINK, GROW = 0.4, 2.0
GAIN = 2e-3
"""share of the height that a box has to promise"""
STIFF = 30.0
"""by how much what is gone already counts against the height"""
LAST = 3
"""places tried whose tangents bound the height"""
TOGETHER = 4096
"""places that are climbed from at once"""


@dataclass(frozen=True, slots=True)
class Places:
    """Places of the stock, each seen from a bite."""

    bite: Ints
    """(n,)"""
    at: Floats
    """(n, 3) radius [mm], angle [rad], z [mm]"""
    height: Floats
    """(n,) above its edge [mm]"""

    def of(self, rows: Ints | Bools) -> "Places":
        """Some of them."""
        return Places(self.bite[rows], self.at[rows], self.height[rows])


@dataclass(frozen=True, slots=True)
class _Tangents:
    """Of the heights above edges, at the last places tried."""

    at: Floats
    """(n, LAST, 3)"""
    height: Floats
    """(n, LAST)"""
    slope: Floats
    """(n, LAST, 3) in steps"""

    def put(self, rows: Ints, number: int, at: Floats, found: tuple[Floats, Floats]) -> None:
        """Replace those of some places."""
        self.at[rows, number] = at
        self.height[rows, number], self.slope[rows, number] = found

    def above(self, rows: Ints, at: Floats) -> Floats:
        """(n, LAST) heights that they allow at places (n, 3)."""
        off = at[:, None] - self.at[rows]
        off[:, :, 1] = at[:, None, 0] * _turned(off[:, :, 1])
        return self.height[rows] + (self.slope[rows] * off).sum(axis=2)


def climbed(metal: Metal, found: Places, box: Floats, known: Floats) -> Floats:
    """Heights (n,) of the highest places near the highest of those `found`; 0 for the others.

    `box` (3,) is how far off the next one found may be: across, around and along the axis [mm]. For each bite
    a height may be `known` (bites,) already.
    """
    start = _starts(found, APART * box, known)
    slices = (start[low : low + TOGETHER] for low in range(0, len(start), TOGETHER))
    height = np.zeros(len(found.height))
    height[start] = np.concatenate(
        [np.zeros(0), *in_parallel(lambda rows: _up(metal, found.of(rows), box), slices)]
    )
    return np.maximum(height, 0.0)


def _starts(found: Places, apart: Floats, known: Floats) -> Ints:
    """The highest places of each bite that are `apart` (3,) from each other."""
    order = np.lexsort((-found.height, found.bite))
    order = order[found.height[order] > WORTH * known[found.bite[order]]]
    kept: list[Ints] = [order[:0]]
    for _ in range(STARTS):
        bite = found.bite[order]
        first = np.flatnonzero(np.diff(bite, prepend=-1))
        kept.append(order[first])
        lead = np.repeat(order[first], np.diff(np.append(first, len(bite))))
        off = found.at[order] - found.at[lead]
        off[:, 1] = found.at[order, 0] * _turned(off[:, 1])
        high = found.height[order] > WORTH * found.height[lead]
        order = order[high & (np.abs(off) > apart).any(axis=1)]
    return np.concatenate(kept)


def _turned(angle: Floats) -> Floats:
    """From −π to π."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def _up(metal: Metal, start: Places, box: Floats) -> Floats:
    """The heights (n,) of the highest places within a few boxes; less where metal is gone."""
    at = start.at.copy()
    # blocks that are asked: the place's own, and that of the last one tried
    where = np.repeat(metal.rows(at)[:, None], 2, axis=1)
    found = metal.height(start.bite, at)
    best = found[0] - STIFF * metal.gone(start.bite, at, where)
    tangents = _Tangents(*(np.repeat(v[:, None], LAST, axis=1) for v in (at, *found)))
    size, rows = np.ones(len(best)), np.arange(len(best))
    for number in range(STEPS):
        here = Places(start.bite[rows], at[rows], best[rows])
        over = tangents.above(rows, here.at), tangents.slope[rows]
        way, gain = _way(metal, here, where[rows], over, size[rows, None] * box)
        worth = gain > GAIN * np.abs(here.height)
        rows, here, way, gain = rows[worth], here.of(worth), way[worth], gain[worth]
        if not len(rows):
            break
        new = metal.moved(here.at, way)
        where[rows, 1] = metal.rows(new)
        found = metal.height(here.bite, new)
        tangents.put(rows, number % LAST, new, found)
        value = found[0] - STIFF * metal.gone(here.bite, new, where[rows])
        better = value > here.height
        size[rows] *= np.where(value > here.height + 0.5 * gain, GROW, np.where(better, 1.0, SHRINK))
        size[rows] = np.minimum(size[rows], 1.0)
        at[rows[better]], best[rows[better]] = new[better], value[better]
    return best


def _way(
    metal: Metal, here: Places, where: Ints, over: tuple[Floats, Floats], box: Floats
) -> tuple[Floats, Floats]:
    """Steps (n, 3) within boxes (n, 3), and what they promise (n,) [mm].

    The height is under the planes `over` it: their heights (n, LAST) at the places, and slopes (n, LAST, 3).
    """
    above, rise = over
    n, each = len(box), np.arange(len(box))
    level, slope = metal.planes(here.bite, here.at, where, box)
    room = metal.room(here.at, box)
    # first out of what is gone, by the plane that is the farthest off
    worst = level.argmax(axis=1)
    out, deep = slope[each, worst], np.maximum(level[each, worst], 0.0)
    back = -out * (deep / np.maximum((out * out).sum(axis=1), 1e-12))[:, None]
    back = np.clip(back, -room[:, 3:], room[:, :3])
    # the fourth unknown is the height
    cube = np.broadcast_to(np.concatenate([np.eye(3), -np.eye(3)]), (n, 6, 3))
    level = np.concatenate([-level, room], axis=1)
    slope = np.concatenate([slope, cube], axis=1)
    level = np.maximum(level - (slope * back[:, None]).sum(axis=2), 0.0)
    under = above + (rise * back[:, None]).sum(axis=2)
    begin = under.min(axis=1)
    slope = np.concatenate([slope, -rise], axis=1)
    slope = np.concatenate([slope, np.zeros((n, slope.shape[1], 1))], axis=2)
    slope[:, -LAST:, 3] = 1.0
    level = np.concatenate([level, under - begin[:, None]], axis=1)
    way = highest(np.broadcast_to([0.0, 0.0, 0.0, 1.0], (n, 4)), slope, level)
    return back + way[:, :3], begin + way[:, 3] - here.height
