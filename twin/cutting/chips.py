"""The chips: what each tooth takes away as it passes, in the order of time.

The blank is divided into cells. Of each place the first bite that comes deeper owns it: true unions, whatever
the program does. A cell counts by a line through its middle, on which each bite's share is found; what a bite
owns, over all cells, is its chip.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.blocks import Blocks
from twin.cutting.cells import Cells, points
from twin.cutting.fields import tool_field
from twin.cutting.meeting import Meeting
from twin.cutting.motion import CutterMotion
from twin.cutting.owners import owned
from twin.cutting.sweep import Sweep
from twin.cutting.thickness import Places, climbed
from twin.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Progress = Callable[[str, float], None]

PLACES = 8_000_000
"""Cells that a run has where no resolution is asked for; it may have eight times as many."""
FINE = 50.0
"""Cells across in the pitch of a hob's teeth, or in the width of another tool's edge"""
AROUND = 1.5
"""Width of the cells of a hobbed part around, for one across"""
LONG = 3.0
"""and along the axis: a hob's chips are as long as it is wide"""
SIMPSON = np.array([1.0, 4.0, 1.0]) / 6.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Chips:
    """One row for each tooth that took something away as it passed, in the order of time.

    Twice the resolution changes volume and thickness by less than 2 % where a chip has more than a hundredth
    of the mean volume (docs/kernel.md); the smallest have a few cells, or none.
    """

    time_s: Floats
    """(n,) when it took the first of it"""
    stretch: Ints
    """(n,) which of the run's stretches with one tool, from 0"""
    turn: Ints
    """(n,) which pass of that stretch, from 0"""
    tooth: Ints
    """(n,) number of the tooth along its edge; 0 also for the land between the teeth"""
    volume_mm3: Floats
    """(n,)"""
    thickness_max_mm: Floats
    """(n,) farthest that the material stood above the edge, in its rake plane"""
    thickness_mean_mm: Floats
    """(n,) twice the material's mean height above the edge: of a chip of even thickness, its thickness"""
    width_mm: Floats
    """(n,) length of the edge that took something"""
    resolution_mm: float
    """size of the cells across"""

    @property
    def total_mm3(self) -> float:
        """Volume of all chips."""
        return float(self.volume_mm3.sum())

    def columns(self) -> dict[str, NDArray]:
        """The columns by name, for a file."""
        return {f.name: np.asarray(getattr(self, f.name)) for f in fields(self)}


@dataclass(frozen=True, slots=True)
class _Shares:
    """Pieces of cells, each with the bite that was the first to remove it."""

    bite: Ints
    """(n,) numbered through all tools"""
    volume: Floats
    height: Floats
    """(n,) mean, above the edge [mm]"""
    largest: Floats
    """(n,) of it, then the highest that is near; 0 where that was not looked for [mm]"""
    instant: Floats
    foot: Floats
    """(n, 2) where on the edge (s, rho) the middle lies [mm]"""
    slope: Floats
    """(n,) way along the edge for each square of a lattice over (s, rho) that it crosses, in its sides"""

    def together(self, side: float) -> tuple["_Shares", Ints]:
        """Those of the same bite whose feet lie in the same square of that side as one; and which of each is
        the highest."""
        square = np.floor(self.foot / side)
        order = np.lexsort((-self.largest, square[:, 1], square[:, 0], self.bite))
        row = np.column_stack([self.bite, square])[order]
        first = np.flatnonzero(np.append(True, (row[1:] != row[:-1]).any(axis=1))[: len(row)])
        if not len(first):
            return self, first
        volume = np.add.reduceat(self.volume[order], first)
        top = order[first]
        one = _Shares(
            self.bite[top],
            volume,
            np.add.reduceat((self.volume * self.height)[order], first) / volume,
            self.largest[top],
            np.minimum.reduceat(self.instant[order], first),
            self.foot[top],
            self.slope[top],
        )
        return one, top


