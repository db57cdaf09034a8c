"""The sides of facets against the field: where each stands furthest off the cut."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.landing import Ground
from twin.cutting.sweep import Deepest

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

TANGENTS = 2
"""Places at which a side that a ridge crosses is asked beside its middle"""
SURELY = 0.25
"""Share of what is aimed at within which a ridge between tangents is left alone."""
LIKELY = 0.6
"""Share of what is aimed at that is expected beside a ridge, from which on it is asked"""
NEAREST = 0.05
"""Share of the way between two tangents that a third stays away from both"""


@dataclass(frozen=True, slots=True)
class Mesh:
    """A surface while it is divided."""

    vertices: Floats
    """(n, 3) [mm]"""
    faces: Ints
    """(m, 3)"""
    bite: Ints
    """(n,) that made each vertex, −1 = none"""
    leaf: Ints
    """(n,) finest block that each comes from"""
    within: Bools
    """(n,) whether it lies in the blank"""

    def cut_in(self, corners: Ints) -> Bools:
        """Which facets or sides (k, c) bites made, within the blank at least at one end."""
        return np.logical_and((self.bite[corners] >= 0).all(axis=1), self.within[corners].any(axis=1))


@dataclass(frozen=True, slots=True)
class Sides:
    """The sides of some facets, each once."""

    ends: Ints
    """(n, 2) vertices, the lower number first"""
    of_face: Ints
    """(m, 3) of each facet: from its first corner to its second, and so on"""


@dataclass(frozen=True, slots=True)
class Worst:
    """Where each of some sides stands furthest off the cut, as far as is known."""

    share: Floats
    """(n,) of the way from its first end"""
    depth: Floats
    """(n,) of the field there [mm]; 0 where nobody asked"""
    bite: Ints
    """(n,) the deepest there"""
    bites: Ints
    """(n, 2) deepest on either side of that place"""

    @property
    def error(self) -> Floats:
        """(n,) [mm]"""
        return np.abs(self.depth)

    def of(self, rows: Bools) -> "Worst":
        """Those of some sides."""
        return Worst(self.share[rows], self.depth[rows], self.bite[rows], self.bites[rows])


def sides_of(faces: Ints) -> Sides:
    """The sides of facets (m, 3)."""
    pairs = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    count = int(pairs.max(initial=0)) + 1
    keys, row = np.unique(pairs[:, 0] * count + pairs[:, 1], return_inverse=True)
    return Sides(np.stack(np.divmod(keys, count), axis=1), row.reshape(-1, 3))


def lengths(vertices: Floats, ends: Ints) -> Floats:
    """(n,) of sides [mm]."""
    return np.linalg.norm(vertices[ends[:, 1]] - vertices[ends[:, 0]], axis=1)


def worst_of(ground: Ground, mesh: Mesh, ends: Ints, rows: Ints, aim: float) -> Worst:
    """Sides (n, 2) against the field, the `rows` of them that are asked: at their middles, and on ridges.

    The field along a side is the deepest bite's. Between two bites it is lowest where their tangents are as
    deep: tangents are drawn where the field was asked, and the field is asked where they meet, unless that
    is well within the `aim` [mm]. Between the ridge and the ends it is asked where it may stand as high.
    """
    bites = mesh.bite[ends]
    worst = Worst(np.full(len(ends), 0.5), np.zeros(len(ends)), bites[:, 0].copy(), bites)

    def asked(rows: Ints, share: Floats) -> Deepest:
        a, b = mesh.vertices[ends[rows]].transpose(1, 0, 2)
        found = ground.field(a + share[:, None] * (b - a), mesh.leaf[ends[rows, 0]])
        worse = np.abs(found.depth) > np.abs(worst.depth[rows])
        at = rows[worse]
        worst.share[at], worst.depth[at], worst.bite[at] = share[worse], found.depth[worse], found.bite[worse]
        return found

    found = asked(rows, worst.share[rows])
    two = (worst.bites[rows] != found.bite[:, None]).any(axis=1)
    rows, found = rows[two], found.of(two)
    way = mesh.vertices[ends[rows, 1]] - mesh.vertices[ends[rows, 0]]
    used, at = np.unique(ends[rows], return_inverse=True)
    normal = ground.sweep.evaluate(mesh.vertices[used], mesh.bite[used], gradient=True).gradient
    at_ends = np.einsum("ncx,nx->nc", normal[at.reshape(-1, 2)], way)
    # place, depth and slope of the tangents on the left and on the right
    place = np.broadcast_to([0.0, 1.0], at_ends.shape).copy()
    depth, slope = np.zeros_like(at_ends), at_ends.copy()
    # over a ridge of metal the field falls and rises again, over a corner it rises and falls
    hollow = at_ends[:, 0] > at_ends[:, 1]
    ridge, height = np.full(len(rows), 0.5), found.depth.copy()
    left = np.arange(len(rows))
    for _ in range(TANGENTS):
        rises = np.einsum("nx,nx->n", found.gradient, way[left])
        side = left, ((rises > 0) != hollow[left]).astype(np.int64)
        place[side], depth[side], slope[side] = ridge[left], found.depth, rises
        worst.bites[rows[left], side[1]] = found.bite
        where, low = _between(place[left], depth[left], slope[left])
        left, where = left[np.abs(low) > SURELY * aim], where[np.abs(low) > SURELY * aim]
        found = asked(rows[left], where)
        ridge[left], height[left] = where, found.depth
    # a parabola from each end, by its slope there, to the ridge
    for share, rise in (
        (0.5 * ridge, at_ends[:, 0] * ridge),
        (0.5 + 0.5 * ridge, at_ends[:, 1] * (ridge - 1.0)),
    ):
        high = np.flatnonzero(rise + height > 4.0 * LIKELY * aim)
        asked(rows[high], share[high])
    return worst


def _between(place: Floats, depth: Floats, slope: Floats) -> tuple[Floats, Floats]:
    """Where two tangents (n, 2) are as deep, kept between their places (n, 2), and how deep that is."""
    left, right = place.T
    with np.errstate(divide="ignore", invalid="ignore"):
        base = depth - slope * place
        met = (base[:, 1] - base[:, 0]) / (slope[:, 0] - slope[:, 1])
    met = np.where(np.isfinite(met), met, 0.5 * (left + right))
    edge = NEAREST * (right - left)
    met = np.clip(met, left + edge, right - edge)
    return met, np.abs(depth + slope * (met[:, None] - place)).max(axis=1)
