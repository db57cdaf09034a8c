"""The stock as a brush of rays from the work axis outwards, each as long as the metal that stands on it.

Rays may be inclined in their planes through the axis, r = z − z₀ or z₀ − z (`slope` ±1): then an edge that
is fed along the axis meets them one by one, as one that comes from outside does, and not row by row.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

RAYS_PER_PITCH = 18.0
"""or on the width of an edge, where the job names no resolution"""
INCLINED_PER_PITCH = 14.0
"""the same of inclined rays, which the edges meet one by one"""
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
"""by which rows of rays stand aside of one another: no few of them repeat"""
RAYS = 60_000
"""that a count has at most where the job names no resolution; it may have ten times as many"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lean:
    """Which way rays are inclined: the same everywhere, or off a height to either side of it."""

    slope: float = 0.0
    """rise along z per radius"""
    split: float | None = None
    """height [mm] below which they rise by 1, and above which by −1, each up to it; None = none"""

    def parts(self, low: float, high: float) -> list[tuple[float, float, float]]:
        """(lowest, highest, slope) of a blank between two heights [mm]."""
        if self.split is None:
            return [(low, high, self.slope)]
        return [(low, self.split, 1.0), (self.split, high, -1.0)]

    @property
    def inclined(self) -> bool:
        """Whether any of them are."""
        return self.split is not None or self.slope != 0.0


@dataclass(slots=True)
class Stock:
    """What stands of the blank: rays at angles and heights of the part frame, angle by angle.

    A line that leaves the blank and enters it again is two rays.
    """

    cos: Floats
    """(m,) of the angle"""
    sin: Floats
    z: Floats
    """(m,) where the ray's line meets the work axis [mm]"""
    slope: Floats
    """(m,) by which it rises along z per radius"""
    inner: Floats
    """(m,) radius at which the metal begins [mm]"""
    end: Floats
    """(m,) how far it reaches from the axis [mm]"""
    farthest: float
    """that any metal of the blank stands from the origin [mm]"""
    turn: float
    """angle between neighbours [rad]"""
    rise: Floats
    """(m,) height between neighbours [mm]"""
    step: float
    """distance of the rays on the blank's surface, as asked for [mm]"""

    @classmethod
    def of(
        cls,
        blank: Blank,
        cutters: Iterable[Cutter],
        resolution_mm: float | None = None,
        *,
        lean: Lean | None = None,
    ) -> "Stock":
        """A whole blank; `resolution_mm` is the distance of the rays on its surface, straight unless they
        `lean`.

        Raises InputError for a resolution that would need too much memory or time.
        """
        lean = lean or Lean()
        parts = [
            (low, high, low - max(slope, 0.0) * blank.radius, high + max(-slope, 0.0) * blank.radius, slope)
            for low, high, slope in lean.parts(*blank.z_range)
        ]
        height = sum(highest - lowest for _, _, lowest, highest, _ in parts)
        per_pitch = INCLINED_PER_PITCH if lean.inclined else RAYS_PER_PITCH
        step = _step(blank, height, cutters, per_pitch, resolution_mm)
        around = math.ceil(2.0 * math.pi * blank.radius / step)
        rows: list[tuple[Floats, Floats, Floats, Floats, Floats]] = []
        for low, high, lowest, highest, slope in parts:
            along = math.ceil((highest - lowest) / step)
            rise = (highest - lowest) / along
            lines = np.asarray(lowest + rise * (np.arange(along) + 0.5), dtype=np.float64)
            found = _stretches(_between(blank.outline(), low, high), lines, slope)
            rows.append((*found, np.full(len(found[0]), slope), np.full(len(found[0]), rise)))
        z, inner, end, slopes, rises = (np.concatenate(column) for column in zip(*rows, strict=True))
        # each row a little further about the axis: else all gaps of a gear may be seen at the same few places
        aside = GOLDEN * np.arange(len(z)) % 1.0
        angle = 2.0 * math.pi * (np.arange(around)[:, None] + aside).reshape(-1) / around
        return cls(
            cos=np.cos(angle),
            sin=np.sin(angle),
            z=np.tile(z, around),
            slope=np.tile(slopes, around),
            inner=np.tile(inner, around),
            end=np.tile(end, around),
            farthest=math.hypot(blank.radius, blank.length_mm),
            turn=2.0 * math.pi / around,
            rise=np.tile(rises, around),
            step=step,
        )

    def copy(self) -> "Stock":
        """The same metal once more, to be cut by itself."""
        return replace(self, end=self.end.copy())

    def points(self, ray: Ints, radius: Floats) -> Floats:
        """(n, 3) at some radii of rays (n,)."""
        return np.column_stack(
            [radius * self.cos[ray], radius * self.sin[ray], self.z[ray] + self.slope[ray] * radius]
        )


def _stretches(outline: Floats, z: Floats, slope: float) -> tuple[Floats, Floats, Floats]:
    """(m,) lines, first and last radius of metal, on lines from z (k,) of the axis on, line by line: where
    they cross a closed `outline` (n, 2) of (r, z)."""
    begin, end = outline, np.roll(outline, -1, axis=0)
    above = begin[:, 1] - slope * begin[:, 0] > z[:, None]
    crossed = above != (end[:, 1] - slope * end[:, 0] > z[:, None])
    line, edge = np.nonzero(crossed)
    rise = end[edge] - begin[edge]
    share = (z[line] + slope * begin[edge, 0] - begin[edge, 1]) / (rise[:, 1] - slope * rise[:, 0])
    radius = begin[edge, 0] + share * rise[:, 0]
    order = np.lexsort((radius, line))
    pairs = radius[order].reshape(-1, 2)
    return z[line[order][::2]], pairs[:, 0], pairs[:, 1]


def _between(outline: Floats, low: float, high: float) -> Floats:
    """(k, 2) what of a closed outline (n, 2) of (r, z) lies between two heights, closed along them."""
    for height, keep in ((low, 1.0), (high, -1.0)):
        over = keep * (outline[:, 1] - height)
        points: list[Floats] = []
        for k in range(len(outline)):
            begin, end = float(over[k - 1]), float(over[k])
            if begin * end < 0.0:
                points.append(outline[k - 1] + begin / (begin - end) * (outline[k] - outline[k - 1]))
            if end >= 0.0:
                points.append(outline[k])
        outline = np.array(points)
    return outline


def _step(
    blank: Blank, height: float, cutters: Iterable[Cutter], per_pitch: float, wanted: float | None
) -> float:
    """The resolution asked for, or a share of the tooth pitch or of the edge's width [mm]."""
    finest = math.sqrt(2.0 * math.pi * blank.radius * height / RAYS)
    if wanted is None:
        wide = [min(c.profile.pitch, 2.0 * c.profile.half_width) for c in cutters]
        return max(min([blank.radius, *wide]) / per_pitch, finest)
    least = finest / math.sqrt(10.0)
    if wanted < least:
        raise InputError(
            f"loads on rays {wanted:g} mm apart would need more memory than allowed",
            remedy=f"valid: {math.ceil(least * 1e3) / 1e3:g} or more",
        )
    return wanted
