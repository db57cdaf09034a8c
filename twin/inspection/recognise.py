"""What stands about the axis: teeth, flats or nothing, how many, over which width, and how they twist.

Nothing is told beforehand: sections at many heights are crossed with a circle at half the depth of their
outline, which gives the number of teeth or corners; their phase along z gives the twist.
"""

import math
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from twin.inspection.sections import (
    FOLD,
    Crossings,
    Segments,
    circle_crossings,
    outer_outlines,
    plane_segments,
    plane_segments_in_parts,
    radial_limits,
    turns_about_axis,
    unfolded,
)
from twin.inspection.solid import Floats, Ints, Solid

Complexes = NDArray[np.complex128]

PLANES = 48
"""sections taken over the length of the part"""
FEWEST_PLANES = 12
MOST_CROSSINGS = 1e6
"""fewer sections are taken of parts whose faces run all along them, so that this many are crossed"""
FEWEST = 5
"""sections in a row that must be alike"""
MOST_SIDES = 24
"""with more corners than this an outline is round, not a polygon"""
NICK = 0.05
"""crossings closer together than this part of a pitch belong to one tooth when teeth are counted"""
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
    length = float(np.ptp(z))
    crossed = float((solid.face_high - solid.face_low).sum()) / length
    planes = int(np.clip(MOST_CROSSINGS / crossed, FEWEST_PLANES, PLANES))
    heights = _midpoints(float(z.min()), float(z.max()), planes)
    low, high, counts = _survey(solid, heights)
    if not np.isfinite(low).all():
        return Outline(
            form=Form.NEITHER,
            reason="the solid has no section at some heights: it is not one body along the z axis",
        )
    depth = high - low
    if (depth < ROUND * high).all():
        return _round(low, high)
    counts[depth < ROUND * high] = 0
    first, last = _longest_run(counts)
    if counts[first] == 0 or last - first + 1 < FEWEST:
        return _neither(
            f"no regular teeth or flats: the outline wanders between diameters {2 * low.min():.2f} "
            f"and {2 * high.max():.2f} mm in uneven steps",
            low,
            high,
        )
    full = _full_depth(low, depth, first, last)
    if len(full) < FEWEST:
        return _neither("no regular teeth or flats: the outline changes all along the axis", low, high)
    form = _form(int(counts[first]), float(np.median(low[full])), float(np.median(high[full])))
    if form is Form.NEITHER:
        return _round(low[full], high[full])
    at_start, at_end = full[0] == 0, full[-1] == planes - 1
    below, above = float(heights[full[0]]), float(heights[full[-1]])
    z_low = float(z.min()) if at_start else below
    z_high = float(z.max()) if at_end else above
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


def _round(low: Floats, high: Floats) -> Outline:
    reason = f"a round part of diameter {2 * np.median(high):.3f} mm: no teeth and no flats"
    return _neither(reason, low, high)


def _neither(reason: str, low: Floats, high: Floats) -> Outline:
    return Outline(
        form=Form.NEITHER, reason=reason, root_radius=float(low.min()), tip_radius=float(high.max())
    )


def _midpoints(low: float, high: float, count: int) -> Floats:
    return low + (high - low) * (np.arange(count) + 0.5) / count


def _survey(solid: Solid, heights: Floats) -> tuple[Floats, Floats, Ints]:
    """Return the outer outline's least and largest radius and its number of teeth, (k,) each."""
    rows = []
    for part in plane_segments_in_parts(solid, heights):
        outer = outer_outlines(part)
        low, high = radial_limits(outer)
        rows.append((low, high, _counts(outer, (low + high) / 2)))
    low, high, counts = (np.concatenate(column) for column in zip(*rows, strict=True))
    return low, high, counts


