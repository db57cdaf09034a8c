"""What stands about the axis: teeth, flats or nothing, how many, over which width, and how they twist.

Nothing is told beforehand: sections at many heights are crossed with a circle at half the depth of their
outline, which gives the number of teeth or corners; their phase along z gives the twist.
"""

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from twin.inspection.sections import (
    Segments,
    circle_crossings,
    faces_at_radius,
    outer_outlines,
    plane_segments,
    radial_limits,
)
from twin.inspection.solid import Floats, Solid

PLANES = 64
"""sections taken over the length of the part"""
MOST_SIDES = 24
"""with more corners than this an outline is round, not a polygon"""
ROUND = 1e-3
"""an outline of less relative depth is round: the chords of a faceted circle"""


class Form(Enum):
    """What the outline of a section is."""

    GEAR = "gear"
    POLYGON = "polygon"
    NEITHER = "neither"


@dataclass(frozen=True, slots=True, kw_only=True)
class Outline:
    """The regular part of the solid, or why there is none. Lengths in mm, angles in radians."""

    form: Form
    reason: str = ""
    """why the form is neither"""
    count: int = 0
    """teeth, or corners of a polygon"""
    low: float = 0.0
    """z where the full depth begins"""
    high: float = 0.0
    """z where it ends"""
    whole: bool = False
    """it reaches both ends of the material"""
    root_radius: float = 0.0
    """smallest radius of the outline"""
    tip_radius: float = 0.0
    """largest radius of the outline"""
    twist: float = 0.0
    """rotation along z [rad/mm], + right-hand"""
    phase: float = 0.0
    """angle of one tooth's centre, or of one corner, at `middle`"""

    @property
    def middle(self) -> float:
        """z half way [mm]."""
        return (self.low + self.high) / 2

    @property
    def depth(self) -> float:
        """From root to tip [mm]."""
        return self.tip_radius - self.root_radius


def recognise(solid: Solid) -> Outline:
    """Find teeth or flats about the z axis."""
    z = solid.vertices[:, 2]
    heights = _midpoints(float(z.min()), float(z.max()), PLANES)
    sections = outer_outlines(plane_segments(solid, heights))
    low, high = radial_limits(sections)
    if not np.isfinite(low).all():
        return _neither("the solid has no section at some heights: it is not one body along the z axis")
    depth = high - low
    if (depth < ROUND * high).all():
        return _round(high)
    counts = _counts(sections, (low + high) / 2)
    counts[depth < ROUND * high] = 0
    first, last = _longest_run(counts)
    if counts[first] == 0 or last - first + 1 < 5:
        return _neither("no regular teeth or flats: the outline crosses no circle in even steps")
    full = _full_depth(low, depth, first, last)
    form = _form(int(counts[first]), float(np.median(low[full])), float(np.median(high[full])))
    if form is Form.NEITHER:
        return _round(high[full])
    step = heights[1] - heights[0]
    at_start, at_end = full[0] == 0, full[-1] == PLANES - 1
    below, above = float(heights[full[0]]), float(heights[full[-1]])
    z_low = below - step / 2 if at_start else below
    z_high = above + step / 2 if at_end else above
    # beyond the last full section there may be nothing of the teeth's size: a shaft is no unfinished gear
    rim = np.median(low[full]) + 0.7 * np.median(depth[full])
    whole = (at_start or high[full[0] - 1] < rim) and (at_end or high[full[-1] + 1] < rim)
    root, tip = float(low[full].min()), float(high[full].max())
    twist, phase = _twist(solid, int(counts[first]), z_low, z_high, (root + tip) / 2)
    return Outline(
        form=form,
        count=int(counts[first]),
        low=z_low,
        high=z_high,
        whole=bool(whole),
        root_radius=root,
        tip_radius=tip,
        twist=twist,
        phase=phase,
    )


def _round(radius: Floats) -> Outline:
    return _neither(f"a round part of diameter {2 * np.median(radius):.3f} mm: no teeth and no flats")


def _neither(reason: str) -> Outline:
    return Outline(form=Form.NEITHER, reason=reason)


def _midpoints(low: float, high: float, count: int) -> Floats:
    return low + (high - low) * (np.arange(count) + 0.5) / count


def _counts(sections: Segments, middles: Floats) -> np.ndarray:
    """Count regular teeth in every plane on its own circle; 0 where the steps are uneven."""
    crossings = circle_crossings(sections.scaled(1 / middles), np.ones(1))
    counts = np.zeros(len(middles), dtype=np.int64)
    for plane in range(len(middles)):
        rising = np.sort(crossings.angle[(crossings.plane == plane) & ~crossings.left])
        if len(rising) >= 2:
            pitch = 2 * math.pi / len(rising)
            steps = np.diff(rising, append=rising[0] + 2 * math.pi)
            if np.abs(steps - pitch).max() < 0.25 * pitch:
                counts[plane] = len(rising)
    return counts


def _longest_run(counts: np.ndarray) -> tuple[int, int]:
    """Return first and last index of the longest run of one count above zero."""
    edges = np.flatnonzero(np.diff(counts, prepend=-1, append=-1))
    runs = [(last - first, first, last - 1) for first, last in zip(edges[:-1], edges[1:], strict=True)]
    toothed = [run for run in runs if counts[run[1]] > 0] or runs
    _, first, last = max(toothed)
    return int(first), int(last)


def _full_depth(low: Floats, depth: Floats, first: int, last: int) -> np.ndarray:
    """Return the indices of the longest stretch that is cut to full depth."""
    run = np.arange(first, last + 1)
    deepest = np.quantile(low[run], 0.1)
    allowed = deepest + max(0.015 * float(depth[run].max()), 0.02)
    full = (low[run] <= allowed).astype(np.int64)
    start, end = _longest_run(full)
    return run[start : end + 1]


def _form(count: int, root: float, tip: float) -> Form:
    """Tell flats from gaps by how far the outline dips below the chord from corner to corner."""
    half = math.pi / count
    dip = (tip * math.cos(half) - root) / (2 * tip * math.sin(half))
    if dip >= 0.15:
        return Form.GEAR
    return Form.POLYGON if count <= MOST_SIDES else Form.NEITHER


def _twist(solid: Solid, count: int, low: float, high: float, radius: float) -> tuple[float, float]:
    """Return twist [rad/mm] and the phase [rad] of a tooth's centre at mid-height from sections close together."""
    pitch = 2 * math.pi * radius / count
    # below 45° a quarter pitch of height turns the teeth by less than half a pitch: no ambiguity
    planes = int(np.clip(math.ceil(4 * (high - low) / pitch), 33, 2000))
    heights = _midpoints(low, high, planes)
    segments = plane_segments(solid, heights, faces=faces_at_radius(solid, radius))
    crossings = circle_crossings(segments, np.array([radius]))
    turn = np.exp(1j * count * crossings.angle)
    left, right = (
        np.bincount(crossings.plane[side], weights=turn[side].real, minlength=planes)
        + 1j * np.bincount(crossings.plane[side], weights=turn[side].imag, minlength=planes)
        for side in (crossings.left, ~crossings.left)
    )
    # half way from each right flank on to the left flank of the same tooth
    thickness = np.mod(np.angle(left * right.conj()), 2 * math.pi)
    centre = np.unwrap(np.angle(right) + thickness / 2) / count
    slope, offset = np.polyfit(heights - (low + high) / 2, centre, 1)
    return float(slope), float(offset)
