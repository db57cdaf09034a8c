"""Synchronisation error: where the slave really is, against where master and slides really ask it to be."""

import numpy as np
from numpy.typing import NDArray

from controller.clock import Chunk, Feedback

Floats = NDArray[np.float64]

ARCSEC_PER_DEG = 3600.0


def sync_error(chunk: Chunk, feedback: Feedback) -> Floats:
    """(ticks,) error of the slave [arcsec], + = ahead in its positive sense; NaN out of sync.

    The slave's deviation from its setpoint less what the deviations of the others ask of it: ratio times that
    of the master, from its setpoint in the interpolated type and from its measured position in the follow
    type, which is what the slave was told; and in a helical gear box that of the axial slide.
    """
    error = np.full(feedback.ticks, np.nan)
    actual, setpoint = feedback.actual, feedback.setpoint
    for gear in chunk.gears:
        here = slice(gear.first, min(gear.last, feedback.ticks))
        told = feedback.readings if gear.follow else setpoint
        master = actual[here, gear.master] - told[here, gear.master]
        asked = master * gear.numerator / gear.denominator
        for slide, rate in gear.slides:
            asked = asked + rate * (actual[here, slide] - setpoint[here, slide])
        off = actual[here, gear.slave] - setpoint[here, gear.slave]
        error[here] = (off - asked) * ARCSEC_PER_DEG
    return error