def _counts(sections: Segments, middles: Floats) -> Ints:
    """Count regular teeth in every plane on its own circle; 0 where steps are uneven or the axis outside."""
    crossings = circle_crossings(sections.scaled(1 / middles), np.ones(1))
    flanks = np.maximum(np.bincount(crossings.plane, minlength=len(middles)), 2)
    crossings = unfolded(crossings, NICK * 4 * math.pi / flanks[crossings.plane])
    around = turns_about_axis(sections) > 0.5
    counts = np.zeros(len(middles), dtype=np.int64)
    for plane in np.flatnonzero(around):
        rising = crossings.angle[(crossings.plane == plane) & ~crossings.left]  # sorted
        if len(rising) >= 2:
            pitch = 2 * math.pi / len(rising)
            steps = np.diff(rising, append=rising[0] + 2 * math.pi)
            if np.abs(steps - pitch).max() < 0.25 * pitch:
                counts[plane] = len(rising)
    return counts


def phase_sums(crossings: Crossings, count: int, place: Ints, places: int) -> tuple[Complexes, Complexes]:
    """Sum exp(i count angle) of the left and the right flanks that fall on each place (n,) of `places`.

    The argument, divided by count, is the mean angle of the flanks within their pitch.
    """
    turn = np.exp(1j * count * crossings.angle)
    sums = np.zeros((2, places), dtype=np.complex128)
    np.add.at(sums, ((~crossings.left).astype(np.int64), place), turn)
    return sums[0], sums[1]


def _longest_run(counts: np.ndarray) -> tuple[int, int]:
    """Return first and last index of the longest run of one count above zero."""
    edges = np.flatnonzero(np.diff(counts, prepend=-1, append=-1))
    runs = [(last - first, first, last - 1) for first, last in pairwise(edges)]
    toothed = [run for run in runs if counts[run[1]] > 0] or runs
    _, first, last = max(toothed)
    return int(first), int(last)


def _full_depth(low: Floats, depth: Floats, first: int, last: int) -> Ints:
    """Return the indices of the longest stretch that is cut to full depth."""
    run = np.arange(first, last + 1)
    deepest = np.quantile(low[run], 0.1)
    run = _stretch(run, low[run] <= deepest + max(0.015 * float(depth[run].max()), 0.02))
    # where a cut ends inside the part the tool's circle runs out: keep to what the middle half is like
    quarter = len(run) // 4
    usual = low[run[quarter : len(run) - quarter]].max() + 0.001
    alike = low[run] <= usual
    if run[0] == 0:
        alike[:quarter] = True
    if run[-1] == len(low) - 1:
        alike[len(run) - quarter :] = True
    return _stretch(run, alike)


def _stretch(run: Ints, chosen: np.ndarray) -> Ints:
    """Return the longest stretch of a run whose members are chosen."""
    start, end = _longest_run(chosen.astype(np.int64))
    return run[start : end + 1]


def _form(count: int, root: float, tip: float) -> Form:
    """Tell flats from gaps by how far the outline dips below the chord from corner to corner."""
    half = math.pi / count
    dip = (tip * math.cos(half) - root) / (2 * tip * math.sin(half))
    if dip >= 0.15:
        return Form.GEAR
    return Form.POLYGON if count <= MOST_SIDES else Form.NEITHER


def _twist(solid: Solid, count: int, low: float, high: float, radius: float) -> tuple[float, float]:
    """Return twist [rad/mm] and a tooth centre's phase [rad] at mid-height, from sections close together."""
    pitch = 2 * math.pi * radius / count
    # below 45° a quarter pitch of height turns the teeth by less than half a pitch: no ambiguity
    planes = int(np.clip(math.ceil(4 * (high - low) / pitch), 33, 2000))
    heights = _midpoints(low, high, planes)
    segments = plane_segments(solid, heights, radius=radius)
    crossings = unfolded(circle_crossings(segments, np.array([radius])), FOLD * 2 * math.pi / count)
    left, right = phase_sums(crossings, count, crossings.plane, planes)
    # half way from each right flank on to the left flank of the same tooth
    thickness = np.mod(np.angle(left * right.conj()), 2 * math.pi)
    centre = np.unwrap(np.angle(right) + thickness / 2) / count
    slope, offset = np.polyfit(heights - (low + high) / 2, centre, 1)
    return float(slope), float(offset)
