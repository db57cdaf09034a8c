"""What is proved of all gaps: patch by patch, or by the templates that they are images of."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.local import Tangents, joined
from twin.cutting.pairs import leaders
from twin.cutting.regular.chart import Chart
from twin.cutting.regular.foreign import matter
from twin.cutting.regular.inside import prove_inside
from twin.cutting.regular.patches import Patches, patches
from twin.cutting.regular.templates import WHOLE, Screwed, Strips, prove_templates, strips_of
from twin.cutting.regular.tiles import Tiling, search
from twin.cutting.sweep import Images, Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class Proved:
    """For each cell of a chart the block that stands for it, and the bites that can be the deepest there."""

    chart: Chart
    tangents: Tangents
    block: Ints
    """(gaps, nu, nz)"""
    later: Ints
    """(gaps · nz,) bites by which a cell's own come after the block's, gap by gap like the following"""
    bites: Ints
    """(2, gaps · nz) first and last of the bites that there are of those"""
    turns: Floats
    """(9, gaps · nz) matrices, row by row, that turn the cells to where their blocks are"""
    moves: Floats
    """(3, gaps · nz) and what moves them there [mm]"""
    pairs: int
    """pairs of block and bite evaluated"""

    def images(self, points: Floats, column: Ints) -> Images:
        """Points (3, n) of cells in columns (n,), or of their corners, seen from the cells' blocks."""
        seen = self.turned(points, column)
        for x in range(3):
            seen[x] += self.moves[x].take(column)
        return Images(seen.T, self.later.take(column), self.bites.take(column, axis=1))

    def turned(self, ways: Floats, column: Ints) -> Floats:
        """Ways (3, n) of cells in columns (n,), seen from the cells' blocks."""
        seen = np.empty_like(ways)
        for x in range(3):
            np.multiply(self.turns[3 * x].take(column), ways[0], out=seen[x])
            for y in (1, 2):
                part = self.turns[3 * x + y].take(column)
                part *= ways[y]
                seen[x] += part
        return seen


def _motions(chart: Chart, home: Ints) -> tuple[Floats, Floats]:
    """Turns (9, gaps · nz) and moves (3, gaps · nz) of cells to their blocks."""
    indexing = chart.frame.indexing
    gap, k = np.indices(home.shape[1:])
    rise = chart.z[home[1]] + chart.lift[home[0]] - chart.z[k] - chart.lift[gap]
    angle = 2.0 * math.pi / chart.gaps * (home[0] - gap) + indexing.twist * rise
    cos, sin, zero, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    rotation, shift = chart.mount.rotation, chart.mount.translation
    # about the spindle's axis, which need not be the part's
    turns = np.stack([cos, -sin, zero, sin, cos, zero, zero, zero, one], axis=-1).reshape(-1, 3, 3)
    moves = turns @ shift
    moves[:, 2] += rise.ravel()
    turns = rotation.T @ turns @ rotation
    return np.ascontiguousarray(turns.reshape(-1, 9).T), np.ascontiguousarray(((moves - shift) @ rotation).T)


def prove(sweep: Sweep, chart: Chart, tiling: Tiling, thick: float, screwed: Screwed | None) -> Proved:
    """That the chart holds all of the cut. Raises IrregularError where that cannot be proved."""
    nu, nz = chart.cells
    gap, column = np.indices((chart.gaps, nz))
    block = np.zeros((chart.gaps, nu, nz), dtype=np.int64)
    home, later = np.stack([gap, column]), np.zeros((chart.gaps, nz), dtype=np.int64)
    bites = np.stack([later, later + sweep.count - 1])
    whole = np.arange(chart.gaps)
    rest = patches(nu, whole, np.tile([0, nz], (chart.gaps, 1)), (WHOLE, WHOLE))
    found: list[Tangents] = []
    pairs = 0
    if screwed is not None:
        templates = prove_templates(sweep, chart, tiling, thick, screwed)
        found.append(templates.tangents)
        pairs += templates.pairs
        strips = strips_of(sweep, chart, screwed, templates, thick)
        steady, layout, field = screwed.steady, screwed.layout, sweep.fields[-1]
        _fill(block, templates.patch, 0)
        g, k = np.nonzero(_cells(strips, chart, strips.image))
        home[:, g, k] = layout.template[g], layout.column(g, k)
        block[g, :, k] = block[home[0, g, k], :, home[1, g, k]]
        later[g, k] = layout.later(g, layout.strip(g, k)) * steady.per_turn * field.bites
        first = sweep.count - field.count
        ends = first + np.array([steady.near[0] * field.bites, (steady.near[1] + 1) * field.bites - 1])
        bites[:, g, k] = ends[:, None]
        judges = _judges(templates.tangents)[block] + later[:, None]
        judges[(judges < ends[0]) | (judges > ends[1])] = -1
        sizes = tiling.sizes(thick, finest=False)
        image = strips.image & ~matter(
            sweep, chart, strips.patch, passes=strips.foreign, judges=judges, sizes=sizes
        )
        g, k = np.nonzero(~_cells(strips, chart, image))
        home[:, g, k] = g, k
        later[g, k] = 0
        bites[:, g, k] = np.array([0, sweep.count - 1])[:, None]
        rest = strips.patch.of(np.flatnonzero(~image))
    if len(rest.gap):
        sizes = tiling.sizes(thick, finest=False)
        patch, held = search(sweep, chart, patches(nu, rest.gap, rest.k, sizes[0][0]), sizes)
        prove_inside(sweep, chart, patch, held.tangents, thick)
        _fill(block, patch, sum(len(t.middle) for t in found))
        found.append(held.tangents)
        pairs += held.pairs
    turns, moves = _motions(chart, home)
    return Proved(
        chart=chart,
        tangents=joined(found),
        block=block,
        later=later.ravel(),
        bites=bites.reshape(2, -1),
        turns=turns,
        moves=moves,
        pairs=pairs,
    )


def _cells(strips: Strips, chart: Chart, chosen: Bools) -> Bools:
    """(gaps, nz) the columns of some strips."""
    found = np.zeros((chart.gaps, chart.cells[1]), dtype=bool)
    for gap, (low, high) in zip(strips.patch.gap[chosen], strips.patch.k[chosen], strict=True):
        found[gap, low:high] = True
    return found


def _judges(tangents: Tangents) -> Ints:
    """(n,) the bite of each block that stands highest in its middle."""
    return tangents.lists.bites[leaders(tangents.plane[0], tangents.lists.start)[1]]


def _fill(block: Ints, patch: Patches, first: int) -> None:
    """Number the cells of patches by their patch, from `first` on."""
    across, along = np.diff(patch.i, axis=1)[:, 0], np.diff(patch.k, axis=1)[:, 0]
    owner = np.repeat(np.arange(len(across)), across * along)
    cell = np.arange(len(owner)) - np.repeat(np.cumsum(across * along) - across * along, across * along)
    i, k = np.divmod(cell, along[owner])
    block[patch.gap[owner], patch.i[owner, 0] + i, patch.k[owner, 0] + k] = first + owner
