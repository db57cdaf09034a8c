"""`[faults]` of a job: what is wrong, in the terms of whoever measures it."""

from dataclasses import dataclass
from typing import Annotated

from msgspec import Meta

NotNegative = Annotated[float, Meta(ge=0)]
Tilt = Annotated[float, Meta(gt=-10, lt=10)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Faults:
    """`[faults]`: all zero on a machine without fault.

    Phases of the work count from the part's +X, which points to the tool at C0, counter-clockwise seen
    from +Z.
    """

    work_eccentricity_mm: NotNegative = 0.0
    """the blank's own axis off the work spindle's, in the middle of the blank's length"""
    work_eccentricity_phase_deg: float = 0.0
    """where the blank's axis stands from the spindle's"""
    work_tilt_deg: Tilt = 0.0
    """the blank's own axis against the work spindle's; both meet in the middle of the blank's length"""
    work_tilt_phase_deg: float = 0.0
    """to which side the blank's front end leans"""
