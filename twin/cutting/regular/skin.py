"""The cut surface in a proved chart: exact crossings on all rays, vertices where their planes meet."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.pairs import in_parallel
from twin.cutting.regular.proved import Proved
from twin.cutting.sweep import Deepest, Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
Rows = Ints | slice

SETTLED = 5e-4
"""[mm] below which one Newton step ends on the surface: what is left is its square over a radius, or, where
another bite takes over, a hundredth of it."""
NEAR = 2e-3
"""[mm] below which it ends near enough for the planes at the corners of a cell"""
ROUNDS = 5
"""of Newton's method"""
CHUNK = 1 << 14
"""Nodes that are worked on at once: few enough for the cache, and many enough that threads seldom wait."""
STIFFNESS = 1e-6
"""What a vertex's way from the middle costs, against its distance from the planes, both squared: feed marks
and generating flats differ by a hundredth of a radian."""
ROOM = 0.35
"""Share of its cell by which a vertex may leave the cell's middle."""


@dataclass(frozen=True, slots=True)
class Skin:
    """One vertex per cell of the chart."""

    vertices: Floats
    """(gaps, nu, nz, 3) [mm]"""
    rising: NDArray[np.bool_]
    """(gaps, nu - 1, nz - 1) whether four neighbouring vertices are split from the first to the last"""
    bite: Ints
    """(gaps, nu, nz) the deepest bite at each vertex"""
    instant: Floats
    """(gaps, nu, nz) sample (fractional) of its tool's motion at which that is made"""


def skin(sweep: Sweep, proved: Proved, thick: float) -> Skin:
    """The surface of a chart, with the bites that can make it there."""
    chart = proved.chart
    nu, nz = chart.cells
    nodes, cells = (chart.gaps, nu + 1, nz + 1), (chart.gaps, nu, nz)
    points, normals = np.zeros((2, 3, *nodes))
    vertices, bite = np.zeros((3, *cells)), np.zeros(cells, dtype=np.int64)
    instant, rising = np.zeros(cells), np.zeros((chart.gaps, nu - 1, nz - 1), dtype=bool)
    flat = points.reshape(3, -1), normals.reshape(3, -1), vertices.reshape(3, -1)

    def cross(part: slice) -> None:
        flat[0][:, part], flat[1][:, part] = _crossings(sweep, proved, _Nodes.of(proved, nodes, part), thick)

    def meet(gap: int) -> None:
        vertices[:, gap] = _meet(points[:, gap], normals[:, gap])

    def settle(part: slice) -> None:
        flat[2][:, part], bite.reshape(-1)[part], instant.reshape(-1)[part] = _settled(
            sweep, proved, _Nodes.of(proved, cells, part), flat[2][:, part]
        )

    def split(gap: int) -> None:
        # four vertices stand around a crossing: split them along the diagonal that comes nearer to it
        inner = points[:, gap, 1:-1, 1:-1], normals[:, gap, 1:-1, 1:-1]
        mine = vertices[:, gap]
        one = _off(*inner, mine[:, :-1, :-1] + mine[:, 1:, 1:])
        rising[gap] = one < _off(*inner, mine[:, 1:, :-1] + mine[:, :-1, 1:])

    in_parallel(cross, _chunks(math.prod(nodes)))
    in_parallel(meet, iter(range(chart.gaps)))
    in_parallel(settle, _chunks(math.prod(cells)))
    in_parallel(split, iter(range(chart.gaps)))
    return Skin(np.ascontiguousarray(np.moveaxis(vertices, 0, -1)), rising, bite, instant)


def _chunks(count: int) -> Iterator[slice]:
    return (slice(low, min(low + CHUNK, count)) for low in range(0, count, CHUNK))


@dataclass(frozen=True, slots=True)
class _Nodes:
    """Some nodes of a chart, or its cells by their first nodes."""

    gap: Ints
    """(n,) like the following"""
    i: Ints
    k: Ints
    column: Ints
    """of a cell that holds the node, as `Proved` counts them"""
    block: Ints
    """of that cell"""

    @classmethod
    def of(cls, proved: Proved, shape: tuple[int, int, int], part: slice) -> "_Nodes":
        """A slice of the nodes of an array."""
        nu, nz = proved.chart.cells
        gap, i, k = np.unravel_index(np.arange(part.start, part.stop), shape)
        column = gap * nz + np.minimum(k, nz - 1)
        block = proved.block.take(column + nz * ((nu - 1) * gap + np.minimum(i, nu - 1)))
        return cls(gap, i, k, column, block)

    def deepest(self, sweep: Sweep, proved: Proved, at: Floats, rows: Rows) -> Deepest:
        """The deepest bite at places (3, n) of some of the nodes' cells."""
        images = proved.images(at, self.column[rows])
        return sweep.deepest(at.T, self.block[rows], proved.tangents, gradient=True, images=images)


