"""The next forces to try, from those tried and what they have caused: Aitken's relaxation, tick by tick.

A force pushes its edge off the metal, and so takes away from itself: ΔF_caused = -g ΔF_tried, g = dF/dh over
stiffness. Tried as caused, rounds diverge where g > 1, as thin chips reach it, whose force rises steepest,
though forces that agree are there. A share of 1/(1 + g) of the way from tried to caused is the secant to
them; g is found in every tick from the last two rounds. A force that pulls its edge into the metal has g < 0:
it is tried as caused, and from g = -1 on, where the cut digs in, rounds lead away from each other as it does.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.load.forces import CuttingLoad, mixed

Floats = NDArray[np.float64]

STEEPEST = 9.0
"""g at most"""
AROUND = 2
"""[ticks] to either side that have a say in g, for edges come a little sooner or later"""
SOME = 1e-3
"""[N] by which forces have to differ to tell of g"""


@dataclass(slots=True)
class Agreement:
    """The last round: forces that acted, and those that they have caused."""

    _last: tuple[CuttingLoad, CuttingLoad] | None = None
    _gain: Floats | None = None
    """(ticks,) g"""

    def after(self, acted: CuttingLoad, caused: CuttingLoad) -> CuttingLoad:
        """What to try next; it comes with the angles of the motion that has caused the last."""
        ticks = caused.angle[0]
        acted = acted.on(*caused.angle)
        gain = np.zeros(len(ticks))
        if self._gain is not None:
            gain[: len(self._gain)] = self._gain[: len(ticks)]
        if self._last is not None:
            before = [one.on(*caused.angle).tool_force(ticks) for one in self._last]
            tried, found = acted.tool_force(ticks) - before[0], caused.tool_force(ticks) - before[1]
            some = _around((tried * tried).sum(axis=1))
            gains = -_around((tried * found).sum(axis=1)) / np.maximum(some, SOME**2)
            gain = np.where(some > SOME**2, np.clip(gains, 0.0, STEEPEST), gain)
        self._last, self._gain = (acted, caused), gain
        share = np.repeat(1.0 / (1.0 + gain), caused.parts)
        cells = (ticks[:, None] * caused.parts + np.arange(caused.parts)).reshape(-1)
        return mixed([acted, caused], np.stack([1.0 - share, share]), cells)


def _around(values: Floats) -> Floats:
    """(n,) sums over each tick and its neighbours."""
    return np.convolve(values, np.ones(2 * AROUND + 1), "same")
