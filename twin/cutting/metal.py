"""What is still metal when a bite comes: the blank, less what earlier passes removed."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.blocks import Blocks
from twin.cutting.cells import points
from twin.cutting.first import NOBODY, first_of
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

ASIDE = 1e-4
"""[mm] between places that the slope of the blank's outline is told by"""
SHORT = 1e-9
"""share of a slab that is left out at its sides"""


class Metal:
    """The metal of a slab. Places are radius [mm], angle [rad], z [mm]; steps from them go across, around and
    along the axis [mm]."""

    def __init__(self, sweep: Sweep, blank: Blank, blocks: Blocks) -> None:
        self._sweep, self._blank, self._blocks = sweep, blank, blocks
        low, high = blocks.z_range
        # a slab's upper side, and by rounding its lower, is in the next one's blocks, unknown here
        short = SHORT * (high - low)
        low, high = low + short, high - short
        self._low = np.array([blank.bore_mm / 2.0, -np.inf, low])
        self._high = np.array([blank.radius, np.inf, high])

    def rows(self, at: Floats) -> Ints:
        """The blocks (n,) of places (n, 3)."""
        return self._blocks.rows(at)

    def height(self, bite: Ints, at: Floats) -> tuple[Floats, Floats]:
        """How high (n,) places (n, 3) lie above the edges of bites (n,), and the slope (n, 3) of that."""
        met = self._sweep.evaluate(points(at), bite, gradient=True)
        return met.depth, polar(met.gradient, at[:, 1])

    def gone(self, bite: Ints, at: Floats, where: Ints) -> Floats:
        """How deep (n,) places (n, 3) lie in what is gone when bites (n,) come, by blocks `where` (n, 2)."""
        item, other = self._earlier(bite, at, where, np.zeros(len(at)))
        where_to = points(at)
        deep = np.zeros(len(at))
        np.maximum.at(deep, item, self._sweep.evaluate(where_to[item], other).depth)
        if self._blank.section is not None:
            deep = np.maximum(deep, self._blank.section.beyond(where_to)[0])
        return deep

    def stands(self, bite: Ints, at: Floats, asked: Bools) -> tuple[Bools, Bools]:
        """Whether (n,) points (n, 3) of the part are metal when bites (n,) come, and whether they lie in this
        slab; only those `asked` (n,) for are."""
        r, z = np.hypot(at[:, 0], at[:, 1]), at[:, 2]
        here = (z >= self._low[2]) & (z <= self._high[2])
        found = np.flatnonzero(asked & here & self._blank.contains(at))
        where = np.stack([r, np.arctan2(at[:, 1], at[:, 0]) % (2.0 * np.pi), z], axis=1)[found]
        rows = self._blocks.rows(where)
        found, rows = found[rows >= 0], rows[rows >= 0]
        item, earlier = self._blocks.coming(at[found], rows, 0.0, self._sweep.pass_begin(bite[found]))
        stands = np.zeros(len(at), dtype=bool)
        stands[found] = first_of(self._sweep, at[found], item, earlier) == NOBODY
        return stands, here

    def planes(self, bite: Ints, at: Floats, where: Ints, box: Floats) -> tuple[Floats, Floats]:
        """Tangent planes of what bounds the metal within boxes (n, 3) about places (n, 3).

        Returns how far (n, k) the places are beyond them, −inf for none, and the slope (n, k, 3) of that.
        """
        n = len(at)
        item, other = self._earlier(bite, at, where, np.hypot(box[:, 0], box[:, 1]))
        met = self._sweep.evaluate(points(at)[item], other, gradient=True)
        slope = polar(met.gradient, at[item, 1])
        near = np.flatnonzero(met.depth + (np.abs(slope) * box[item]).sum(axis=1) > 0)
        item, first = item[near], np.searchsorted(item[near], np.arange(n + 1))
        number = np.arange(len(item)) - first[item]
        k = int(np.diff(first).max(initial=0))
        levels, slopes = np.full((n, k + 2), -np.inf), np.zeros((n, k + 2, 3))
        levels[item, number], slopes[item, number] = met.depth[near], slope[near]
        outer, z = self._blank.outer_radius, at[:, 2]
        levels[:, k], slopes[:, k, 0] = at[:, 0] - outer(z), 1.0
        slopes[:, k, 2] = (outer(z - ASIDE) - outer(z + ASIDE)) / (2.0 * ASIDE)
        if self._blank.section is not None:
            levels[:, k + 1], beyond = self._blank.section.beyond(points(at))
            slopes[:, k + 1] = polar(beyond, at[:, 1])
        return levels, slopes

    def room(self, at: Floats, box: Floats) -> Floats:
        """(n, 6) steps that places may go up, and down, within boxes (n, 3) and the slab."""
        up, down = np.minimum(self._high - at, box), np.minimum(at - self._low, box)
        return np.maximum(np.concatenate([up, down], axis=1), 0.0)

    def moved(self, at: Floats, way: Floats) -> Floats:
        """Places (n, 3) some steps off, pulled back onto the blank's turned outline."""
        new = at + way
        new[:, 1] = at[:, 1] + way[:, 1] / np.maximum(at[:, 0], 1e-9)
        new = np.clip(new, self._low, self._high)
        new[:, 0] = np.minimum(new[:, 0], self._blank.outer_radius(new[:, 2]))
        return new

    def _earlier(self, bite: Ints, at: Floats, where: Ints, reach: Floats) -> tuple[Ints, Ints]:
        """Items, ascending, and bites of earlier passes that may come within `reach` (n,)."""
        until = self._sweep.pass_begin(bite)
        other = np.where(where[:, 0] == where[:, 1], -1, where[:, 1])
        where_to = points(at)
        near = [self._blocks.coming(where_to, rows, reach, until) for rows in (where[:, 0], other)]
        item, found = (np.concatenate(column) for column in zip(*near, strict=True))
        order = np.argsort(item, kind="stable")
        return item[order], found[order]


def polar(slope: Floats, angle: Floats) -> Floats:
    """Slopes (n, 3) by steps across, around and along the axis."""
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, z = slope.T
    return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=1)
