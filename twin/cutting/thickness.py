"""The largest thickness of chips: the highest place above a bite's edge that is still metal when it comes.

Pieces of rings say about where that is. From there it is climbed to. What earlier bites have left is what
lies outside of convex bodies; a linear program in a box about the last place says where to go next
(`climb.py`). The bites that it asks are those of the blocks that the rings were searched with: all that come.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.blocks import Blocks
from twin.cutting.climb import highest
from twin.cutting.grid import cartesian
from twin.cutting.pairs import in_parallel
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STARTS = 3
"""places of each bite that are climbed from"""
APART = 2.0
"""boxes between them at least"""
STEPS = 16
"""boxes after each other, at most"""
SHRINK, GROW = 0.4, 2.0
GAIN = 1e-3
"""share of the height that a box has to promise"""
STIFF = 30.0
"""by how much what is gone already counts against the height"""
ASIDE = 1e-4
"""[mm] between places that the slope of the blank's outline is told by"""
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

    def of(self, rows: Ints | slice | NDArray[np.bool_]) -> "Places":
        """Some of them."""
        return Places(self.bite[rows], self.at[rows], self.height[rows])


@dataclass(frozen=True, slots=True)
class _Planes:
    """What bounds the metal about some places, as tangent planes, in steps across, around and along [mm]."""

    rise: Floats
    """(n, 3) slope of the height above the edge"""
    level: Floats
    """(n, k) how far the places are beyond what is gone, or the blank; −inf for none"""
    slope: Floats
    """(n, k, 3) of that"""


def climbed(sweep: Sweep, blank: Blank, blocks: Blocks, found: Places, box: Floats) -> Floats:
    """Heights (n,) of the highest places near the highest of those `found`; 0 for the others.

    `box` (3,) is how far off the next one found may be: across, around and along the axis [mm].
    """
    start = _starts(found, APART * box)
    climb = _Climb(sweep, blank, blocks, box)
    slices = (start[low : low + TOGETHER] for low in range(0, len(start), TOGETHER))
    height = np.zeros(len(found.height))
    height[start] = np.concatenate(
        [np.zeros(0), *in_parallel(lambda rows: climb.up(found.of(rows)).height, slices)]
    )
    return np.maximum(height, 0.0)


def _starts(found: Places, apart: Floats) -> Ints:
    """The highest places of each bite that are `apart` (3,) from each other."""
    order = np.lexsort((-found.height, found.bite))
    kept: list[Ints] = [order[:0]]
    for _ in range(STARTS):
        bite = found.bite[order]
        first = np.flatnonzero(np.diff(bite, prepend=-1))
        kept.append(order[first])
        lead = np.repeat(order[first], np.diff(np.append(first, len(bite))))
        off = found.at[order] - found.at[lead]
        off[:, 1] = found.at[order, 0] * _turned(off[:, 1])
        order = order[(np.abs(off) > apart).any(axis=1)]
    return np.concatenate(kept)


