"""Where sides of facets are divided: their worst places, brought onto the cut surface.

Between two bites the new vertex stands on both, where one bite has an edge of its own on that, elsewhere on
the surface nearby. So ridges and edges are cut along.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.landing import SETTLED, Ground, between, newton
from twin.cutting.parting import both_across
from twin.cutting.planes import onto_corners, onto_edges
from twin.cutting.sides import Mesh, Worst, lengths

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

STRAYED = 2.0
"""Times its distance from the cut by which a point is moved to where two bites meet"""
SLID = 0.25
"""Share of its way to an end that a point must keep"""
WALL = 3.0
"""Cells that a wall may stand out of a side that runs through it"""
STEPS = 12
"""in which the top of such a wall is looked for"""
FOUND = 1e-3
"""[mm] off the cut within which the top of a wall is found"""
SAME = 1e-3
"""[mm] within which a vertex stands already where another is wanted"""


@dataclass(frozen=True, slots=True)
class Placed:
    """New vertices on some sides."""

    points: Floats
    """(n, 3) [mm]"""
    bite: Ints
    """(n,) that made the surface there"""
    good: Bools
    """(n,) whether they divide their sides"""
    there: Ints
    """(n,) the corner across the side that stands there already, −1 = none does"""


def placed(ground: Ground, mesh: Mesh, ends: Ints, worst: Worst, *, aim: float) -> Placed:
    """Vertices for sides (n, 2) where these stand furthest off the cut; edges that a bite has itself are
    looked for where that is more than `aim` [mm]."""
    a, b = mesh.vertices[ends].transpose(1, 0, 2)
    points, leaf = a + worst.share[:, None] * (b - a), mesh.leaf[ends[:, 0]]
    beyond = np.flatnonzero(worst.depth > aim)
    edges, sharp = _onto_own_edges(ground, mesh, ends, worst, beyond)
    points, walls = _onto_ridges(ground, worst, points, leaf)
    rows = np.flatnonzero(walls)
    points[rows] = _onto_tops(ground, points[rows], _upwards(mesh, ends[rows]), leaf[rows])
    led = np.zeros(len(points), dtype=bool)
    led[beyond[sharp]] = True
    points[led] = edges[sharp]
    bite, lost, _ = newton(ground, points, np.arange(len(points)), leaf)
    walls |= worst.bites[:, 0] == worst.bites[:, 1]
    # what lands on a third bite is on the top that this has left of a wall
    beside = (bite[:, None] == worst.bites).any(axis=1)
    lost |= walls & beside & ~led & _slid(points, worst.share, a, b)
    taken, there = _taken(points, mesh, ends)
    # where no bite can be the deepest the field is not known
    return Placed(points, bite, ~lost & ~taken & ground.passed(points), there)


def _taken(points: Floats, mesh: Mesh, ends: Ints) -> tuple[Bools, Ints]:
    """Which points (n, 3) for sides (n, 2) are taken by corners of the facets on these, or by points for
    others of their sides; and the corner across (n,) that takes one, −1 = none.

    Without that, what runs beside a step of the surface could be divided at the same places for ever.
    """
    facets, corners = both_across(mesh.faces, ends)
    corner = np.concatenate([ends, corners], axis=1)
    away = np.linalg.norm(points[:, None] - mesh.vertices[corner], axis=2)
    taken = (away < SAME).any(axis=1)
    n = np.arange(len(points))
    nearest = 2 + away[:, 2:].argmin(axis=1)
    there = np.where(away[n, nearest] < SAME, corner[n, nearest], -1)
    facet = facets.T.ravel()
    order = np.argsort(facet, kind="stable")
    # a facet has up to three divided sides
    for step in (1, 2):
        i, j = order[:-step], order[step:]
        same = facet[i] == facet[j]
        i, j = i[same] % len(points), j[same] % len(points)
        twin = np.linalg.norm(points[i] - points[j], axis=1) < SAME
        taken[np.maximum(i, j)[twin]] = True
    return taken, there


def _slid(points: Floats, share: Floats, a: Floats, b: Floats) -> Bools:
    """Which points (n, 3) have come from their `share` of the way from a to b most of the way to either end.

    Through a wall whose top is far away a side runs from flank to flank, and so it does where one bite has an
    edge that was not found: what lands on the flanks divides nothing.
    """
    way = b - a
    at = np.einsum("nx,nx->n", points - a, way) / np.maximum(np.einsum("nx,nx->n", way, way), 1e-300)
    return np.minimum(at / share, (1.0 - at) / (1.0 - share)) < SLID


def _onto_ridges(ground: Ground, worst: Worst, points: Floats, leaf: Ints) -> tuple[Floats, Bools]:
    """Points (n, 3) on sides that two bites made, brought to where those meet; which (n,) run through walls
    whose edge was not found.

    Through a wall the side runs in metal, and its flanks meet above it, or would if nothing cut off the top:
    then the point is on the top.
    """
    start, points = points, points.copy()
    two = np.flatnonzero(worst.bites[:, 0] != worst.bites[:, 1])
    owner, pair = np.repeat(np.arange(len(two)), 2), worst.bites[two].reshape(-1)
    meeting = ground.sweep.evaluate(points[two][owner], pair, gradient=True)
    slope = meeting.gradient.reshape(-1, 2, 3)
    wall = np.einsum("nx,nx->n", slope[:, 0], slope[:, 1]) < 0
    wall &= meeting.depth.reshape(-1, 2).max(axis=1) < 0
    # beside a ridge its bites meet far away: there the surface itself is near
    longest = np.where(wall, WALL * min(ground.grid.cell_mm), STRAYED * worst.error[two])
    met = onto_edges(ground.sweep, points[two], owner, pair, longest)
    rows = two[wall]
    here, there = (ground.field(at, leaf[rows]).depth for at in (points[rows], met[wall]))
    cut_off = (here < -SETTLED) & (there > SETTLED)
    points[two] = met
    points[rows[cut_off]] = between(
        lambda at, of: ground.field(at, leaf[rows[cut_off]][of]).depth,
        (start[rows[cut_off]], met[wall][cut_off]),
        (here[cut_off], there[cut_off]),
    )
    walls = np.zeros(len(points), dtype=bool)
    walls[rows] = np.abs(there) > FOUND
    return points, walls


def _upwards(mesh: Mesh, ends: Ints) -> Floats:
    """Out of the metal (n, 3), at right angles to the facets on sides (n, 2)."""
    a, b = mesh.vertices[ends].transpose(1, 0, 2)
    c, d = mesh.vertices[both_across(mesh.faces, ends)[1]].transpose(1, 0, 2)
    inwards = np.cross(b - a, c - a) + np.cross(a - b, d - b)
    return -inwards / np.maximum(np.linalg.norm(inwards, axis=1, keepdims=True), 1e-300)


def _onto_tops(ground: Ground, points: Floats, up: Floats, leaf: Ints) -> Floats:
    """Points (n, 3) in walls whose flanks meet too far away, brought `upwards` (n, 3) onto what cuts off the
    tops, where that comes within WALL cells."""
    points = points.copy()
    reach = WALL * min(ground.grid.cell_mm) * up
    low, below = points.copy(), ground.field(points, leaf).depth
    left = np.flatnonzero(below < -FOUND)
    for share in np.linspace(0.0, 1.0, STEPS + 1)[1:]:
        there = points[left] + share * reach[left]
        depth = np.where(ground.passed(there), ground.field(there, leaf[left]).depth, -np.inf)
        out = depth > 0
        rows, ends = left[out], (low[left[out]], there[out])
        found = between(
            lambda at, of, rows=rows: ground.field(at, leaf[rows[of]]).depth, ends, (below[rows], depth[out])
        )
        points[rows] = found
        inside = ~out & np.isfinite(depth)
        left = left[inside]
        low[left], below[left] = there[inside], depth[inside]
    return points


def _onto_own_edges(ground: Ground, mesh: Mesh, ends: Ints, worst: Worst, rows: Ints) -> tuple[Floats, Bools]:
    """The worst places of the `rows` (m,) of some sides, brought onto the edges that their bites have there
    themselves, and which of them (m,) have one."""
    a, b = mesh.vertices[ends[rows]].transpose(1, 0, 2)
    beside = a[:, None] + worst.places[rows][..., None] * (b - a)[:, None]
    return onto_corners(
        ground.sweep,
        a + worst.share[rows, None] * (b - a),
        worst.bite[rows],
        (np.repeat(np.arange(len(rows)), 2), beside.reshape(-1, 3)),
        0.5 * lengths(mesh.vertices, ends[rows]),
    )
