"""Charts of the gaps of a gear: every place is on a ray from inside a gap, across its flank, into the tooth.

In the section of a gap, +x leads outwards along its middle. Ray i leaves the middle at `inner[i]`, runs along
`along[i]` and crosses the expected surface at `surface[i]`; it ends in the middle of the tooth or below all
the tool can reach. The sections are turned with the gap's twist. Between the nodes the chart is linear in
each direction. Depths `tau` [mm] on a ray count from the expected surface, + into the material.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.motion import RigidTransform
from twin.cutting.regular.indexing import Indexing
from twin.cutting.regular.irregular import IrregularError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FAN = 0.3
"""Share of the tooth height above the root at which the rays into the root have their common origin."""
CORE = 0.3
"""Share of the tooth height below the root at which rays end, or half the root where that is more."""
BEYOND = 1.15
"""How much longer the rays into the root are than needed: a chord between two cuts off the core's corner."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """The section of a gap, before its surface is known."""

    indexing: Indexing
    stock: float
    """radius that holds the blank [mm]"""
    margin: float
    """how much further out the surface is wanted [mm]"""

    @property
    def outside(self) -> float:
        """Radius to which the surface is wanted [mm]."""
        return self.stock + self.margin

    @property
    def height(self) -> float:
        """Of the teeth [mm]."""
        return self.outside - self.indexing.root

    @property
    def fan(self) -> float:
        """x of the common origin of the rays into the root [mm]."""
        return self.indexing.root + FAN * self.height

    @property
    def core(self) -> float:
        """Radius below which no ray is needed [mm]."""
        return max(self.indexing.root - CORE * self.height, 0.5 * self.indexing.root)

    def reach(self, start: Floats, along: Floats) -> Floats:
        """(n,) way from `start` (n, 2) along unit vectors to the middles of the teeth or the core [mm]."""
        half = math.pi / self.indexing.teeth
        found = np.full(len(start), np.inf)
        for side in (-1.0, 1.0):
            normal = np.array([-math.sin(half), side * math.cos(half)])
            rate = along @ normal
            with np.errstate(divide="ignore"):
                way = np.where(rate > 1e-9, -(start @ normal) / rate, np.inf)
            found = np.minimum(found, way)
        b = (start * along).sum(axis=1)
        rest = b * b - (start * start).sum(axis=1) + self.core**2
        hits = (rest > 0) & (b < 0)
        return np.where(hits, np.minimum(found, -b - np.sqrt(np.maximum(rest, 0.0))), found)

    def trial(self, flank: int, root: int) -> tuple[Floats, Floats]:
        """Origins and directions (n, 2) of rays to find the surface with, from the one tip to the other."""
        # a gap is wider at its tips than half the pitch
        first = self.outside * math.cos(0.5 * math.pi / self.indexing.teeth)
        x = np.linspace(first, self.fan, flank + 1)[:-1]
        angle = np.linspace(0.5 * math.pi, 1.5 * math.pi, root)
        zeros, ones = np.zeros(flank), np.ones(flank)
        start = np.concatenate(
            [
                np.stack([x, zeros], axis=1),
                np.tile([self.fan, 0.0], (root, 1)),
                np.stack([x, zeros], axis=1)[::-1],
            ]
        )
        along = np.concatenate(
            [
                np.stack([zeros, ones], axis=1),
                np.stack([np.cos(angle), np.sin(angle)], axis=1),
                np.stack([zeros, -ones], axis=1),
            ]
        )
        return start, along


@dataclass(frozen=True, slots=True, kw_only=True)
class Chart:
    """The nodes of all gaps: rays (nu + 1) across a gap, sections (nz + 1) along it."""

    frame: Frame
    mount: RigidTransform
    surface: Floats
    """(nu + 1, 2) expected surface in a gap's section [mm]"""
    along: Floats
    """(nu + 1, 2) unit vectors"""
    inner: Floats
    """(nu + 1,) way back from the surface to the gap's middle [mm]"""
    outer: Floats
    """(nu + 1,) way on to the middle of the tooth and beyond [mm]"""
    z: Floats
    """(nz + 1,) ascending [mm]"""
    lift: Floats
    """(gaps,) by which each gap's nodes stand higher than `z` [mm]"""

    @property
    def gaps(self) -> int:
        """Number of gaps."""
        return self.frame.indexing.teeth

    @property
    def cells(self) -> tuple[int, int]:
        """Cells across and along a gap."""
        return len(self.surface) - 1, len(self.z) - 1

    def at(self, gap: Ints, i: Ints, k: Ints, tau: Floats) -> tuple[Floats, Floats]:
        """Points (…, 3) of the part on rays, `tau` behind the expected surface, and the rays' directions.

        The arguments are of one shape, or broadcast to one.
        """
        indexing = self.frame.indexing
        z = self.z[k] + self.lift[gap]
        angle = indexing.phase + 2.0 * math.pi / self.gaps * gap + indexing.twist * z
        cos, sin = np.cos(angle), np.sin(angle)
        dx, dy = self.along[i, 0], self.along[i, 1]
        x, y = self.surface[i, 0] + tau * dx, self.surface[i, 1] + tau * dy
        points = np.stack(np.broadcast_arrays(x * cos - y * sin, x * sin + y * cos, z), axis=-1)
        ways = np.stack(np.broadcast_arrays(dx * cos - dy * sin, dx * sin + dy * cos, 0.0 * cos), axis=-1)
        rotation, shift = self.mount.rotation, self.mount.translation
        return (points - shift) @ rotation, ways @ rotation


