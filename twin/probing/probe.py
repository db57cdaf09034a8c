"""The touch probe of a machine, as a job's `[probe]` says it."""

from dataclasses import dataclass
from typing import Annotated

from msgspec import Meta

Positive = Annotated[float, Meta(gt=0, le=1e4)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Probe:
    """`[probe]`: a stylus that gives way along X, towards +X, in the place of the tool.

    With its T number called, X reads the diameter at the front of its ball, Z the ball's centre.
    """

    tool: Annotated[int, Meta(ge=1, le=99)] = 9
    """T number that swings it in"""
    program: str | None = None
    """the probing cycle that `hobtwin compensate` runs; a file beside the job"""
    reach_mm: Positive = 80.0
    """front of the ball from the tool centre, towards the work"""
    ball_radius_mm: Positive = 2.0
    stiffness_n_per_mm: Annotated[float, Meta(gt=0, le=100)] = 1.0
    """of the spring that holds the stylus"""
    trigger_force_n: Positive = 0.1
    """force of the spring at which the signal comes; the way there, F/k, is the pre-travel"""
    repeatability_um: Annotated[float, Meta(ge=0, le=100)] = 0.0
    """one standard deviation of the pre-travel, touch by touch"""
    latency_s: Annotated[float, Meta(ge=0, le=0.1)] = 0.0
    """from the touch to the latching of the axes"""
    overtravel_mm: Positive = 4.0
    """how far the stylus can be pushed back"""
    seed: Annotated[int, Meta(ge=0)] = 0
    """of the repeatability: the same seed, the same run"""

    @property
    def pretravel_mm(self) -> float:
        """How far the ball is pushed back when the signal comes [mm]."""
        return self.trigger_force_n / self.stiffness_n_per_mm
