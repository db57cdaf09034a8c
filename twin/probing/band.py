"""What a stylus may meet on a clamped blank: reference bands, and what is none."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Form:
    """How a band is out of round: a wave about its radius, counted in the part's own frame."""

    range_mm: float = 0.0
    """highest less lowest place"""
    lobes: int = 2
    """waves about the turn"""
    phase: float = 0.0
    """of a crest, from the part's +X [rad]"""

    def at(self, angle: float) -> float:
        """What the radius has more at an angle [mm, rad]."""
        return 0.5 * self.range_mm * math.cos(self.lobes * (angle - self.phase))


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """A cylinder about the part's axis."""

    radius: float
    """[mm]"""
    low: float
    """[mm] in the part frame"""
    high: float
    band: bool
    """a reference, round about the part's own axis; else teeth or a cone, which no probe may touch"""


def steps_of(blank: Blank) -> tuple[Step, ...]:
    """The steps of a blank along its axis: cylinders without gaps are bands."""
    root = math.inf if blank.section is None else float(np.hypot(*blank.section.outline.T).min())
    found = []
    for (z0, r0), (z1, r1) in pairwise(blank.steps().tolist()):
        if z0 == z1:
            continue
        band = r0 == r1 and r0 <= root
        found.append(Step(radius=max(r0, r1), low=z1, high=z0, band=band))
    return tuple(found)
