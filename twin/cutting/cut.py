"""Any motion, any tools: the quick way where it is proved to be right, the general way everywhere else."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.check import Errors, check, coarse, missed
from twin.cutting.crossings import find_crossings, leaf_cells, left_volume, node_depths
from twin.cutting.dual import Cells, Surface, contour
from twin.cutting.engagement import StockCylinder, axes_apart, scraped
from twin.cutting.facets import divided
from twin.cutting.feed_marks import unmarked
from twin.cutting.fields import tool_field
from twin.cutting.grid import Grid
from twin.cutting.landing import Ground
from twin.cutting.moments import face_moments, moments
from twin.cutting.motion import CutterMotion
from twin.cutting.plan import CORE, facet_limit, plan_grid, useful, working_memory
from twin.cutting.refine import refine
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.regular import Regular, regular_cut
from twin.cutting.stock import Remains, subtract
from twin.cutting.strokes import Strokes, find_strokes, ridges
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Progress = Callable[[str, float], None]

MUCH_COARSER = 2.0
"""Times the tolerance by which facets may stray before a note says so."""
FORMED_ERROR = 0.1
"""[µm] off the envelope from which a cut is not one of strokes along gaps"""
FORMED_ROUNDS = 2
"""of strokes: ridges between them are off as facets are, and may ask for finer cells"""
SAFELY = 0.8
"""Share of FORMED_ERROR that finer cells are chosen for"""


@dataclass(frozen=True, slots=True, kw_only=True)
class CutResult:
    """A cut part and how it came about."""

    remains: Remains
    method: str
    """which mesher made it"""
    cell_mm: tuple[float, ...]
    """of the grid, along r, theta, z; or across and along the gaps"""
    passes: int
    """cutting passes that came near the stock"""
    pairs: int
    """pairs of block and pass evaluated while searching for the surface"""
    face_time_s: Floats
    """(m,) when each face of the part was cut, by the deepest bite there; NaN on what is left of the blank"""
    checked: int
    """vertices of the cut surface held against all passes"""
    largest_error_um: float
    """largest distance of those from the envelope of all passes"""
    facet_error_um: float
    """the same for as many random points of facets: what their size costs"""
    notes: tuple[str, ...]


def cut(
    blank: Blank,
    tools: tuple[tuple[Cutter, CutterMotion], ...],
    *,
    cell_mm: float | None = None,
    tolerance_um: float = 1.0,
    progress: Progress = lambda _stage, _share: None,
) -> CutResult:
    """Cut the blank by everything the tools sweep.

    Facets keep to `tolerance_um` on the flanks of a regular gear, three times that in its roots, twice that
    on any other part; `cell_mm`, the cell across the surface, takes its place. Raises PartError
    where nothing is left or the motion is not modelled, InputError for a cell or a tolerance that cannot be.
    """
    progress("passes", 0.0)
    if not tools:
        return _uncut(blank, ("the tool never moved: nothing was cut",))
    closest = min(_closest(c, m) for c, m in tools)
    cutters = [c for c, _ in tools]
    smooth = all(unmarked(c, m, blank) for c, m in tools)
    grid = plan_grid(
        blank, cutters, closest=closest, cell_mm=cell_mm, tolerance_um=tolerance_um, smooth=smooth
    )
    cell_mm, tolerance_um = useful(blank, cutters, cell_mm=cell_mm, tolerance_um=tolerance_um)
    notes = [*_rubbing(blank, tools)]
    formed = _formed(blank, tools, grid.cell_mm[0])
    if formed is not None:
        progress("done", 1.0)
        return replace(formed, notes=(*notes, *formed.notes))
    sweep = Sweep(tuple(tool_field(c, m, grid.hull_radius, grid.z_range) for c, m in tools))
    if sweep.passes == 0:
        return _uncut(blank, (*notes, "no edge ever swung past the blank: nothing was cut"))
    progress("searching the cut surface", 0.1)
    try:
        regular = regular_cut(blank, tools, sweep, tolerance_um=tolerance_um, cell_mm=cell_mm)
        method, cells, pairs = _regular_method(regular), regular.cell_mm, regular.pairs
        surface: Surface | None = regular.surface
        progress("checking", 0.8)
        errors, facets = check(sweep, regular.surface, blank)
        notes += [*_coarser(regular, tolerance_um), *coarse(errors, facets)]
    except IrregularError as why:
        limit = facet_limit(blank, cutters, cell_mm=cell_mm, tolerance_um=tolerance_um)
        made = _general(blank, sweep, grid, limit=limit, closest=closest, progress=progress)
        method, cells, pairs = f"general (cylindrical grid), for {why}", grid.cell_mm, made.pairs
        surface, errors, facets = made.surface, made.errors, made.facets
        notes += made.notes
    progress("cutting the blank", 0.9)
    surfaces = [surface] if surface else []
    remains = subtract(blank, *surfaces)
    times = [moments(sweep, tuple(motion for _, motion in tools), one) for one in surfaces]
    notes += _severed(remains)
    if (remains.origin < 0).all():
        notes.append("the tool passed the blank without touching it: nothing was cut")
    progress("done", 1.0)
    return CutResult(
        remains=remains,
        method=method,
        cell_mm=cells,
        passes=sweep.passes,
        pairs=pairs,
        face_time_s=face_moments(remains.origin, [one.faces for one in surfaces], times),
        checked=len(errors.distance),
        largest_error_um=errors.largest_um,
        facet_error_um=facets.largest_um,
        notes=tuple(notes),
    )


def _regular_method(regular: Regular) -> str:
    if regular.coarser == 1.0:
        return "regular (charts of equal gaps)"
    return (
        f"regular (charts of equal gaps, cells {regular.coarser:.2g} times as long to keep within the memory)"
    )


def _coarser(regular: Regular, tolerance_um: float) -> list[str]:
    """What to say of cells much longer than the tolerance asks for."""
    if regular.coarser**2 < MUCH_COARSER:
        return []
    return [
        f"cells are {regular.coarser:.2g} times as long as the tolerance asks for, to save memory: "
        f"facets keep to about {tolerance_um * regular.coarser**2:.2g} µm on the flanks"
    ]


@dataclass(frozen=True, slots=True)
class _Made:
    """The surface by the general way."""

    surface: Surface | None
    errors: Errors
    facets: Errors
    pairs: int
    notes: list[str]


def _general(
    blank: Blank, sweep: Sweep, grid: Grid, *, limit: float, closest: float, progress: Progress
) -> _Made:
    """On a cylindrical grid, whatever the tools do, with facets within `limit` of the cut [mm]."""
    leaves = refine(sweep, grid, allowed=working_memory())
    progress("crossings", 0.5)
    depth = node_depths(sweep, grid, leaves)
    none = Errors(np.zeros((0, 3)), np.zeros(0))
    if not (depth > 0).any():
        return _Made(None, none, none, leaves.pairs, [])
    notes = []
    if (depth[1] > 0).any() and max(closest, 0.5 * blank.bore_mm) <= CORE * blank.radius:
        notes.append(f"the cut reaches the work axis; a core of {grid.r[0] + grid.r[1]:.2f} mm is kept")
    crossings = find_crossings(sweep, grid, leaves, depth)
    cell_low, case, leaf = leaf_cells(grid, leaves, depth)
    progress("meshing", 0.7)
    ground = Ground(sweep, grid, leaves)
    surface, leaf = contour(ground, Cells(cell_low, case, leaf), crossings)
    volume = left_volume(grid, depth, blank)
    surface = divided(ground, surface, leaf, blank, limit=limit, volume=volume)
    progress("checking", 0.8)
    errors, facets = check(sweep, surface, blank)
    notes += coarse(errors, facets, limit) + missed(sweep, grid, leaves, surface, depth=depth, blank=blank)
    return _Made(surface, errors, facets, leaves.pairs, notes)


def _severed(remains: Remains) -> list[str]:
    """What to say of pieces that fell off."""
    volumes = remains.loose_volumes_mm3
    if not volumes:
        return []
    return [f"{len(volumes)} severed piece(s), the largest of {volumes[0]:.3g} mm³, fell off the part"]


def _formed(blank: Blank, tools: tuple[tuple[Cutter, CutterMotion], ...], cell: float) -> CutResult | None:
    """The cut by strokes of wheels along whole gaps; None where it is something else, or does not hold."""
    for _ in range(FORMED_ROUNDS):
        found: list[Strokes] = []
        for cutter, motion in tools:
            strokes = find_strokes(blank, cutter, motion, cell)
            if strokes is None or strokes.vertices.largest_um > FORMED_ERROR:
                return None
            found.append(strokes)
        remains = subtract(blank, *(tube for strokes in found for tube in strokes.tubes))
        met = ridges(found, remains)
        if met.largest_um <= FORMED_ERROR:
            return _of_strokes(found, remains, met, cell)
        cell *= math.sqrt(SAFELY * FORMED_ERROR / met.largest_um)
    return None


def _of_strokes(found: list[Strokes], remains: Remains, met: Errors, cell: float) -> CutResult:
    """What strokes have left of the blank, with the errors of the ridges where they met."""
    tubes = [tube for strokes in found for tube in strokes.tubes]
    times = [time for strokes in found for time in strokes.times]
    return CutResult(
        remains=remains,
        method="strokes of a wheel (rays in transverse planes)",
        cell_mm=(0.5 * cell, 0.5 * cell, cell),
        passes=len(tubes),
        pairs=sum(len(tube.vertices) for tube in tubes),
        face_time_s=face_moments(remains.origin, [tube.faces for tube in tubes], times),
        checked=sum(len(errors.distance) for errors in (met, *(strokes.vertices for strokes in found))),
        largest_error_um=max(met.largest_um, *(strokes.vertices.largest_um for strokes in found)),
        facet_error_um=max(strokes.facets.largest_um for strokes in found),
        notes=(
            *(note for one in found for note in coarse(one.vertices, one.facets)),
            *_severed(remains),
        ),
    )


def _rubbing(blank: Blank, tools: tuple[tuple[Cutter, CutterMotion], ...]) -> list[str]:
    """What to say of tools that stand still in the stock while it moves."""
    ways = [scraped(c, m, StockCylinder.around(m.mount, blank.radius, blank.z_range)) for c, m in tools]
    return [
        f"the tool stood still within the blank's outline while the blank moved {way:.3g} mm past it: "
        "what that scrapes off is not modelled"
        for way in ways
        if way > 0
    ]


def _uncut(blank: Blank, notes: tuple[str, ...]) -> CutResult:
    """The blank as it was."""
    remains = subtract(blank)
    return CutResult(
        remains=remains,
        method="none",
        cell_mm=(0.0, 0.0, 0.0),
        passes=0,
        pairs=0,
        face_time_s=np.full(len(remains.faces), np.nan),
        checked=0,
        largest_error_um=0.0,
        facet_error_um=0.0,
        notes=notes,
    )


def _closest(cutter: Cutter, motion: CutterMotion) -> float:
    """Smallest radius of the work that the tool's tips may reach [mm]."""
    offset = float(np.linalg.norm(motion.mount.translation[:2]))
    return max(float(axes_apart(motion).min()) - cutter.radius - offset, 0.0)
