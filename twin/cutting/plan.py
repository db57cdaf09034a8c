"""The grid of a cut, and what it will need, before any work is done."""

import math
import os
from collections.abc import Iterable

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.grid import Grid, grid_around
from twin.errors import InputError

CELLS = 150_000
"""Surface cells aimed at where no cell size is asked for."""
ALLOWED = 2 << 30
"""[bytes] of memory that a cut may take"""
BASE = 150e6
"""[bytes] that every cut takes"""
PER_NODE = 12
"""[bytes] of a grid node: its depth, and half as much again while it is made"""
PER_CELL = 2100
"""[bytes] of a surface cell, as measured on gears: mostly the tangents of the bites around it"""
LEAST = 1e-6
"""[mm] below which a cell is hopeless, whatever its size"""
WIDEST = 0.05
"""Share of the blank's radius: in blocks of wider cells hardly a pass can be left out"""
SMOOTH = 2.5
"""Times as wide cells do on a part without feed marks: facets are divided where it bends."""
FACETS = 2.0
"""Tolerances within which facets of the general way keep to the cut."""
CORE = 0.02
"""Share of the blank's radius that the grid leaves out around the axis."""


def plan_grid(
    blank: Blank,
    cutters: Iterable[Cutter],
    *,
    closest: float,
    cell_mm: float | None = None,
    tolerance_um: float = 1.0,
    smooth: bool = False,
) -> Grid:
    """The grid for a cut whose edges come as near as `closest` [mm] to the work axis.

    `cell_mm` is its cell across the surface (twice that along z); left out, it follows from the teeth, the
    size of the blank and the tolerance, to which errors go with the square of the cell; on a `smooth` part,
    without feed marks, it may be wider. It is no wider than WIDEST. Raises InputError for what is no cell or
    no tolerance, or would need more memory than ALLOWED, with the estimate.
    """
    if cell_mm is not None and not (math.isfinite(cell_mm) and cell_mm > 0):
        raise InputError(f"a cell of {cell_mm:g} mm", remedy="valid: above 0, for example 0.1")
    if not (math.isfinite(tolerance_um) and tolerance_um > 0):
        raise InputError(f"a tolerance of {tolerance_um:g} µm", remedy="valid: above 0, for example 1")
    cell_mm, tolerance_um = useful(blank, cutters, cell_mm=cell_mm, tolerance_um=tolerance_um)
    cell = _cell(blank, cutters, smooth=smooth) * math.sqrt(tolerance_um) if cell_mm is None else cell_mm
    lowest = max(CORE * blank.radius, 0.5 * blank.bore_mm, closest)
    low = max(lowest - 2.5 * cell, 0.5 * CORE * blank.radius)
    if low >= blank.radius:
        low = max(blank.radius - 3 * cell, 0.5 * blank.radius)
    needed = _memory(blank, low, cell)
    if needed > ALLOWED:
        coarser = max(cell, LEAST)
        while _memory(blank, low, coarser) > ALLOWED:
            coarser *= 1.05
        fits = f"--cell-mm {math.ceil(coarser * 1e3) / 1e3:g}"
        if cell_mm is None and tolerance_um < 1.0:
            fits = f"--tolerance-um {math.ceil(tolerance_um * (coarser / cell) ** 2 * 1e3) / 1e3:g}"
        raise InputError(
            f"cells of {cell:.3g} mm would need about {needed / 2**30:.1f} GiB of memory, "
            f"{ALLOWED / 2**30:g} are allowed",
            remedy=f"valid: {fits} or more",
        )
    return grid_around(
        r_low=low,
        r_high=blank.radius,
        z_low=blank.z_range[0],
        z_high=blank.z_range[1],
        cell=(cell, cell, 2.0 * cell),
    )


def useful(
    blank: Blank, cutters: Iterable[Cutter], *, cell_mm: float | None, tolerance_um: float
) -> tuple[float | None, float]:
    """Cell and tolerance asked for, or those of the widest cells that save any time."""
    widest = WIDEST * blank.radius
    if cell_mm is not None:
        return min(cell_mm, widest), tolerance_um
    return None, min(tolerance_um, max(widest / _cell(blank, cutters), 1.0) ** 2)


def facet_limit(
    blank: Blank, cutters: Iterable[Cutter], *, cell_mm: float | None = None, tolerance_um: float = 1.0
) -> float:
    """How far the facets of the general way may stand off the cut [mm].

    Twice the tolerance; where a cell was asked for, twice the tolerance that it would follow from.
    """
    share = tolerance_um if cell_mm is None else (cell_mm / _cell(blank, cutters)) ** 2
    return FACETS * 1e-3 * share


def working_memory() -> float:
    """[bytes] that a search may take that turns out to need more than was planned: half of the machine's."""
    try:
        whole = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return ALLOWED
    return max(ALLOWED, whole / 2)


def _memory(blank: Blank, low: float, cell: float) -> float:
    """Estimate [bytes], in floating point: no cell is too small for it."""
    cell = max(cell, LEAST)
    around = 2.0 * math.pi * blank.radius / cell
    nodes = (blank.radius - low + 3.0 * cell) / cell * around * (blank.length_mm + 8.0 * cell) / (2.0 * cell)
    return BASE + PER_NODE * nodes + PER_CELL * _surface(blank) / (2.0 * cell * cell)


def _surface(blank: Blank) -> float:
    """Area of the cut surface [mm²]: a toothed blank has about twice that of its cylinder."""
    return 2.0 * math.pi * blank.diameter_mm * (blank.length_mm + blank.radius * 0.1)


def _cell(blank: Blank, cutters: Iterable[Cutter], *, smooth: bool = False) -> float:
    """Cell size [mm]: what shows the cutters' teeth, or what keeps to CELLS on a toothed blank."""
    fine = min(_detail(cutter, blank) * (SMOOTH if smooth else 1.0) for cutter in cutters)
    return max(fine, math.sqrt(_surface(blank) / (2.0 * CELLS)))


def _detail(cutter: Cutter, blank: Blank) -> float:
    """A sixtieth of the tooth pitch; a thirtieth of the gap that a wheel cuts [mm]."""
    if math.isfinite(cutter.profile.pitch):
        return cutter.profile.pitch / 60.0
    if cutter.revolved:
        return min(cutter.profile.half_width / 15.0, blank.radius / 120.0)
    return blank.radius / 120.0
