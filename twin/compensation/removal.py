"""How much of its stock every flank of a pre-cut gear has lost, from the mesh of the part."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.grinding.precut import PrecutGear
from twin.inspection.involute import geometry

Floats = NDArray[np.float64]

INSIDE_MM = 0.02
"""how far below the tips and above the form circle, and within the faces, flanks are looked at"""
NEAR = 0.25
"""of a pitch on the base circle that a point of a flank may lie off its place"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Removal:
    """Normal to the flanks [mm], gap by gap from gap 1 on; each (z,)."""

    left: tuple[Floats, Floats]
    """smallest and largest of each gap's left flank, which stands counter-clockwise of the gap's middle seen
    from +Z; NaN where the mesh has no point of it"""
    right: tuple[Floats, Floats]

    def extremes(self, side: str) -> tuple[float, float]:
        """Smallest and largest over all flanks of a side."""
        low, high = self.left if side == "left" else self.right
        return float(np.nanmin(low)), float(np.nanmax(high))


def removal(vertices: Floats, precut: PrecutGear, *, low: float, high: float) -> Removal:
    """Measure a part against its pre-cut flanks.

    `vertices` (n, 3) in the part frame; teeth from `low` to `high` along Z [mm]. A flank point that keeps its
    stock counts 0; the gear without stock counts `stock_per_flank_mm`.
    """
    gear = geometry(precut.nominal())
    r, z = np.hypot(vertices[:, 0], vertices[:, 1]), vertices[:, 2]
    keep = (r > gear.form_diameter / 2 + INSIDE_MM) & (z > low + INSIDE_MM) & (z < high - INSIDE_MM)
    tip = min(gear.tip_diameter / 2, float(r.max()))
    keep &= r < tip - INSIDE_MM
    points, r, z = vertices[keep], r[keep], z[keep]
    pitch = 2.0 * math.pi / gear.teeth
    angle = np.arctan2(points[:, 1], points[:, 0]) - math.radians(precut.gap_phase_deg) - gear.twist * z
    gap = np.round(angle / pitch).astype(np.int64)
    off = angle - gap * pitch
    half = pitch / 2.0 - gear.half_tooth(r)
    normal = gear.base_radius * math.cos(gear.base_helix)
    wider = (np.abs(off) - half) * normal
    flank = np.abs(wider) < NEAR * pitch * normal
    taken = precut.stock_per_flank_mm + wider
    sides = []
    for side in (off > 0.0, off <= 0.0):
        least, most = np.full(gear.teeth, np.inf), np.full(gear.teeth, -np.inf)
        here = flank & side
        np.minimum.at(least, gap[here] % gear.teeth, taken[here])
        np.maximum.at(most, gap[here] % gear.teeth, taken[here])
        sides.append((np.where(np.isfinite(least), least, np.nan), np.where(np.isfinite(most), most, np.nan)))
    return Removal(left=sides[0], right=sides[1])
