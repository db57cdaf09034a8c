"""The cut surface in a proved chart: exact crossings on all rays, vertices where their planes meet."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.pairs import in_parallel
from twin.cutting.regular.proved import Proved
from twin.cutting.sweep import Images, Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

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
    shape = chart.gaps, nu + 1, nz + 1
    points, normals = np.zeros((2, math.prod(shape), 3))

    def cross(part: slice) -> None:
        points[part], normals[part] = _crossings(sweep, proved, _Nodes.of(proved, shape, part), thick)

    in_parallel(cross, _chunks(len(points)))
    points, normals = points.reshape(*shape, 3), normals.reshape(*shape, 3)
    vertices = np.ascontiguousarray(_meet(points, normals).reshape(-1, 3))
    bite, instant = np.zeros(len(vertices), dtype=np.int64), np.zeros(len(vertices))

    def settle(part: slice) -> None:
        nodes = _Nodes.of(proved, (chart.gaps, nu, nz), part)
        vertices[part], bite[part], instant[part] = _settled(sweep, proved, nodes, vertices[part])

    in_parallel(settle, _chunks(len(vertices)))
    vertices = vertices.reshape(chart.gaps, nu, nz, 3)
    # four vertices stand around a crossing: split them along the diagonal that comes nearer to it
    inner = points[:, 1:-1, 1:-1], normals[:, 1:-1, 1:-1]
    one = _off(*inner, vertices[:, :-1, :-1] + vertices[:, 1:, 1:])
    other = _off(*inner, vertices[:, 1:, :-1] + vertices[:, :-1, 1:])
    shape = vertices.shape[:3]
    return Skin(vertices, one < other, bite.reshape(shape), instant.reshape(shape))


def _chunks(count: int) -> Iterator[slice]:
    return (slice(low, min(low + CHUNK, count)) for low in range(0, count, CHUNK))


@dataclass(frozen=True, slots=True)
class _Nodes:
    """Some nodes of a chart, or its cells by their first nodes."""

    gap: Ints
    """(n,) like the following"""
    i: Ints
    k: Ints
    cell: Ints
    """along the gap, of a cell that holds the node"""
    block: Ints
    """of that cell"""

    @classmethod
    def of(cls, proved: Proved, shape: tuple[int, int, int], part: slice) -> "_Nodes":
        """A slice of the nodes of an array."""
        nu, nz = proved.chart.cells
        gap, i, k = np.unravel_index(np.arange(part.start, part.stop), shape)
        cell = np.minimum(k, nz - 1)
        return cls(gap, i, k, cell, proved.block[gap, np.minimum(i, nu - 1), cell])

    def images(self, proved: Proved, points: Floats, rows: Ints) -> Images:
        """Points of some of the nodes' cells, seen from the cells' blocks."""
        return proved.images(points, self.gap[rows], self.cell[rows])


def _settled(sweep: Sweep, proved: Proved, nodes: _Nodes, guess: Floats) -> tuple[Floats, Ints, Floats]:
    """Vertices (n, 3) brought onto the surface, the bites (n,) that make it there, and when."""
    vertices, bite, instant = guess.copy(), np.zeros(len(guess), dtype=np.int64), np.zeros(len(guess))
    left = np.arange(len(vertices))
    for _ in range(ROUNDS):
        at = vertices[left]
        found = sweep.deepest(
            at, nodes.block[left], proved.tangents, gradient=True, images=nodes.images(proved, at, left)
        )
        bite[left], instant[left] = found.bite, found.instant
        step = found.depth / np.einsum("nx,nx->n", found.gradient, found.gradient)
        vertices[left] = at - step[:, None] * found.gradient
        left = left[np.abs(step) > SETTLED]
        if not len(left):
            break
    return vertices, bite, instant


def _crossings(sweep: Sweep, proved: Proved, nodes: _Nodes, thick: float) -> tuple[Floats, Floats]:
    """Where the rays of nodes cross the surface, (n, 3), and the unit normals into the material."""
    start, along = proved.chart.at(nodes.gap, nodes.i, nodes.k, np.zeros(1))
    tau = _first_planes(proved, nodes, (start, along), thick)
    slope = np.zeros_like(start)
    left = np.arange(len(start))
    for _ in range(ROUNDS):
        at = start[left] + tau[left, None] * along[left]
        found = sweep.deepest(
            at, nodes.block[left], proved.tangents, gradient=True, images=nodes.images(proved, at, left)
        )
        slope[left] = found.gradient
        step = found.depth / np.minimum(np.einsum("nx,nx->n", found.gradient, along[left]), -1e-3)
        tau[left] = np.clip(tau[left] - step, -thick, thick)
        left = left[np.abs(step) > NEAR]
        if not len(left):
            break
    slope /= -np.linalg.norm(slope, axis=1, keepdims=True)
    return start + tau[:, None] * along, slope


def _first_planes(proved: Proved, nodes: _Nodes, rays: tuple[Floats, Floats], thick: float) -> Floats:
    """Ways (n,) along rays to the first of the bites' tangent planes, seen from the tooth."""
    tangents, lists = proved.tangents, proved.tangents.lists
    start, along = rays
    whole = np.arange(len(start))
    # in the frame of the blocks the rays of all images are those of the template
    seen = nodes.images(proved, start, whole).points
    ahead = proved.turned(along, nodes.gap, nodes.cell)
    length = np.diff(lists.start)[nodes.block]
    pairs = lists.pairs(nodes.block)
    owner = np.repeat(whole, length)
    plane = tangents.plane.take(pairs, axis=1)
    way = seen - tangents.middle[nodes.block]
    level, rate = plane[0], np.zeros(len(pairs))
    for x in range(3):
        level += plane[1 + x] * way[:, x].take(owner)
        rate += plane[1 + x] * ahead[:, x].take(owner)
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.where(rate < 0, -level / rate, -thick)
    found = np.maximum.reduceat(root, np.concatenate([[0], np.cumsum(length)[:-1]]))
    return np.clip(found, -thick, thick)


