"""What a run says of its own cut surface: held against all passes, and searched for what the cells missed."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.dual import Surface
from twin.cutting.grid import Grid, cartesian
from twin.cutting.refine import LEAF, Leaves
from twin.cutting.sweep import Sweep
from twin.cutting.topology import CORNERS
from twin.errors import PartError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

CHECKED = 1000
"""Points of the mesh that every run holds against all passes: half vertices, half amid facets"""
VERTEX_ERROR = 1e-4
"""[mm] off the envelope from which a vertex is worth a note"""
FACET_ERROR = 1e-2
"""[mm] off the envelope from which the cells are too coarse for the part"""
PROBES = 20_000
"""Random points in the finest blocks that are searched for what the mesh does not show."""
APART = 1.2
"""Cells between such a point and the mesh, from which on it does not belong to an edge of it"""


@dataclass(frozen=True, slots=True)
class Errors:
    """How far some points of the mesh stand off the envelope of all passes."""

    points: Floats
    """(n, 3) [mm]"""
    distance: Floats
    """(n,) [mm]"""

    def beyond(self, limit: float) -> "Errors":
        """Those that stand further off."""
        far = self.distance > limit
        return Errors(self.points[far], self.distance[far])

    @property
    def largest_um(self) -> float:
        """The largest of them [µm]."""
        return float(self.distance.max(initial=0.0)) * 1e3


def check(sweep: Sweep, surface: Surface, blank: Blank) -> tuple[Errors, Errors]:
    """Errors of random vertices, and of random points of facets, against all passes, unculled.

    What lies on the closing faces outside the blank is left out. Raises PartError for points that no pass can
    have made.
    """
    rng = np.random.default_rng(0)

    def amid(faces: Ints) -> Floats:
        share = rng.dirichlet(np.ones(3), len(faces))
        return np.einsum("fc,fcx->fx", share, surface.vertices[surface.faces[faces]])

    vertices = _some(len(surface.vertices), lambda rows: surface.vertices[rows], blank, rng)
    facets = _some(len(surface.faces), amid, blank, rng)
    return _off(sweep, vertices), _off(sweep, facets)


def _some(count: int, place: Callable[[Ints], Floats], blank: Blank, rng: np.random.Generator) -> Floats:
    """(n, 3) of `count` places, drawn at random, those in the blank: as many as are checked, if there are."""
    wanted = CHECKED // 2
    found: list[Floats] = [np.zeros((0, 3))]
    order = rng.permutation(count)
    for low in range(0, count, CHECKED):
        points = place(order[low : low + CHECKED])
        found.append(points[blank.contains(points)])
        if sum(map(len, found)) >= wanted:
            break
    return np.concatenate(found)[:wanted]


def _off(sweep: Sweep, chosen: Floats) -> Errors:
    depth = sweep.unculled(chosen)
    if not np.isfinite(depth).all():
        raise PartError("the cut surface has points that no pass can have made")
    return Errors(chosen, np.abs(depth))


def coarse(vertices: Errors, facets: Errors, limit: float = FACET_ERROR) -> list[str]:
    """What the check has to say; facets that stand off by more than `limit` [mm] are worth a note."""
    notes: list[str] = []
    off = vertices.beyond(VERTEX_ERROR)
    if len(off.distance):
        notes.append(
            f"{len(off.distance)} of {len(vertices.distance)} checked points of the cut stand up to "
            f"{off.largest_um:.2g} µm off it, {region(off.points)}; a smaller --cell-mm holds them better"
        )
    off = facets.beyond(limit)
    if len(off.distance):
        notes.append(
            f"between its vertices the mesh stands up to {off.largest_um:.3g} µm off the cut "
            f"({len(off.distance)} of {len(facets.distance)} checked facets), {region(off.points)}; a "
            "smaller --cell-mm follows it better"
        )
    return notes


def region(points: Floats) -> str:
    """Where points (n, 3) lie, in words."""
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    return f"between Ø {2 * r.min():.1f} and {2 * r.max():.1f} mm, z {z.min():.1f} and {z.max():.1f} mm"


def missed(
    sweep: Sweep, grid: Grid, leaves: Leaves, surface: Surface, *, depth: Floats, blank: Blank
) -> list[str]:
    """What to say of fins and slots between the grid's nodes, which the mesh does not show.

    Random points of the finest blocks are held against the passes; where all nodes around one say otherwise,
    and the mesh is more than a cell away, something thinner than a cell was missed. `depth` is the field at
    the grid's nodes.
    """
    owner = np.repeat(np.arange(len(leaves.low)), LEAF**3)
    owner = owner[np.diff(leaves.tangents.lists.start)[owner] > 0]
    if not len(owner):
        return []
    rng = np.random.default_rng(1)
    leaf = rng.choice(owner, min(PROBES, len(owner)))
    cell = leaves.low[leaf] + rng.integers(0, LEAF, (len(leaf), 3))
    flat = depth.reshape(-1)
    removed = np.stack([flat[grid.node_id(*(cell + step).T)] > 0 for step in CORNERS])
    alike = removed.all(axis=0) | ~removed.any(axis=0)
    i, j, k = (cell + rng.random(cell.shape)).T
    nodes = np.arange(len(grid.r)), np.arange(len(grid.z))
    points = cartesian(np.interp(i, nodes[0], grid.r), grid.angle(j), np.interp(k, nodes[1], grid.z))
    asked = np.flatnonzero(alike & blank.contains(points))
    value = sweep.deepest(points[asked], leaf[asked], leaves.tangents).depth
    contrary = (value > 0) != removed[0, asked]
    points, value = points[asked[contrary]], value[contrary]
    if not len(points):
        return []
    from scipy.spatial import KDTree  # noqa: PLC0415 - half a second to load, and not every cut needs it

    cells = np.array(grid.cell_mm)[[0, 0, 2]]
    far = KDTree(surface.vertices / cells).query(points / cells)[0] > APART
    share = len(owner) / len(leaf) * float(np.prod(grid.cell_mm))
    kept = value <= 0
    return [
        *_told(points[far & kept], -value[far & kept], share, "fins", "missing in"),
        *_told(points[far & ~kept], value[far & ~kept], share, "slots", "filled in"),
    ]


def _told(points: Floats, depth: Floats, share: float, what: str, how: str) -> list[str]:
    """The note for points (n, 3) that stand for `share` [mm³] each, `depth` (n,) inside what was missed."""
    if not len(points):
        return []
    thick = 2e3 * float(depth.max())
    size = 10.0 ** math.floor(math.log10(share * len(points)))
    return [
        f"{what} thinner than a cell, up to {thick:.0f} µm thick, are {how} the mesh {region(points)}: about "
        f"{round(share * len(points) / size) * size:g} mm³; a smaller --cell-mm shows them"
    ]
