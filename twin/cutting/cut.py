"""The general way: any motion, any tools, on a cylindrical grid."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.crossings import find_crossings, leaf_cells, node_depths
from twin.cutting.dual import Cells, Surface, contour
from twin.cutting.engagement import StockCylinder, scraped
from twin.cutting.field import DepthField
from twin.cutting.grid import grid_around
from twin.cutting.motion import CutterMotion
from twin.cutting.refine import refine
from twin.cutting.stock import Blank, Remains, subtract
from twin.cutting.sweep import Sweep
from twin.errors import InputError, PartError

Floats = NDArray[np.float64]
Progress = Callable[[str, float], None]

CELLS = 150_000
"""Surface cells aimed at where no cell size is asked for."""
CHECKED = 120
"""Vertices, and as many middles of facets, that every run holds against all passes, unculled."""
LARGEST_NODES = 150_000_000
"""Grid nodes that fit the memory: 8 bytes each, and half as much again while they are made."""
VERTEX_ERROR = 2e-3
"""[mm] off the envelope from which a vertex is worth a note: an edge of the cut that a cell could not hold"""
FACET_ERROR = 1e-2
"""[mm] off the envelope from which the cells are too coarse for the part"""
CRUMB = 1e-6
"""[mm³] below which a severed piece is rounding"""


@dataclass(frozen=True, slots=True, kw_only=True)
class CutResult:
    """A cut part and how it came about."""

    remains: Remains
    method: str
    """which mesher made it"""
    cell_mm: tuple[float, float, float]
    """of the grid, along r, theta, z"""
    passes: int
    """cutting passes that came near the stock"""
    pairs: int
    """pairs of block and pass evaluated while searching for the surface"""
    checked: int
    """vertices of the cut surface held against all passes"""
    largest_error_um: float
    """largest distance of those from the envelope of all passes"""
    facet_error_um: float
    """the same for as many middles of facets: what the cells' size costs"""
    notes: tuple[str, ...]


