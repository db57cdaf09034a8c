"""What bites own of cells: of each place the first that removes it.

Each cell stands for what a line through its middle passes. Where its faces have different owners, the line
goes the way that the owner's surface is crossed the steepest, in cells: along r, the angle, or z.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blocks import FINEST, Blocks
from twin.cutting.cells import Cells, Pieces, joined, points
from twin.cutting.changes import Lines, met
from twin.cutting.first import NOBODY, first_owners
from twin.cutting.metal import polar
from twin.cutting.section import Section
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

AROUND = 1
TOGETHER = 1 << 16
"""cells at a time"""


def owned(sweep: Sweep, cells: Cells, blocks: Blocks) -> Iterator[Pieces]:
    """What bites own of the cells of a slab's blocks, some cells at a time."""
    cell, rows = _cells(cells, blocks)
    faces = _faces(sweep, cells, blocks, cell, rows)
    for at in range(0, len(cell), TOGETHER):
        part = slice(at, at + TOGETHER)
        yield _owned(sweep, cells, blocks, (cell[part], rows[part], faces[part]))


def _owned(sweep: Sweep, cells: Cells, blocks: Blocks, part: tuple[Ints, Ints, Ints]) -> Pieces:
    cell, rows, faces = part
    low, high = cells.edges(cell)
    same = (faces == faces[:, :1]).all(axis=1)
    axis = np.full(len(cell), AROUND)
    mixed = np.flatnonzero(~same & cells.whole[cell[:, 0], cell[:, 2]])
    axis[mixed] = _steepest(sweep, cells, 0.5 * (low + high)[mixed], (high - low)[mixed], faces[mixed])
    if cells.section is not None:
        alone = np.flatnonzero(same & cells.whole[cell[:, 0], cell[:, 2]])
        axis[alone] = _across(cells.section, 0.5 * (low + high)[alone])
    # the line through the middle, between the faces of its axis
    each = np.arange(len(cell))
    start, end = 0.5 * (low + high), 0.5 * (low + high)
    start[each, axis], end[each, axis] = low[each, axis], high[each, axis]
    a, b = faces[each, axis], faces[each, 3 + axis]
    i, k = cell[:, 0], cell[:, 2]
    volume = cells.weight[i, k] * (2.0 * np.pi / cells.grid.sectors)
    one = np.flatnonzero((a == b) & (a != NOBODY))
    alone = Pieces(start[one], end[one], a[one], volume[one])
    two = np.flatnonzero(a != b)
    lines = Lines(low=start[two], high=end[two], axis=axis[two], a=a[two], b=b[two], row=rows[two])
    line, t0, t1, bite = met(sweep, blocks, lines)
    found = Pieces(
        lines.at(line, t0),
        lines.at(line, t1),
        bite,
        volume[two[line]] * (t1 - t0) * _thick(lines, line, t0, t1),
    )
    return joined(alone, found.of((t1 > t0) & (bite != NOBODY)))


def _thick(lines: Lines, line: Ints, t0: Floats, t1: Floats) -> Floats:
    """(n,) by which a piece from `t0` to `t1` of a line counts, for the whole of it to count 1."""
    axis = lines.axis[line]
    each = np.arange(len(line))
    low, high = lines.low[line][each, axis], lines.high[line][each, axis]
    # rings grow with their radius
    grow = np.where(axis == 0, (t0 + t1) / np.where(axis == 0, low + high, 1.0), 1.0)
    return grow / (high - low)


def _cells(cells: Cells, blocks: Blocks) -> tuple[Ints, Ints]:
    """The cells (n, 3) that lie in blocks and in the blank, and their blocks (n,)."""
    steps = np.stack(np.meshgrid(*[np.arange(FINEST)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    cell = (blocks.low[:, None] + steps).reshape(-1, 3)
    rows = np.repeat(np.arange(len(blocks.low)), len(steps))
    nr, sectors, nz = cells.grid.cells
    inside = (cell[:, 0] < nr) & (cell[:, 2] < nz)
    cell, rows = cell[inside], rows[inside]
    cell[:, 1] %= sectors
    some = cells.weight[cell[:, 0], cell[:, 2]] > 0
    return cell[some], rows[some]


def _faces(sweep: Sweep, cells: Cells, blocks: Blocks, cell: Ints, rows: Ints) -> Ints:
    """(n, 6) owners of the middles of the cells' faces: low ones across r, angle, z, then high ones.

    A face that two cells have is asked for once; where its other cell has no block, nobody comes.
    """
    low, high = cells.edges(cell)
    grid = cells.grid
    shape = (len(grid.r), grid.sectors, len(grid.z))
    first_k = int(cell[:, 2].min(initial=0))
    last = cell + 1 == [len(grid.r) - 1, -1, int(cell[:, 2].max(initial=0)) + 1]
    faces = np.full((len(cell), 6), NOBODY)
    owner = np.full(
        (shape[0], shape[1], int(cell[:, 2].max(initial=0)) + 2 - first_k), NOBODY, dtype=np.int64
    )
    for axis in range(3):
        at = 0.5 * (low + high)
        at[:, axis] = low[:, axis]
        owner[:] = NOBODY
        i, j, k = cell[:, 0], cell[:, 1], cell[:, 2] - first_k
        owner[i, j, k] = first_owners(sweep, blocks, points(at), rows)
        end = np.flatnonzero(last[:, axis])
        at[end, axis] = high[end, axis]
        over = first_owners(sweep, blocks, points(at[end]), rows[end])
        step = np.eye(3, dtype=np.int64)[axis]
        faces[:, axis] = owner[i, j, k]
        faces[:, 3 + axis] = owner[i + step[0], (j + step[1]) % grid.sectors, k + step[2]]
        faces[end, 3 + axis] = over
    return faces


def _across(section: Section, middle: Floats) -> Ints:
    """(n,) r or the angle, whichever crosses the outline more, in cells of the same owner."""
    _, slope = section.beyond(points(middle))
    return np.where(np.abs(polar(slope, middle[:, 1])[:, 0]) > math.sqrt(0.5), 0, AROUND)


def _steepest(sweep: Sweep, cells: Cells, middle: Floats, size: Floats, faces: Ints) -> Ints:
    """(n,) the axis along which the first owner's surface crosses the most of cells (n, 3)."""
    none = np.iinfo(np.int64).max
    first = np.where(faces == NOBODY, none, faces).min(axis=1)
    slope = polar(sweep.evaluate(points(middle), first, gradient=True).gradient, middle[:, 1])
    size = size * np.stack([np.ones(len(size)), middle[:, 0], np.ones(len(size))], axis=1)
    if cells.section is not None:
        # it bounds the angle and r alone
        size[:, 2] = 0.0
    return np.abs(slope * size).argmax(axis=1)
