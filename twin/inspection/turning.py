"""How teeth turn along the axis: their phase in sections close together gives the twist."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.inspection.sections import FOLD, Crossings, circle_crossings, plane_segments, unfolded
from twin.inspection.solid import Floats, Ints, Solid

Complexes = NDArray[np.complex128]

BENT = 0.02
"""part of a pitch by which the teeth of one helix leave a straight line at most"""
SPLITS = 33
"""places tried where the teeth may turn back"""
STRAIGHT = 0.1
"""part of the squares about one line that is left about two, where teeth turn back"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Turning:
    """How the teeth turn along z."""

    twist: float
    """[rad/mm]"""
    phase: float
    """of a tooth's centre at mid-height [rad]"""
    back_at: float | None = None
    """z [mm] where they begin to turn the other way"""


def turning(solid: Solid, count: int, low: float, high: float, radius: float) -> Turning:
    """Find the twist and a tooth centre's phase at mid-height, from sections close together."""
    pitch = 2 * math.pi * radius / count
    # below 45° a quarter pitch of height turns the teeth by less than half a pitch: no ambiguity
    planes = int(np.clip(math.ceil(4 * (high - low) / pitch), 33, 2000))
    heights = low + (high - low) * (np.arange(planes) + 0.5) / planes
    segments = plane_segments(solid, heights, radius=radius)
    crossings = unfolded(circle_crossings(segments, np.array([radius])), FOLD * 2 * math.pi / count)
    left, right = phase_sums(crossings, count, crossings.plane, planes)
    # half way from each right flank on to the left flank of the same tooth
    thickness = np.mod(np.angle(left * right.conj()), 2 * math.pi)
    centre = np.unwrap(np.angle(right) + thickness / 2) / count
    along = heights - (low + high) / 2
    slope, offset = np.polyfit(along, centre, 1)
    off = float(np.abs(centre - slope * along - offset).max())
    back_at = _turns_back(heights, centre) if off > BENT * 2 * math.pi / count else None
    return Turning(twist=float(slope), phase=float(offset), back_at=back_at)


def _turns_back(heights: Floats, centre: Floats) -> float | None:
    """Return the height from which teeth that turned one way turn the other, if two lines say so."""
    tries = []
    for k in (np.linspace(0.1, 0.9, SPLITS) * len(heights)).astype(np.int64):
        parts = (slice(None, k), slice(k, None))
        fits = [np.polyfit(heights[part], centre[part], 1, full=True)[:2] for part in parts]
        tries.append((sum(float(rest.sum()) for _, rest in fits), int(k), *(line for line, _ in fits)))
    rest, k, below, above = min(tries, key=lambda one: one[0])
    if below[0] * above[0] >= 0 or rest > STRAIGHT * np.polyfit(heights, centre, 1, full=True)[1].sum():
        return None
    meeting = (below[1] - above[1]) / (above[0] - below[0])
    return float(np.clip(meeting, *heights[[max(k - 2, 0), min(k + 1, len(heights) - 1)]]))


def phase_sums(crossings: Crossings, count: int, place: Ints, places: int) -> tuple[Complexes, Complexes]:
    """Sum exp(i count angle) of the left and the right flanks that fall on each place (n,) of `places`.

    The argument, divided by count, is the mean angle of the flanks within their pitch.
    """
    turn = np.exp(1j * count * crossings.angle)
    sums = np.zeros((2, places), dtype=np.complex128)
    np.add.at(sums, ((~crossings.left).astype(np.int64), place), turn)
    return sums[0], sums[1]
