"""Where the teeth or flats end along the axis, and whether they were meant to end there."""

import numpy as np

from twin.inspection.solid import Ints, Solid
from twin.inspection.survey import Survey, survey

SLICES = 4
"""that the place of an end is narrowed down to at a time"""
EXACT = 1e-4
"""[mm] until it is known to this"""
DEEPER = 1e-3
"""[mm] a gap that ends by this much higher is not cut to full depth"""
RIM = 0.7
"""part of the depth: what is left beyond is a shaft if it stays inside, else the blank or a collar"""
BLANK = 0.1
"""part of the depth: a collar differs from the tips by more than this, the blank by less"""


def end_of_depth(solid: Solid, seen: Survey, full: Ints, end: int) -> tuple[float, bool]:
    """Find where the full depth ends beyond its first or last section.

    Args:
        solid: the part.
        seen: sections of it.
        full: indices of those of full depth, in a row.
        end: 0 for the lower end, -1 for the upper one.

    Returns:
        z [mm], and whether what is beyond is something else than unfinished teeth: nothing, a shaft, or a
        collar.

    """
    z = solid.vertices[:, 2]
    heights = np.concatenate([[seen.bottom], seen.heights, [seen.top]])
    inner, outer = (int(full[end]) + 1 + step for step in ((0, 1) if end else (0, -1)))
    inside, outside = float(heights[inner]), float(heights[outer])
    if outside in (z.min(), z.max()):
        return outside, True
    shaft = _section(solid, outside).high[0]
    count, limit = seen.counts[full[0]], seen.low[full].max() + DEEPER
    while abs(outside - inside) > EXACT:
        part = survey(solid, min(inside, outside), max(inside, outside), SLICES)
        deep = (part.counts == count) & (part.low <= limit)
        # the slices from the inside on
        tried, deep = (part.heights, deep) if outside > inside else (part.heights[::-1], deep[::-1])
        first = len(deep) if deep.all() else int(np.argmin(deep))
        inside, outside = (
            float(tried[first - 1]) if first else inside,
            float(tried[first]) if first < len(tried) else outside,
        )
    near = float(z[np.argmin(np.abs(z - inside))])
    place = near if abs(near - inside) <= 2 * EXACT else inside
    root, tip = float(np.median(seen.low[full])), float(np.median(seen.high[full]))
    rim = root + RIM * (tip - root)
    # a wall across the gaps, of another size than the blank, is a collar; gaps that rise are a hob's run-out
    wall = _section(solid, outside)
    collar = wall.low[0] >= rim and abs(wall.high[0] - tip) > BLANK * (tip - root)
    return place, bool(shaft < rim or collar)


def _section(solid: Solid, height: float) -> Survey:
    """Look at one section."""
    return survey(solid, height, height, 1)
