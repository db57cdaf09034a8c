"""The faces that close the removed solid in the air, in wide triangles: nobody sees them."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.crossings import Crossings
from twin.cutting.grid import Grid

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

WIDE = 16, 8, 4
"""Quadrilaterals along the edges of squares that become fans about their middles. They bow by less than the
layer of cells between them and the blank."""


def fanned(grid: Grid, crossings: Crossings, quads: Ints) -> tuple[Bools, Ints]:
    """Which of the quadrilaterals (n, 4) are left, and triangles (m, 3) that stand for the others.

    `quads` are those around each crossed edge, seen from the material. Squares of those that no bite made,
    outside of the blank, keep their rims and lose what is amid them. At the work axis the closing faces are
    those of a core that is kept: they stay.
    """
    axis, node = np.divmod(crossings.key, np.int64(np.prod(grid.node_shape)))
    place = np.stack(np.unravel_index(node, grid.node_shape), axis=1)
    left = np.ones(len(quads), dtype=bool)
    fans = [np.zeros((0, 3), dtype=np.int64)]
    last = len(grid.r) - 2, 0, len(grid.z) - 2
    for along, layer in ((0, last[0]), (2, 0), (2, last[2])):
        rows = np.flatnonzero((axis == along) & (place[:, along] == layer) & (crossings.bite < 0))
        for wide in WIDE:
            b, c = place[rows, (along + 1) % 3], place[rows, (along + 2) % 3]
            square, of = np.unique(b // wide * max(grid.node_shape) + c // wide, return_inverse=True)
            whole = np.bincount(of, minlength=len(square)) == wide * wide
            mine = whole[of]
            here, of = rows[mine], (np.cumsum(whole) - 1)[of[mine]]
            fans.append(
                _fans(quads[here], of, (b[mine] % wide, c[mine] % wide), wide, crossings.rising[here])
            )
            left[here] = False
            rows = rows[~mine]
    return left, np.concatenate(fans)


def _fans(quads: Ints, square: Ints, at: tuple[Ints, Ints], wide: int, rising: Bools) -> Ints:
    """Triangles (m, 3) about the middles of squares, `wide` quadrilaterals along their edges, of which each
    stands `at` (b, c) in its `square`."""
    if not len(quads):
        return np.zeros((0, 3), dtype=np.int64)
    table = np.zeros((square.max() + 1, wide + 1, wide + 1), dtype=np.int64)
    turned = np.where(rising[:, None], quads, quads[:, ::-1])
    for corner, (right, up) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)]):
        table[square, at[0] + right, at[1] + up] = turned[:, corner]
    way, start, end = np.arange(wide), np.zeros(wide, dtype=np.int64), np.full(wide, wide)
    ring = table[:, np.r_[way, end, wide - way, start], np.r_[start, way, end, wide - way]]
    middle = np.broadcast_to(table[:, wide // 2, wide // 2, None], ring.shape)
    made = np.stack([middle, ring, np.roll(ring, -1, axis=1)], axis=2)
    upwards = np.zeros(len(table), dtype=bool)
    upwards[square] = rising
    made[~upwards] = made[~upwards][..., ::-1]
    return made.reshape(-1, 3)
