"""What is proved of a few stretches of gaps on behalf of all their images on the screw of a motion."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.engagement import StockCylinder, sway
from twin.cutting.field import DepthField
from twin.cutting.local import Tangents
from twin.cutting.pairs import Candidates
from twin.cutting.regular.chart import Chart
from twin.cutting.regular.inside import prove_inside
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.patches import Patches, blocks, columns, patches
from twin.cutting.regular.screw import Layout
from twin.cutting.regular.steady import SAMPLES, Steady
from twin.cutting.regular.tiles import Tiling, search
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

WHOLE = 1 << 30
"""Cells of a patch that is as large as its gap."""
DOUBLINGS = 4
"""of the way of a motion without end, until both its ends are clear of the templates"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Screwed:
    """A steady motion, and the charts laid out on its screw."""

    steady: Steady
    layout: Layout


@dataclass(frozen=True, slots=True, kw_only=True)
class Templates:
    """Patches of the templates, with the bites that can be the deepest there."""

    patch: Patches
    tangents: Tangents
    """with bites numbered as in the sweep, and on beyond both its ends"""
    passes: tuple[int, int]
    """first and last of them, as numbers of the last tool's passes"""
    room: float
    """that was left in all bounds for images that are a little off [mm]"""
    pairs: int
    """pairs of block and bite evaluated"""


def prove_templates(sweep: Sweep, chart: Chart, tiling: Tiling, thick: float, screwed: Screwed) -> Templates:
    """In the steady motion without end: as `prove`, for the templates of a layout.

    Raises IrregularError where it does not hold.
    """
    steady, layout, nu = screwed.steady, screwed.layout, chart.cells[0]
    field = sweep.fields[-1]
    if not isinstance(field, DepthField):
        raise IrregularError("not hobbed")
    gap, k = layout.templates
    middle, radius = columns(blocks(chart, patches(nu, gap, k, (WHOLE, WHOLE)), thick))
    z = float((middle[:, 2] - radius).min()), float((middle[:, 2] + radius).max())
    own = _endless(steady, field, float((np.linalg.norm(middle[:, :2], axis=1) + radius).max()), z)
    room = steady.margin(layout.most_turns)
    endless = Sweep((own,), room)
    sizes = tiling.sizes(thick, finest=True)
    patch, held = search(endless, chart, patches(nu, gap, k, sizes[0][0]), sizes)
    prove_inside(endless, chart, patch, held.tangents, thick)
    lists, passes = _renumbered(held.tangents.lists, own, field, steady.number(float(own.passes.angle[0])))
    before = sweep.count - field.count
    lists = Candidates(lists.start, lists.bites + before)
    tangents = Tangents(
        lists, held.tangents.middle, held.tangents.radius, held.tangents.plane, held.tangents.over
    )
    return Templates(patch=patch, tangents=tangents, passes=passes, room=room, pairs=held.pairs)


@dataclass(frozen=True, slots=True, kw_only=True)
class Strips:
    """The strips of all gaps, and what comes near them besides what their templates show."""

    patch: Patches
    image: Bools
    """(n,) whether all that can be the deepest in its template has been made at a strip, too"""
    foreign: tuple[tuple[Ints, ...], ...]
    """for each strip and each tool the passes near it that do not repeat"""


def strips_of(sweep: Sweep, chart: Chart, screwed: Screwed, proved: Templates, thick: float) -> Strips:
    """The strips of all gaps."""
    steady, layout = screwed.steady, screwed.layout
    nu, nz = chart.cells
    gap, k = np.indices((chart.gaps, nz))
    strip = layout.strip(gap, k)
    g, low = np.nonzero(np.diff(strip, axis=1, prepend=strip[:, :1] - 1))
    last = np.append(g[1:] != g[:-1], True)
    high = np.where(last, nz, np.append(low[1:], nz))
    patch = patches(nu, g, np.stack([low, high], axis=1), (WHOLE, WHOLE))
    later = layout.later(g, strip[g, low]) * steady.per_turn
    needed = np.array(proved.passes) + later[:, None]
    made = ((needed >= steady.made[0]) & (needed <= steady.made[1])).all(axis=1)
    middle, radius = columns(blocks(chart, patch, thick))
    others: list[Ints | None] = [None] * len(sweep.fields)
    passes = np.arange(sweep.fields[-1].passes.count)
    others[-1] = passes[(passes < steady.near[0]) | (passes > steady.near[1])]
    foreign = [
        tuple(f.near(point, float(reach), among) for f, among in zip(sweep.fields, others, strict=True))
        for point, reach in zip(middle, radius + 2.0 * proved.room, strict=True)
    ]
    return Strips(patch=patch, image=np.asarray(made), foreign=tuple(foreign))


def _endless(steady: Steady, field: DepthField, radius: float, z: tuple[float, float]) -> DepthField:
    """The field of a steady motion without end for stock within `radius` and between z [mm]."""
    cutter, motion = field.cutter, steady.source
    stock = StockCylinder.around(motion.mount, radius, z)
    axis = motion.basis[2]
    far = 0.5 * (stock.z_high - stock.z_low) + sum(sway(cutter, motion, stock)[1:])
    far += cutter.radius + stock.radius * abs(axis[2]) / math.hypot(axis[0], axis[1])
    for _ in range(DOUBLINGS):
        made = DepthField(cutter, steady.endless(0.5 * (stock.z_low + stock.z_high), far), radius, z)
        at = made.passes.at
        ends = len(steady.angle)
        if made.passes.count > ends and at[0] > SAMPLES and at[-1] < made.samples - SAMPLES:
            return made
        far *= 2.0
    raise IrregularError("the tool does not leave the blank")


def _renumbered(
    lists: Candidates, own: DepthField, field: DepthField, first: int
) -> tuple[Candidates, tuple[int, int]]:
    """Lists of one field's bites as another numbers them, whose pass `first` is the one's pass 0."""
    index, number = np.divmod(lists.bites, own.bites)
    pieces = len(field.cutter.profile.pieces)
    land = number == own.bites - 1 if own.has_land else np.zeros(len(number), dtype=bool)
    tooth = own.tooth[number] - field.tooth[0]
    there = np.where(land, field.bites - 1, tooth * pieces + number % pieces)
    known = (there >= 0) & (there < field.bites - field.has_land) | land
    if not known.all():
        raise IrregularError("a tooth reaches a template that does not reach the blank")
    bites = (first + index) * field.bites + there
    return Candidates(lists.start, bites), (first + int(index.min()), first + int(index.max()))