def cut(
    blank: Blank,
    tools: tuple[tuple[Cutter, CutterMotion], ...],
    *,
    cell_mm: float | None = None,
    progress: Progress = lambda _stage, _share: None,
) -> CutResult:
    """Cut the blank by everything the tools sweep.

    `cell_mm` is the grid's cell across the surface (twice that along z); left out, it follows from the
    teeth and the size of the blank. Raises PartError where nothing is left or the motion is not modelled.
    """
    progress("passes", 0.0)
    if not tools:
        return _uncut(blank, ("the tool never moved: nothing was cut",))
    cell = _cell(blank, tools) if cell_mm is None else cell_mm
    lowest = max(0.02 * blank.radius, 0.5 * blank.bore_mm, min(_closest(c, m) for c, m in tools))
    low = max(lowest - 2.5 * cell, 0.01 * blank.radius)
    if low >= blank.radius:
        low = max(blank.radius - 3 * cell, 0.5 * blank.radius)
    grid = grid_around(
        r_low=low,
        r_high=blank.radius,
        z_low=blank.z_range[0],
        z_high=blank.z_range[1],
        cell=(cell, cell, 2.0 * cell),
    )
    sweep = Sweep(tuple(DepthField(c, m, grid.hull_radius, grid.z_range) for c, m in tools))
    notes = [*_rubbing(blank, tools)]
    if sweep.passes == 0:
        return _uncut(blank, (*notes, "no edge ever swung past the blank: nothing was cut"))
    nodes = math.prod(grid.node_shape)
    if nodes > LARGEST_NODES:
        coarser = cell * (nodes / LARGEST_NODES) ** (1 / 3)
        raise InputError(
            f"a cell of {cell:g} mm makes {nodes / 1e6:.0f} million grid nodes, {nodes * 12e-9:.1f} GB",
            remedy=f"valid: --cell-mm {coarser:.2g} or more",
        )
    progress("searching the cut surface", 0.1)
    leaves = refine(sweep, grid)
    progress("crossings", 0.5)
    depth = node_depths(sweep, grid, leaves)
    surface = None
    errors = facets = np.zeros(0)
    if (depth > 0).any():
        if (depth[1] > 0).any() and low > 0.5 * blank.bore_mm and lowest <= 0.02 * blank.radius:
            notes.append(f"the cut reaches the work axis; a core of {grid.r[0] + grid.r[1]:.2f} mm is kept")
        crossings = find_crossings(sweep, grid, leaves, depth)
        cell_low, case, leaf = leaf_cells(grid, leaves, depth)
        progress("meshing", 0.7)
        surface = contour(sweep, grid, Cells(cell_low, case, leaf, leaves.tangents), crossings)
        progress("checking", 0.8)
        errors, facets = _check(sweep, surface, blank)
        notes += _coarse(errors, facets)
    else:
        notes.append("the tool passed the blank without touching it: nothing was cut")
    progress("cutting the blank", 0.9)
    remains = subtract(blank, surface)
    severed = [volume for volume in remains.loose_volumes_mm3 if volume > CRUMB]
    if severed:
        notes.append(
            f"{len(severed)} severed piece(s), the largest of {severed[0]:.3g} mm³, fell off the part"
        )
    progress("done", 1.0)
    return CutResult(
        remains=remains,
        method="general (cylindrical grid, dual contouring)",
        cell_mm=grid.cell_mm,
        passes=sweep.passes,
        pairs=leaves.pairs,
        checked=len(errors),
        largest_error_um=float(errors.max(initial=0.0)) * 1e3,
        facet_error_um=float(facets.max(initial=0.0)) * 1e3,
        notes=tuple(notes),
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
    return CutResult(
        remains=subtract(blank, None),
        method="none",
        cell_mm=(0.0, 0.0, 0.0),
        passes=0,
        pairs=0,
        checked=0,
        largest_error_um=0.0,
        facet_error_um=0.0,
        notes=notes,
    )


def _cell(blank: Blank, tools: tuple[tuple[Cutter, CutterMotion], ...]) -> float:
    """Cell size [mm]: a sixtieth of the tooth pitch, or what keeps to CELLS on a toothed blank."""
    pitch = min(c.profile.pitch for c, _ in tools)
    fine = pitch / 60.0 if math.isfinite(pitch) else blank.radius / 120.0
    area = 2.0 * math.pi * blank.diameter_mm * (blank.length_mm + blank.radius * 0.1)
    return max(fine, math.sqrt(area / (2.0 * CELLS)))


def _closest(cutter: Cutter, motion: CutterMotion) -> float:
    """Smallest radius of the work that the tool's tips may reach [mm]."""
    axis = motion.basis[2]
    across = np.cross(axis, [0.0, 0.0, 1.0])
    length = np.linalg.norm(across)
    if length < 1e-6:
        distance = np.hypot(motion.centre[:, 0], motion.centre[:, 1])
    else:
        distance = np.abs(motion.centre @ (across / length))
    offset = float(np.linalg.norm(motion.mount.translation[:2]))
    return max(float(distance.min()) - cutter.radius - offset, 0.0)


def _check(sweep: Sweep, surface: Surface, blank: Blank) -> tuple[Floats, Floats]:
    """Distances [mm] from the envelope of all passes, unculled, of random vertices and middles of facets.

    What lies on the closing faces outside the blank is left out.
    """
    rng = np.random.default_rng(0)
    middles = surface.vertices[surface.faces].mean(axis=1)
    return _off(sweep, surface.vertices, blank, rng), _off(sweep, middles, blank, rng)


def _off(sweep: Sweep, points: Floats, blank: Blank, rng: np.random.Generator) -> Floats:
    low, high = blank.z_range
    r = np.hypot(points[:, 0], points[:, 1])
    inside = (r < blank.radius) & (r > 0.5 * blank.bore_mm) & (points[:, 2] > low) & (points[:, 2] < high)
    rows = np.flatnonzero(inside)
    chosen = rng.choice(rows, min(CHECKED, len(rows)), replace=False) if len(rows) else rows
    depth = [sweep.unculled(point) for point in points[chosen]]
    if not np.isfinite(depth).all():
        raise PartError("the cut surface has points that no pass can have made")
    return np.abs(np.array(depth))


def _coarse(vertices: Floats, facets: Floats) -> list[str]:
    """What the check has to say."""
    notes: list[str] = []
    if (off := vertices[vertices > VERTEX_ERROR]).size:
        notes.append(
            f"{off.size} of {vertices.size} checked points of the cut stand up to {off.max() * 1e3:.0f} µm "
            "off it, at its edges; a smaller --cell-mm holds them better"
        )
    if (off := facets[facets > FACET_ERROR]).size:
        notes.append(
            f"between its vertices the mesh stands up to {off.max() * 1e3:.0f} µm off the cut "
            f"({off.size} of {facets.size} checked facets); a smaller --cell-mm follows it better"
        )
    return notes