def _turned(angle: Floats) -> Floats:
    """From −π to π."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


class _Climb:
    """What is climbed over: a blank, less what bites remove."""

    def __init__(self, sweep: Sweep, blank: Blank, blocks: Blocks, box: Floats) -> None:
        self._sweep, self._blank, self._blocks, self._box = sweep, blank, blocks, box

    def up(self, start: Places) -> Places:
        """The highest places within a few boxes."""
        at = start.at.copy()
        # blocks that are asked: the place's own, and that of the last one tried
        where = np.repeat(self._blocks.rows(at)[:, None], 2, axis=1)
        height = self._height(start, where)
        size = np.ones(len(height))
        rows = np.arange(len(height))
        for _ in range(STEPS):
            here = Places(start.bite[rows], at[rows], height[rows])
            way, gain = self._way(here, where[rows], size[rows])
            worth = gain > GAIN * np.abs(here.height)
            rows, here, way, gain = rows[worth], here.of(worth), way[worth], gain[worth]
            if not len(rows):
                break
            new = Places(here.bite, self._moved(here.at, way), here.height)
            where[rows, 1] = self._blocks.rows(new.at)
            value = self._height(new, where[rows])
            better = value > here.height
            size[rows] *= np.where(value > here.height + 0.5 * gain, GROW, np.where(better, 1.0, SHRINK))
            size[rows] = np.minimum(size[rows], 1.0)
            up = rows[better]
            at[up], height[up] = new.at[better], value[better]
        return Places(start.bite, at, height)

    def _way(self, here: Places, where: Ints, size: Floats) -> tuple[Floats, Floats]:
        """Steps (n, 3) within boxes, and what they promise (n,) [mm]."""
        planes = self._planes(here, where)
        # first out of what is gone, by the plane that is the farthest off
        worst = planes.level.argmax(axis=1)
        out = planes.slope[np.arange(len(worst)), worst]
        deep = np.maximum(planes.level[np.arange(len(worst)), worst], 0.0)
        back = -out * (deep / np.maximum((out * out).sum(axis=1), 1e-12))[:, None]
        side = size[:, None] * self._box
        low, high = self._ends()
        room = np.concatenate([np.minimum(high - here.at, side), np.minimum(here.at - low, side)], axis=1)
        room[:, [1, 4]] = side[:, 1, None]
        back = np.clip(back, -room[:, 3:], room[:, :3])
        cube = np.broadcast_to(np.concatenate([np.eye(3), -np.eye(3)]), (len(side), 6, 3))
        slope = np.concatenate([planes.slope, cube], axis=1)
        room = np.concatenate([-planes.level, room], axis=1) - np.einsum("nkx,nx->nk", slope, back)
        way = back + highest(planes.rise, slope, np.maximum(room, 0.0))
        return way, (planes.rise * way).sum(axis=1) + STIFF * deep

    def _ends(self) -> tuple[Floats, Floats]:
        """Lowest and highest radius, angle and z of the slab."""
        low, high = self._blocks.z_range
        return (
            np.array([self._blank.bore_mm / 2.0, -np.inf, low]),
            np.array([self._blank.radius, np.inf, high]),
        )

    def _moved(self, at: Floats, way: Floats) -> Floats:
        """Places (n, 3) that far off, pulled back onto the blank's turned outline."""
        new = at + way
        new[:, 1] = at[:, 1] + way[:, 1] / np.maximum(at[:, 0], 1e-9)
        new = np.clip(new, *self._ends())
        new[:, 0] = np.minimum(new[:, 0], self._blank.outer_radius(new[:, 2]))
        return new

    def _height(self, places: Places, where: Ints) -> Floats:
        """(n,) above the edge, much less where metal is gone [mm]."""
        points = cartesian(*places.at.T)
        height = self._sweep.evaluate(points, places.bite).depth
        item, bite = self._earlier(places, where)
        gone = np.zeros(len(height))
        np.maximum.at(gone, item, self._sweep.evaluate(points[item], bite).depth)
        if self._blank.section is not None:
            gone = np.maximum(gone, self._blank.section.beyond(points)[0])
        return height - STIFF * gone

    def _planes(self, places: Places, where: Ints) -> _Planes:
        radius, angle, z = places.at.T
        points = cartesian(radius, angle, z)
        n = len(points)
        item, bite = self._earlier(places, where)
        met = self._sweep.evaluate(points[item], bite, gradient=True)
        slope = _polar(met.gradient, angle[item])
        # no plane out of reach within the largest box
        near = np.flatnonzero(met.depth + np.abs(slope) @ self._box > 0)
        item, first = item[near], np.searchsorted(item[near], np.arange(n + 1))
        number = np.arange(len(item)) - first[item]
        k = int(np.diff(first).max(initial=0))
        levels, slopes = np.full((n, k + 2), -np.inf), np.zeros((n, k + 2, 3))
        levels[item, number], slopes[item, number] = met.depth[near], slope[near]
        outer = self._blank.outer_radius
        levels[:, k], slopes[:, k, 0] = radius - outer(z), 1.0
        slopes[:, k, 2] = (outer(z - ASIDE) - outer(z + ASIDE)) / (2.0 * ASIDE)
        if self._blank.section is not None:
            levels[:, k + 1], beyond = self._blank.section.beyond(points)
            slopes[:, k + 1] = _polar(beyond, angle)
        rise = self._sweep.evaluate(points, places.bite, gradient=True).gradient
        return _Planes(_polar(rise, angle), levels, slopes)

    def _earlier(self, places: Places, where: Ints) -> tuple[Ints, Ints]:
        """Items and bites of earlier passes in the blocks `where` (n, k)."""
        item, bite = self._blocks.near(where)
        before = self._sweep.order(bite) < self._sweep.order(places.bite)[item]
        return item[before], bite[before]


def _polar(slope: Floats, angle: Floats) -> Floats:
    """Slopes (m, 3) by steps across, around and along the axis."""
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, z = slope.T
    return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=1)
