"""The orders of work and tool turns in the synchronisation error, at constant speed."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

STEADY = 0.01
"""relative change of the commanded speed within which a stretch counts as steady"""
SETTLING_S = 0.3
"""after the speed is reached, until the loops have come to rest"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spectrum:
    """Of the longest stretch in sync at constant speed, over whole turns of the work."""

    begin_s: float
    end_s: float
    work_rpm: float
    tool_rpm: float
    mean_arcsec: float
    """what the slave is ahead by all the time: a lag, where it is below zero"""
    rms_arcsec: float
    """about the mean"""
    peak_to_peak_arcsec: float
    order: Floats
    """(n,) periods per turn of the work, ascending"""
    amplitude_arcsec: Floats
    """(n,)"""
    turn_arcsec: Floats
    """(m,) error over the last turn of the work, evenly"""

    @property
    def tool_turns(self) -> float:
        """Of the tool per turn of the work."""
        return abs(self.tool_rpm / self.work_rpm)

    def strongest(self, count: int) -> list[tuple[float, float, float]]:
        """The largest lines, down to a hundredth of the first: order per turn of the work, per turn of the
        tool, amplitude [arcsec]."""
        a = self.amplitude_arcsec
        inner = (a >= np.r_[0.0, a[:-1]]) & (a > np.r_[a[1:], 0.0]) & (a > 0.01 * a.max(initial=0.0))
        peaks = np.flatnonzero(inner)
        peaks = peaks[np.argsort(-a[peaks])][:count]
        return [(float(self.order[k]), float(self.order[k]) / self.tool_turns, float(a[k])) for k in peaks]


def spectrum(time_s: Floats, error_arcsec: Floats, work_deg: Floats, tool_deg: Floats) -> Spectrum | None:
    """Spectrum of (n,) errors, NaN out of sync, over (n,) angles of work and tool as commanded.

    None where the work never made a whole turn in sync at constant speed.
    """
    stretch = _steady(time_s, error_arcsec, work_deg)
    if stretch is None:
        return None
    first, last = stretch
    turns = int(abs(work_deg[last - 1] - work_deg[first]) / 360.0)
    if turns < 1:
        return None
    time, error = time_s[first:last], error_arcsec[first:last]
    turned = np.abs(work_deg[first:last] - work_deg[first]) / 360.0
    begin = turned[-1] - turns
    samples = int(np.count_nonzero(turned > begin))
    value = np.interp(begin + turns * np.arange(samples) / samples, turned, error)
    amplitude = 2.0 * np.abs(np.fft.rfft(value)) / samples
    seconds = time[-1] - time[0]
    return Spectrum(
        begin_s=float(time[0]),
        end_s=float(time[-1]),
        work_rpm=float((work_deg[last - 1] - work_deg[first]) / seconds / 6.0),
        tool_rpm=float((tool_deg[last - 1] - tool_deg[first]) / seconds / 6.0),
        mean_arcsec=float(value.mean()),
        rms_arcsec=float(value.std()),
        peak_to_peak_arcsec=float(np.ptp(value)),
        order=np.arange(1, len(amplitude)) / turns,
        amplitude_arcsec=amplitude[1:],
        turn_arcsec=value[-(samples // turns) :],
    )


def _steady(time_s: Floats, error: Floats, work_deg: Floats) -> tuple[int, int] | None:
    """First and one-past-last sample of the longest stretch in sync at constant speed, settled."""
    step = np.diff(time_s)
    # the usual step; a median would load all of numpy's masked arrays for this one figure
    tick = float(np.partition(step, len(step) // 2)[len(step) // 2]) if len(step) else 0.0
    # speeds over 50 ms, for the counts of an encoder whisper in the setpoint of a follower
    wide = max(1, round(0.05 / tick)) if tick > 0.0 else 0
    if not 0 < 2 * wide < len(step):
        return None
    n = len(time_s)
    speed, change = np.full(n, np.nan), np.full(n, np.nan)
    speed[wide:] = (work_deg[wide:] - work_deg[:-wide]) / (wide * tick)
    change[2 * wide :] = np.abs(speed[2 * wide :] - speed[wide:-wide])
    good = np.isfinite(error) & (change <= STEADY * np.abs(speed)) & (speed != 0.0)
    good[1:] &= step < 1.5 * tick
    edge = np.flatnonzero(np.diff(np.concatenate([[0], good.astype(np.int8), [0]])))
    # a change of speed shows in the last of them before it passes the limit
    starts, ends = edge[::2] + round(SETTLING_S / tick), edge[1::2] - 2 * wide
    if not len(starts) or (ends - starts).max() < 3:
        return None
    longest = int(np.argmax(ends - starts))
    return int(starts[longest]), int(ends[longest])
