"""What the torque of a cut sounds like: the largest line of its spectrum.

Of a cut that goes on evenly that is the frequency with which edges come to the metal, or a multiple of it.
"""

import math
from dataclasses import dataclass

import numpy as np

from twin.load.timeline import CuttingLoad

PAUSE = 1000
"""[ticks] without metal after which another cut begins"""
LEAST_TURNS = 4.0
"""of the tool, that a cut must last"""
SLOWEST = 0.5
"""per turn of the tool: what comes more slowly is the course of the cut, and no line of it"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """One line of a spectrum."""

    hz: float
    amplitude: float
    """[N m] of the torque on the tool spindle, from its middle to its peak"""
    per_turn: float
    """of the tool, in the mean"""


def largest_line(load: CuttingLoad, tick_s: float) -> Line | None:
    """Of the torque on the tool in the cut that takes most energy; None where no cut is long enough."""
    ticks = load.tick
    if not len(ticks):
        return None
    starts = np.concatenate([[0], np.flatnonzero(np.diff(ticks) > PAUSE) + 1])
    energy = np.add.reduceat(load.whole().power_w, starts)
    most = int(np.argmax(energy))
    last = ticks[starts[most + 1] - 1] if most + 1 < len(starts) else ticks[-1]
    first, count = int(ticks[starts[most]]), int(last - ticks[starts[most]]) + 1
    angle = np.interp([first - 1, first - 1 + count], *load.angle)
    turns = abs(float(np.diff(angle)[0])) / 360.0
    if turns < LEAST_TURNS:
        return None
    window = np.hanning(count)
    torque = load(first, count)[:, load.spindle]
    spectrum = 2.0 * np.abs(np.fft.rfft((torque - torque.mean()) * window)) / window.sum()
    lowest = math.ceil(SLOWEST * turns)
    at = lowest + int(np.argmax(spectrum[lowest:-1]))
    off, amplitude = _peak(spectrum[at - 1], spectrum[at], spectrum[at + 1])
    frequency = float(at + off) / (count * tick_s)
    return Line(hz=frequency, amplitude=amplitude, per_turn=frequency * count * tick_s / turns)


def _peak(before: float, largest: float, after: float) -> tuple[float, float]:
    """Where, from the largest of three neighbours on, a line stands in the spectrum of a Hann window, and how
    high: the window's own is sinc(δ) / (1 − δ²) at δ from a line, which two neighbours give."""
    share = max(before, after) / largest if largest else 0.0
    off = max((2.0 * share - 1.0) / (1.0 + share), 0.0)
    return math.copysign(off, after - before), float(largest * (1.0 - off * off) / np.sinc(off))
