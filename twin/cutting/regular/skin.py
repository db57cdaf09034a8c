"""The cut surface in a proved chart: exact crossings on all rays, vertices where their planes meet."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.local import Tangents
from twin.cutting.pairs import batches, in_parallel
from twin.cutting.regular.chart import Chart
from twin.cutting.regular.tiles import Patches
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SETTLED = 2e-4
"""[mm] below which one Newton step ends on the surface: what is left is its square over a radius, or, where
another bite takes over, a share of it."""
ROUNDS = 5
"""of Newton's method"""
STIFFNESS = 1e-6
"""What a vertex's way from the middle costs, against its distance from the planes, both squared: feed marks
and generating flats differ by a hundredth of a radian."""
ROOM = 0.5
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


def skin(sweep: Sweep, chart: Chart, patch: Patches, tangents: Tangents, thick: float) -> Skin:
    """The surface on patches, all of one size, with the bites that can make it there."""
    nu, nz = chart.cells
    home = _homes(chart, patch)
    points, normals = _crossings(sweep, chart, home, tangents, thick)
    guess = _meet(points, normals)
    block = home.reshape(-1)
    vertices = np.ascontiguousarray(guess.reshape(-1, 3))
    bite = np.zeros(len(vertices), dtype=np.int64)
    left = np.arange(len(vertices))
    for _ in range(ROUNDS):
        found = sweep.deepest(vertices[left], block[left], tangents, gradient=True)
        bite[left] = found.bite
        step = found.depth / np.einsum("nx,nx->n", found.gradient, found.gradient)
        vertices[left] -= step[:, None] * found.gradient
        left = left[np.abs(step) > SETTLED]
    vertices = vertices.reshape(chart.gaps, nu, nz, 3)
    # four vertices stand around a crossing: split them along the diagonal that comes nearer to it
    inner = points[:, 1:-1, 1:-1], normals[:, 1:-1, 1:-1]
    one = _off(*inner, vertices[:, :-1, :-1] + vertices[:, 1:, 1:])
    other = _off(*inner, vertices[:, 1:, :-1] + vertices[:, :-1, 1:])
    return Skin(vertices, one < other, bite.reshape(vertices.shape[:3]))


def _off(points: Floats, normals: Floats, ends: Floats) -> Floats:
    """How far the middles of some edges, given as the sums of their `ends`, stand off planes."""
    return np.abs(np.einsum("...x,...x->...", normals, 0.5 * ends - points))


def _homes(chart: Chart, patch: Patches) -> Ints:
    """The patch (gaps, nu, nz) of each cell."""
    nu, nz = chart.cells
    size = int((patch.i[:, 1] - patch.i[:, 0]).max()), int((patch.k[:, 1] - patch.k[:, 0]).max())
    home = np.zeros((chart.gaps, nu // size[0], nz // size[1]), dtype=np.int64)
    home[patch.gap, patch.i[:, 0] // size[0], patch.k[:, 0] // size[1]] = np.arange(len(patch.gap))
    return home.repeat(size[0], axis=1).repeat(size[1], axis=2)


def _crossings(
    sweep: Sweep, chart: Chart, home: Ints, tangents: Tangents, thick: float
) -> tuple[Floats, Floats]:
    """Where the rays cross the surface, (gaps, nu + 1, nz + 1, 3), and the unit normals into the material."""
    nu, nz = chart.cells
    shape = (chart.gaps, nu + 1, nz + 1)
    gap, i, k = (v.reshape(-1) for v in np.indices(shape))
    block = home[gap, np.minimum(i, nu - 1), np.minimum(k, nz - 1)]
    start, along = chart.at(gap, i, k, np.zeros(1))
    lists = tangents.lists
    tau = np.zeros(len(block))
    length = np.diff(lists.start)[block]

    def guess(part: slice) -> None:
        """Where the first of the bites' tangent planes, seen from the tooth, is crossed."""
        own = block[part]
        pairs = lists.pairs(own)
        owner = np.repeat(np.arange(len(own)), length[part])
        plane = tangents.plane.take(pairs, axis=1)
        way = start[part] - tangents.middle[own]
        level, rate = plane[0], np.zeros(len(pairs))
        for x in range(3):
            level += plane[1 + x] * way[:, x].take(owner)
            rate += plane[1 + x] * along[part, x].take(owner)
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.where(rate < 0, -level / rate, -thick)
        tau[part] = np.maximum.reduceat(root, np.concatenate([[0], np.cumsum(length[part])[:-1]]))

    in_parallel(guess, batches(np.concatenate([[0], np.cumsum(length)]), 1 << 15))
    np.clip(tau, -thick, thick, out=tau)
    slope = np.zeros_like(start)
    left = np.arange(len(block))
    for _ in range(ROUNDS):
        found = sweep.deepest(
            start[left] + tau[left, None] * along[left], block[left], tangents, gradient=True
        )
        slope[left] = found.gradient
        step = found.depth / np.minimum(np.einsum("nx,nx->n", found.gradient, along[left]), -1e-3)
        tau[left] = np.clip(tau[left] - step, -thick, thick)
        left = left[np.abs(step) > SETTLED]
    slope /= -np.linalg.norm(slope, axis=1, keepdims=True)
    return (start + tau[:, None] * along).reshape(*shape, 3), slope.reshape(*shape, 3)


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
