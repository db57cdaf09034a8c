"""Dual contouring: one vertex per sheet of the surface in a cell, one quadrilateral per crossed edge.

T. Ju et al., Dual contouring of Hermite data, 2002; vertices of smooth cells are then brought onto the cut
surface exactly, those of sharp ones stand where the tangent planes meet.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.crossings import Crossings, edge_key
from twin.cutting.grid import Grid
from twin.cutting.local import Tangents
from twin.cutting.sweep import Sweep
from twin.cutting.topology import CORNERS, EDGES, SHEET, SHEETS, edge_at

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SHARP = 0.03
"""Share of an eigenvalue of the normals' scatter above which a direction is an edge of its own: tangent
planes more than about 20° apart. Feed marks and generating flats meet at a few degrees: they are surface."""
MARGIN = 0.05
"""Share of a cell by which a vertex may stand outside its own."""


@dataclass(frozen=True, slots=True)
class Surface:
    """The closed surface of what was removed, normals outwards (into the material)."""

    vertices: Floats
    """(n, 3) [mm]"""
    faces: Ints
    """(m, 3)"""


@dataclass(frozen=True, slots=True)
class Cells:
    """The cells that the surface passes, ascending by id."""

    low: Ints
    """(n, 3) low corner"""
    case: Ints
    """(n,) corner signs as bits"""
    leaf: Ints
    """(n,) row of its leaf in `tangents`"""
    tangents: Tangents


def contour(sweep: Sweep, grid: Grid, cells: Cells, crossings: Crossings) -> Surface:
    """Mesh of the cut surface."""
    first = np.concatenate([[0], np.cumsum(SHEETS[cells.case])])
    vertices, normals, sharp = _fit(grid, cells, crossings, first)
    cell = np.repeat(np.arange(len(cells.case)), SHEETS[cells.case])
    smooth = np.flatnonzero(~sharp)
    leaf = cells.leaf[cell[smooth]]
    vertices[smooth] = _onto_surface(sweep, vertices[smooth], leaf, cells.tangents, min(grid.cell_mm))
    quads = _quads(grid, cells, crossings, first)
    return Surface(vertices, _triangles(vertices, normals, quads))


def _fit(
    grid: Grid, cells: Cells, crossings: Crossings, first: Ints
) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Vertices (n, 3) where the tangent planes of each sheet's crossings meet best, normals, sharpness."""
    rows, owners = [], []
    for number, (axis, low, _) in enumerate(EDGES):
        sheet = SHEET[cells.case, number]
        here = np.flatnonzero(sheet >= 0)
        rows.append(np.searchsorted(crossings.key, edge_key(grid, axis, cells.low[here] + CORNERS[low])))
        owners.append(first[here] + sheet[here])
    row, owner = np.concatenate(rows), np.concatenate(owners)
    n = first[-1]
    p, q = crossings.point[row], crossings.normal[row]

    def total(values: Floats) -> Floats:
        return np.asarray(np.bincount(owner, values, minlength=n), dtype=np.float64)

    count = total(np.ones(len(row)))
    middle = np.stack([total(p[:, x]) for x in range(3)], axis=1) / count[:, None]
    normal = np.stack([total(q[:, x]) for x in range(3)], axis=1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    height = np.einsum("nx,nx->n", q, p - middle[owner])
    scatter = np.empty((n, 3, 3))
    for x in range(3):
        for y in range(x, 3):
            scatter[:, x, y] = scatter[:, y, x] = total(q[:, x] * q[:, y])
    pull = np.stack([total(q[:, x] * height) for x in range(3)], axis=1)
    values, vectors = np.linalg.eigh(scatter)
    inverse = np.where(values > SHARP * values[:, 2:], 1.0 / np.maximum(values, 1e-12), 0.0)
    shift = np.einsum("nxe,ne,nye,ny->nx", vectors, inverse, vectors, pull)
    sharp = values[:, 1] > SHARP * values[:, 2]
    vertices = middle + shift
    # a vertex that leaves its cell may fold the mesh: fall back to the middle of the crossings
    cell = np.repeat(np.arange(len(cells.case)), SHEETS[cells.case])
    out = ~_free(grid, cells.low, cells.low[cell], vertices)
    vertices[out] = middle[out]
    return vertices, normal, sharp & ~out


def _free(grid: Grid, occupied: Ints, low: Ints, points: Floats) -> NDArray[np.bool_]:
    """Whether points lie in their own cells, or in a neighbour that the surface's signs do not show.

    A sharp corner may reach between the nodes of a cell without touching one; its vertex belongs there. A
    corner on the very border of two cells belongs to either: MARGIN.
    """
    nr, nt, nz = grid.cells
    r = np.interp(np.hypot(points[:, 0], points[:, 1]), grid.r, np.arange(nr + 1))
    turn = np.arctan2(points[:, 1], points[:, 0]) * (nt / (2 * math.pi)) - low[:, 1]
    turn -= nt * np.rint((turn - 0.5) / nt)
    z = np.interp(points[:, 2], grid.z, np.arange(nz + 1))
    off = np.stack([r - low[:, 0], turn, z - low[:, 2]], axis=1)
    own = ((off >= -MARGIN) & (off <= 1 + MARGIN)).all(axis=1)
    step = np.floor(off).astype(np.int64)
    there = low + step
    near = (np.abs(step) <= 1).all(axis=1) & ((there >= 0) & (there < [nr, 2 * nt, nz]))[:, [0, 2]].all(
        axis=1
    )
    ids = np.sort(grid.node_id(*occupied.T))
    mine = grid.node_id(np.clip(there[:, 0], 0, nr), there[:, 1], np.clip(there[:, 2], 0, nz))
    at = np.minimum(np.searchsorted(ids, mine), len(ids) - 1)
    return own | (near & (ids[at] != mine))


def _onto_surface(sweep: Sweep, points: Floats, leaf: Ints, tangents: Tangents, cell: float) -> Floats:
    """Two Newton steps towards the field's zero, none longer than half a cell."""
    points = points.copy()
    for _ in range(2):
        value, slope = sweep.deepest(points, leaf, tangents, gradient=True)
        square = np.einsum("nx,nx->n", slope, slope)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = -slope * (value / square)[:, None]
        length = np.linalg.norm(step, axis=1)
        near = np.isfinite(length) & (length < 0.5 * cell)
        points[near] += step[near]
    return points


def _quads(grid: Grid, cells: Cells, crossings: Crossings, first: Ints) -> Ints:
    """(n, 4) vertices around each crossed edge, counter-clockwise seen from the material."""
    nodes = np.int64(np.prod(grid.node_shape))
    axis, node_id = np.divmod(crossings.key, nodes)
    ids = grid.node_id(*cells.low.T)
    order = np.argsort(ids)
    ids = ids[order]
    i, rest = np.divmod(node_id, grid.sectors * len(grid.z))
    j, k = np.divmod(rest, len(grid.z))
    node = np.stack([i, j, k], axis=1)
    quads = np.empty((len(axis), 4), dtype=np.int64)
    for a in range(3):
        here = np.flatnonzero(axis == a)
        b, c = (a + 1) % 3, (a + 2) % 3
        for corner, (back_b, back_c) in enumerate([(1, 1), (0, 1), (0, 0), (1, 0)]):
            back = np.zeros(3, dtype=np.int64)
            back[b], back[c] = back_b, back_c
            cell = order[np.searchsorted(ids, grid.node_id(*(node[here] - back).T))]
            sheet = SHEET[cells.case[cell], edge_at(a, (int(back[0]), int(back[1]), int(back[2])))]
            quads[here, corner] = first[cell] + sheet
    quads[~crossings.rising] = quads[~crossings.rising][:, ::-1]
    return quads


def _triangles(vertices: Floats, normals: Floats, quads: Ints) -> Ints:
    """Split each quadrilateral along the diagonal that follows the surface better."""

    def sag(a: int, b: int) -> Floats:
        p, q = quads[:, a], quads[:, b]
        return np.abs(np.einsum("nx,nx->n", normals[p] - normals[q], vertices[q] - vertices[p]))

    first = (sag(0, 2) <= sag(1, 3))[:, None]
    one = np.where(first, quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    two = np.where(first, quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.vstack([one, two])
