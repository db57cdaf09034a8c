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
from twin.cutting.cells import Cells
from twin.cutting.engaged import Edges, Engaged, engaged
from twin.cutting.field import DepthField
from twin.cutting.fields import tool_field
from twin.cutting.height import above
from twin.cutting.metal import Metal
from twin.cutting.motion import CutterMotion
from twin.cutting.owners import owned
from twin.cutting.sweep import Sweep
from twin.cutting.thickness import Places, climbed
from twin.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Progress = Callable[[str, float], None]
_Widths = tuple[int, Engaged]
"""Number of the tool, and how much of its edges stands in metal"""

PLACES = 8_000_000
"""Cells that a run has where no resolution is asked for; it may have eight times as many."""
FINE = 50.0
"""Cells across in the pitch of a hob's teeth, or in the width of another tool's edge"""
AROUND = 1.5
"""Width of the cells of a hobbed part around, for one across"""
LONG = 3.0
"""and along the axis: a hob's chips are as long as it is wide"""
WIDE = 2.5
"""Distance of places at which edges are asked, for one across"""
SIMPSON = np.array([1.0, 4.0, 1.0]) / 6.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Chips:
    """One row for each tooth that took something away as it passed, in the order of time.

    What twice the resolution changes of them stands in docs/kernel.md.
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
    """(n,) the most of its edge that stood in metal at one instant; 0 of wheels, which have none"""
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

    def together(self, block: Ints) -> tuple["_Shares", Ints]:
        """Those of the same bite in the same of the blocks (n,) as one; and which of each is the highest."""
        key = self.bite * (int(block.max(initial=0)) + 2) + block
        order = np.argsort(key)
        first = np.flatnonzero(np.diff(key[order], prepend=-2))
        if not len(first):
            return self, first
        group = np.cumsum(np.diff(key[order], prepend=-2) != 0) - 1
        largest = np.maximum.reduceat(self.largest[order], first)
        top = np.zeros(len(first), dtype=np.int64)
        highest = self.largest[order] == largest[group]
        top[group[highest]] = order[highest]
        volume = np.add.reduceat(self.volume[order], first)
        one = _Shares(
            self.bite[top],
            volume,
            np.add.reduceat((self.volume * self.height)[order], first) / volume,
            largest,
            np.minimum.reduceat(self.instant[order], first),
        )
        return one, top


_NONE = _Shares(np.zeros(0, dtype=np.int64), *np.zeros((4, 0)))


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
    widths: list[_Widths] = []
    edges = [Edges(field) if isinstance(field, DepthField) else None for field in sweep.fields]
    known = np.zeros(sweep.count)
    slabs = list(cells.slabs()) if sweep.passes else []
    for number, low in enumerate(slabs):
        progress("chips", number / len(slabs))
        blocks = Blocks.of(sweep, cells.grid, low)
        one, width = _slab(sweep, blank, cells, (blocks, edges), known)
        shares.append(one)
        widths += width
        np.maximum.at(known, one.bite, one.largest)
    progress("chips", 1.0)
    return _summed(sweep, tools, shares, widths, step)


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


def _slab(
    sweep: Sweep, blank: Blank, cells: Cells, of: tuple[Blocks, list[Edges | None]], known: Floats
) -> tuple[_Shares, list[_Widths]]:
    """What each bite was the first to remove of a slab, block by block, and how much of its edge did.

    `known` (bites,) is how thick its chip is at least.
    """
    blocks, edges = of
    found, tops = [_NONE], [np.zeros((0, 3))]
    feet = [[(_NONE.bite, _NONE.volume, _NONE.volume)] for _ in edges]
    for part in owned(sweep, cells, blocks):
        own = part if blank.section is None else part.within(blank.section)
        at = np.stack([own.at(share) for share in (0.0, 0.5, 1.0)], axis=1)
        bite, height, met = above(sweep, at, own.bite)
        best = height.argmax(axis=1)
        each = np.arange(len(best))
        shares = _Shares(bite, own.volume, height @ SIMPSON, height[each, best], met.instant)
        stretch = sweep.tool(bite)
        number = bite - sweep.first(stretch)
        for tool, one in enumerate(edges):
            if one is not None:
                rows = np.flatnonzero(stretch == tool)
                middle = met.of(rows)
                feet[tool].append(
                    (number[rows], *one.foot(number[rows], middle.s, middle.rho, middle.instant))
                )
        together, top = shares.together(blocks.rows(at[:, 1]) + 1)
        found.append(together)
        tops.append(at[each, best][top])
    every = _Shares(*(np.concatenate([getattr(f, name) for f in found]) for name in _Shares.__slots__))
    places = Places(every.bite, np.concatenate(tops), every.largest)
    metal = Metal(sweep, blank, blocks)
    every = replace(every, largest=climbed(metal, places, cells.spacing, known))
    across = float(cells.spacing[0])
    widths: list[_Widths] = []
    for tool, one in enumerate(edges):
        if one is not None:
            bite, along, turn = (np.concatenate(column) for column in zip(*feet[tool], strict=True))
            seen, first = (bite.astype(np.int64), along, turn), int(sweep.first(np.array(tool)))
            widths.append((tool, engaged(metal, one, first, seen, (WIDE * across, across))))
    return every, widths


def _kinds(*columns: Ints) -> tuple[Ints, Ints]:
    """The different rows (k, c) of some columns (n,), in order, and which of them each row is."""
    order = np.lexsort(columns[::-1])
    rows = np.column_stack(columns)[order]
    new = np.concatenate([[True], (rows[1:] != rows[:-1]).any(axis=1)])[: len(rows)]
    number = np.zeros(len(rows), dtype=np.int64)
    number[order] = np.cumsum(new) - 1
    return rows[new], number


def _summed(
    sweep: Sweep,
    tools: tuple[tuple[Cutter, CutterMotion], ...],
    shares: list[_Shares],
    widths: list[_Widths],
    step: float,
) -> Chips:
    """Shares of each tooth's pass together, in the order of time."""
    none = np.zeros(0)
    bite = np.concatenate([none.astype(np.int64), *(s.bite for s in shares)])
    volume, height, highest, instant = (
        np.concatenate([none, *(getattr(s, name) for s in shares)])
        for name in ("volume", "height", "largest", "instant")
    )
    stretch = sweep.tool(bite)
    own = bite - sweep.first(stretch)
    turn, tooth, time = np.zeros_like(own), np.zeros_like(own), np.zeros(len(own))
    for n, (_, motion) in enumerate(tools):
        here = np.flatnonzero(stretch == n)
        turn[here], tooth[here] = _named(sweep, n, own[here])
        time[here] = np.interp(instant[here], np.arange(len(motion.time_s)), motion.time_s)
    kinds, chip = _kinds(stretch, turn, tooth)
    n = len(kinds)
    total, mean = np.zeros(n), np.zeros(n)
    np.add.at(total, chip, volume)
    np.add.at(mean, chip, volume * height)
    largest, begin = np.zeros(n), np.full(n, np.inf)
    np.maximum.at(largest, chip, highest)
    np.minimum.at(begin, chip, time)
    width = _widest(sweep, kinds, widths)
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


def _widest(sweep: Sweep, kinds: Ints, widths: list[_Widths]) -> Floats:
    """(n,) of chips (n, 3): the most of their edges, in all pieces and slabs, that is in metal at once."""
    none = np.zeros(0, dtype=np.int64)
    rows = [(np.full(len(w.bite), tool), *_named(sweep, tool, w.bite), w.row) for tool, w in widths]
    columns = [np.concatenate([none, *column]) for column in zip(*rows, strict=True)] or [none] * 4
    instants, number = _kinds(*columns)
    length = np.zeros(len(instants))
    np.add.at(length, number, np.concatenate([np.zeros(0), *(w.length for _, w in widths)]))
    # of chips alone
    every, which = _kinds(*np.concatenate([kinds, instants[:, :3]]).T)
    widest = np.zeros(len(every))
    np.maximum.at(widest, which[len(kinds) :], length)
    return widest[which[: len(kinds)]]


def _named(sweep: Sweep, tool: int, bite: Ints) -> tuple[Ints, Ints]:
    """Pass and tooth (n,) of a tool's bites."""
    turn, number = np.divmod(bite, sweep.fields[tool].bites)
    return turn, sweep.fields[tool].tooth[number]