def _off(points: Floats, normals: Floats, ends: Floats) -> Floats:
    """How far the middles of some edges, given as the sums of their `ends`, stand off planes."""
    return np.abs(np.einsum("...x,...x->...", normals, 0.5 * ends - points))


def _meet(points: Floats, normals: Floats) -> Floats:
    """Where the planes at the corners of each cell meet best, within the cell: (gaps, nu, nz, 3)."""
    corners = [(a, b) for a in (0, 1) for b in (0, 1)]
    cut = [(slice(None), slice(a, a - 1 or None), slice(b, b - 1 or None)) for a, b in corners]
    p, q = [points[at] for at in cut], [normals[at] for at in cut]
    middle = np.mean(p, axis=0)
    scatter = np.zeros((6, *middle.shape[:-1]))
    pull = np.zeros((3, *middle.shape[:-1]))
    pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
    for point, normal in zip(p, q, strict=True):
        height = np.einsum("...x,...x->...", normal, point - middle)
        for row, (x, y) in enumerate(pairs):
            scatter[row] += normal[..., x] * normal[..., y]
        pull += np.moveaxis(normal * height[..., None], -1, 0)
    scatter[:3] += 4.0 * STIFFNESS
    shift = _solved(scatter, pull)
    # within the cell, in shares of its edges
    edges = [0.5 * (p[2] + p[3] - p[0] - p[1]), 0.5 * (p[1] + p[3] - p[0] - p[2])]
    far = np.zeros(middle.shape[:-1])
    for edge in edges:
        share = np.einsum("...x,...x->...", shift, edge) / np.einsum("...x,...x->...", edge, edge)
        np.maximum(far, np.abs(share), out=far)
    return middle + shift * np.minimum(1.0, ROOM / np.maximum(far, 1e-9))[..., None]


def _solved(matrix: Floats, right: Floats) -> Floats:
    """Solutions (…, 3) of symmetric systems: xx, yy, zz, xy, xz, yz of the matrix (6, …), sides (3, …)."""
    xx, yy, zz, xy, xz, yz = matrix
    a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    d, e, f = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
    determinant = xx * a + xy * b + xz * c
    x, y, z = right
    return (
        np.stack([a * x + b * y + c * z, b * x + d * y + e * z, c * x + e * y + f * z], axis=-1)
        / determinant[..., None]
    )
