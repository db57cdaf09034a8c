"""Rings about the work axis, and the intervals of angle that each bite removes of them."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.blocks import COARSEST, FINEST, Blocks
from twin.cutting.grid import Grid, cartesian
from twin.cutting.pairs import LISTED, Candidates, batches, in_parallel
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUNDS = 12
CLOSE = 1e-5
"""[mm] of depth at which the end of an interval counts as found"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rings:
    """Rings through the middles of the cells (r, z) of a grid, with a place at each of its angles."""

    grid: Grid
    gaps: tuple[Floats, ...]
    """(m, 2) for each radius: stretches of angle at height 0 that lie in gaps of the blank [rad]"""
    twist: float
    """turn of these per height [rad/mm]"""
    weight: Floats
    """(nr, nz) area of the blank's section that each ring stands for, times its radius [mm³/rad]"""

    @classmethod
    def of(
        cls, blank: Blank, step: float, *, around: float | None = None, along: float | None = None
    ) -> "Rings":
        """Rings about `step` apart, with places about as far apart, or `around`; `along` the axis [mm]."""
        low = blank.bore_mm / 2.0
        nr = max(1, math.ceil((blank.radius - low) / step))
        nz = max(1, math.ceil(blank.length_mm / (along or step)))
        sectors = COARSEST * max(6, math.ceil(2.0 * math.pi * blank.radius / (around or step) / COARSEST))
        r = np.linspace(low, blank.radius, nr + 1)
        z = np.linspace(*blank.z_range, nz + 1)
        outer = blank.outer_radius(0.5 * (z[1:] + z[:-1]))
        # the share of each cell that is inside the blank at the middle of its height
        inside = np.clip(outer - r[:-1, None], 0.0, np.diff(r)[:, None])
        middle = 0.5 * (r[1:] + r[:-1])
        section = blank.section
        gaps = tuple(np.zeros((0, 2)) if section is None else section.gaps(at) for at in middle.tolist())
        twist = 0.0 if section is None else section.twist
        weight = middle[:, None] * inside * np.diff(z)
        return cls(grid=Grid(r=r, sectors=sectors, z=z), gaps=gaps, twist=twist, weight=weight)

    def air(self, ring: int) -> Floats:
        """(m, 2) stretches of a ring that lie in gaps of the blank, from and to [rad]."""
        i, k = divmod(ring, len(self.height))
        found = self.gaps[i] + self.twist * self.height[k]
        return found - 2.0 * math.pi * np.floor(found[:, :1] / (2.0 * math.pi))

    @property
    def radius(self) -> Floats:
        """(nr,) of the rings [mm]."""
        return 0.5 * (self.grid.r[1:] + self.grid.r[:-1])

    @property
    def spacing(self) -> Floats:
        """(3,) between neighbours across, around at the outer radius, and along the axis [mm]."""
        return np.array(self.grid.cell_mm)

    @property
    def height(self) -> Floats:
        """(nz,) z of the rings [mm]."""
        return 0.5 * (self.grid.z[1:] + self.grid.z[:-1])

    def points(self, ring: Ints, angle: Floats) -> Floats:
        """(n, 3) places on rings, numbered i nz + k."""
        i, k = np.divmod(ring, len(self.height))
        return cartesian(self.radius[i], angle, self.height[k])

    def slabs(self) -> Iterator[Ints]:
        """Low corners (n, 3) of the coarsest blocks, slab after slab along z."""
        nr, nt, nz = self.grid.cells
        across = np.stack(
            np.meshgrid(np.arange(0, nr, COARSEST), np.arange(0, nt, COARSEST), indexing="ij"), axis=-1
        ).reshape(-1, 2)
        for k in range(0, nz, COARSEST):
            yield np.column_stack([across, np.full(len(across), k)])


@dataclass(frozen=True, slots=True)
class Intervals:
    """Intervals of angle on rings, each removed by one bite."""

    ring: Ints
    """(n,)"""
    start: Floats
    """(n,) [rad]; an interval may begin below 0"""
    end: Floats
    bite: Ints
    instant: Floats
    """(n,) sample of the motion at which the bite passes"""


def intervals(sweep: Sweep, rings: Rings, blocks: Blocks) -> Intervals:
    """Everything that any bite removes of the rings in a slab's blocks, before all around is gone."""
    ring, place, bite, instant = _removed(sweep, rings, blocks.low, blocks.lists)
    order = np.lexsort((place, bite, ring))
    ring, place, bite, instant = ring[order], place[order], bite[order], instant[order]
    sectors = rings.grid.sectors
    same = (np.diff(ring) == 0) & (np.diff(bite) == 0)
    begins = np.concatenate([[True], ~(same & (np.diff(place) == 1))]) if len(ring) else np.zeros(0, bool)
    first = np.flatnonzero(begins)
    last = np.append(first[1:], len(ring))[: len(first)] - 1
    # a run that ends at the last place goes on in the one that begins at the first
    key = ring[first] * np.int64(sum(field.count for field in sweep.fields) + 1) + bite[first]
    tail = np.flatnonzero((place[last] == sectors - 1) & (place[first] > 0))
    heads = np.flatnonzero(place[first] == 0)
    at = np.minimum(np.searchsorted(key[heads], key[tail]), max(len(heads) - 1, 0))
    joins = key[heads[at]] == key[tail] if len(heads) else np.zeros(len(tail), dtype=bool)
    begin = place[first].copy()
    begin[heads[at[joins]]] = begin[tail[joins]] - sectors
    gone = np.zeros(len(first), dtype=bool)
    gone[tail[joins]] = True
    middle = (first + last) // 2
    rows = np.flatnonzero(~gone)
    first, last, middle = first[rows], last[rows], middle[rows]
    passed = sweep.order(bite)
    taken = _Taken.of(ring * sectors + place, passed, np.append(~begins[1:], False)[: len(ring)])
    sides = []
    for places, way in ((begin[rows], -1), (place[last], 1)):
        between = ring[first] * sectors + (places + min(way, 0)) % sectors
        own = np.flatnonzero(~taken.before(between, passed[first]))
        at = rings.grid.angle(places) + rings.grid.angle(np.array(0.5 * way))
        at[own] = _ends(sweep, rings, ring[first[own]], bite[first[own]], (places[own], way))
        sides.append(at)
    return Intervals(ring[first], sides[0], sides[1], bite[first], instant[middle])


