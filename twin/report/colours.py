"""Deviation as colour: diverging, symmetric about zero, told apart by colour-blind eyes too."""

from dataclasses import dataclass

import matplotlib
import numpy as np
from numpy.typing import NDArray

from twin.inspection.result import Floats
from twin.report.scale import nice_ceiling, number

STEEL = (0.86, 0.87, 0.88)
"""of faces without a deviation, red, green, blue in 0 … 1"""
ZERO = 128
"""index of no deviation; 1 and 255 are the ends of the scale, 0 = no value"""
COVERED = 0.99
"""share of the values that the scale must hold"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scale:
    """What the colours of one part mean."""

    limit_um: float
    """the scale runs from -limit to +limit"""
    beyond: float
    """share of the values that lie outside it and are drawn in its end colours, 0 … 1"""

    def index(self, deviation_um: Floats) -> NDArray[np.uint8]:
        """(n,) place of each value on the scale, 0 where there is none."""
        finite = np.isfinite(deviation_um)
        share = np.clip(np.where(finite, deviation_um, 0.0) / self.limit_um, -1, 1)
        return np.where(finite, np.rint(ZERO + (ZERO - 1) * share), 0).astype(np.uint8)

    def ticks(self) -> tuple[tuple[float, str], ...]:
        """Heights in % of the bar, and what stands there [µm]."""
        shares = (1.0, 0.5, 0.0, -0.5, -1.0)
        digits = 0 if self.limit_um >= 4 else 1
        return tuple(
            (50 + 50 * share, ("+" if share > 0 else "") + number(share * self.limit_um, digits))
            for share in shares
        )


def scale_for(deviation_um: Floats) -> Scale | None:
    """Round limit that holds `COVERED` of the finite values, at least 1 µm; None where there are none."""
    size = np.abs(deviation_um[np.isfinite(deviation_um)])
    if not size.size:
        return None
    limit = max(nice_ceiling(float(np.quantile(size, COVERED))), 1.0)
    return Scale(limit_um=limit, beyond=float(np.mean(size > limit)))


def palette() -> NDArray[np.uint8]:
    """(256, 3) red, green, blue by index: 0 steel, 1 blue (missing), 128 near white, 255 red (too much)."""
    shares = np.clip((np.arange(256) - 1) / 254, 0, 1)
    colours = matplotlib.colormaps["RdBu_r"](shares)[:, :3]
    colours[0] = STEEL
    return np.rint(255 * colours).astype(np.uint8)


def gradient(colours: NDArray[np.uint8]) -> str:
    """CSS colour stops of the scale, lowest first."""
    return ", ".join("#" + bytes(colours[k]).hex() for k in (1, *range(16, 256, 16), 255))
