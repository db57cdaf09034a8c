"""The follow type of the gear box (parameter 201#7 = 1) rides in the chunk: the machine moves the slave."""

import math
from collections.abc import Iterable

from controller.clock import Follow
from controller.motion.timeline import Epoch


def follow_in(epochs: Iterable[Epoch], tick: int, ticks: int, rate: int) -> tuple[Follow | None, int]:
    """The coupling of the `ticks` behind `tick`, and how many of them it holds for, or there is none for.

    `rate`: ticks per second. The follow type begins and ends at ticks, where the encoders are read.
    """
    first = (tick + 1) / rate
    for epoch in epochs:
        if not epoch.gear.follow or first > epoch.end:
            continue
        if first <= epoch.start:
            return None, min(ticks, round(epoch.start * rate) - tick)
        if math.isfinite(epoch.end):
            ticks = min(ticks, round(epoch.end * rate) - tick)
        gear = epoch.gear
        follow = Follow(
            slave=gear.slave,
            master=gear.master,
            numerator=gear.numerator,
            denominator=gear.denominator,
            offset=-gear.numerator / gear.denominator * epoch.master_start,
        )
        return follow, ticks
    return None, ticks
