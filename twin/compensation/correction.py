"""Where a straight program's places go for a gear whose axis stands off the work spindle's.

Both follow from where O1 stands once C has turned the work: at e∠(φ + C). With a Y axis the tool's path is
laid about O1 instead of O. Without, the place on X that a gap's pitch point comes to is turned back onto X.
"""

import math
from dataclasses import dataclass
from enum import Enum

from twin.probing.circle import Circle

SAG_MM = 0.05e-3
"""how far the path may stand off the arc of O1 between two blocks"""


class Way(Enum):
    """How a program is compensated."""

    ACROSS = "X and Y, gap by gap"
    TURNED = "C and X, gap by gap: no linear Y"
    TABLE = "C and X against the work angle, while hobbing"


@dataclass(frozen=True, slots=True, kw_only=True)
class Correction:
    """What to add to a place of the program."""

    x: float
    """tool's distance from the work axis [mm]"""
    y: float
    """[mm]"""
    c: float
    """[deg]"""
    slope: float
    """by which the gap's line stays off X [rad]"""


def corrected(circle: Circle, c_deg: float, *, radius: float, has_y: bool) -> Correction:
    """The correction at an angle of C; `radius` [mm] is where gaps are put right without a Y axis."""
    turned = circle.phase + math.radians(c_deg)
    along = circle.eccentricity * math.cos(turned)
    across = circle.eccentricity * math.sin(turned)
    if has_y:
        return Correction(x=along, y=across, c=0.0, slope=0.0)
    slope = math.atan2(across, radius + along)
    return Correction(
        x=math.hypot(radius + along, across) - radius, y=0.0, c=-math.degrees(slope), slope=-slope
    )


def widest_step(circle: Circle) -> float:
    """How far C may turn in one block [deg]."""
    if circle.eccentricity <= 2.0 * SAG_MM:
        return 90.0
    return min(2.0 * math.degrees(math.acos(1.0 - SAG_MM / circle.eccentricity)), 90.0)
