"""The face that polygon turning leaves: its curvature, its bow, the width across corners (geometry.md, 3).

In the work frame the edge of a cutter moves on w(θ) = A e^(−jθ) − R e^(j(i−1)θ), nearest to the work axis at
θ = 0, the middle of a face. A = S/2 + R is the centre distance, i = Q/P the ratio, signed.
"""

import cmath
import math
from dataclasses import dataclass

_HALVINGS = 80
"""of an angle below one turn: down to its last bit"""
_STEPS = 720
"""in which the first crossing of the corner's direction is looked for"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Face:
    """One face of the polygon, up to its corners."""

    bow: float
    """[mm] how far the middle stands out over the line through the corners, + convex"""
    across_corners: float
    """[mm]"""

    @property
    def concave(self) -> bool:
        """Whether the middle lies behind the corners."""
        return self.bow < 0.0


def sides_cut(inserts: int, ratio: float) -> float:
    """Sides that so many inserts cut at the ratio i = Q/P: inserts · |i|; no whole number is no polygon."""
    return inserts * abs(ratio)


def curvature(across_flats: float, radius: float, ratio: float) -> float:
    """Curvature [1/mm] in the middle of a face, + concave: ((i−1)² R − A) / (A + (i−1) R)²."""
    distance, relative = across_flats / 2.0 + radius, ratio - 1.0
    return (relative**2 * radius - distance) / (distance + relative * radius) ** 2


def face(*, across_flats: float, radius: float, ratio: float, sides: int) -> Face | None:
    """The face between two corners; None where the path of the cutter closes no corner.

    `across_flats` S and the tip `radius` R in mm, the `ratio` i = Q/P, the number of `sides` cut.
    """
    corner = _corner(across_flats / 2.0 + radius, radius, ratio, math.pi / sides)
    if corner is None:
        return None
    bow = across_flats / 2.0 - abs(corner) * math.cos(math.pi / sides)
    return Face(bow=bow, across_corners=2.0 * abs(corner))


def _corner(distance: float, radius: float, ratio: float, direction: float) -> complex | None:
    """Where the path first meets the ray at `direction` [rad] on either side of the face's middle."""

    def at(theta: float) -> complex:
        return distance * cmath.exp(-1j * theta) - radius * cmath.exp(1j * (ratio - 1.0) * theta)

    def beyond(theta: float) -> float:
        return abs(cmath.phase(at(theta))) - direction

    width = math.pi / _STEPS
    for k in range(_STEPS):
        low, high = k * width, (k + 1) * width
        if beyond(high) < 0.0:
            continue
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if beyond(middle) >= 0.0 else (middle, high)
        return at(high)
    return None
