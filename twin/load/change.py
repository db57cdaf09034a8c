"""What forces change of a motion, as the part's surface sees it."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.motion import CutterMotion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STILL = 1e-6
"""[rad per sample] below which a tool does not turn"""
UM = 1e3


def change_um(
    before: CutterMotion, after: CutterMotion, ticks: Ints, *, radius: float, tick_s: float
) -> Floats:
    """(m, 5) how the tool's place (3,) and the stock's surface about its axis have changed [µm], and by how
    much sooner the tool comes [ticks], in those of the `ticks` that both runs have.

    Compared where the edges stand alike: an edge that comes late meets the metal where that has gone on to.
    """
    before_ticks, after_ticks = (np.rint(m.time_s / tick_s).astype(np.int64) - 1 for m in (before, after))
    common = np.intersect1d(np.intersect1d(before_ticks, after_ticks), ticks)
    a, b = np.searchsorted(before_ticks, common), np.searchsorted(after_ticks, common)
    old, new = _places(before, radius), _places(after, radius)
    rate = np.gradient(new, axis=0)[b]
    turned, turning = after.tool_angle[b] - before.tool_angle[a], np.gradient(after.tool_angle)[b]
    late = np.divide(turned, turning, out=np.zeros(len(b)), where=np.abs(turning) > STILL)
    return np.column_stack([(new[b] - old[a] - late[:, None] * rate) * UM, late])


def bound_um(change: Floats) -> float:
    """How far at most the part's surface has moved in a change (m, 5) [µm]: by the tool's way and the stock's
    turn together."""
    moved = np.linalg.norm(change[:, :3], axis=1) + np.abs(change[:, 3])
    return float(moved.max(initial=0.0))


def dominant_hz(change: Floats, ticks: Ints, tick_s: float) -> float:
    """Frequency [Hz] with the largest amplitude in a change (m, k); none while nothing is cut."""
    if len(ticks) < 2:
        return 0.0
    whole = np.zeros((int(ticks[-1] - ticks[0]) + 1, change.shape[1]))
    whole[ticks - ticks[0]] = change
    power = (np.abs(np.fft.rfft(whole, axis=0)[1:]) ** 2).sum(axis=1)
    return float(np.fft.rfftfreq(len(whole), tick_s)[1 + int(np.argmax(power))])


def _places(motion: CutterMotion, radius: float) -> Floats:
    """(n, 4) tool centre and way of the stock's surface [mm]."""
    return np.column_stack([motion.centre, radius * motion.work_angle])
