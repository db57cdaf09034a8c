"""The sides of facets against the field: where each stands furthest off the cut."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.landing import Ground
from twin.cutting.parting import pairs_of
from twin.cutting.sweep import Deepest

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

QUARTERS = 0.25, 0.5, 0.75
"""Shares of the way along a side at which every one is asked"""
BETWEEN = 0.125, 0.375, 0.625, 0.875
"""Shares at which those are asked that may stand off it"""
NEARLY = 0.75
"""Share of what is aimed at from which on a side is asked more closely"""
RIDGE = 0.5
"""The same for how far tangents at both ends let it run in metal"""
RISE = 4.8
"""The same for the rise of the tangent at one end over all of its length: a parabola has a quarter of it"""
SURELY = 0.25
"""The same within which tangents that meet are left alone"""
NEAREST = 0.02
"""Share of the way between two places that their tangents must meet away from both"""


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
        """Which facets (k, c) bites made, within the blank at least at one corner."""
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
    """(n, 2) deepest at the nearest places that were asked on either side"""
    places: Floats
    """(n, 2) shares of the way at which these are"""

    @property
    def error(self) -> Floats:
        """(n,) [mm]"""
        return np.abs(self.depth)

    def of(self, rows: Bools | Ints) -> "Worst":
        """Those of some sides."""
        return Worst(self.share[rows], self.depth[rows], self.bite[rows], self.bites[rows], self.places[rows])

    def put(self, rows: Ints, there: "Worst") -> None:
        """Put in what is known of some sides (m,)."""
        for name in Worst.__slots__:
            getattr(self, name)[rows] = getattr(there, name)


def sides_of(faces: Ints) -> Sides:
    """The sides of facets (m, 3)."""
    pairs = pairs_of(faces).reshape(-1, 2)
    count = int(pairs.max(initial=0)) + 1
    keys, row = np.unique(pairs[:, 0] * count + pairs[:, 1], return_inverse=True)
    return Sides(np.stack(np.divmod(keys, count), axis=1), row.reshape(-1, 3))


def lengths(vertices: Floats, ends: Ints) -> Floats:
    """(n,) of sides [mm]."""
    return np.linalg.norm(vertices[ends[:, 1]] - vertices[ends[:, 0]], axis=1)


def worst_of(ground: Ground, mesh: Mesh, ends: Ints, rows: Ints, aim: float) -> Worst:
    """Sides (n, 2) against the field, the `rows` of them that are asked.

    They are asked at QUARTERS. Where that, or the tangents at the ends, let expect more than the `aim` [mm],
    they are asked BETWEEN those as well, and where the tangents of neighbouring places meet highest: there
    two bites meet, or two sides of one.
    """
    bites = mesh.bite[ends]
    known = np.full(len(ends), 0.5), np.zeros(len(ends)), bites[:, 0].copy(), bites
    worst = Worst(*known, np.tile([0.0, 1.0], (len(ends), 1)))
    ways = _Ways.of(ground, mesh, ends[rows])
    along = _Along.at_ends(ways, bites[rows]).and_at(ways.asked(ground, QUARTERS))
    worst.put(rows, along.highest())
    some = along.doubtful(aim)
    rows, ways = rows[some], ways.some(some)
    along = along.some(some).and_at(ways.asked(ground, BETWEEN))
    worst.put(rows, along.highest())
    peak, height = along.peaks()
    some = np.flatnonzero(height > np.maximum(SURELY * aim, worst.error[rows]))
    rows, peak = rows[some], peak.of(some)
    found = ways.some(some).at(ground, peak.share)
    peak.depth[:], peak.bite[:] = found.depth, found.bite
    further = peak.error >= worst.error[rows]
    worst.put(rows[further], peak.of(further))
    return worst


@dataclass(frozen=True, slots=True)
class _Ways:
    """Sides on their way from their first end to the other."""

    start: Floats
    """(n, 3) [mm]"""
    way: Floats
    """(n, 3) [mm]"""
    leaf: Ints
    """(n,) finest block that each starts in"""
    slope: Floats
    """(n, 2) of the field's tangents at both ends, over all of the way [mm]"""

    @staticmethod
    def of(ground: Ground, mesh: Mesh, ends: Ints) -> "_Ways":
        """Those of sides (n, 2)."""
        start, end = mesh.vertices[ends].transpose(1, 0, 2)
        used, number = np.unique(ends, return_inverse=True)
        normal = ground.sweep.evaluate(mesh.vertices[used], mesh.bite[used], gradient=True).gradient
        slope = np.einsum("ncx,nx->nc", normal[number.reshape(-1, 2)], end - start)
        return _Ways(start, end - start, mesh.leaf[ends[:, 0]], slope)

    def some(self, rows: Ints) -> "_Ways":
        """Some of them."""
        return _Ways(self.start[rows], self.way[rows], self.leaf[rows], self.slope[rows])

    def at(self, ground: Ground, share: Floats | float) -> Deepest:
        """The field at a share (n,) of each way."""
        return ground.field(self.start + np.reshape(share, (-1, 1)) * self.way, self.leaf)

    def asked(self, ground: Ground, shares: tuple[float, ...]) -> "_Along":
        """The field at the same shares of all of them."""
        found = [self.at(ground, share) for share in shares]
        return _Along(
            np.array(shares),
            np.stack([f.depth for f in found], axis=1),
            np.stack([np.einsum("nx,nx->n", f.gradient, self.way) for f in found], axis=1),
            np.stack([f.bite for f in found], axis=1),
        )


