"""What each gap of an eccentrically clamped gear needs: the patent's triangle, and the plain form of it.

Angles in the frame of the work spindle at C0, counter-clockwise from +X, where the tool stands. O is the work
spindle's axis, O1 the gear's, at e and φ; A is where a gap's line of symmetry, at ψ from O1, meets the root
circle. All functions take arrays or floats.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.probing.circle import Circle
from twin.probing.errors import ProbingError

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class GapCorrection:
    """For every gap; each (n,)."""

    c: Floats
    """C to turn to [rad]"""
    x: Floats
    """to add to the tool's distance from the work axis [mm]"""
    y: Floats
    """[mm]"""
    alpha: Floats
    """O1 O A, signed as φ − arg A [rad]"""
    beta: Floats
    """O A O1, signed with α [rad]"""


def plain_correction(circle: Circle, gap: Floats) -> GapCorrection:
    """The gap's line turned parallel to X, the tool moved onto it.

    `gap` (n,): ψ [rad]. Then O1 stands at φ − ψ from the tool's side: Y = e sin(φ − ψ), X += e cos(φ − ψ).
    α and β are 0 here: this form does not need them.
    """
    e, turned = circle.eccentricity, circle.phase - gap
    none = np.zeros_like(turned)
    return GapCorrection(c=-gap, x=e * np.cos(turned), y=e * np.sin(turned), alpha=none, beta=none)


def patent_correction(circle: Circle, gap: Floats, root_radius: float) -> GapCorrection:
    """The patent's way: A onto X, then β = arcsin(e sin α / r_f) further, then Y and X by the turned e.

    Raises ProbingError where e is not below r_f: then the triangle has no such β.
    """
    require_inside(circle, root_radius)
    e = circle.eccentricity
    along = circle.x + root_radius * np.cos(gap), circle.y + root_radius * np.sin(gap)
    towards = np.arctan2(along[1], along[0])
    alpha = _wrapped(circle.phase - towards)
    beta = np.arcsin(e * np.sin(alpha) / root_radius)
    return GapCorrection(
        c=_wrapped(beta - towards + gap) - gap,
        x=e * np.cos(alpha + beta),
        y=e * np.sin(alpha + beta),
        alpha=alpha,
        beta=beta,
    )


def turned_correction(circle: Circle, gap: Floats, radius: float) -> GapCorrection:
    """Without a Y axis: the gap's point on `radius` [mm] turned onto X, and X set to its distance.

    Pitch and runout are right there; the gap's line stays off X by β, which is the slope that remains.
    Raises ProbingError where e is not below the radius.
    """
    require_inside(circle, radius)
    along = circle.x + radius * np.cos(gap), circle.y + radius * np.sin(gap)
    towards = np.arctan2(along[1], along[0])
    alpha = _wrapped(circle.phase - towards)
    beta = np.arcsin(circle.eccentricity * np.sin(alpha) / radius)
    return GapCorrection(
        c=_wrapped(gap - towards) - gap,
        x=np.hypot(*along) - radius,
        y=np.zeros_like(beta),
        alpha=alpha,
        beta=beta,
    )


def require_inside(circle: Circle, radius: float) -> None:
    """Raise ProbingError unless e lies below `radius` [mm]."""
    if not circle.eccentricity < radius:
        raise ProbingError(
            f"the eccentricity measured is {circle.eccentricity:.4g} mm, "
            f"the root circle's radius {radius:.4g} mm",
            remedy="e below r_f: clamp the work anew, probe its band",
        )


def _wrapped(angle: Floats) -> Floats:
    """Angles within ±π of 0."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi
