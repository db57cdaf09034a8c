"""The tool's motion past the work, as the cutting kernel sees it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class RigidTransform:
    """`p -> rotation @ p + translation`."""

    rotation: Floats = field(default_factory=lambda: np.eye(3))
    """(3, 3)"""
    translation: Floats = field(default_factory=lambda: np.zeros(3))
    """(3,) [mm]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class CutterMotion:
    """One tool's motion in the non-turning work frame, linear in these values between two samples.

    The work frame has its origin on the work spindle's axis at the part's front face, Z along that axis
    away from the chuck, +X towards the tool; it coincides with the part frame at work angle 0.
    """

    time_s: Floats
    """(n,) strictly increasing"""
    work_angle: Floats
    """(n,) [rad] unwrapped, + counter-clockwise seen from +Z"""
    tool_angle: Floats
    """(n,) [rad] unwrapped, right-hand about `basis[2]`, 0 along `basis[0]`"""
    centre: Floats
    """(n, 3) [mm] tool centre"""
    basis: Floats
    """(3, 3) constant; rows: direction of tool angle 0, u × that, u = tool axis in its positive sense"""
    mount: RigidTransform = field(default_factory=RigidTransform)
    """part frame -> work spindle frame; identity where the part is clamped without fault"""
