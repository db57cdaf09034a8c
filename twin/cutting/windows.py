"""Stretches of a motion along which every point of the stock moves nearly straight past the tool."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.motion import CutterMotion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STILL = 1e-6
"""[mm] of way below which the next sample is none: dwells have no direction"""
UNEVEN = 1e-6
"""[mm] that the recorded way may stray from a straight and even one within a window: what the search for the
deepest instant may miss"""
BENT = 5e-4
"""[mm] that points may depart from their chords as the work turns; it costs culling, not truth"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """A motion over the way that it makes past the stock, without its dwells."""

    sample: Floats
    """(n,) samples of the motion that are kept"""
    length: Floats
    """(n,) way up to each [mm], increasing"""
    place: Floats
    """(n, 4) work angle [rad] and tool centre [mm]"""
    radius: float
    """of the stock about the work axis [mm]: what a turn of the work counts for"""

    @classmethod
    def of(cls, motion: CutterMotion, radius: float) -> "Way":
        """The way of stock within `radius` [mm] of the work axis."""
        place = np.column_stack([motion.work_angle, motion.centre])
        step = np.linalg.norm(np.diff(place, axis=0) * [radius, 1.0, 1.0, 1.0], axis=1)
        length = np.concatenate([[0.0], np.cumsum(step)])
        # the first sample in each STILL of the way
        kept = np.flatnonzero(np.diff(np.floor(length / STILL), prepend=-1.0))
        if len(kept) < 2:
            kept = np.array([0, len(length) - 1])
            length[-1] = max(length[-1], STILL)
        return cls(sample=kept.astype(np.float64), length=length[kept], place=place[kept], radius=radius)


@dataclass(frozen=True, slots=True, kw_only=True)
class Windows:
    """Windows of a way in order of time."""

    first: Floats
    """(k,) [mm] along the way"""
    last: Floats
    """(k,)"""
    bow: Floats
    """(k,) bound on how far any point of the stock departs from its chord [mm]"""
    swing: Floats
    """(k,) the work's turn [rad]"""

    @property
    def count(self) -> int:
        """Number of windows."""
        return len(self.first)

    def where(self, keep: NDArray[np.bool_]) -> "Windows":
        """Some of them."""
        return Windows(
            first=self.first[keep], last=self.last[keep], bow=self.bow[keep], swing=self.swing[keep]
        )


def straight_windows(way: Way, runs: Ints) -> Windows:
    """Cut the `runs` (2, m), of first and last samples of the motion, into windows.

    A window of one interval between samples is as straight as it gets.
    """
    path = way.place * [way.radius, 1.0, 1.0, 1.0]
    todo = [(int(a), int(b)) for a, b in np.searchsorted(way.sample, runs).T[::-1]]
    rows: list[tuple[float, float, float, float]] = []
    while todo:
        a, b = todo.pop()
        b = min(b, len(path) - 1)
        if b <= a:
            continue
        swing = float(np.ptp(way.place[a : b + 1, 0]))
        stray = _off_chord(path[a : b + 1], way.length[a : b + 1])
        bent = way.radius * (1.0 - math.cos(min(0.5 * swing, math.pi)))
        if (stray > UNEVEN or bent > BENT) and b - a > 1:
            middle = (a + b) // 2
            todo += [(middle, b), (a, middle)]
        else:
            rows.append((way.length[a], way.length[b], stray + bent, swing))
    first, last, bow, swings = np.array(rows, dtype=np.float64).reshape(-1, 4).T
    return Windows(first=first, last=last, bow=bow, swing=swings)


def _off_chord(path: Floats, length: Floats) -> float:
    """How far a path (n, 4) departs from the straight and even way between its ends."""
    share = (length - length[0]) / (length[-1] - length[0])
    chord = path[0] + share[:, None] * (path[-1] - path[0])
    return float(np.linalg.norm(path - chord, axis=1).max())
