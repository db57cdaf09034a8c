"""Facets divided until they keep to the cut surface, wherever its curvature and its ridges ask for it.

What stands too far off is divided at the worst place of its sides (`sides.py`), which is brought onto the
surface, or onto both bites where two meet. So ridges are cut along, facet by facet.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.dual import Surface
from twin.cutting.landing import SETTLED, Ground, between, newton
from twin.cutting.parting import parted
from twin.cutting.planes import onto_corners, onto_edges
from twin.cutting.sides import Mesh, Sides, Worst, lengths, sides_of, worst_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

INWARDS = 1.4
"""Error amid a facet against the largest of its sides: on an evenly curved surface 4/3."""
HIDDEN = 2.0 / 3.0
"""Share of what is aimed at by which metal may stand out amid a facet: a peak is higher than its middle."""
VOLUME = 0.7e-4
"""Share of the part's volume that may lie between its facets and the cut"""
SAMPLED = 4000
"""points of facets that tell it"""
SHARPER = 2.0
"""Times what is aimed at from which a sharp edge is looked for: less than that any division halves"""
GROWTH = 1.5
"""Times as many sides to divide as in the round with the least: then dividing them settles nothing"""
STRAYED = 2.0
"""Times its distance from the cut by which a point is moved to where two bites meet"""
SLID = 0.25
"""Share of its way to an end that a point must keep"""
WALL = 3.0
"""Cells that a wall may stand out of a side that runs through it"""
ROUNDS = 14
"""of division"""
SHORTEST = 2e-3
"""[mm] of a side that is divided no more"""


def divided(
    ground: Ground, surface: Surface, leaf: Ints, blank: Blank, *, limit: float, volume: float
) -> Surface:
    """The surface with facets that keep within `limit` [mm] of the cut, as far as they lie in the blank.

    Chords of hollow places all lie on one side of them: where that would make the part, of about `volume`
    [mm³], smaller or larger by more than VOLUME of it, facets are divided further. `leaf` (n,) tells the
    finest block that each vertex comes from.
    """
    inside = blank.contains(surface.vertices)
    mesh = _kept(ground, Mesh(surface.vertices, surface.faces, surface.bite, leaf, inside), blank, limit)
    off = abs(_between(ground, mesh, limit))
    if off > VOLUME * volume > 0.0:
        mesh = _kept(ground, mesh, blank, limit * VOLUME * volume / off)
    return Surface(mesh.vertices, mesh.faces, mesh.bite)


def _between(ground: Ground, mesh: Mesh, limit: float) -> float:
    """Volume between facets and cut [mm³], from random points of the facets; + = the mesh stands too deep.

    What stands further off than `limit` [mm] did not settle: it is not mended by dividing the rest.
    """
    faces = mesh.faces[mesh.cut_in(mesh.faces)]
    if not len(faces):
        return 0.0
    a, b, c = mesh.vertices[faces].transpose(1, 0, 2)
    area = np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0)
    rng = np.random.default_rng(2)
    row = np.minimum(np.searchsorted(area, area[-1] * rng.random(SAMPLED)), len(faces) - 1)
    points = np.einsum("nc,ncx->nx", rng.dirichlet(np.ones(3), SAMPLED), mesh.vertices[faces[row]])
    depth = ground.field(points, mesh.leaf[faces[row, 0]]).depth
    return float(area[-1] * np.where(np.abs(depth) < limit, depth, 0.0).mean())


def _kept(ground: Ground, mesh: Mesh, blank: Blank, limit: float) -> Mesh:
    """The mesh with facets within `limit` [mm] of the cut."""
    asked = np.arange(len(mesh.faces))
    aim, first, least = limit / INWARDS, 0, np.inf
    for _ in range(ROUNDS):
        faces = mesh.faces[asked]
        faces = faces[mesh.cut_in(faces)]
        sides = sides_of(faces)
        # sides between two older vertices have been asked before
        new = np.flatnonzero(sides.ends[:, 1] >= first)
        new = new[mesh.cut_in(sides.ends[new])]
        worst = worst_of(ground, mesh, sides.ends, new, aim)
        far = worst.error > aim
        calm = ~far[sides.of_face].any(axis=1)
        far[_bumpy(ground, mesh, faces[calm], Sides(sides.ends, sides.of_face[calm]), worst, aim=aim)] = True
        far &= lengths(mesh.vertices, sides.ends) > SHORTEST
        # what does not settle is left and told
        count = far.sum()
        if not 0 < count < GROWTH * least:
            break
        least = min(least, count)
        first = len(mesh.vertices)
        mesh, asked = _split(ground, mesh, blank, _Divided.of(faces, sides, far), worst.of(far), aim=aim)
    return mesh


