"""Where a hob's motion puts the gaps of a gear: a guess, which the proofs then judge."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.engagement import axes_apart
from twin.cutting.motion import CutterMotion
from twin.cutting.regular.irregular import IrregularError

Floats = NDArray[np.float64]

AT_DEPTH = 0.02
"""Share of the infeed by which the tool may stand off its deepest and still index the gear."""
UPRIGHT = 0.9
"""Share of the tool's axis along the work's beyond which nothing is hobbed."""
FEWEST, MOST = 5, 1000
"""Numbers of teeth that are tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Indexing:
    """Equal gaps about the spindle's axis, in the spindle's frame."""

    teeth: int
    twist: float
    """turn of the gaps along z [rad/mm]"""
    phase: float
    """angle of the middle of a gap at z = 0 [rad]"""
    root: float
    """smallest radius that the tips reach [mm]"""


def find_indexing(cutter: Cutter, motion: CutterMotion, radius: float) -> Indexing:
    """The gaps that a hob rolls into a blank of `radius` [mm]. Raises IrregularError for no such gear."""
    profile = cutter.profile
    if not math.isfinite(profile.pitch) or len(cutter.gash_angle) < 2:
        raise IrregularError("not hobbed")
    axis = motion.basis[2]
    if abs(axis[2]) > UPRIGHT:
        raise IrregularError("the hob's axis stands along the work's")
    distance = axes_apart(motion)
    root = float(distance.min()) - profile.tip
    if not 0 < root < radius:
        raise IrregularError("the tips do not come between the work's axis and its outside")
    deep = at_depth(motion, root, radius)
    tool, work, centre = motion.tool_angle[deep], motion.work_angle[deep], motion.centre[deep]
    height = centre[:, 2]
    if np.ptp(height) < profile.pitch or not np.ptp(tool):
        raise IrregularError("no feed along the axis at full depth")
    # tooth middles at tool-fixed angle phi: s = base + lead phi, modulo the pitch
    lead, base = (float(v) for v in np.polyfit(cutter.gash_angle, cutter.gash_shift, 1))
    starts = round(2.0 * math.pi * abs(lead) / profile.pitch)
    turned, rolled = float(tool[-1] - tool[0]), float(work[-1] - work[0])
    # the differential of a helical gear is less than half a tooth
    teeth = round(abs(starts * turned / rolled)) if rolled else 0
    if not starts or not FEWEST <= teeth <= MOST:
        raise IrregularError("tool and work do not roll as for a gear")
    ratio = math.copysign(starts / teeth, turned * rolled)
    middle = tool.mean(), height.mean()
    rest = work - work.mean() - ratio * (tool - middle[0])
    rise = float(np.polyfit(height - middle[1], rest, 1)[0])
    # the rack tooth that faces the work's axis, at an edge that is twisted along its length
    stretch = 1.0 / (1.0 + lead * cutter.twist)
    s = stretch * (base - lead * (middle[0] - cutter.twist * cutter.shift))
    s -= stretch * profile.pitch * round(s / (stretch * profile.pitch))
    per_turn = -lead * stretch
    twist = -rise
    rolling = axis[1] * per_turn / (ratio + twist * axis[2] * per_turn)
    across_y = float(centre[:, 1].mean()) + axis[1] * s
    z = middle[1] + axis[2] * s
    phase = across_y / rolling - float(work.mean()) - twist * z
    return Indexing(teeth=teeth, twist=twist, phase=math.remainder(phase, 2.0 * math.pi), root=root)


def at_depth(motion: CutterMotion, root: float, radius: float) -> slice:
    """The last samples in which the tool keeps to its full depth, given the radii of root and blank [mm]."""
    distance = axes_apart(motion)
    return _last_run(distance - distance.min() < AT_DEPTH * (radius - root))


def _last_run(rows: NDArray[np.bool_]) -> slice:
    """The last unbroken run of true rows."""
    end = len(rows) - int(np.argmax(rows[::-1]))
    before = np.flatnonzero(~rows[:end])
    return slice(int(before[-1]) + 1 if len(before) else 0, end)
