"""The metal of one window, looked for among all rays once, and then followed from round to round.

Rounds of a window differ by some micrometres. What may meet in all of them meets in the first, or lacks
little; each ray's new end lies near the old one.
"""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.load.change import bound_um, change_um
from twin.load.contacts import CLOSE_BY, Contacts
from twin.load.removal import Removal, looked_for, looked_for_again
from twin.load.span import Span
from twin.load.stock import Stock

Floats = NDArray[np.float64]

UM = 1e3
LATE = 1.0
"""[ticks] by which an edge may come sooner or later in a motion close by"""


class Search:
    """In one stock, for one tool."""

    def __init__(self, stock: Stock, *, radius: float, tick_s: float) -> None:
        """`radius` of the blank."""
        self.stock = stock
        self._sizes = {"radius": radius, "tick_s": tick_s}
        self._tick_s = tick_s
        self._known: Contacts | None = None
        self._base: CutterMotion | None = None
        """that contacts were looked for on"""

    def metal(self, field: DepthField | None, motion: CutterMotion, span: Span) -> Removal:
        """What the passes of a field take off in a span, and in the ticks next to it; no field, no metal."""
        if field is None:
            return Removal.none()
        between = span.between(self._tick_s)
        if self._known is not None and self._close(motion, span):
            again = looked_for_again(self.stock, self._known, field, motion, between)
            if again is not None:
                metal, self._known = again
                return metal
        metal, self._known = looked_for(self.stock, field, motion, between, LATE * self._tick_s)
        self._base = motion
        return metal

    def _close(self, motion: CutterMotion, span: Span) -> bool:
        if self._base is None:
            return False
        ticks = np.arange(span.first - 1, span.last)
        change = change_um(self._base, motion, ticks, **self._sizes)
        late = float(np.abs(change[:, 4]).max(initial=0.0))
        return bound_um(change) < CLOSE_BY * UM and late < LATE
