"""Deviation as colour: diverging, symmetric about zero, told apart by colour-blind eyes too."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.inspection.result import Floats
from twin.report.scale import nice_ceiling, number

STEEL = (0.86, 0.87, 0.88)
"""of faces without a deviation, red, green, blue in 0 … 1"""
ZERO = 128
"""index of no deviation; 1 and 255 are the ends of the scale, 0 = no value"""
DIVERGING = "053061 2166ac 4393c3 92c5de d1e5f0 f7f7f7 fddbc7 f4a582 d6604d b2182b 67001f"
"""eleven steps from blue to red: the scheme "RdBu" of C. Brewer, joined by straight lines"""
COVERED = 0.99
"""share of the values that the scale must hold"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scale:
    """What the colours of one part mean."""

    limit_um: float
    """the scale runs from -limit to +limit"""
    beyond: float
    """share of the values that lie outside it and are drawn in its end colours, 0 … 1"""

    def index(self, deviation_um: NDArray[np.floating]) -> NDArray[np.uint8]:
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
    steps = np.array([list(bytes.fromhex(step)) for step in DIVERGING.split()], np.float64)
    place = np.clip((np.arange(256) - 1) / 254, 0, 1) * (len(steps) - 1)
    colours = np.stack([np.interp(place, np.arange(len(steps)), one) for one in steps.T], axis=-1)
    colours[0] = 255 * np.array(STEEL)
    return np.rint(colours).astype(np.uint8)


@dataclass(frozen=True, slots=True, kw_only=True)
class Legend:
    """What the page says of the colours."""

    limit: str
    """end of the scale [µm]"""
    ticks: tuple[tuple[float, str], ...]
    gradient: str
    """CSS colour stops, lowest first"""
    beyond: str
    """share of the values beyond its ends [%]; empty where there are none"""

    @staticmethod
    def of(deviation_um: Floats) -> "Legend | None":
        """The legend of a part; None where nothing on it is coloured."""
        scale = scale_for(deviation_um)
        if scale is None:
            return None
        return Legend(
            limit=f"{scale.limit_um:g}",
            ticks=scale.ticks(),
            gradient=gradient(palette()),
            beyond=_share(scale.beyond),
        )


def _share(share: float) -> str:
    """Share as percentage; never zero of something."""
    if not share:
        return ""
    return number(100 * share, 1) if share >= 5e-4 else "less than 0.1"


def gradient(colours: NDArray[np.uint8]) -> str:
    """CSS colour stops of the scale, lowest first."""
    return ", ".join("#" + bytes(colours[k]).hex() for k in (1, *range(16, 256, 16), 255))
