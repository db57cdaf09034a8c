"""Signs at the grid's nodes and exact crossings of the cut surface with the grid's edges."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.grid import Grid, cartesian
from twin.cutting.refine import LEAF, Leaves
from twin.cutting.sweep import Deepest, Sweep
from twin.cutting.topology import CORNERS

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

ROOT_TOLERANCE = 1e-6
"""[mm] at which a crossing counts as found"""
ROUNDS = 40


@dataclass(frozen=True, slots=True)
class Crossings:
    """Where the cut surface crosses grid edges."""

    key: Ints
    """(n,) ascending: axis * nodes + id of the edge's lower node; see `edge_key`"""
    point: Floats
    """(n, 3) [mm]"""
    normal: Floats
    """(n, 3) unit, into the material"""
    bite: Ints
    """(n,) that made the surface there; −1 where the removed solid is closed in the air"""
    rising: Bools
    """(n,) whether the lower node is the removed one"""


def node_depths(sweep: Sweep, grid: Grid, leaves: Leaves) -> Floats:
    """Field at the nodes, (nr + 1, sectors, nz + 1); far from the surface only its sign, ±1.

    The outermost nodes count as material, so that what is removed is a closed solid.
    """
    depth = np.full(grid.node_shape, -1.0)
    flat = depth.reshape(-1)
    for low, size in leaves.removed:
        steps = np.arange(size + 1)
        for at in range(0, len(low), 4096):
            i, j, k = (low[at : at + 4096, axis, None] + steps for axis in range(3))
            i = np.minimum(i, grid.node_shape[0] - 1)
            k = np.minimum(k, grid.node_shape[2] - 1)
            flat[grid.node_id(i[:, :, None, None], j[:, None, :, None], k[:, None, None, :])] = 1.0
    node, block = _owned(leaves)
    point = grid.points(node[:, 0], node[:, 1] % grid.sectors, node[:, 2])
    value = sweep.deepest(point, block, leaves.tangents, sign=True).depth
    ids = grid.node_id(*node.T)
    # a node of a neighbouring block that is removed whole is known already
    flat[ids] = np.where(flat[ids] == 1.0, 1.0, np.maximum(value, -1.0))
    depth[0] = depth[-1] = -1.0
    depth[:, :, 0] = depth[:, :, -1] = -1.0
    return depth


def left_volume(grid: Grid, depth: Floats, blank: Blank) -> float:
    """About how much of the blank is left [mm³]: what lies around the nodes that are kept, and their core."""
    r, z = np.meshgrid(grid.r, grid.z, indexing="ij")
    inside = blank.contains(np.column_stack([r.ravel(), np.zeros(r.size), z.ravel()])).reshape(r.shape)
    kept = grid.sectors - (depth > 0).sum(axis=1)
    dr, dz = grid.r[1] - grid.r[0], grid.z[1] - grid.z[0]
    around = float((inside * kept * r).sum()) * dr * dz * 2.0 * np.pi / grid.sectors
    low = grid.r[0] - 0.5 * dr
    return around + np.pi * max(low * low - 0.25 * blank.bore_mm**2, 0.0) * blank.length_mm


