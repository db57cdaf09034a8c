"""Whether a cutter leaves feed marks: strips beside one another, which only fine cells show."""

import math

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutters.profile import ToothProfile
from twin.cutting.blank import Blank
from twin.cutting.motion import CutterMotion

Floats = NDArray[np.float64]

STEP = 5e-4
"""[mm] between neighbouring strips that is no mark"""
OVERLAP = 0.9
"""Share of the edge's flat by which the tool may go on in a turn of the work."""
CORNER = 1e-6
"""[mm] below the tip where its flat ends"""


def unmarked(cutter: Cutter, motion: CutterMotion, blank: Blank) -> bool:
    """Whether the strips that straight edges along the work axis cut, turn after turn, lie in one surface.

    They do where each reaches over the next, and a turn later the edges come to the same places again: the
    tool no nearer, as many edges further on, and the edge aslant by less than STEP over what it is fed on.
    """
    if math.isfinite(cutter.profile.pitch) or cutter.revolved or motion.lean is not None:
        return False
    if cutter.gash_shift.any():
        return False
    z, away = motion.centre[:, 2], np.hypot(motion.centre[:, 0], motion.centre[:, 1])
    reach = cutter.profile.half_width + float(np.linalg.norm(motion.mount.translation))
    low, high = blank.z_range
    engaged = (z + reach > low) & (z - reach < high) & (away < cutter.radius + blank.radius + reach)
    turned = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(motion.work_angle)))])
    then = turned + 2.0 * math.pi
    # both now and a turn later
    at = np.flatnonzero(engaged & (then <= turned[-1]))
    at = at[engaged[np.searchsorted(turned, then[at])]]
    if not len(at):
        return False

    def change(values: Floats) -> Floats:
        return np.interp(then[at], turned, values) - values[at]

    fed = float(np.abs(change(z)).max())
    edges = change(motion.tool_angle) * len(cutter.gash_angle) / (2.0 * math.pi)
    aside = float(np.abs(edges - np.rint(edges)).max()) * 2.0 * math.pi / len(cutter.gash_angle)
    off = float(np.abs(change(away)).max()) + aside * blank.radius + fed * _slant(motion)
    return fed <= OVERLAP * 2.0 * _flat(cutter.profile) and off <= STEP


def _flat(profile: ToothProfile) -> float:
    """Half the length of the straight edge at the tip [mm]."""
    x = np.linspace(0.0, profile.half_width, 1001)
    on = profile.depth(x, np.full(len(x), profile.tip - CORNER))[0] > 0
    return float(x[on].max(initial=0.0))


def _slant(motion: CutterMotion) -> float:
    """Sine of the angle between the edge and the part's axis."""
    return float(np.linalg.norm(np.cross(motion.basis[2], motion.mount.rotation[:, 2])))
