"""Cells of a blank about its axis, and straight pieces of them."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.blocks import COARSEST
from twin.cutting.grid import Grid, cartesian
from twin.cutting.section import Section

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cells:
    """The cells of a grid that covers a blank."""

    grid: Grid
    section: Section | None
    """of a blank that has gaps already"""
    weight: Floats
    """(nr, nz) volume of the blank in a cell, by the angle [mm³/rad]"""
    whole: Bools
    """(nr, nz) whether the cell lies in the blank as a whole"""

    @classmethod
    def of(cls, blank: Blank, step: float, *, around: float, along: float) -> "Cells":
        """Cells of about `step` across, `around` and `along` the axis [mm]."""
        low = blank.bore_mm / 2.0
        nr = max(1, math.ceil((blank.radius - low) / step))
        nz = max(1, math.ceil(blank.length_mm / along))
        sectors = COARSEST * max(6, math.ceil(2.0 * math.pi * blank.radius / around / COARSEST))
        r = np.linspace(low, blank.radius, nr + 1)
        z = np.linspace(*blank.z_range, nz + 1)
        outer = blank.outer_radius(0.5 * (z[1:] + z[:-1]))
        # the share of each cell that is inside the blank at the middle of its height
        inside = np.clip(outer - r[:-1, None], 0.0, np.diff(r)[:, None])
        weight = 0.5 * (r[1:] + r[:-1])[:, None] * inside * np.diff(z)
        least = np.minimum(outer, np.minimum(*(blank.outer_radius(side) for side in (z[1:], z[:-1]))))
        whole = r[1:, None] <= least
        return cls(grid=Grid(r=r, sectors=sectors, z=z), section=blank.section, weight=weight, whole=whole)

    @property
    def spacing(self) -> Floats:
        """(3,) of a cell across, around at the outer radius, and along the axis [mm]."""
        return np.array(self.grid.cell_mm)

    def edges(self, cell: Ints) -> tuple[Floats, Floats]:
        """Lowest and highest radius, angle and z (n, 3) of cells (n, 3)."""
        i, j, k = cell.T
        g = self.grid
        return (
            np.stack([g.r[i], g.angle(j), g.z[k]], axis=1),
            np.stack([g.r[i + 1], g.angle(j + 1), g.z[k + 1]], axis=1),
        )

    def slabs(self) -> Iterator[Ints]:
        """Low corners (n, 3) of the coarsest blocks, slab after slab along z."""
        nr, nt, nz = self.grid.cells
        across = np.stack(
            np.meshgrid(np.arange(0, nr, COARSEST), np.arange(0, nt, COARSEST), indexing="ij"), axis=-1
        ).reshape(-1, 2)
        for k in range(0, nz, COARSEST):
            yield np.column_stack([across, np.full(len(across), k)])


@dataclass(frozen=True, slots=True)
class Pieces:
    """Pieces of cells, each of one bite: straight through the cell's middle along r, angle or z."""

    start: Floats
    """(n, 3) radius [mm], angle [rad], z [mm]"""
    end: Floats
    """(n, 3)"""
    bite: Ints
    """(n,) numbered through all tools"""
    volume: Floats
    """(n,) [mm³]"""

    def of(self, rows: Ints | Bools) -> "Pieces":
        """Some of them."""
        return Pieces(self.start[rows], self.end[rows], self.bite[rows], self.volume[rows])

    def at(self, share: float) -> Floats:
        """(n, 3) at a share of the way: radius, angle, z."""
        return self.start + share * (self.end - self.start)

    def within(self, section: Section) -> "Pieces":
        """What of pieces along r or the angle lies in a section, not in its gaps."""
        outward = self.start[:, 0] < self.end[:, 0]
        part = self.of(outward)
        low, high = part.start[:, 0], np.minimum(part.end[:, 0], section.reach(part.start))
        # rings grow with their radius
        share = (high**2 - low**2) / (part.end[:, 0] ** 2 - low**2)
        end = part.end.copy()
        end[:, 0] = high
        part = Pieces(part.start, end, part.bite, part.volume * share)
        return joined(part.of(share > 0), self.of(~outward)._around(section))

    def _around(self, section: Section) -> "Pieces":
        """What of pieces along the angle lies outside of the gaps."""
        radii, which = np.unique(self.start[:, 0], return_inverse=True)
        found = [section.gaps(radius) for radius in radii.tolist()]
        gaps = np.full((len(radii), max(map(len, found), default=0), 2), np.nan)
        for own, some in zip(gaps, found, strict=True):
            own[: len(some)] = some
        left = self
        for number in range(gaps.shape[1]):
            for turn in (-1.0, 0.0, 1.0):
                gap = gaps[which, number] + section.twist * left.start[:, 2, None]
                gap += 2.0 * math.pi * (turn - np.floor(gap[:, :1] / (2.0 * math.pi)))
                low, high = left.start[:, 1], left.end[:, 1]
                cut = (gap[:, 0] < high) & (gap[:, 1] > low)
                before, behind = np.minimum(high, gap[:, 0]), np.maximum(low, gap[:, 1])
                left = joined(
                    left.of(~cut),
                    left._between(low, before).of(cut),
                    left._between(behind, high).of(cut),
                )
                which = np.concatenate([which[~cut], which[cut], which[cut]])
                some = left.volume > 0
                left, which = left.of(some), which[some]
        return left

    def _between(self, low: Floats, high: Floats) -> "Pieces":
        """Pieces along the angle cut to between `low` and `high` (n,) [rad]."""
        start, end = self.start.copy(), self.end.copy()
        start[:, 1], end[:, 1] = low, high
        share = (high - low) / (self.end[:, 1] - self.start[:, 1])
        return Pieces(start, end, self.bite, self.volume * share)


def joined(*pieces: Pieces) -> Pieces:
    """All of them."""
    return Pieces(*(np.concatenate([getattr(p, name) for p in pieces]) for name in Pieces.__slots__))


def points(at: Floats) -> Floats:
    """(n, 3) from radius, angle, z (n, 3)."""
    return cartesian(*at.T)