def _owned(leaves: Leaves) -> tuple[Ints, Ints]:
    """The nodes (n, 3) at the low side of each leaf's cells, and the leaf of each."""
    steps = np.stack(np.meshgrid(*[np.arange(LEAF)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    node = (leaves.low[:, None, :] + steps).reshape(-1, 3)
    return node, np.repeat(np.arange(len(leaves.low)), len(steps))


def leaf_cells(grid: Grid, leaves: Leaves, depth: Floats) -> tuple[Ints, Ints, Ints]:
    """Cells that the surface passes: low corners (n, 3), corner signs as bits (n,), leaf of each (n,)."""
    cell, block = _owned(leaves)
    flat = depth.reshape(-1)
    case = np.zeros(len(cell), dtype=np.int64)
    for bit, step in enumerate(CORNERS):
        case |= (flat[grid.node_id(*(cell + step).T)] > 0).astype(np.int64) << bit
    mixed = (case > 0) & (case < 255)
    return cell[mixed], case[mixed], block[mixed]


def edge_key(grid: Grid, axis: Ints | int, node: Ints) -> Ints:
    """Number of the edge that leaves `node` (n, 3) along `axis` upwards."""
    return axis * np.int64(np.prod(grid.node_shape)) + grid.node_id(*node.T)


def edge_nodes(grid: Grid, crossings: Crossings, row: Ints) -> tuple[Floats, Floats]:
    """The removed and the kept end (m, 3) of the edges that some of the crossings are on."""
    axis, node = np.divmod(crossings.key[row], np.int64(np.prod(grid.node_shape)))
    low = np.stack(np.unravel_index(node, grid.node_shape), axis=1)
    high = low.copy()
    high[np.arange(len(row)), axis] += 1
    ends = grid.points(*low.T), grid.points(*high.T)
    rising = crossings.rising[row, None]
    return np.where(rising, ends[0], ends[1]), np.where(rising, ends[1], ends[0])


def find_crossings(sweep: Sweep, grid: Grid, leaves: Leaves, depth: Floats) -> Crossings:
    """All crossings with edges, in the order of their keys."""
    node, block = _owned(leaves)
    flat = depth.reshape(-1)
    here = flat[grid.node_id(*node.T)]
    rows = []
    for axis in range(3):
        step = np.zeros(3, dtype=np.int64)
        step[axis] = 1
        inside = node[:, axis] < grid.node_shape[axis] - 1 if axis != 1 else np.ones(len(node), dtype=bool)
        there = np.where(inside, flat[grid.node_id(*np.where(inside[:, None], node + step, node).T)], here)
        crossed = np.flatnonzero((here > 0) != (there > 0))
        rows.append(
            (edge_key(grid, axis, node[crossed]), crossed, np.full(len(crossed), axis), there[crossed])
        )
    key, owner, axis, there = (np.concatenate(column) for column in zip(*rows, strict=True))
    order = np.argsort(key)
    key, owner, axis, there = key[order], owner[order], axis[order], there[order]
    edge = _Edges(grid, node[owner], axis)
    rising = here[owner] > 0
    closing = _closing(grid, node[owner], axis)
    t = np.full(len(key), 0.5)
    point, normal = edge.at(np.arange(len(key)), t)
    normal *= np.where(rising, 1.0, -1.0)[:, None]
    cut = np.flatnonzero(~closing)
    leaf = block[owner[cut]]

    def field(points: Floats, rows: Ints) -> Deepest:
        return sweep.deepest(points, leaf[rows], leaves.tangents, gradient=True)

    bite = np.full(len(key), -1)
    point[cut], normal[cut], bite[cut] = _solve(field, edge, cut, (here[owner[cut]], there[cut]))
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    return Crossings(key, point, normal, bite, rising)


def _closing(grid: Grid, node: Ints, axis: Ints) -> Bools:
    """Edges that end at an outermost node: there the removed solid is closed, not cut."""
    i, _, k = node.T
    nr, _, nz = grid.cells
    radial = (i == 0) | (i + (axis == 0) == nr)
    axial = (k == 0) | (k + (axis == 2) == nz)
    return radial | axial


class _Edges:
    """Positions along edges, by a parameter from 0 at the lower to 1 at the upper node."""

    def __init__(self, grid: Grid, node: Ints, axis: Ints) -> None:
        i, j, k = node.T
        self.low = np.stack([grid.r[i], grid.angle(j), grid.z[k]], axis=1)
        self.step = np.zeros_like(self.low)
        spacing = np.stack(
            [
                grid.r[np.minimum(i + 1, len(grid.r) - 1)] - grid.r[i],
                np.full(len(node), float(grid.angle(np.array(1)))),
                grid.z[np.minimum(k + 1, len(grid.z) - 1)] - grid.z[k],
            ],
            axis=1,
        )
        rows = np.arange(len(node))
        self.step[rows, axis] = spacing[rows, axis]
        self.axis = axis

    def at(self, rows: Ints, t: Floats) -> tuple[Floats, Floats]:
        """Points (m, 3) and their derivatives by t."""
        r, angle, z = (self.low[rows] + t[:, None] * self.step[rows]).T
        dr, da, dz = self.step[rows].T
        cos, sin = np.cos(angle), np.sin(angle)
        return cartesian(r, angle, z), np.stack(
            [dr * cos - r * sin * da, dr * sin + r * cos * da, dz], axis=1
        )


def _solve(
    field: Callable[[Floats, Ints], Deepest],
    edge: _Edges,
    rows: Ints,
    ends: tuple[Floats, Floats],
) -> tuple[Floats, Floats, Ints]:
    """Points, normals and bites of some edges, by Newton's method kept between a removed and a kept point.

    `field` tells the deepest bite at points, each on the edge rows[i] for one i.
    """
    here, there = ends
    n = len(here)
    rising = here > 0
    # what is known only by its sign makes no secant
    known = (np.abs(here) < 1.0) & (np.abs(there) < 1.0)
    t = np.where(known, here / np.where(here == there, 1.0, here - there), 0.5)
    t = np.clip(t, 0.02, 0.98)
    low, high = np.zeros(n), np.ones(n)
    normal = np.zeros((n, 3))
    bite = np.zeros(n, dtype=np.int64)
    left = np.arange(n)
    for _ in range(ROUNDS):
        guess = t[left]
        point, along = edge.at(rows[left], guess)
        found = field(point, left)
        value, slope = found.depth, found.gradient
        normal[left], bite[left] = -slope, found.bite
        short = (value > 0) == rising[left]
        low[left] = np.where(short, guess, low[left])
        high[left] = np.where(short, high[left], guess)
        with np.errstate(divide="ignore", invalid="ignore"):
            new = guess - value / np.einsum("nx,nx->n", slope, along)
        lost = ~((new >= low[left]) & (new <= high[left]))
        new[lost] = 0.5 * (low[left] + high[left])[lost]
        t[left] = new
        left = left[np.abs(new - guess) * np.linalg.norm(along, axis=1) > ROOT_TOLERANCE]
        if not len(left):
            break
    return edge.at(rows, t)[0], normal, bite
