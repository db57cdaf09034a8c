"""The stock as a brush of rays from the work axis outwards, each as long as the metal that stands on it."""

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
RAYS = 60_000
"""that a count has at most where the job names no resolution; it may have ten times as many"""


@dataclass(slots=True)
class Stock:
    """What stands of the blank: rays at angles and heights of the part frame, angle by angle."""

    cos: Floats
    """(m,) of the angle"""
    sin: Floats
    z: Floats
    """(m,) [mm]"""
    end: Floats
    """(m,) how far the metal reaches from the axis [mm]"""
    inner: float
    """radius of the bore [mm]"""
    turn: float
    """angle between neighbours [rad]"""
    rise: float
    """height between neighbours [mm]"""
    step: float
    """distance of the rays on the blank's surface, as asked for [mm]"""

    @classmethod
    def of(cls, blank: Blank, cutters: Iterable[Cutter], resolution_mm: float | None = None) -> "Stock":
        """A whole blank; `resolution_mm` is the distance of the rays on its surface.

        Raises InputError for a resolution that would need too much memory or time.
        """
        step = _step(blank, cutters, resolution_mm)
        around = math.ceil(2.0 * math.pi * blank.radius / step)
        along = math.ceil(blank.length_mm / step)
        low, high = blank.z_range
        angle = 2.0 * math.pi * (np.arange(around) + 0.5) / around
        z = low + (high - low) * (np.arange(along) + 0.5) / along
        turned, height = (grid.reshape(-1) for grid in np.meshgrid(angle, z, indexing="ij"))
        return cls(
            cos=np.cos(turned),
            sin=np.sin(turned),
            z=height,
            end=blank.outer_radius(height),
            inner=blank.bore_mm / 2.0,
            turn=2.0 * math.pi / around,
            rise=(high - low) / along,
            step=step,
        )

    def copy(self) -> "Stock":
        """The same metal once more, to be cut by itself."""
        return replace(self, end=self.end.copy())

    def points(self, ray: Ints, radius: Floats) -> Floats:
        """(n, 3) at some radii of rays (n,)."""
        return np.column_stack([radius * self.cos[ray], radius * self.sin[ray], self.z[ray]])


def _step(blank: Blank, cutters: Iterable[Cutter], wanted: float | None) -> float:
    """The resolution asked for, or an 18th of the tooth pitch or of the edge's width [mm]."""
    finest = math.sqrt(2.0 * math.pi * blank.radius * blank.length_mm / RAYS)
    if wanted is None:
        wide = [min(c.profile.pitch, 2.0 * c.profile.half_width) for c in cutters]
        return max(min([blank.radius, *wide]) / RAYS_PER_PITCH, finest)
    least = finest / math.sqrt(10.0)
    if wanted < least:
        raise InputError(
            f"loads on rays {wanted:g} mm apart would need more memory than allowed",
            remedy=f"valid: {math.ceil(least * 1e3) / 1e3:g} or more",
        )
    return wanted
