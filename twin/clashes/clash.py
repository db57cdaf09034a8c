"""One meeting of cutter and stock that must not be."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from controller.tables.alarms import Alarm


@dataclass(frozen=True, slots=True, kw_only=True)
class Clash:
    """The first time that a tool takes metal the wrong way in a block."""

    alarm: Alarm
    time_s: float
    point: NDArray[np.float64]
    """(3,) [mm] where an edge meets the metal, in the work frame: the part frame at C0"""