def _settled(sweep: Sweep, proved: Proved, nodes: _Nodes, guess: Floats) -> tuple[Floats, Ints, Floats]:
    """Vertices (3, n) brought onto the surface, the bites (n,) that make it there, and when."""
    vertices, count = guess.copy(), guess.shape[1]
    bite, instant = np.zeros(count, dtype=np.int64), np.zeros(count)
    rows: Rows = slice(0, count)
    for _ in range(ROUNDS):
        at = vertices[:, rows]
        found = nodes.deepest(sweep, proved, at, rows)
        bite[rows], instant[rows] = found.bite, found.instant
        slope = found.gradient.T
        step = found.depth / _product(slope, slope)
        vertices[:, rows] = at - step * slope
        rows = _left(rows, np.abs(step) > SETTLED)
        if not len(rows):
            break
    return vertices, bite, instant


def _crossings(sweep: Sweep, proved: Proved, nodes: _Nodes, thick: float) -> tuple[Floats, Floats]:
    """Where the rays of nodes cross the surface, (3, n), and the unit normals into the material."""
    start, along = (
        np.ascontiguousarray(v.T) for v in proved.chart.at(nodes.gap, nodes.i, nodes.k, np.zeros(1))
    )
    tau = _first_planes(proved, nodes, (start, along), thick)
    slope = np.zeros_like(start)
    rows: Rows = slice(0, len(tau))
    for _ in range(ROUNDS):
        ahead = along[:, rows]
        found = nodes.deepest(sweep, proved, start[:, rows] + tau[rows] * ahead, rows)
        slope[:, rows] = found.gradient.T
        step = found.depth / np.minimum(_product(found.gradient.T, ahead), -1e-3)
        tau[rows] = np.clip(tau[rows] - step, -thick, thick)
        rows = _left(rows, np.abs(step) > NEAR)
        if not len(rows):
            break
    slope /= -np.sqrt(_product(slope, slope))
    return start + tau * along, slope


def _left(rows: Rows, which: Bools) -> Ints:
    """Which of some rows are left."""
    left = np.flatnonzero(which)
    return left if isinstance(rows, slice) else rows[left]


def _product(a: Floats, b: Floats) -> Floats:
    """Scalar products (…) of vectors (3, …)."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _first_planes(proved: Proved, nodes: _Nodes, rays: tuple[Floats, Floats], thick: float) -> Floats:
    """Ways (n,) along rays (3, n) to the first of the bites' tangent planes, seen from the tooth."""
    tangents, lists = proved.tangents, proved.tangents.lists
    start, along = rays
    # in the frame of the blocks the rays of all images are those of the template
    way = proved.images(start, nodes.column).points - tangents.middle.take(nodes.block, axis=0)
    way, ahead = np.ascontiguousarray(way.T), proved.turned(along, nodes.column)
    length = np.diff(lists.start).take(nodes.block)
    owner = np.repeat(np.arange(len(length)), length)
    level, *gradients = tangents.plane.take(lists.pairs(nodes.block), axis=1)
    rate = np.zeros(len(owner))
    for x in range(3):
        level += gradients[x] * way[x].take(owner)
        rate += gradients[x] * ahead[x].take(owner)
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.where(rate < 0, -level / rate, -thick)
    found = np.maximum.reduceat(root, np.concatenate([[0], np.cumsum(length)[:-1]]))
    return np.clip(found, -thick, thick)


def _off(points: Floats, normals: Floats, ends: Floats) -> Floats:
    """How far the middles of some edges, given as the sums of their `ends` (3, …), stand off planes."""
    return np.abs(_product(normals, 0.5 * ends - points))


def _meet(points: Floats, normals: Floats) -> Floats:
    """Where the planes at the corners of each cell of a gap meet best, within the cell: (3, nu, nz)."""
    low, high = slice(None, -1), slice(1, None)
    cut = [(slice(None), i, k) for i in (low, high) for k in (low, high)]
    p, q = [points[at] for at in cut], [normals[at] for at in cut]
    middle = 0.25 * (p[0] + p[1] + p[2] + p[3])
    scatter, pull = np.zeros((6, *middle.shape[1:])), np.zeros_like(middle)
    pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
    for point, normal in zip(p, q, strict=True):
        height = _product(normal, point - middle)
        for row, (x, y) in enumerate(pairs):
            scatter[row] += normal[x] * normal[y]
        pull += normal * height
    scatter[:3] += 4.0 * STIFFNESS
    shift = _solved(scatter, pull)
    # within the cell, in shares of its edges
    edges = [0.5 * (p[2] + p[3] - p[0] - p[1]), 0.5 * (p[1] + p[3] - p[0] - p[2])]
    far = np.zeros(middle.shape[1:])
    for edge in edges:
        np.maximum(far, np.abs(_product(shift, edge) / _product(edge, edge)), out=far)
    return middle + shift * np.minimum(1.0, ROOM / np.maximum(far, 1e-9))


def _solved(matrix: Floats, right: Floats) -> Floats:
    """Solutions (3, …) of symmetric systems: xx, yy, zz, xy, xz, yz of the matrix (6, …), sides (3, …)."""
    xx, yy, zz, xy, xz, yz = matrix
    a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    d, e, f = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
    determinant = xx * a + xy * b + xz * c
    x, y, z = right
    solved = np.stack([a * x + b * y + c * z, b * x + d * y + e * z, c * x + e * y + f * z])
    return solved / determinant
