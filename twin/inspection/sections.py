"""Exact sections of a mesh: by planes z = const, and of those by circles r = const.

Every figure of an inspection is read from points that lie on the mesh itself: where a face crosses a plane,
and where that crossing crosses a circle about the work axis. A point on a plane or circle counts as above or
outside it, so that closed meshes give closed outlines and crossings come in pairs.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from twin.inspection.components import components
from twin.inspection.solid import Floats, Ints, Solid

PART = 1_000_000
"""about so many segments are handled at a time"""
BETWEEN = 20
"""heights between two others at which points are taken"""
EDGE = 1e-4
"""part of the height that is no more between"""
FOLD = 0.005
"""flanks crossed twice or more within this part of a pitch are folded there, where cuts meet"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Segments:
    """The crossings of faces with parallel planes; walking from start to end, material is on the left."""

    heights: Floats
    """(k,) z of the planes [mm], ascending"""
    plane: Ints
    """(n,) index into `heights`"""
    start: Floats
    """(n, 2) [mm]"""
    end: Floats
    """(n, 2) [mm]"""
    start_node: Ints
    """(n,) number of the mesh edge crossed at the start, unique within its plane"""
    end_node: Ints
    """(n,)"""

    def select(self, mask: np.ndarray) -> "Segments":
        """Return the segments where `mask` (n,) is true."""
        return Segments(
            heights=self.heights,
            plane=self.plane[mask],
            start=self.start[mask],
            end=self.end[mask],
            start_node=self.start_node[mask],
            end_node=self.end_node[mask],
        )

    def scaled(self, factor: Floats) -> "Segments":
        """Return the sections scaled about the axis, `factor` (k,) for each plane."""
        each = factor[self.plane, None]
        return Segments(
            heights=self.heights,
            plane=self.plane,
            start=self.start * each,
            end=self.end * each,
            start_node=self.start_node,
            end_node=self.end_node,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Crossings:
    """Where sections cross circles about the axis, sorted by plane, circle and angle."""

    plane: Ints
    """(n,) index of the plane"""
    circle: Ints
    """(n,) index of the radius"""
    angle: Floats
    """(n,) [rad], -pi to pi"""
    left: np.ndarray
    """(n,) bool: a left flank (material towards -angle); else a right flank"""
    segment: Ints
    """(n,) which segment is crossed"""
    along: Floats
    """(n,) how far along it, 0 at its start to 1 at its end"""


def plane_segments(solid: Solid, heights: Floats, *, radius: float | None = None) -> Segments:
    """Cut a solid by the planes z = heights (k,), ascending.

    With a `radius` [mm] only the faces that can meet that cylinder are cut.
    """
    z = solid.vertices[:, 2]
    met = (solid.face_low < heights[-1]) & (solid.face_high >= heights[0])
    if radius is not None:
        met &= (solid.face_near <= radius**2) & (solid.face_far >= radius**2)
    chosen = np.flatnonzero(met)
    first, count = _spans(solid.face_low[chosen], solid.face_high[chosen], heights)
    face, plane = _expand(first, count)
    h = heights[plane]
    a, b, c = solid.faces.take(chosen[face], axis=0).T
    above_a, above_b, above_c = (z[corner] >= h for corner in (a, b, c))
    # one corner lies alone on its side of the plane; walk round the face from it
    lone_a, lone_b = above_b == above_c, above_a == above_c
    apex = np.where(lone_a, a, np.where(lone_b, b, c))
    following = np.where(lone_a, b, np.where(lone_b, c, a))
    preceding = np.where(lone_a, c, np.where(lone_b, a, b))
    lone_above = np.where(lone_a, above_a, np.where(lone_b, above_b, above_c))
    from_corner = np.where(lone_above, following, preceding)
    to_corner = np.where(lone_above, preceding, following)
    start, start_node = _cross_edge(solid.vertices, apex, from_corner, h)
    end, end_node = _cross_edge(solid.vertices, apex, to_corner, h)
    return Segments(
        heights=heights, plane=plane, start=start, end=end, start_node=start_node, end_node=end_node
    )


def plane_segments_in_parts(solid: Solid, heights: Floats) -> Iterator[Segments]:
    """Cut a solid by planes as `plane_segments` does, a few planes at a time to bound the memory taken.

    The planes of each part are numbered from 0 again; together they are `heights`, in order.
    """
    planes = len(heights)
    apart = float(np.diff(heights).min(initial=math.inf))
    if len(solid.faces) + (solid.face_high - solid.face_low).sum() / apart <= PART:
        yield plane_segments(solid, heights)  # there are no more crossings than that
        return
    first, count = _spans(solid.face_low, solid.face_high, heights)
    begin = np.bincount(first, minlength=planes + 1)
    end = np.bincount(first + count, minlength=planes + 1)
    part = np.cumsum(np.cumsum(begin - end)[:planes]) // PART
    for number in range(int(part.max(initial=-1)) + 1):
        if (part == number).any():
            yield plane_segments(solid, heights[part == number])


def points_between(solid: Solid, low: float, high: float) -> Floats:
    """Return points (n, 3) of a solid's surface between two heights [mm]: its vertices, if it ends there.

    Where it goes on, in a shaft or a collar, what stands at the heights themselves is not between them, and
    faces may run past without a vertex: then vertices in between and points of edges at several heights.
    """
    z = solid.vertices[:, 2]
    if low <= z.min() and high >= z.max():
        return solid.vertices
    edge = EDGE * (high - low)
    heights = low + (high - low) * (np.arange(BETWEEN) + 0.5) / BETWEEN
    segments = plane_segments(solid, heights)
    crossed = np.column_stack([segments.start, heights[segments.plane]])
    return np.concatenate([solid.vertices[(z > low + edge) & (z < high - edge)], crossed])


def circle_crossings(segments: Segments, radii: Floats) -> Crossings:
    """Cross sections with circles of `radii` (m,) [mm], ascending; exact on each chord."""
    r_start = np.hypot(*segments.start.T)
    r_end = np.hypot(*segments.end.T)
    # a chord comes nearer to the axis up to its foot and leaves it from there: two crossings are possible
    along = segments.end - segments.start
    length2 = np.einsum("ij,ij->i", along, along)
    foot = -np.einsum("ij,ij->i", segments.start, along) / np.where(length2 > 0, length2, 1.0)
    nearest = np.hypot(*(segments.start + foot[:, None] * along).T)
    nearest = np.where(foot <= 0, r_start, np.where(foot >= 1, r_end, nearest))
    nearest = np.minimum(nearest, np.minimum(r_start, r_end))
    first, count = _spans(np.tile(nearest, 2), np.concatenate([r_start, r_end]), radii)
    piece, circle = _expand(first, count)
    left = piece < len(foot)
    segment = piece % max(len(foot), 1)
    p = segments.start[segment]
    d = along[segment]
    a = length2[segment]
    b = np.einsum("ij,ij->i", p, d)
    c = np.einsum("ij,ij->i", p, p) - radii[circle] ** 2
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    t = np.clip((np.where(left, -root, root) - b) / a, 0.0, 1.0)
    point = p + t[:, None] * d
    angle = np.arctan2(point[:, 1], point[:, 0])
    order = np.lexsort((angle, circle, segments.plane[segment]))
    return Crossings(
        plane=segments.plane[segment][order],
        circle=circle[order],
        angle=angle[order],
        left=left[order],
        segment=segment[order],
        along=t[order],
    )


def unfolded(crossings: Crossings, within: float | Floats) -> Crossings:
    """Take crossings that lie closer together than `within` [rad] for one: where cuts meet a mesh may fold.

    Of an odd number one is left, as far out as all their material together reaches; an even number, a nick on
    one side of the circle, goes. `within` is one angle, or (n,) one for every crossing.
    """
    sense = np.where(crossings.left, 1, -1)
    together = (np.diff(crossings.plane) == 0) & (np.diff(crossings.circle) == 0)
    near = together & (np.diff(crossings.angle) < np.broadcast_to(within, sense.shape)[1:])
    if not near.any():
        return crossings
    group = np.concatenate([[0], np.cumsum(~near)])
    net = np.bincount(group, weights=sense).astype(np.int64)[group]
    begin = crossings.angle[np.searchsorted(group, group)]
    reach = np.bincount(group, weights=sense * (crossings.angle - begin))[group]
    one = np.abs(net) == 1
    # whichever of the group first goes the way of all of them stands for it; what stays unclear stays
    candidates = np.flatnonzero(one & (sense == net))
    chosen = candidates[np.diff(group[candidates], prepend=-1) != 0]
    kept = np.sort(np.concatenate([chosen, np.flatnonzero(np.abs(net) > 1)]))
    angle = np.where(one, begin + net * reach, crossings.angle)
    return Crossings(
        plane=crossings.plane[kept],
        circle=crossings.circle[kept],
        angle=angle[kept],
        left=crossings.left[kept],
        segment=crossings.segment[kept],
        along=crossings.along[kept],
    )


def outer_outlines(segments: Segments) -> Segments:
    """Keep, in every plane, the closed outline of largest area: bores and loose pieces go."""
    if len(segments.plane) == 0:
        return segments
    swept = _cross(segments.start, segments.end)
    if (swept >= 0).all() and (turns_about_axis(segments) < 1.5).all():
        return segments  # what only goes forward and once round is one outline
    n, planes = len(segments.plane), len(segments.heights)
    # every node is the start of one segment and the end of another
    by_start = np.argsort(segments.start_node * planes + segments.plane)
    by_end = np.argsort(segments.end_node * planes + segments.plane)
    loop = components(n, by_end, by_start)
    area = np.bincount(loop, weights=swept)
    plane_of = np.zeros(len(area), dtype=np.int64)
    plane_of[loop] = segments.plane
    largest = np.full(len(segments.heights), -np.inf)
    np.maximum.at(largest, plane_of, area)
    return segments.select(area[loop] == largest[segments.plane])


def outline(segments: Segments, plane: int) -> Floats:
    """Chain the one closed outline of a plane into (n, 2) points [mm], material on the left."""
    chosen = segments.select(segments.plane == plane)
    following = dict(zip(chosen.start_node.tolist(), chosen.end_node.tolist(), strict=True))
    row = {node: i for i, node in enumerate(chosen.start_node.tolist())}
    node = int(chosen.start_node[0])
    rows = []
    for _ in range(len(row)):
        rows.append(row[node])
        node = following[node]
    return chosen.start[rows]


def turns_about_axis(segments: Segments) -> Floats:
    """Return how often the outlines of each plane go round the axis, (k,); clockwise is negative."""
    start, end = segments.start, segments.end
    swept = _cross(start, end)
    angle = np.arctan2(swept, np.einsum("ij,ij->i", start, end))
    return np.bincount(segments.plane, weights=angle, minlength=len(segments.heights)) / (2 * np.pi)


def radial_limits(segments: Segments) -> tuple[Floats, Floats]:
    """Return least and largest radius [mm] of the outlines in each plane, (k,) each; NaN if empty."""
    p, d = segments.start, segments.end - segments.start
    square = np.maximum(np.einsum("ij,ij->i", d, d), np.finfo(np.float64).tiny)
    foot = p + np.clip(-np.einsum("ij,ij->i", p, d) / square, 0.0, 1.0)[:, None] * d
    low = np.full(len(segments.heights), np.inf)
    high = np.full(len(segments.heights), -np.inf)
    np.minimum.at(low, segments.plane, np.hypot(*foot.T))
    np.maximum.at(high, segments.plane, np.hypot(*p.T))
    empty = ~np.isfinite(low)
    low[empty] = high[empty] = np.nan
    return low, high


def _spans(low: Floats, high: Floats, levels: Floats) -> tuple[Ints, Ints]:
    """Return for each interval low < level <= high the first level's index and how many there are."""
    first = np.searchsorted(levels, low, side="right")
    last = np.searchsorted(levels, high, side="right")
    return first, last - first


def _expand(first: Ints, count: Ints) -> tuple[Ints, Ints]:
    """List all pairs (item, level) of the spans."""
    item = np.repeat(np.arange(len(count)), count)
    offset = np.arange(len(item)) - np.repeat(np.cumsum(count) - count, count)
    return item, first[item] + offset


def _cross_edge(vertices: Floats, one: Ints, other: Ints, z: Floats) -> tuple[Floats, Ints]:
    """Cross mesh edges with z; the same from both of an edge's faces, to the last bit."""
    low, high = np.minimum(one, other), np.maximum(one, other)
    # take, and in place: half the work of a section is here
    a, along = vertices.take(low, axis=0), vertices.take(high, axis=0)
    along -= a
    along *= ((z - a[:, 2]) / along[:, 2])[:, None]
    along += a
    return along[:, :2], low * len(vertices) + high


def _cross(a: Floats, b: Floats) -> Floats:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