def chart_along(frame: Frame, mount: RigidTransform, surface: Floats, z: Floats, lift: Floats) -> Chart:
    """The chart of a surface (nu + 1, 2) from the one tip to the other. Raises IrregularError for no gap."""
    fan, top = frame.fan, frame.outside
    first = max(surface[0, 0], surface[-1, 0])
    if first <= fan or np.abs(np.diff(np.sign(surface[:, 1]))).sum() != 2:
        raise IrregularError("the section of a gap is not open at its tips and closed below")
    # the first and the last ray stay outside of the blank, the others spread down to the fan
    stretch = max(top + frame.height * 0.05 - fan, 0.0) / (first - fan)
    start = np.zeros_like(surface)
    start[:, 0] = fan + np.maximum(surface[:, 0] - fan, 0.0) * stretch
    along = surface - start
    inner = np.linalg.norm(along, axis=1)
    if inner.min() <= 0:
        raise IrregularError("the section of a gap has no room in its middle")
    along /= inner[:, None]
    fanned = start[:, 0] == fan
    outer = np.where(fanned, BEYOND, 1.0) * frame.reach(start, along) - inner
    if not (np.isfinite(outer).all() and outer.min() > 0):
        raise IrregularError("the gap is wider than its pitch")
    chart = Chart(
        frame=frame, mount=mount, surface=surface, along=along, inner=inner, outer=outer, z=z, lift=lift
    )
    _check_cover(chart)
    return chart


def _check_cover(chart: Chart) -> None:
    """Raise IrregularError unless the rays cover the sector between two tooth middles, core to outside."""
    frame = chart.frame
    half = math.pi / chart.gaps
    ends = chart.surface + chart.outer[:, None] * chart.along
    starts = chart.surface - chart.inner[:, None] * chart.along
    # fan out one way: every ray turns on
    a, b = starts[:-1], starts[1:]
    quads = [(a, chart.surface[:-1], chart.surface[1:]), (a, ends[:-1], ends[1:]), (b, ends[:-1], ends[1:])]
    turns = [_cross(p - o, q - o) for o, p, q in quads]
    rim = max(float(np.hypot(*starts[0])), float(np.hypot(*starts[-1])))
    edges = [np.stack([starts[0], ends[0]]), np.stack([starts[-1], ends[-1]])]
    lowest = min(_distance(edge) for edge in edges)
    corner = frame.core * np.array([math.cos(half), math.sin(half)])
    polygon = np.vstack([starts[:1], ends, starts[-1:]])
    held = all(_inside(polygon, corner * [1.0, side]) for side in (-1.0, 1.0))
    if min(float(t.min()) for t in turns) < -1e-12 or not held or min(lowest, rim) < frame.stock:
        raise IrregularError("rays into the teeth do not cover them")


def _cross(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _distance(edge: Floats) -> float:
    """Of a stretch (2, 2) from the origin."""
    a, way = edge[0], edge[1] - edge[0]
    t = np.clip(-(a @ way) / (way @ way), 0.0, 1.0)
    return float(np.hypot(*(a + t * way)))


def _inside(polygon: Floats, point: Floats) -> bool:
    """Whether a point lies in a polygon (n, 2)."""
    (x0, y0), (x1, y1) = polygon.T, np.roll(polygon, -1, axis=0).T
    crossed = (y0 > point[1]) != (y1 > point[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        at = x0 + (point[1] - y0) / (y1 - y0) * (x1 - x0)
    return bool((crossed & (at > point[0])).sum() % 2)
