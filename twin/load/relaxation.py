"""How far to go from forces that were tried to those that they have caused: Aitken's relaxation.

A spindle that is braked comes later, and so meets less metal in a tick: what forces cause goes back and forth
about what they are to be. From two rounds the share of the way is found at which both agree, were one gain
the same everywhere (Irons and Tuck 1969).
"""

import numpy as np
from numpy.typing import NDArray

from twin.load.span import Span
from twin.load.timeline import CuttingLoad, summed

Floats = NDArray[np.float64]

LEAST, MOST = 0.2, 1.5
"""share of the way"""
CLOSER = 0.3
"""of the move before, at which rounds come together by themselves"""


class Relaxation:
    """The rounds of one window so far."""

    def __init__(self) -> None:
        self._share = 1.0
        self._left: Floats | None = None
        """(ticks, 3) what the last round left between tried and caused"""

    def towards(self, tried: CuttingLoad, caused: CuttingLoad, span: Span, moved: list[float]) -> CuttingLoad:
        """What to try next, on the motion that has `caused` forces under those `tried`; rounds that
        come together by themselves, as they have `moved` the part, go all the way."""
        ticks = np.arange(span.first, span.last)
        left, before = caused.tool_force(ticks) - tried.tool_force(ticks), self._left
        self._left = left
        slow = len(moved) > 1 and moved[-1] > CLOSER * moved[-2]
        if slow and before is not None and len(before) == len(left):
            change = left - before
            size = float((change * change).sum())
            if size > 0.0:
                self._share *= -float((before * change).sum()) / size
                self._share = min(max(self._share, LEAST), MOST)
        if self._share == 1.0:
            return caused
        return summed([tried, caused], (1.0 - self._share, self._share))