_NONE = _Shares(np.zeros(0, dtype=np.int64), *np.zeros((4, 0)), foot=np.zeros((0, 2)), slope=np.zeros(0))


def chips(
    blank: Blank,
    tools: tuple[tuple[Cutter, CutterMotion], ...],
    *,
    resolution_mm: float | None = None,
    progress: Progress = lambda _stage, _share: None,
) -> Chips:
    """The chips of a cut; `resolution_mm` is the size of the cells across.

    Raises InputError for a resolution that is none, or would need too much memory.
    """
    step = _step(blank, tools, resolution_mm)
    # the coarsest blocks are sixths of a turn at most, and their hulls stand out of the blank
    hull = blank.radius / math.cos(math.pi / 6.0)
    sweep = Sweep(tuple(tool_field(c, m, hull, blank.z_range) for c, m in tools))
    around, along = _wide(tools)
    cells = Cells.of(blank, step, around=step * around, along=step * along)
    shares: list[_Shares] = []
    slabs = list(cells.slabs()) if sweep.passes else []
    for number, low in enumerate(slabs):
        progress("chips", number / len(slabs))
        blocks = Blocks.of(sweep, cells.grid, low)
        shares.append(_shares(sweep, blank, cells, blocks, 2.0 * step))
    progress("chips", 1.0)
    return _summed(sweep, tools, shares, step)


def _step(blank: Blank, tools: tuple[tuple[Cutter, CutterMotion], ...], resolution: float | None) -> float:
    """The resolution asked for, or what FINE says [mm]."""
    volume = math.pi * blank.radius**2 * blank.length_mm
    usual = (volume / (PLACES * math.prod(_wide(tools)))) ** (1.0 / 3.0)
    if resolution is None:
        wide = [min(c.profile.pitch, 2.0 * c.profile.half_width) for c, _ in tools]
        return max(min([blank.radius, *wide]) / FINE, usual)
    if not (math.isfinite(resolution) and resolution > 0):
        raise InputError(f"a resolution of {resolution:g} mm", remedy="valid: above 0, for example 0.1")
    if resolution < usual / 2.0:
        raise InputError(
            f"chips of cells of {resolution:g} mm would need more memory than allowed",
            remedy=f"valid: {math.ceil(usual * 500.0) / 1e3:g} or more",
        )
    return resolution


def _wide(tools: tuple[tuple[Cutter, CutterMotion], ...]) -> tuple[float, float]:
    """Width of cells around and along the axis for one across."""
    return (AROUND, LONG) if all(math.isfinite(cutter.profile.pitch) for cutter, _ in tools) else (1.0, 1.0)


def _shares(sweep: Sweep, blank: Blank, cells: Cells, blocks: Blocks, side: float) -> _Shares:
    """What each bite was the first to remove of a slab, by the squares of its edge."""
    found, tops = [_NONE], [np.zeros((0, 3))]
    for part in owned(sweep, cells, blocks):
        own = part if blank.section is None else part.within(blank.section)
        at = np.stack([own.at(share) for share in (0.0, 0.5, 1.0)], axis=1)
        met = [sweep.evaluate(points(where), own.bite) for where in at.transpose(1, 0, 2)]
        height = np.stack([np.maximum(meeting.depth, 0.0) for meeting in met], axis=1)
        best = height.argmax(axis=1)
        each = np.arange(len(best))
        foot, slope = _foot(sweep, met[1], own.bite)
        shares = _Shares(
            own.bite, own.volume, height @ SIMPSON, height[each, best], met[1].instant, foot, slope
        )
        together, top = shares.together(side)
        found.append(together)
        tops.append(at[each, best][top])
    names = _Shares.__slots__
    every = _Shares(*(np.concatenate([getattr(f, name) for f in found]) for name in names))
    places = Places(every.bite, np.concatenate(tops), every.largest)
    return replace(every, largest=climbed(sweep, blank, blocks, places, cells.spacing))


