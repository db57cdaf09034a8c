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
    off = feedback.actual - feedback.setpoint
    for gear in chunk.gears:
        here = slice(gear.first, min(gear.last, feedback.ticks))
        if gear.follow:
            master = feedback.actual[here, gear.master] - feedback.readings[here, gear.master]
        else:
            master = off[here, gear.master]
        asked = master * gear.numerator / gear.denominator
        for slide, rate in gear.slides:
            asked = asked + rate * off[here, slide]
        error[here] = (off[here, gear.slave] - asked) * ARCSEC_PER_DEG
    return error
