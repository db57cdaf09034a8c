"""Where stock meets an edge, foretold: work and slides go on evenly by the tool's angle, or nearly so.

While a tool turns by Δθ from where an edge points to the work, stock at r from the work axis goes g r Δθ, g
the work's turn over the tool's. What is left out is its curve, g² r Δθ²/2, and how unevenly axes have gone,
which is read off the motion.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.motion import CutterMotion

Floats = NDArray[np.float64]

SLOWEST = 0.5
"""share of the tool's turn by which stock may go about its axis for a first step to tell"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Evenly:
    """The motion in one pass, over the tool's angle from where its edge points to the work."""

    basis: Floats
    """(3, 3) of the motion"""
    centre: Floats
    """(3,) of the tool [mm]"""
    feed: Floats
    """(3,) of the tool per radian of its turn [mm]"""
    gear: float
    """turn of the work over the tool's"""
    swing: float
    """[rad] of the tool to either side of which that is known"""
    uneven: float
    """by how far stock, or the tool, stands elsewhere in that swing at most [mm]"""
    far: float
    """that stock stands from the work axis at most [mm]"""

    @classmethod
    def of(cls, motion: CutterMotion, angle: float, far: float, swing: float) -> "Evenly | None":
        """At a tool angle [rad], as far as it has a `swing` around it; None where the tool comes there more
        than once, or not at all."""
        sign = math.copysign(1.0, motion.tool_angle[-1] - motion.tool_angle[0])
        theta = sign * motion.tool_angle
        ends = sign * angle + np.array([-swing, 0.0, swing])
        if (np.diff(theta) <= 0.0).any() or ends[0] < theta[0] or ends[-1] > theta[-1]:
            return None
        columns = np.column_stack([motion.centre, far * motion.work_angle])
        low, middle, high = (np.array([np.interp(end, theta, one) for one in columns.T]) for end in ends)
        rate = (high - low) / (2.0 * swing)
        inside = (theta > ends[0]) & (theta < ends[-1])
        off = columns[inside] - middle - (theta[inside] - ends[1])[:, None] * rate
        off = np.vstack([off, low - middle + swing * rate])
        uneven = float((np.linalg.norm(off[:, :3], axis=1) + np.abs(off[:, 3])).max())
        return cls(
            basis=motion.basis,
            centre=middle[:3],
            feed=sign * rate[:3],
            gear=float(sign * rate[3] / far),
            swing=swing,
            uneven=uneven,
            far=far,
        )

    def met(self, own: Floats, turn: Floats) -> tuple[Floats, Floats]:
        """(3, n) where points meet the edge, along the tool's own axes from its centre, and (n,) how far off
        that may be at most [mm]; `own` (3, n) where they stand as the edge points to the work, `turn` [rad]
        about the tool's axis then."""
        # the work turns about z, which goes through its own origin
        turn_rate = self.basis @ np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
        still = turn_rate @ self.centre * self.gear - self.basis @ self.feed
        rate = self.gear * (turn_rate @ self.basis.T) @ own + still[:, None]
        turning = (own[0] * rate[1] - own[1] * rate[0]) / (own[0] * own[0] + own[1] * own[1])
        slow = np.abs(turning) < SLOWEST
        ahead = turn / np.where(slow, 1.0 - turning, 1.0)
        # what the first step leaves out of the angle makes no more of the way than the curve itself
        bound = self.gear * self.gear * self.far * ahead * ahead + 2.0 * self.uneven
        return own + ahead * rate, np.where(slow & (np.abs(ahead) < self.swing), bound, np.inf)
