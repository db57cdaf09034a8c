"""What stands about the axis: teeth, flats or nothing, how many, over which width, and how they twist.

Nothing is told beforehand: sections at many heights are crossed with a circle at half the depth of their
outline, which gives the number of teeth or corners; their phase along z gives the twist.
"""

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from twin.inspection.ends import end_of_depth
from twin.inspection.solid import Floats, Ints, Solid
from twin.inspection.survey import ROUND, Survey, longest_run, runs_of, survey
from twin.inspection.turning import turning

PLANES = 48
"""sections taken over the length of the part"""
FEWEST_PLANES = 24
MOST_CROSSINGS = 2.5e5
"""fewer sections are taken of parts whose faces run all along them, so that this many are crossed"""
FEWEST = 5
"""sections in a row that must be alike"""
MOST_SIDES = 24
"""with more corners than this an outline is round, not a polygon"""
LOOKS = 3
"""times a short toothed stretch is looked at more closely"""


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
    others: tuple[tuple[int, float, float], ...] = ()
    """teeth or corners, z from and z to of other stretches"""

    @property
    def middle(self) -> float:
        """z half way [mm]."""
        return (self.low + self.high) / 2

    @property
    def depth(self) -> float:
        """From root to tip [mm]."""
        return self.tip_radius - self.root_radius


def recognise(solid: Solid, *, wanted: int | None = None) -> Outline:
    """Find teeth or flats about the z axis.

    Of several toothed stretches the longest is taken, or that with as many teeth or sides as `wanted`.
    """
    z = solid.vertices[:, 2]
    bottom, top = float(z.min()), float(z.max())
    seen = _look(solid, bottom, top)
    if not np.isfinite(seen.low).all():
        return Outline(
            form=Form.NEITHER,
            reason="the solid has no section at some heights: it is not one body along the z axis",
        )
    if (seen.depth < ROUND * seen.high).all():
        return _round(seen.low, seen.high)
    others: tuple[tuple[int, float, float], ...] = ()
    for _ in range(LOOKS):
        first, last = longest_run(seen.counts, wanted)
        others = others or _others(seen, (first, last))
        closer = _closer(seen, first, last)
        if closer is None:
            break
        seen = _look(solid, *closer)
    return _outline(solid, seen, longest_run(seen.counts, wanted), others)


def _outline(
    solid: Solid, seen: Survey, run: tuple[int, int], others: tuple[tuple[int, float, float], ...]
) -> Outline:
    """Tell what the sections of a run show."""
    first, last = run
    if seen.counts[first] == 0 or last - first + 1 < FEWEST:
        return _neither(_uneven(seen), seen.low, seen.high)
    full = _full_depth(seen.low, seen.depth, first, last)
    if len(full) < FEWEST:
        return _neither(
            "no regular teeth or flats: the outline changes all along the axis", seen.low, seen.high
        )
    count = int(seen.counts[first])
    low, high = seen.low[full], seen.high[full]
    form = _form(count, float(np.median(low)), float(np.median(high)))
    if form is Form.NEITHER:
        return _round(low, high)
    (z_low, done_low), (z_high, done_high) = (end_of_depth(solid, seen, full, end) for end in (0, -1))
    root, tip = float(low.min()), float(high.max())
    turns = turning(solid, count, z_low, z_high, (root + tip) / 2)
    if turns.back_at is not None:
        return _neither(
            f"{count} teeth turn one way up to z = {round(turns.back_at, 1) + 0.0:g} mm and the other way "
            "from there on: a double helix, or two gears; one helix is measured at a time",
            seen.low,
            seen.high,
        )
    return Outline(
        form=form,
        count=count,
        low=z_low,
        high=z_high,
        whole=done_low and done_high,
        root_radius=root,
        tip_radius=tip,
        twist=turns.twist,
        phase=turns.phase,
        others=others,
    )


def _look(solid: Solid, bottom: float, top: float) -> Survey:
    """Survey a solid between two heights."""
    crossed = float((solid.face_high - solid.face_low).sum()) / float(np.ptp(solid.vertices[:, 2]))
    planes = int(np.clip(MOST_CROSSINGS / crossed, FEWEST_PLANES, PLANES))
    return survey(solid, bottom, top, planes)


def _closer(seen: Survey, first: int, last: int) -> tuple[float, float] | None:
    """Return the heights between which to look again: teeth that are a small part of what was looked at."""
    many = len(seen.heights)
    if seen.counts[first] == 0 or 2 * (last - first + 1) >= many:
        return None
    beside = [k for k in (first - 1, last + 1) if 0 <= k < many]
    if seen.wild[beside].any():
        return None
    return (
        float(seen.heights[first - 1]) if first > 0 else seen.bottom,
        float(seen.heights[last + 1]) if last < many - 1 else seen.top,
    )


def _others(seen: Survey, run: tuple[int, int]) -> tuple[tuple[int, float, float], ...]:
    """Return count, z from and z to of the other stretches of regular teeth or flats."""
    runs = [other for other in runs_of(seen.counts) if other != run and other[1] - other[0] + 1 >= FEWEST]
    return tuple(
        (int(seen.counts[a]), float(seen.heights[a]), float(seen.heights[b]))
        for a, b in runs
        if seen.counts[a] > 0
    )


def _uneven(seen: Survey) -> str:
    """Say why there are no regular teeth."""
    gaps = np.flatnonzero(seen.missing)
    if 2 * len(gaps) > len(seen.heights):
        missing = int(np.median(seen.missing[gaps]))
        return (
            f"the teeth stand about the axis in regular steps but for {missing} "
            f"{'that is' if missing == 1 else 'that are'} missing"
        )
    return (
        f"no regular teeth or flats: the outline wanders between diameters {2 * seen.low.min():.2f} "
        f"and {2 * seen.high.max():.2f} mm in uneven steps"
    )


def _round(low: Floats, high: Floats) -> Outline:
    reason = f"a round part of diameter {2 * np.median(high):.3f} mm: no teeth and no flats"
    return _neither(reason, low, high)


def _neither(reason: str, low: Floats, high: Floats) -> Outline:
    return Outline(
        form=Form.NEITHER, reason=reason, root_radius=float(low.min()), tip_radius=float(high.max())
    )


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
    start, end = longest_run(chosen.astype(np.int64))
    return run[start : end + 1]


def _form(count: int, root: float, tip: float) -> Form:
    """Tell flats from gaps by how far the outline dips below the chord from corner to corner."""
    half = math.pi / count
    dip = (tip * math.cos(half) - root) / (2 * tip * math.sin(half))
    if dip >= 0.15:
        return Form.GEAR
    return Form.POLYGON if count <= MOST_SIDES else Form.NEITHER
