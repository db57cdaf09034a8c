"""Every vertex onto the cut surface, also where no plane or edge leads it there.

Newton's method settles what stands near the surface. Where edges meet within a cell it may run in circles or
away; then the surface lies between the vertex and a node of its own sheet that says otherwise than the
vertex, and is searched for there.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.crossings import Crossings, edge_nodes
from twin.cutting.grid import Grid
from twin.cutting.refine import LEAF, Leaves
from twin.cutting.sweep import Deepest, Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

SETTLED = 1e-5
"""[mm] of depth at which a vertex stands on the surface"""
STEPS = 4
"""of Newton's method"""
ROUNDS = 40
"""of the search between two points"""


class Ground:
    """The field in the finest blocks, wherever in them a point lies."""

    def __init__(self, sweep: Sweep, grid: Grid, leaves: Leaves) -> None:
        self.sweep, self.grid, self.tangents = sweep, grid, leaves.tangents
        cut = np.flatnonzero(np.diff(leaves.tangents.lists.start))
        # the finest block with bites at each place, -1 = none
        self._at = np.full([-(-n // LEAF) for n in grid.cells], -1)
        self._at[tuple(leaves.low[cut].T // LEAF)] = cut

    def field(self, points: Floats, own: Ints) -> Deepest:
        """The deepest bite at points (n, 3); in blocks that are none of the finest, by those of the `own`."""
        return self.sweep.deepest(points, self.leaf(points, own), self.tangents, gradient=True)

    def leaf(self, points: Floats, own: Ints) -> Ints:
        """The finest block (n,) that each point lies in, or its `own`."""
        row = self._row_at(points)
        return np.where(row >= 0, row, own)

    def passed(self, points: Floats) -> Bools:
        """Whether the surface may pass near to points (n, 3)."""
        return self._row_at(points) >= 0

    def _row_at(self, points: Floats) -> Ints:
        """The finest block (n,) with bites that each point lies in, or −1."""
        r, z = self.grid.r, self.grid.z
        turn = np.arctan2(points[:, 1], points[:, 0]) / self.grid.angle(np.array(1))
        i = np.searchsorted(r, np.hypot(points[:, 0], points[:, 1]), side="right") - 1
        j = np.floor(turn).astype(np.int64) % self.grid.sectors
        k = np.searchsorted(z, points[:, 2], side="right") - 1
        ends = np.array(self._at.shape) - 1
        return self._at[np.clip(i // LEAF, 0, ends[0]), j // LEAF, np.clip(k // LEAF, 0, ends[2])]


@dataclass(frozen=True, slots=True)
class Around:
    """The crossings on the border of each sheet."""

    owner: Ints
    """(m,) sheet of each pair of sheet and crossing"""
    row: Ints
    """(m,) its crossing"""
    leaf: Ints
    """(n,) the finest block of each sheet"""


def landed(
    ground: Ground, points: Floats, rows: Ints, around: Around, crossings: Crossings
) -> tuple[Floats, Ints]:
    """Bring the vertices `rows` (m,) of some sheets (n, 3) onto the surface; their deepest bites (m,)."""
    points = points.copy()
    bite, lost, found = newton(ground, points, rows, around.leaf)
    if lost.any():
        left = rows[lost]
        points[left] = _between(ground, (points[left], found), left, around, crossings)
        bite[lost] = ground.field(points[left], around.leaf[left]).bite
    return points, bite


def newton(ground: Ground, points: Floats, rows: Ints, leaf: Ints) -> tuple[Ints, Bools, Deepest]:
    """Move the vertices `rows`; returns their deepest bites, which do not settle, put back, and the field
    there."""
    longest = 0.5 * min(ground.grid.cell_mm)
    start = points[rows]
    first = found = ground.field(start, leaf[rows])
    bite = first.bite.copy()
    at = np.arange(len(rows))
    lost = np.zeros(len(rows), dtype=bool)
    for step_number in range(STEPS + 1):
        open_ = np.abs(found.depth) > SETTLED
        at = at[open_]
        if not len(at):
            break
        if step_number == STEPS:
            lost[at] = True
            break
        slope = found.gradient[open_]
        with np.errstate(divide="ignore", invalid="ignore"):
            step = -slope * (found.depth[open_] / np.einsum("nx,nx->n", slope, slope))[:, None]
        there = points[rows[at]] + step
        near = np.linalg.norm(there - start[at], axis=1) < longest
        lost[at[~near]] = True
        at = at[near]
        points[rows[at]] = there[near]
        found = ground.field(points[rows[at]], leaf[rows[at]])
        bite[at] = found.bite
    points[rows[lost]] = start[lost]
    return bite, lost, first.of(lost)


def _between(
    ground: Ground, here: tuple[Floats, Deepest], rows: Ints, around: Around, crossings: Crossings
) -> Floats:
    """Points (m, 3) of the surface between the vertices `rows`, where the field is known, and nodes."""
    points, found = here
    number = np.full(int(around.owner.max()) + 1, -1)
    number[rows] = np.arange(len(rows))
    mine = np.flatnonzero(number[around.owner] >= 0)
    owner, row = number[around.owner[mine]], around.row[mine]
    removed, kept = edge_nodes(ground.grid, crossings, row)
    inside = found.depth > 0
    node = np.where(inside[owner, None], kept, removed)
    # the node that lies most nearly along the slope
    uphill = np.where(inside, -1.0, 1.0)[:, None] * found.gradient
    way = node - points[owner]
    score = np.einsum("nx,nx->n", way, uphill[owner]) / np.maximum(np.linalg.norm(way, axis=1), 1e-12)
    order = np.lexsort((score, owner))
    best = order[np.flatnonzero(np.diff(owner[order], append=-1))]
    node, leaf = node[best], around.leaf[rows]
    other = ground.field(node, leaf).depth
    apart = (other > 0) != inside
    place = np.where(apart[:, None], points, crossings.point[row[best]])
    some = np.flatnonzero(apart)
    place[some] = between(
        lambda at, of: ground.field(at, leaf[some[of]]).depth,
        (points[some], node[some]),
        (found.depth[some], other[some]),
    )
    return place


def between(
    depth: Callable[[Floats, Ints], Floats], ends: tuple[Floats, Floats], at_ends: tuple[Floats, Floats]
) -> Floats:
    """Points (n, 3) of the surface between two `ends` each, at which the depths have different signs.

    `depth` tells that at points between the ends of rows (m,). False position, with bisections between.
    """
    start, way = ends[0], ends[1] - ends[0]
    inside = at_ends[0] > 0
    near, far = np.zeros(len(start)), np.ones(len(start))
    value = np.stack(at_ends)
    place = start.copy()
    open_ = np.arange(len(start))
    for turn in range(ROUNDS):
        if not len(open_):
            break
        a, b = value[:, open_]
        share = a / (a - b) if turn % 3 < 2 else np.full(len(open_), 0.5)
        at = near[open_] + share * (far[open_] - near[open_])
        place[open_] = start[open_] + at[:, None] * way[open_]
        found = depth(place[open_], open_)
        alike = (found > 0) == inside[open_]
        one, two = open_[alike], open_[~alike]
        near[one], value[0, one] = at[alike], found[alike]
        far[two], value[1, two] = at[~alike], found[~alike]
        # the side that stays loses weight, so that it moves soon
        value[1, one] *= 0.5
        value[0, two] *= 0.5
        open_ = open_[np.abs(found) > SETTLED]
    return place
