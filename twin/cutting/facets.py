"""Facets divided until they keep to the cut surface, wherever its curvature and its ridges ask for it.

What stands too far off is divided at the worst place of its sides (`sides.py`), which is brought onto the
surface, or onto both bites where two meet. So ridges are cut along, facet by facet.
"""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.dual import Surface
from twin.cutting.landing import Ground, newton
from twin.cutting.parting import parted
from twin.cutting.planes import onto_edges
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
GROWTH = 1.5
"""Times as many sides to divide as in the round before: then dividing them settles nothing"""
STRAYED = 2.0
"""Times its distance from the cut by which a point is moved to where two bites meet"""
ROUNDS = 8
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
    off = abs(_between(ground, mesh))
    if off > VOLUME * volume > 0.0:
        mesh = _kept(ground, mesh, blank, limit * VOLUME * volume / off)
    return Surface(mesh.vertices, mesh.faces, mesh.bite)


def _between(ground: Ground, mesh: Mesh) -> float:
    """Volume between facets and cut [mm³], from random points of the facets; + = the mesh stands too deep."""
    faces = mesh.faces[mesh.cut_in(mesh.faces)]
    if not len(faces):
        return 0.0
    a, b, c = mesh.vertices[faces].transpose(1, 0, 2)
    area = np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0)
    rng = np.random.default_rng(2)
    row = np.minimum(np.searchsorted(area, area[-1] * rng.random(SAMPLED)), len(faces) - 1)
    points = np.einsum("nc,ncx->nx", rng.dirichlet(np.ones(3), SAMPLED), mesh.vertices[faces[row]])
    return float(area[-1] * ground.field(points, mesh.leaf[faces[row, 0]]).depth.mean())


def _kept(ground: Ground, mesh: Mesh, blank: Blank, limit: float) -> Mesh:
    """The mesh with facets within `limit` [mm] of the cut."""
    asked = np.arange(len(mesh.faces))
    aim, first, before = limit / INWARDS, 0, np.inf
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
        # what does not settle, as corners of one bite between its own faces, is left and told
        if not 0 < far.sum() < GROWTH * before:
            break
        before = far.sum()
        first = len(mesh.vertices)
        mesh, asked = _split(ground, mesh, blank, sides.ends[far], worst.of(far))
    return mesh


def _bumpy(ground: Ground, mesh: Mesh, faces: Ints, sides: Sides, worst: Worst, *, aim: float) -> Ints:
    """The longest sides of those facets (m, 3) that stand off the cut between their sides.

    Amid a facet that one bite made all around there is nothing new: it is not asked.
    """
    around = np.concatenate([mesh.bite[faces], worst.bites[sides.of_face].reshape(-1, 6)], axis=1)
    rows = np.flatnonzero((around != around[:, :1]).any(axis=1))
    depth = ground.field(mesh.vertices[faces[rows]].mean(axis=1), mesh.leaf[faces[rows, 0]]).depth
    own = sides.of_face[rows[(depth > aim) | (depth < -HIDDEN * aim)]]
    length = lengths(mesh.vertices, sides.ends[own.reshape(-1)]).reshape(own.shape)
    return own[np.arange(len(own)), length.argmax(axis=1)]


def _split(ground: Ground, mesh: Mesh, blank: Blank, ends: Ints, worst: Worst) -> tuple[Mesh, Ints]:
    """The mesh with sides (n, 2) divided where they stand furthest off, and which facets are new."""
    a, b = mesh.vertices[ends].transpose(1, 0, 2)
    points, leaf = a + worst.share[:, None] * (b - a), mesh.leaf[ends[:, 0]]
    two = np.flatnonzero(worst.bites[:, 0] != worst.bites[:, 1])
    owner = np.repeat(np.arange(len(two)), 2)
    # beside a ridge its bites meet far away: there the surface itself is near
    longest = STRAYED * worst.error[two]
    points[two] = onto_edges(ground.sweep, points[two], owner, worst.bites[two].reshape(-1), longest)
    bite, lost, _ = newton(ground, points, np.arange(len(points)), leaf)
    kept = np.flatnonzero(~lost)
    faces, new = parted(mesh.faces, ends[kept], len(mesh.vertices))
    return Mesh(
        np.concatenate([mesh.vertices, points[kept]]),
        faces,
        np.concatenate([mesh.bite, bite[kept]]),
        np.concatenate([mesh.leaf, leaf[kept]]),
        np.concatenate([mesh.within, blank.contains(points[kept])]),
    ), new