def stretch_of(sweep: Sweep, bite: Ints) -> tuple[Ints, Ints]:
    """The stretch of each bite (n,), and its number within it."""
    first = np.cumsum([0, *(field.count for field in sweep.fields)])
    stretch = np.searchsorted(first[1:], bite, side="right")
    return stretch, bite - first[stretch]


def _foot(sweep: Sweep, meeting: Meeting, bite: Ints) -> tuple[Floats, Floats]:
    """The points (n, 2) of the edge that are nearest to places above it, and `_Shares.slope` there."""
    stretch, own = stretch_of(sweep, bite)
    foot, slope = np.zeros((len(bite), 2)), np.ones(len(bite))
    for n, field in enumerate(sweep.fields):
        here = np.flatnonzero(stretch == n)
        s, rho = meeting.s[here], meeting.rho[here]
        depth, by_s, by_rho = field.outline(own[here], s, rho)
        foot[here] = np.column_stack([s - depth * by_s, rho - depth * by_rho])
        slope[here] = 1.0 / np.maximum(np.abs(by_s) + np.abs(by_rho), 1e-12)
    return foot, slope


def _kinds(*columns: Ints) -> tuple[Ints, Ints]:
    """The different rows (k, c) of some columns (n,), in order, and which of them each row is."""
    order = np.lexsort(columns[::-1])
    rows = np.column_stack(columns)[order]
    new = np.concatenate([[True], (rows[1:] != rows[:-1]).any(axis=1)])[: len(rows)]
    number = np.zeros(len(rows), dtype=np.int64)
    number[order] = np.cumsum(new) - 1
    return rows[new], number


def _summed(
    sweep: Sweep, tools: tuple[tuple[Cutter, CutterMotion], ...], shares: list[_Shares], step: float
) -> Chips:
    """Shares of each tooth's pass together, in the order of time."""
    none = np.zeros(0)
    bite = np.concatenate([none.astype(np.int64), *(s.bite for s in shares)])
    volume, height, highest, instant, slope = (
        np.concatenate([none, *(getattr(s, name) for s in shares)])
        for name in ("volume", "height", "largest", "instant", "slope")
    )
    foot = np.concatenate([np.zeros((0, 2)), *(s.foot for s in shares)])
    stretch, own = stretch_of(sweep, bite)
    turn, tooth, time = np.zeros_like(own), np.zeros_like(own), np.zeros(len(own))
    for n, (field, (_, motion)) in enumerate(zip(sweep.fields, tools, strict=True)):
        here = np.flatnonzero(stretch == n)
        turn[here], number = np.divmod(own[here], field.bites)
        tooth[here] = field.tooth[number]
        time[here] = np.interp(instant[here], np.arange(len(motion.time_s)), motion.time_s)
    kinds, chip = _kinds(stretch, turn, tooth)
    n = len(kinds)
    total, mean = np.zeros(n), np.zeros(n)
    np.add.at(total, chip, volume)
    np.add.at(mean, chip, volume * height)
    largest, begin = np.zeros(n), np.full(n, np.inf)
    np.maximum.at(largest, chip, highest)
    np.minimum.at(begin, chip, time)
    side = 2.0 * step
    square = np.floor(foot / side).astype(np.int64)
    order = np.lexsort((square[:, 1], square[:, 0], chip))
    row = np.column_stack([chip, square])[order]
    one = order[np.concatenate([[True], (row[1:] != row[:-1]).any(axis=1)])[: len(order)]]
    width = np.zeros(n)
    np.add.at(width, chip[one], side * slope[one])
    order = np.lexsort((kinds[:, 2], kinds[:, 1], begin))
    return Chips(
        time_s=begin[order],
        stretch=kinds[order, 0],
        turn=kinds[order, 1],
        tooth=kinds[order, 2],
        volume_mm3=total[order],
        thickness_max_mm=largest[order],
        thickness_mean_mm=2.0 * (mean / np.maximum(total, 1e-300))[order],
        width_mm=width[order],
        resolution_mm=step,
    )
