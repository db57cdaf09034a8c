"""The stretches of a recorded motion in which cutter and stock must not meet, as far as they come close."""

from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.engagement import StockCylinder
from twin.cutting.motion import CutterMotion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

REST = 1e-4
"""[mm] in one sample, at the tips or at the stock's surface, below which a spindle stands"""


class Manner(Enum):
    """How they must not meet: the alarm that says so."""

    RAPID = "HT9032"
    TOOL_AT_REST = "HT9033"
    WORK_AT_REST = "HT9034"


CLASHES = frozenset(manner.value for manner in Manner)
"""alarms that are found when the program has run"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Samples of one tool's motion: at rapid one block of the program, else as long as the spindle stands."""

    manner: Manner
    start: int
    """sample at which it begins, close or not"""
    near: Ints
    """(n,) samples at whose end tool and stock may touch, ascending"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ways:
    """How far everything goes in each sample of a motion, (n,) [mm]; the first one is 0."""

    tips: Floats
    stock: Floats
    """of its surface"""
    slides: Floats

    @classmethod
    def of(cls, cutter: Cutter, motion: CutterMotion, blank: Blank) -> "Ways":
        """Of a tool and a turning blank."""
        return cls(
            tips=cutter.radius * np.abs(np.diff(motion.tool_angle, prepend=motion.tool_angle[0])),
            stock=blank.radius * np.abs(np.diff(motion.work_angle, prepend=motion.work_angle[0])),
            slides=np.linalg.norm(np.diff(motion.centre, axis=0, prepend=motion.centre[:1]), axis=1),
        )


def runs(
    cutter: Cutter, motion: CutterMotion, blank: Blank, *, block: Ints, rapid: Bools, sync: Bools
) -> list[Run]:
    """Every run in which the endless tool comes to the blank; `block`, `rapid` and `sync` are (n,), of the
    samples of the motion."""
    ways = Ways.of(cutter, motion, blank)
    turning = ways.tips > REST
    rests = {
        Manner.RAPID: rapid,
        Manner.TOOL_AT_REST: ~turning,
        Manner.WORK_AT_REST: sync & turning & (ways.stock <= REST),
    }
    moving = {
        Manner.RAPID: ways.slides > 0.0,
        Manner.TOOL_AT_REST: ways.stock + ways.slides > REST,
        Manner.WORK_AT_REST: turning,
    }
    wanted = np.flatnonzero(np.any([rests[manner] & moving[manner] for manner in Manner], axis=0))
    stock = StockCylinder.around(motion.mount, blank.radius, blank.z_range)
    close = np.zeros(len(block), dtype=bool)
    reach = cutter.radius + ways.slides.max(initial=0.0)
    close[wanted] = ~stock.clear_of(motion.centre[wanted], motion.basis, reach)
    other = block[1:] != block[:-1]
    found = []
    for manner in Manner:
        here, counts = rests[manner], moving[manner] & close
        if not (here & counts).any():
            continue
        change = here[1:] != here[:-1]
        if manner is Manner.RAPID:
            change = change | other
        for first, last in pairwise([0, *(np.flatnonzero(change) + 1).tolist(), len(here)]):
            near = first + np.flatnonzero(counts[first:last]) if here[first] else np.zeros(0, np.int64)
            if len(near):
                found.append(Run(manner=manner, start=max(first - 1, 0), near=near))
    return found
