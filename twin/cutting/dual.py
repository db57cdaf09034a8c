"""Dual contouring: one vertex per sheet of the surface in a cell, one quadrilateral per crossed edge.

T. Ju et al., Dual contouring of Hermite data, 2002; vertices of smooth cells are then brought onto the cut
surface exactly, those of ridges and edges onto all the bites that meet there.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from twin.cutting.closing import fanned
from twin.cutting.crossings import Crossings, edge_key
from twin.cutting.grid import Grid
from twin.cutting.landing import Around, Ground, landed
from twin.cutting.planes import FEATURE, meet, onto_edges, totals
from twin.cutting.sheets import NO_SHEETS, Sheets
from twin.cutting.sweep import Sweep
from twin.cutting.topology import CORNERS, EDGES, SHEET, SHEETS, edge_at

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MARGIN = 0.05
"""Share of a cell by which a vertex may stand outside its own."""


@dataclass(frozen=True, slots=True)
class Surface:
    """The closed surface of what was removed, normals outwards (into the material)."""

    vertices: Floats
    """(n, 3) [mm]"""
    faces: Ints
    """(m, 3)"""
    bite: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    """(n,) the bite that made each vertex, −1 = none; (0,) where nobody told"""
    instant: Floats = field(default_factory=lambda: np.zeros(0))
    """(n,) sample (fractional) of the tool's motion at which that was; (0,) where nobody told"""
    sheets: Sheets = NO_SHEETS
    """rectangles of it"""


@dataclass(frozen=True, slots=True)
class Cells:
    """The cells that the surface passes, ascending by id."""

    low: Ints
    """(n, 3) low corner"""
    case: Ints
    """(n,) corner signs as bits"""
    leaf: Ints
    """(n,) row of its leaf"""


def contour(ground: Ground, cells: Cells, crossings: Crossings) -> tuple[Surface, Ints]:
    """Mesh of the cut surface, and the leaf (n,) of each of its vertices."""
    sweep, grid = ground.sweep, ground.grid
    first = np.concatenate([[0], np.cumsum(SHEETS[cells.case])])
    sheets = _Sheets.of(grid, cells, crossings, first)
    vertices, normals, spread = _fit(grid, cells, crossings, sheets)
    # a vertex beside a closing face has planes that no bite makes: it stays
    closed = np.zeros(len(vertices), dtype=bool)
    closed[sheets.owner[sheets.bite < 0]] = True
    longest = 0.5 * min(grid.cell_mm)
    vertices = _onto_edges(sweep, vertices, (spread > FEATURE) & ~closed, sheets, longest)
    leaf = cells.leaf[sheets.cell]
    around = Around(sheets.owner, sheets.row, leaf)
    bite = np.full(len(vertices), -1, dtype=np.int64)
    vertices, bite[~closed] = landed(ground, vertices, np.flatnonzero(~closed), around, crossings)
    quads = _quads(grid, cells, crossings, first)
    fine, fans = fanned(grid, crossings, quads)
    faces = np.vstack([_triangles(vertices, normals, quads[fine]), fans])
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    return Surface(vertices[used], (np.cumsum(used) - 1)[faces], bite[used]), leaf[used]


@dataclass(frozen=True, slots=True)
class _Sheets:
    """The sheets of the surface in the cells, and the crossings on the border of each."""

    cell: Ints
    """(n,) row of each sheet's cell"""
    owner: Ints
    """(m,) sheet of each pair of sheet and crossing"""
    row: Ints
    """(m,) its crossing"""
    bite: Ints
    """(m,) what made the surface there, −1 = nothing"""

    @staticmethod
    def of(grid: Grid, cells: Cells, crossings: Crossings, first: Ints) -> "_Sheets":
        """`first` (n + 1,) counts the sheets of the cells before each cell."""
        rows, owners = [], []
        for number, (axis, low, _) in enumerate(EDGES):
            sheet = SHEET[cells.case, number]
            here = np.flatnonzero(sheet >= 0)
            rows.append(np.searchsorted(crossings.key, edge_key(grid, axis, cells.low[here] + CORNERS[low])))
            owners.append(first[here] + sheet[here])
        cell = np.repeat(np.arange(len(cells.case)), SHEETS[cells.case])
        row = np.concatenate(rows)
        return _Sheets(cell, np.concatenate(owners), row, crossings.bite[row])


def _fit(grid: Grid, cells: Cells, crossings: Crossings, sheets: _Sheets) -> tuple[Floats, Floats, Floats]:
    """Vertices (n, 3) where the tangent planes of each sheet's crossings meet best, normals, and how far
    the planes differ (n,), in terms of FEATURE."""
    owner, n = sheets.owner, len(sheets.cell)
    p, q = crossings.point[sheets.row], crossings.normal[sheets.row]
    count = totals(owner, np.ones(len(owner)), n)
    middle = np.stack([totals(owner, p[:, x], n) for x in range(3)], axis=1) / count[:, None]
    normal = np.stack([totals(owner, q[:, x], n) for x in range(3)], axis=1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    height = np.einsum("nx,nx->n", q, p - middle[owner])
    # what closes the removed solid in the air needs no planes
    made = totals(owner, (sheets.bite >= 0).astype(np.float64), n) > 0
    mine, number = made[owner], np.cumsum(made) - 1
    shift, values = np.zeros((n, 3)), np.zeros((n, 3))
    shift[made], values[made] = meet(number[owner[mine]], q[mine], height[mine], int(made.sum()))
    spread = values[:, 1] / np.maximum(values[:, 2], 1e-12)
    vertices = middle + shift
    # a vertex that leaves its cell may fold the mesh: fall back to the middle of the crossings
    out = ~_free(grid, cells.low, cells.low[sheets.cell], vertices)
    vertices[out] = middle[out]
    spread[out] = 0.0
    return vertices, normal, spread


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


def _onto_edges(
    sweep: Sweep, vertices: Floats, edgy: NDArray[np.bool_], sheets: _Sheets, longest: float
) -> Floats:
    """Bring some vertices to where the bites around them meet."""
    vertices = vertices.copy()
    number = np.cumsum(edgy) - 1
    mine = edgy[sheets.owner] & (sheets.bite >= 0)
    bites = sheets.bite.max() + 1
    owner, bite = np.divmod(np.unique(number[sheets.owner[mine]] * bites + sheets.bite[mine]), bites)
    vertices[edgy] = onto_edges(sweep, vertices[edgy], owner, bite, longest)
    return vertices


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
