"""Which bite was the first to remove what of the rings."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from twin.cutting.rings import Intervals, Rings
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

NOBODY = -1
"""in place of a bite"""


@dataclass(frozen=True, slots=True)
class Removed:
    """Pieces of rings, each with the bite that was the first to remove it."""

    ring: Ints
    """(n,)"""
    start: Floats
    """(n,) [rad]"""
    width: Floats
    """(n,) [rad]"""
    bite: Ints
    """(n,) numbered through all tools"""
    instant: Floats
    """(n,) sample of the bite's motion at which it passes the middle of its interval"""

    def volume(self, rings: Rings) -> Floats:
        """(n,) that the pieces stand for [mm³]."""
        return rings.weight.reshape(-1)[self.ring] * self.width


def removed(sweep: Sweep, rings: Rings, found: Intervals, longest: float) -> Removed:
    """What of the intervals was still there, in pieces of arc no longer than `longest` [mm].

    On each ring the later ones are painted over by the earlier.
    """
    order = np.lexsort((-sweep.order(found.bite), found.ring))
    ring = found.ring[order]
    bounds = np.concatenate([[0], np.flatnonzero(np.diff(ring)) + 1, [len(ring)]])
    owners: list[Ints] = []
    starts: list[Floats] = []
    ends: list[Floats] = []
    for first, last in pairwise(bounds):
        own = order[first:last]
        # where there never was metal, nothing can be the first to remove it
        air = rings.air(int(ring[first]))
        owner, edges = _painted(
            np.concatenate([own, np.full(len(air), NOBODY)]),
            np.concatenate([found.start[own], air[:, 0]]),
            np.concatenate([found.end[own], air[:, 1]]),
        )
        change = np.flatnonzero(np.diff(owner, prepend=-2, append=-2))
        kept = owner[change[:-1]] >= 0
        owners.append(owner[change[:-1]][kept])
        starts.append(edges[change[:-1]][kept])
        ends.append(edges[change[1:]][kept])
    none = np.zeros(0)
    owner = np.concatenate([none.astype(np.int64), *owners])
    start, end = np.concatenate([none, *starts]), np.concatenate([none, *ends])
    radius = rings.radius[found.ring[owner] // len(rings.height)]
    parts = np.maximum(np.ceil((end - start) * radius / longest).astype(np.int64), 1)
    number = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    wide = np.repeat((end - start) / parts, parts)
    owner, start = np.repeat(owner, parts), np.repeat(start, parts) + number * wide
    return Removed(found.ring[owner], start, wide, found.bite[owner], found.instant[owner])


def _painted(own: Ints, start: Floats, end: Floats) -> tuple[Ints, Floats]:
    """Which interval each stretch between the edges of all of them belongs to: the last that covers it.

    Returns the owners (e − 1,), −1 where there is none, and the edges (e,) from 0 to a full turn.
    """
    full = 2.0 * math.pi
    # an interval that begins before 0 goes on before the end of the turn
    before, after = start < 0, end > full
    own = np.concatenate([own, own[before], own[after]])
    rank = np.concatenate([np.arange(len(start)), np.flatnonzero(before), np.flatnonzero(after)])
    low = np.concatenate([np.maximum(start, 0.0), start[before] + full, np.zeros(after.sum())])
    high = np.concatenate([np.minimum(end, full), np.full(before.sum(), full), end[after] - full])
    edges = np.unique(np.concatenate([[0.0, full], low, high]))
    order = np.argsort(rank, kind="stable")
    owner = np.full(len(edges) - 1, -1, dtype=np.int64)
    rows = zip(
        np.searchsorted(edges, low)[order], np.searchsorted(edges, high)[order], own[order], strict=True
    )
    for a, b, who in rows:
        owner[a:b] = who
    return owner, edges
