"""Where the band's centre stands, how surely, and whether the measurement may be compensated."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.probing.circle import Circle, centre_covariance, geometric_circle, patent_circle
from twin.probing.errors import ProbingError

Floats = NDArray[np.float64]

COVERAGE = math.sqrt(-2.0 * math.log(0.05))
"""Standard deviations of a centre within which it lies with 95 % (Rayleigh), 2.448."""
ROUND_SHARE = 0.25
"""Of e that the band may be out of round (eccentricity.md, end)."""
ROUND_MM = 0.02
"""[mm] that it may be in any case"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Centre:
    """The measured clamping eccentricity, by both fits."""

    points: Floats
    """(n, 2) touched points in the part's frame [mm]"""
    patent: Circle
    """by the patent's formulas"""
    geometric: Circle
    """by least distances: the one that is compensated"""
    out_of_round_mm: float
    """range of the distances from the geometric circle"""
    covariance: Floats
    """(2, 2) of its centre [mm²]"""

    @property
    def uncertainty_mm(self) -> float:
        """Radius about the centre in which the true one lies with 95 % [mm]."""
        return COVERAGE * math.sqrt(float(np.linalg.eigvalsh(self.covariance)[-1]))


def find_centre(points: Floats, *, repeatability_mm: float = 0.0) -> Centre:
    """Fit both circles to touched points (n, 2) [mm].

    The scatter of a touch is what the probe states, `repeatability_mm` (one standard deviation), and what the
    band's form leaves about the circle, n − 3 being free, both in square. Raises ProbingError for points that
    make no circle, and for a band out of round by more than a quarter of e or 0.02 mm, whichever is larger.
    """
    patent, geometric = patent_circle(points), geometric_circle(points)
    residuals = geometric.residuals(points)
    free = len(points) - 3
    form = math.sqrt(float((residuals**2).sum()) / free) if free else 0.0
    found = Centre(
        points=points,
        patent=patent,
        geometric=geometric,
        out_of_round_mm=geometric.out_of_round(points),
        covariance=centre_covariance(geometric, points, math.hypot(form, repeatability_mm)),
    )
    allowed = max(ROUND_SHARE * geometric.eccentricity, ROUND_MM)
    if found.out_of_round_mm > allowed:
        raise ProbingError(
            f"the band is out of round by {found.out_of_round_mm * 1e3:.1f} µm, "
            f"its eccentricity is {geometric.eccentricity * 1e3:.1f} µm",
            remedy=f"at most {allowed * 1e3:.1f} µm: clean the band, or choose another",
        )
    return found
