"""Sections at many heights: how far they reach, and how many teeth or corners stand about the axis."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from twin.inspection.beside import Beside
from twin.inspection.sections import (
    Segments,
    circle_crossings,
    outer_outlines,
    plane_segments_in_parts,
    radial_limits,
    turns_about_axis,
    unfolded,
)
from twin.inspection.solid import Floats, Ints, Solid

NICK = 0.05
"""crossings closer together than this part of a pitch belong to one tooth when teeth are counted"""
UNEVEN = 0.25
"""steps that differ from the pitch by more than this part of it are no regular teeth"""
FEWEST_WITH_GAPS = 5
"""teeth, from which gaps of several pitches are missing teeth and not just uneven steps"""
ROUND = 1e-3
"""an outline of less relative depth is round: the chords of a faceted circle"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Survey:
    """The outer outline at heights between `bottom` and `top`, (k,) each."""

    bottom: float
    """z [mm]"""
    top: float
    """z [mm]"""
    heights: Floats
    """z [mm], ascending"""
    low: Floats
    """least radius [mm]; NaN: there is no section"""
    high: Floats
    """largest radius [mm]"""
    counts: Ints
    """regular teeth or corners; 0: round, uneven, or beside the axis"""
    missing: Ints
    """teeth that are not there where all others stand regularly"""

    @property
    def depth(self) -> Floats:
        """From least to largest radius [mm]."""
        return self.high - self.low

    @property
    def wild(self) -> np.ndarray:
        """Where the outline is neither round nor regular."""
        return (self.counts == 0) & (self.depth >= ROUND * self.high)


def survey(solid: Solid, bottom: float, top: float, planes: int) -> Survey:
    """Look at sections in the middles of as many slices between two heights [mm]."""
    heights = bottom + (top - bottom) * (np.arange(planes) + 0.5) / planes
    half = planes // 2
    above = Beside(lambda: _rows(solid, heights[half:]))
    rows = (_rows(solid, heights[:half]) if half else []) + above.result()
    low, high, counts, missing = (np.concatenate(column) for column in zip(*rows, strict=True))
    return Survey(bottom=bottom, top=top, heights=heights, low=low, high=high, counts=counts, missing=missing)


def _rows(solid: Solid, heights: Floats) -> list[tuple[Floats, Floats, Ints, Ints]]:
    """Look at sections at heights (k,): least and largest radii, teeth, and teeth that are missing."""
    rows = []
    for part in plane_segments_in_parts(solid, heights):
        outer = outer_outlines(part)
        low, high = radial_limits(outer)
        counts, missing = _counts(outer, (low + high) / 2)
        rows.append((low, high, np.where(high - low < ROUND * high, 0, counts), missing))
    return rows


def longest_run(counts: Ints, wanted: int | None = None) -> tuple[int, int]:
    """Return first and last index of the longest run of one count above zero, of `wanted` if there is one.

    Without any count above zero, of zeros.
    """
    runs = runs_of(counts)
    toothed = [run for run in runs if counts[run[0]] > 0] or runs
    named = [run for run in toothed if counts[run[0]] == wanted and run[1] > run[0]]
    return max(named or toothed, key=lambda run: (run[1] - run[0], run[0]))


def runs_of(values: np.ndarray) -> list[tuple[int, int]]:
    """Return first and last index of every run of equal values."""
    edges = np.flatnonzero(np.diff(values, prepend=values[0] - 1, append=values[-1] - 1))
    return [(int(first), int(last) - 1) for first, last in pairwise(edges)]


def _counts(sections: Segments, middles: Floats) -> tuple[Ints, Ints]:
    """Count regular teeth in every plane on its own circle, and those missing among them."""
    crossings = circle_crossings(sections.scaled(1 / middles), np.ones(1))
    flanks = np.maximum(np.bincount(crossings.plane, minlength=len(middles)), 2)
    crossings = unfolded(crossings, NICK * 4 * math.pi / flanks[crossings.plane])
    around = turns_about_axis(sections) > 0.5
    counts, missing = np.zeros((2, len(middles)), dtype=np.int64)
    for plane in np.flatnonzero(around):
        rising = crossings.angle[(crossings.plane == plane) & ~crossings.left]  # sorted
        if len(rising) >= 2:
            steps = np.diff(rising, append=rising[0] + 2 * math.pi)
            pitches = np.maximum(np.round(steps / np.median(steps)), 1)
            pitch = 2 * math.pi / pitches.sum()
            even = (np.abs(steps - pitch * pitches) < UNEVEN * pitch).all()
            if even and (pitches == 1).all():
                counts[plane] = len(rising)
            elif even and len(rising) >= FEWEST_WITH_GAPS:
                missing[plane] = int(pitches.sum()) - len(rising)
    return counts, missing
