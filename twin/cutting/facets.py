"""Facets divided until they keep to the cut surface, wherever its curvature and its ridges ask for it.

What stands too far off is divided at the worst places of its sides (`sides.py`), brought onto the surface
(`placing.py`); flat facets that this leaves are turned (`turning.py`).
"""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.dual import Surface
from twin.cutting.landing import Ground
from twin.cutting.parting import among, parted
from twin.cutting.placing import placed
from twin.cutting.sides import Mesh, Sides, Worst, lengths, sides_of, worst_of
from twin.cutting.turning import unflattened

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

INWARDS = 1.4
"""Error amid a facet against the largest of its sides: on an evenly curved surface 4/3."""
HIDDEN = 2.0 / 3.0
"""Share of what is aimed at by which metal may stand out amid a facet: a peak is higher than its middle."""
VOLUME = 0.7e-4
"""Share of the part's volume that may lie between its facets and the cut"""
AMID = np.array([[2, 2, 2], [4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6.0
"""Shares of its corners in the places amid a facet that are asked"""
SAMPLED = 4000
"""points of facets that tell it"""
GROWTH = 1.5
"""Times as many sides to divide as in the round with the least: then dividing them settles nothing"""
ROUNDS = 30
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
    again = np.zeros((0, 2), dtype=np.int64)
    for _ in range(ROUNDS):
        faces = mesh.faces[asked]
        faces = faces[mesh.cut_in(faces)]
        sides = sides_of(faces)
        # most sides between two older vertices have been asked before
        new = (sides.ends[:, 1] >= first) | among(sides.ends, again, len(mesh.vertices))
        new = np.flatnonzero(new & (mesh.bite[sides.ends] >= 0).all(axis=1))
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
        mesh, asked, again = _split(ground, mesh, blank, sides.ends[far], worst.of(far), aim=aim)
    return mesh


def _bumpy(ground: Ground, mesh: Mesh, faces: Ints, sides: Sides, worst: Worst, *, aim: float) -> Ints:
    """The longest sides of those facets (m, 3) that stand off the cut between their sides.

    All are asked in their middles; those that more than one bite made nearer to their corners as well.
    """
    around = np.concatenate([mesh.bite[faces], worst.bites[sides.of_face].reshape(-1, 6)], axis=1)
    several = np.flatnonzero((around != around[:, :1]).any(axis=1))
    bumpy = np.zeros(len(faces), dtype=bool)
    for share, rows in zip(AMID, [np.arange(len(faces)), several, several, several], strict=True):
        corners = mesh.vertices[faces[rows]]
        found = ground.field(np.einsum("c,ncx->nx", share, corners), mesh.leaf[faces[rows, 0]])
        alone = (found.bite[:, None] != around[rows]).all(axis=1)
        peak = (found.depth > np.where(alone, HIDDEN, 1.0) * aim) | (found.depth < -HIDDEN * aim)
        bumpy[rows[peak]] = True
    own = sides.of_face[bumpy]
    length = lengths(mesh.vertices, sides.ends[own.reshape(-1)]).reshape(own.shape)
    return own[np.arange(len(own)), length.argmax(axis=1)]


def _split(
    ground: Ground, mesh: Mesh, blank: Blank, ends: Ints, worst: Worst, *, aim: float
) -> tuple[Mesh, Ints, Ints]:
    """The mesh with sides (n, 2) divided where they stand furthest off, which facets are new, and old sides
    to be asked again."""
    new = placed(ground, mesh, ends, worst, aim=aim)
    faces, asked = parted(mesh.faces, ends[new.good], len(mesh.vertices))
    mesh = Mesh(
        np.concatenate([mesh.vertices, new.points[new.good]]),
        faces,
        np.concatenate([mesh.bite, new.bite[new.good]]),
        np.concatenate([mesh.leaf, mesh.leaf[ends[new.good, 0]]]),
        np.concatenate([mesh.within, blank.contains(new.points[new.good])]),
    )
    mesh, asked, fresh = unflattened(ground, mesh, asked, ends[new.there >= 0], aim=aim)
    return mesh, asked, np.concatenate([fresh, ends[~new.good]])
