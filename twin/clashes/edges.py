"""Where points of the cutting edges are, time by time, in the blank."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.motion import CutterMotion
from twin.cutting.passes import REACH

Floats = NDArray[np.float64]

GRAIN = 0.25
"""[mm] between points of an edge, and how far inside its outline they are looked for"""
INSIDE = 1e-6
"""[mm] under the tips, where an edge is not missed for rounding"""
MOST = 3000
"""points of one edge"""
AROUND = 24
"""directions in which the outline of a body of revolution is looked at"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Places:
    """Points of edges at some instants."""

    part: Floats
    """(n, 3) in the part frame [mm]"""
    work: Floats
    """(n, 3) in the work frame, which does not turn [mm]"""
    instant: Floats
    """(n,) sample (fractional) of the motion"""

    def of(self, rows: NDArray) -> "Places":
        """Some of them."""
        return Places(part=self.part[rows], work=self.work[rows], instant=self.instant[rows])

    @staticmethod
    def joined(parts: "Sequence[Places]") -> "Places":
        """All of some, in their order."""
        none = np.zeros((0, 3))
        return Places(
            part=np.concatenate([none, *(one.part for one in parts)]),
            work=np.concatenate([none, *(one.work for one in parts)]),
            instant=np.concatenate([none[:, 0], *(one.instant for one in parts)]),
        )


def edge_points(cutter: Cutter, low: float, high: float) -> Floats:
    """(k, 2) points of one edge in its rake plane, just inside its outline: position along the tool's axis
    between `low` and `high`, distance from it [mm]."""
    if math.isfinite(cutter.half_length):
        low = max(low, cutter.shift - cutter.half_length)
        high = min(high, cutter.shift + cutter.half_length)
    profile = cutter.profile
    inner = max(profile.root, 0.5 * profile.tip)
    if high <= low:
        return np.zeros((0, 2))
    grain = min(GRAIN, 0.25 * profile.half_width)
    top = profile.tip - INSIDE
    s, rho = np.meshgrid(
        np.arange(low, high + grain, grain), np.arange(top, inner - grain, -grain), indexing="ij"
    )
    s, rho = s.ravel(), rho.ravel()
    depth, _, _ = profile.depth(s, rho)
    kept = np.flatnonzero((depth >= 0.0) & (depth <= grain))
    kept = kept[:: max(1, math.ceil(len(kept) / MOST))]
    return np.column_stack([s[kept], rho[kept]])


def places(cutter: Cutter, motion: CutterMotion, edge: Floats, instant: Floats) -> Places:
    """The points (k, 2) of all edges that face the work, at instants (n,): fractional samples."""
    samples = np.arange(len(motion.time_s))
    work = np.interp(instant, samples, motion.work_angle)
    tool = np.interp(instant, samples, motion.tool_angle)
    centre = np.stack([np.interp(instant, samples, column) for column in motion.centre.T], axis=1)
    s, rho = edge.T
    if cutter.revolved:
        gash = np.linspace(-REACH, REACH, AROUND)
        angle = np.broadcast_to(gash[:, None], (len(instant), AROUND, 1))
        shift = np.zeros(AROUND)
    else:
        angle, shift = tool[:, None, None] + cutter.gash_angle[:, None], cutter.gash_shift
    along = s + shift[:, None]
    angle = angle + cutter.twist * (along - cutter.shift)
    row, gash, point = np.nonzero(np.cos(angle) > math.cos(REACH))
    turned, reach = angle[row, gash, point], rho[point]
    own = np.column_stack([reach * np.cos(turned), reach * np.sin(turned), along[gash, point]])
    at_work = centre[row] + own @ motion.basis
    cos, sin = np.cos(work[row]), np.sin(work[row])
    x, y, z = at_work.T
    back = np.column_stack([x * cos + y * sin, y * cos - x * sin, z])
    return Places(
        part=(back - motion.mount.translation) @ motion.mount.rotation,
        work=at_work,
        instant=instant[row],
    )
