"""How far a ball is pushed back along X by a clamped blank, in closed form: the law of the ideal machine.

A ball of radius ρ touches a cylinder of radius R where the distance of its centre from the cylinder's axis is
R + ρ. For an axis parallel to Z through (e_x, e_y) the centre then stands at x = e_x + √((R + ρ)² − e_y²).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.kinematics import Kinematics
from twin.probing.band import Form, Step
from twin.probing.probe import Probe

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """One probe before one clamped blank."""

    probe: Probe
    kinematics: Kinematics
    """poses of tool and work; the ball is carried by what carries the tool"""
    steps: tuple[Step, ...]
    form: Form

    def pushed_back(self, axes: Floats) -> tuple[Floats, NDArray[np.bool_]]:
        """How far the stylus is pushed back (n,) [mm], and whether by what is no band (n,).

        `axes` (n, k): where the axes stand [mm | deg].
        """
        ball, axis, origin = self._poses(axes)
        away = ball - origin
        along = np.einsum("nx,nx->n", away, axis)
        across = away - along[:, None] * axis
        # how far the axis leaves X as the ball goes along it
        slide = np.array([1.0, 0.0, 0.0]) - axis[:, :1] * axis
        turned = np.radians(axes[:, self.kinematics.work.spindle.column])
        bump = np.array([self.form.at(-angle) for angle in turned.tolist()])
        most, blocked = np.zeros(len(axes)), np.zeros(len(axes), dtype=bool)
        for step in self.steps:
            reach = step.radius + (bump if step.band else 0.0) + self.probe.ball_radius_mm
            push = _outer_root(across, slide, reach)
            met = (along > step.low) & (along < step.high) & (push > 0.0)
            blocked |= met & (not step.band)
            most = np.where(met, np.maximum(most, push), most)
        return most, blocked

    def _poses(self, axes: Floats) -> tuple[Floats, Floats, Floats]:
        """Centre of the ball, direction of the part's axis and its origin, each (n, 3), in the machine."""
        centre, _ = self.kinematics.tool.pose(axes)
        ahead = self.probe.reach_mm - self.probe.ball_radius_mm
        origin, work = self.kinematics.work.pose(axes)
        mount = self.kinematics.mount
        return (
            centre - np.array([ahead, 0.0, 0.0]),
            work @ mount.rotation[:, 2],
            origin + work @ mount.translation,
        )


def _outer_root(across: Floats, slide: Floats, reach: Floats | float) -> Floats:
    """(n,) largest s with |across + s slide| = reach; −inf where the ball passes beside."""
    a = np.einsum("nx,nx->n", slide, slide)
    b = np.einsum("nx,nx->n", across, slide)
    c = np.einsum("nx,nx->n", across, across) - np.square(reach)
    inside = b * b - a * c
    return np.where(inside > 0.0, (np.sqrt(np.maximum(inside, 0.0)) - b) / a, -np.inf)
