"""The cylindrical grid (r, theta, z) on which the cut is resolved."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BLOCK = 32
"""Cells along the edge of the coarsest block."""
FEWEST = 6
"""Coarsest blocks around: fewer make hulls that stand far out of them."""
OCTANTS = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), axis=-1).reshape(-1, 3)


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """Nodes at (r_i, theta_j, z_k); theta closes on itself."""

    r: Floats
    """(nr + 1,) [mm] ascending"""
    sectors: int
    """cells around, a multiple of BLOCK"""
    z: Floats
    """(nz + 1,) [mm] ascending"""

    @property
    def cells(self) -> tuple[int, int, int]:
        """Number of cells along r, theta, z."""
        return len(self.r) - 1, self.sectors, len(self.z) - 1

    @property
    def node_shape(self) -> tuple[int, int, int]:
        """Number of nodes along r, theta, z."""
        return len(self.r), self.sectors, len(self.z)

    @property
    def cell_mm(self) -> tuple[float, float, float]:
        """Largest cell edge along r, theta (at the outer radius), z [mm]."""
        return (
            float(np.diff(self.r).max()),
            float(self.r[-1] * 2 * math.pi / self.sectors),
            float(np.diff(self.z).max()),
        )

    @property
    def hull_radius(self) -> float:
        """Radius of a cylinder that holds the hulls of all blocks [mm]."""
        return float(self.r[-1]) / math.cos(BLOCK * math.pi / self.sectors)

    @property
    def z_range(self) -> tuple[float, float]:
        """Lowest and highest z [mm]."""
        return float(self.z[0]), float(self.z[-1])

    def angle(self, j: Ints | Floats) -> Floats:
        """Angle of node index `j` [rad]."""
        return np.asarray(j, dtype=np.float64) * (2 * math.pi / self.sectors)

    def points(self, i: Ints, j: Ints, k: Ints) -> Floats:
        """(n, 3) positions of nodes [mm]."""
        return cartesian(self.r[i], self.angle(j), self.z[k])

    def node_id(self, i: Ints, j: Ints, k: Ints) -> Ints:
        """Flat index into an array of `node_shape`."""
        return (i * self.sectors + j % self.sectors) * len(self.z) + k

    def halved(self, low: Ints, size: int) -> tuple[Ints, Ints]:
        """The eighths (m, 3), of `size` cells, of blocks (n, 3), and the block (m,) that each is part of."""
        parent = np.repeat(np.arange(len(low)), len(OCTANTS))
        low = (low[:, None] + size * OCTANTS).reshape(-1, 3)
        inside = (low[:, 0] < self.cells[0]) & (low[:, 2] < self.cells[2])
        return low[inside], parent[inside]

    def hulls(self, low: Ints, size: int) -> tuple[Floats, Floats]:
        """Middles (n, 3) and corners (n, 8, 3) of convex hulls around the blocks of `size` cells.

        The outer corners stand where the tangent at the outer arc's middle meets the sides.
        """
        i0, j0, k0 = low.T
        half = size * math.pi / self.sectors
        r0, r1 = self.r[i0], self.r[np.minimum(i0 + size, len(self.r) - 1)]
        z0, z1 = self.z[k0], self.z[np.minimum(k0 + size, len(self.z) - 1)]
        middle = self.angle(j0 + 0.5 * size)
        corners = [
            cartesian(r, middle + side, z)
            for r in (r0, r1 / math.cos(half))
            for side in (-half, half)
            for z in (z0, z1)
        ]
        return cartesian(0.5 * (r0 + r1), middle, 0.5 * (z0 + z1)), np.stack(corners, axis=1)


def cartesian(r: Floats, angle: Floats, z: Floats) -> Floats:
    """(n, 3) points from cylindrical coordinates."""
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def grid_around(
    *, r_low: float, r_high: float, z_low: float, z_high: float, cell: tuple[float, float, float]
) -> Grid:
    """The grid that covers a hollow cylinder with cells of about `cell` = (r, theta, z) mm.

    Two more layers stand outside r_high, z_low and z_high, so that the cut's closing faces lie in the air.
    """
    nr = max(2, math.ceil((r_high - r_low) / cell[0]))
    nr += nr % 2
    nz = max(2, math.ceil((z_high - z_low) / cell[2]))
    nz += nz % 2
    dr = (r_high - r_low) / nr
    dz = (z_high - z_low) / nz
    sectors = BLOCK * max(FEWEST, round(2 * math.pi * r_high / cell[1] / BLOCK))
    return Grid(
        r=r_low + dr * np.arange(nr + 3, dtype=np.float64),
        sectors=sectors,
        z=z_low + dz * np.arange(-2, nz + 3, dtype=np.float64),
    )
