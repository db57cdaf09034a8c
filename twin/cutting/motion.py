"""The tool's motion past the work, as the cutting kernel sees it."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from twin.errors import InputError

Floats = NDArray[np.float64]

SQUARE = 1e-9
"""How far a frame may be off square."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigidTransform:
    """`p -> rotation @ p + translation`."""

    rotation: Floats = field(default_factory=lambda: np.eye(3))
    """(3, 3)"""
    translation: Floats = field(default_factory=lambda: np.zeros(3))
    """(3,) [mm]"""

    def moved(self, points: Floats) -> Floats:
        """Points (n, 3) [mm] carried along."""
        return points @ self.rotation.T + self.translation


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
    lean: Floats | None = None
    """(n, 2) components of the tool's own axis along `basis[0]` and `basis[1]` where it does not keep to
    `basis[2]`: it tilts about the tool centre, by the shortest way"""
    mount: RigidTransform = field(default_factory=RigidTransform)
    """part frame -> work spindle frame; identity where the part is clamped without fault"""

    def __post_init__(self) -> None:
        """Raise InputError for a recording that is no motion: too short, not finite, time not increasing."""
        n = len(self.time_s)
        if n < 2:
            raise InputError(f"a recording of {n} sample(s) holds no motion", remedy="valid: 2 or more")
        shapes = {"time_s": (n,), "work_angle": (n,), "tool_angle": (n,), "centre": (n, 3), "basis": (3, 3)}
        if self.lean is not None:
            shapes["lean"] = (n, 2)
        for name, shape in shapes.items():
            values = getattr(self, name)
            if values.shape != shape:
                raise InputError(f"recording, {name}: expected {shape}, got {values.shape}")
            if not np.isfinite(values).all():
                first = int(np.flatnonzero(~np.isfinite(values).reshape(len(values), -1).all(axis=1))[0])
                raise InputError(f"recording, {name}: sample {first} is not a finite number")
        back = np.flatnonzero(np.diff(self.time_s) <= 0)
        if len(back):
            k = int(back[0])
            raise InputError(
                f"recording: time does not increase from sample {k} ({self.time_s[k]:g} s) to the next "
                f"({self.time_s[k + 1]:g} s)"
            )
        if not np.allclose(self.basis @ self.basis.T, np.eye(3), atol=SQUARE) or not math.isclose(
            float(np.linalg.det(self.basis)), 1.0, abs_tol=SQUARE
        ):
            raise InputError("recording, basis: its rows are no right-handed frame")