@dataclass(frozen=True, slots=True)
class _Taken:
    """Stretches between neighbouring places of a ring that a pass takes as a whole, and the first to do so.

    Where a later pass ends within one of them does not matter.
    """

    place: Ints
    """(n,) ascending: number of the place before the stretch"""
    passed: Ints
    """(n,) order of the first pass"""

    @classmethod
    def of(cls, place: Ints, passed: Ints, goes_on: NDArray[np.bool_]) -> "_Taken":
        """From places that passes remove, and whether (m,) a pass goes on to the next place."""
        place, passed = place[goes_on], passed[goes_on]
        order = np.lexsort((passed, place))
        place, passed = place[order], passed[order]
        new = np.flatnonzero(np.diff(place, prepend=-1))
        return cls(place[new], passed[new])

    def before(self, place: Ints, passed: Ints) -> NDArray[np.bool_]:
        """Whether (k,) the stretches behind some places are taken before a pass."""
        if not len(self.place):
            return np.zeros(len(place), dtype=bool)
        at = np.minimum(np.searchsorted(self.place, place), len(self.place) - 1)
        return (self.place[at] == place) & (self.passed[at] < passed)


def _removed(sweep: Sweep, rings: Rings, low: Ints, lists: Candidates) -> tuple[Ints, Ints, Ints, Floats]:
    """Ring, place, bite and instant (n,) of every place of the rings that a bite removes."""
    nr, sectors, nz = rings.grid.cells
    found: list[tuple[Ints, Ints, Ints, Floats]] = []
    for di in range(FINEST):
        for dj in range(FINEST):
            for dk in range(FINEST):
                i, j, k = (low + np.array([di, dj, dk])).T
                inside = np.flatnonzero((i < nr) & (k < nz))
                inside = inside[rings.weight[i[inside], k[inside]] > 0]
                ring, place, own = i[inside] * nz + k[inside], j[inside] % sectors, lists.of(inside)
                found += _hit(sweep, rings, ring, place, own)
    none = np.zeros(0, dtype=np.int64)
    ring, place, bite, instant = zip((none, none, none, np.zeros(0)), *found, strict=True)
    return np.concatenate(ring), np.concatenate(place), np.concatenate(bite), np.concatenate(instant)


def _hit(
    sweep: Sweep, rings: Rings, ring: Ints, place: Ints, lists: Candidates
) -> list[tuple[Ints, Ints, Ints, Floats]]:
    point = rings.points(ring, rings.grid.angle(place))

    def work(part: slice) -> tuple[Ints, Ints, Ints, Floats]:
        own = lists.of(np.arange(part.start, part.stop))
        owner = own.owner() + part.start
        meeting = sweep.evaluate(point[owner], own.bites)
        hit = np.flatnonzero(meeting.depth > 0)
        return ring[owner[hit]], place[owner[hit]], own.bites[hit], meeting.instant[hit]

    return in_parallel(work, batches(lists.start, LISTED))


def _ends(sweep: Sweep, rings: Rings, ring: Ints, bite: Ints, place: tuple[Ints, int]) -> Floats:
    """Angles (n,) at which the bites' depths cross zero, from removed places to the next, ±1 further on."""
    begin = rings.grid.angle(place[0])
    way = place[1] * 2.0 * math.pi / rings.grid.sectors

    def work(part: slice) -> Floats:
        return begin[part] + way * _crossing(sweep, rings, ring[part], bite[part], (begin[part], way))

    return np.concatenate([np.zeros(0), *in_parallel(work, batches(np.arange(len(ring) + 1)))])


def _crossing(sweep: Sweep, rings: Rings, ring: Ints, bite: Ints, span: tuple[Floats, float]) -> Floats:
    """Shares (n,) of the way, by false position kept between a removed and a kept place."""
    begin, way = span
    inner, outer, at = np.zeros(len(ring)), np.ones(len(ring)), np.zeros(len(ring))

    def depth(rows: Ints, share: Floats) -> Floats:
        return sweep.evaluate(rings.points(ring[rows], begin[rows] + share * way), bite[rows]).depth

    rows = np.arange(len(ring))
    value = np.stack([depth(rows, inner), np.minimum(depth(rows, outer), 0.0)])
    for _ in range(ROUNDS):
        here, there = value[:, rows]
        new = inner[rows] + here / np.maximum(here - there, 1e-300) * (outer[rows] - inner[rows])
        at[rows] = new
        found = depth(rows, new)
        removed = found > 0
        inner[rows[removed]], value[0, rows[removed]] = new[removed], found[removed]
        outer[rows[~removed]], value[1, rows[~removed]] = new[~removed], found[~removed]
        value[1, rows[removed]] *= 0.5
        value[0, rows[~removed]] *= 0.5
        rows = rows[np.abs(found) > CLOSE]
        if not len(rows):
            break
    return at