@dataclass(frozen=True, slots=True)
class _Along:
    """The field at some places along sides."""

    share: Floats
    """(k,) of the way, ascending"""
    depth: Floats
    """(n, k) [mm]"""
    slope: Floats
    """(n, k) of its tangents, over all of the way [mm]"""
    bite: Ints
    """(n, k) the deepest"""

    @staticmethod
    def at_ends(ways: _Ways, bites: Ints) -> "_Along":
        """At both ends, which `bites` (n, 2) made."""
        return _Along(np.array([0.0, 1.0]), np.zeros_like(ways.slope), ways.slope, bites)

    def and_at(self, other: "_Along") -> "_Along":
        """The same at more places."""
        share = np.concatenate([self.share, other.share])
        order = np.argsort(share)
        columns = ((getattr(self, name), getattr(other, name)) for name in ("depth", "slope", "bite"))
        return _Along(share[order], *(np.concatenate(pair, axis=1)[:, order] for pair in columns))

    def some(self, rows: Ints) -> "_Along":
        """Of some sides."""
        return _Along(self.share, self.depth[rows], self.slope[rows], self.bite[rows])

    def doubtful(self, aim: float) -> Ints:
        """Sides that may stand off the cut by the `aim` [mm]."""
        # into what is gone, and into metal, from either end
        rise = self.slope[:, [0, -1]] * [1.0, -1.0]
        fall = np.maximum(-rise, 0.0)
        ridge = fall.prod(axis=1) / np.maximum(fall.sum(axis=1), 1e-300)
        found = np.abs(self.depth).max(axis=1) > NEARLY * aim
        return np.flatnonzero(found | (ridge > RIDGE * aim) | (rise.max(axis=1) > RISE * aim))

    def highest(self) -> Worst:
        """The place that stands furthest off."""
        n, k = np.arange(len(self.depth)), np.abs(self.depth[:, 1:-1]).argmax(axis=1) + 1
        beside = np.stack([k - 1, k + 1], axis=1)
        bites = self.bite[n[:, None], beside]
        return Worst(self.share[k], self.depth[n, k], self.bite[n, k], bites, self.share[beside])

    def peaks(self) -> tuple[Worst, Floats]:
        """Where the tangents of two neighbouring places meet furthest off, and how far that is (n,); 0 where
        none do between their places."""
        step = np.diff(self.share)
        with np.errstate(divide="ignore", invalid="ignore"):
            met = self.depth[:, 1:] - self.depth[:, :-1] - self.slope[:, 1:] * step
            met = met / (self.slope[:, :-1] - self.slope[:, 1:])
        between = (met > NEAREST * step) & (met < (1.0 - NEAREST) * step)
        met = np.where(between, met, 0.0)
        height = np.where(between, np.abs(self.depth[:, :-1] + self.slope[:, :-1] * met), 0.0)
        n, k = np.arange(len(height)), height.argmax(axis=1)
        beside = np.stack([k, k + 1], axis=1)
        bites = self.bite[n[:, None], beside]
        there = Worst(self.share[k] + met[n, k], np.zeros(len(n)), bites[:, 0], bites, self.share[beside])
        return there, height[n, k]
