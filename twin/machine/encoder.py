"""What the motor's encoder reads: the true position, its cyclic error, in whole counts."""

import math
from collections.abc import Callable

from twin.machine.drive import AxisDrive

WHOLE = 1.5 * 2.0**52
"""added to a float below 2^51 and taken away again it leaves the nearest whole number, ties to even, as
`round` does, in a third of the time"""


def encoder(axis: AxisDrive) -> Callable[[float], float]:
    """The reading [m | rad] of a true motor-side position, both referred to the axis.

    reading = count · round((q + a sin(order · motor angle)) / count)
    """
    count, amplitude = axis.count, axis.cyclic_error
    order = axis.drive.encoder_cyclic_order / axis.reduction

    def exact(position: float) -> float:
        return position

    def in_counts(position: float) -> float:
        return (position / count + WHOLE - WHOLE) * count

    def wavy(position: float) -> float:
        return position + amplitude * math.sin(order * position)

    def wavy_in_counts(position: float) -> float:
        return in_counts(wavy(position))

    if amplitude:
        return wavy_in_counts if count else wavy
    return in_counts if count else exact