def _bumpy(ground: Ground, mesh: Mesh, faces: Ints, sides: Sides, worst: Worst, *, aim: float) -> Ints:
    """The longest sides of those facets (m, 3) that stand off the cut between their sides.

    Amid a facet that one bite made all around there is nothing new: it is not asked.
    """
    around = np.concatenate([mesh.bite[faces], worst.bites[sides.of_face].reshape(-1, 6)], axis=1)
    rows = np.flatnonzero((around != around[:, :1]).any(axis=1))
    found = ground.field(mesh.vertices[faces[rows]].mean(axis=1), mesh.leaf[faces[rows, 0]])
    depth, alone = found.depth, (found.bite[:, None] != around[rows]).all(axis=1)
    own = sides.of_face[rows[(depth > np.where(alone, HIDDEN, 1.0) * aim) | (depth < -HIDDEN * aim)]]
    length = lengths(mesh.vertices, sides.ends[own.reshape(-1)]).reshape(own.shape)
    return own[np.arange(len(own)), length.argmax(axis=1)]


@dataclass(frozen=True, slots=True)
class _Divided:
    """Sides to divide, and the corners of the facets on them."""

    ends: Ints
    """(n, 2)"""
    owner: Ints
    """(m,) side of each pair of side and corner"""
    corner: Ints
    """(m,)"""

    @staticmethod
    def of(faces: Ints, sides: Sides, far: NDArray[np.bool_]) -> "_Divided":
        """Those of all `sides` of some `faces` that are `far` off."""
        number = np.cumsum(far) - 1
        face, k = np.nonzero(far[sides.of_face])
        across = faces[face, (k + 2) % 3]
        ends = sides.ends[far]
        owner = [np.repeat(np.arange(len(ends)), 2), number[sides.of_face[face, k]]]
        return _Divided(ends, np.concatenate(owner), np.concatenate([ends.ravel(), across]))


def _split(
    ground: Ground, mesh: Mesh, blank: Blank, divided: _Divided, worst: Worst, *, aim: float
) -> tuple[Mesh, Ints]:
    """The mesh with sides divided where they stand furthest off, and which facets are new."""
    ends = divided.ends
    a, b = mesh.vertices[ends].transpose(1, 0, 2)
    points, leaf = a + worst.share[:, None] * (b - a), mesh.leaf[ends[:, 0]]
    beyond = np.flatnonzero(worst.depth > SHARPER * aim)
    edges, sharp = _onto_corners(ground, mesh, divided, (points, worst.bite), beyond)
    points, walls = _onto_ridges(ground, worst, points, leaf)
    points[beyond[sharp]] = edges[sharp]
    bite, lost, _ = newton(ground, points, np.arange(len(points)), leaf)
    walls = walls | (worst.bites[:, 0] == worst.bites[:, 1])
    lost |= walls & _slid(points, worst.share, a, b)
    # where no bite can be the deepest the field is not known
    kept = np.flatnonzero(~lost & ground.passed(points))
    faces, new = parted(mesh.faces, ends[kept], len(mesh.vertices))
    return Mesh(
        np.concatenate([mesh.vertices, points[kept]]),
        faces,
        np.concatenate([mesh.bite, bite[kept]]),
        np.concatenate([mesh.leaf, leaf[kept]]),
        np.concatenate([mesh.within, blank.contains(points[kept])]),
    ), new


def _slid(points: Floats, share: Floats, a: Floats, b: Floats) -> NDArray[np.bool_]:
    """Which points (n, 3) have come from their `share` of the way from a to b most of the way to either end.

    Through a wall whose top is far away a side runs from flank to flank, and so it does where one bite has an
    edge that was not found: what lands on the flanks divides nothing.
    """
    way = b - a
    at = np.einsum("nx,nx->n", points - a, way) / np.maximum(np.einsum("nx,nx->n", way, way), 1e-300)
    return np.minimum(at / share, (1.0 - at) / (1.0 - share)) < SLID


def _onto_ridges(
    ground: Ground, worst: Worst, points: Floats, leaf: Ints
) -> tuple[Floats, NDArray[np.bool_]]:
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
    walls[rows] = np.abs(there) > SETTLED
    return points, walls


def _onto_corners(
    ground: Ground, mesh: Mesh, divided: _Divided, at: tuple[Floats, Ints], rows: Ints
) -> tuple[Floats, NDArray[np.bool_]]:
    """Places on the `rows` (m,) of some sides, where a bite reaches further, brought onto the edge that it
    has there itself, and which of them (m,) there is one for.

    `at` are places (n, 3) on all the sides, and the deepest bites there (n,).
    """
    points, bite = at
    number = np.full(len(points), -1)
    number[rows] = np.arange(len(rows))
    mine = np.flatnonzero(number[divided.owner] >= 0)
    return onto_corners(
        ground.sweep,
        points[rows],
        bite[rows],
        (number[divided.owner[mine]], mesh.vertices[divided.corner[mine]]),
        0.5 * lengths(mesh.vertices, divided.ends[rows]),
    )
