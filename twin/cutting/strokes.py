"""Strokes of a form grinding wheel: one by one along gaps that it alone shapes.

While the wheel passes a transverse plane of the part, what it takes away there is seen whole from a point in
the wheel's middle plane just outside the blank. Rays fan out from that point; along each the way out of the
wheel, the furthest over all time, is a point of the cut surface. One tube a stroke, one boolean for all.

What is assumed, a way along a gap from end to end and one way out on each ray, is looked at for every ray,
and points of the finished surface are held against every instant of their stroke. Where it does not hold,
the general way cuts the part.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.check import Errors
from twin.cutting.dual import Surface
from twin.cutting.engagement import StockCylinder, turning_runs
from twin.cutting.motion import CutterMotion
from twin.cutting.passing_wheel import PassingWheel, standing_wheel
from twin.cutting.stock import Remains

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

OUTSIDE = 0.15
"""Of the profile's depth: how far outside the blank the rays begin [mm/mm]."""
OVER = 0.7
"""[mm] that a tube goes on beyond the faces of the toothed part"""
DEEPEST = 0.25
"""[mm] above its deepest that a stroke may stand and still count as at depth"""
NEARBY = 128
"""[samples] by which the deepest instant moves at most as a point moves along its ray"""
HUMPS = (256, 2)
"""[samples] within which the deepest instant is looked for hump by hump, and how closely"""
ROUNDS = 14
"""halvings along a ray; the profile itself does the rest"""
CHECKED = 300
"""vertices, and as many middles of facets, that are held against every instant of their stroke"""
CORNER = 0.1
"""[rad] by which the wheel's outline turns at a corner, which has rays of its own"""
POLISH = 3
"""steps of Newton's method onto the profile"""
BEHIND = (0.25, 0.6)
"""Shares of the rest of a ray at which the wheel must not be met again."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Strokes:
    """What all strokes remove."""

    tubes: tuple[Surface, ...]
    """one for each stroke"""
    times: tuple[Floats, ...]
    """when the wheel made the vertices (n,) of each [s]; NaN beyond the blank"""
    vertices: Errors
    """of random vertices from the envelope of their stroke"""
    facets: Errors
    """of random middles of facets"""
    wheels: tuple[PassingWheel, ...]
    """on their strokes"""


def ridges(strokes: list[Strokes], remains: Remains) -> Errors:
    """How far random vertices stand off the cut where two strokes meet: there the boolean made them, of
    their facets alone."""
    wheels = [wheel for one in strokes for wheel in one.wheels]
    first = np.cumsum([0, *(len(tube.faces) for one in strokes for tube in one.tubes)])
    made = remains.origin >= 0
    tube = np.repeat(np.searchsorted(first, remains.origin[made], side="right") - 1, 3)
    corner = remains.faces[made].ravel()
    low, high = np.full(len(remains.vertices), len(wheels)), np.full(len(remains.vertices), -1)
    np.minimum.at(low, corner, tube)
    np.maximum.at(high, corner, tube)
    rows = np.flatnonzero(low < high)
    rows = np.random.default_rng(0).choice(rows, min(CHECKED, len(rows)), replace=False)
    points = remains.vertices[rows].astype(np.float64)
    depth = np.full(len(rows), -np.inf)
    for number, wheel in enumerate(wheels):
        near = np.flatnonzero((low[rows] == number) | (high[rows] == number))
        if len(near):
            depth[near] = np.maximum(depth[near], wheel.held(points[near]))
    return Errors(points, np.abs(depth))


def find_strokes(blank: Blank, cutter: Cutter, motion: CutterMotion, cell: float) -> Strokes | None:
    """The tubes of all strokes; None where the motion is not one of strokes along whole gaps.

    `cell` is the spacing of the layers along z, twice that across the surface [mm].
    """
    if not cutter.revolved:
        return None
    runs = _near(blank, cutter, motion)
    if not len(runs):
        return None
    standing = standing_wheel(cutter.profile)
    wheels = [standing.along(motion, (int(a), int(b)), blank.radius) for a, b in runs]
    closest = min(float(np.hypot(*wheel.centre[:, :2].T).min()) for wheel in wheels) - cutter.radius
    layers = _layers(blank, closest, cell)
    if layers is None:
        return None
    rng = np.random.default_rng(0)
    tubes, times, vertices, facets = [], [], [], []
    for wheel in wheels:
        made = _tube(blank, wheel, layers, cell)
        if made is None:
            return None
        tube, when = made
        tubes.append(tube)
        times.append(when)
        share = math.ceil(CHECKED / len(runs))
        for errors, points in (
            (vertices, tube.vertices),
            (facets, tube.vertices[tube.faces].mean(axis=1)),
        ):
            inside = np.flatnonzero(blank.contains(points))
            chosen = points[rng.choice(inside, min(share, len(inside)), replace=False)]
            errors.append(Errors(chosen, np.abs(wheel.held(chosen))))
    return Strokes(
        tubes=tuple(tubes),
        times=tuple(times),
        vertices=_joined(vertices),
        facets=_joined(facets),
        wheels=tuple(wheels),
    )


def _joined(errors: list[Errors]) -> Errors:
    return Errors(np.concatenate([e.points for e in errors]), np.concatenate([e.distance for e in errors]))


def _near(blank: Blank, cutter: Cutter, motion: CutterMotion) -> Ints:
    """(k, 2) first and last samples of the stretches in which the turning wheel may touch the blank."""
    stock = StockCylinder.around(motion.mount, blank.radius, blank.z_range)
    near = ~stock.clear_of(motion.centre, motion.basis, cutter.radius)
    turning = np.zeros(len(near), dtype=bool)
    for a, b in turning_runs(cutter, motion).T:
        turning[a : b + 1] = True
    edges = np.flatnonzero(np.diff((near & turning).astype(np.int8), prepend=0, append=0))
    return edges.reshape(-1, 2) - [0, 1]


def _layers(blank: Blank, closest: float, cell: float) -> Floats | None:
    """Heights from below to above what the wheel can reach of the blank; None where that is nothing."""
    steps = blank.steps()
    out = steps[:, 1] > closest
    low_high = [
        (min(z0, z1), max(z0, z1))
        for (z0, _), (z1, _), o0, o1 in zip(steps, steps[1:], out, out[1:], strict=False)
        if o0 or o1
    ]
    if not low_high:
        return None
    low, high = min(a for a, _ in low_high) - OVER, max(b for _, b in low_high) + OVER
    return np.linspace(low, high, max(int(np.ceil((high - low) / cell)), 2) + 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fan:
    """Rays from the middle of the wheel out into the material."""

    begin: Floats
    """(k, 3) [mm]"""
    rays: Floats
    """(k, 3) unit vectors"""
    length: Floats
    """(k,) to the wheel's outline, about [mm]"""


def _tube(blank: Blank, wheel: PassingWheel, layers: Floats, cell: float) -> tuple[Surface, Floats] | None:
    """The tube of one stroke and when its vertices came to be [s]; None where it does not pass all layers at
    depth, or a ray tells otherwise."""
    tip = wheel.profile.tip
    reach = np.hypot(*wheel.centre[:, :2].T)
    at_depth = np.flatnonzero(reach < reach.min() + DEEPEST)
    order = at_depth[np.argsort(wheel.centre[at_depth, 2], kind="stable")]
    height = wheel.centre[order, 2]
    here = np.clip(np.searchsorted(height, layers), 1, len(order) - 1)
    here = np.where(layers - height[here - 1] < height[here] - layers, here - 1, here)
    sample = order[here]
    if len(order) < 2 or np.abs(wheel.centre[sample, 2] - layers).max() > cell:
        return None
    # towards the work axis in the wheel's middle plane
    inward = np.cross(wheel.axis[sample], [0.0, 0.0, 1.0])[:, :2]
    inward /= np.hypot(*inward.T)[:, None]
    centre = wheel.centre[sample, :2]
    inward *= -np.sign((inward * centre).sum(axis=1))[:, None]
    profile_depth = blank.radius - (float(reach.min()) - tip)
    outer = blank.radius + OUTSIDE * profile_depth
    along = -(inward * centre).sum(axis=1)
    origin = centre + (along - np.sqrt(outer**2 - (centre**2).sum(axis=1) + along**2))[:, None] * inward
    angle, length = _directions(wheel, outer - float(reach.min()) + tip, blank.radius, outer, 0.5 * cell)
    cos, sin = np.cos(angle), np.sin(angle)
    across = np.stack([-inward[:, 1], inward[:, 0]], axis=1)
    direction = inward[:, None] * cos[:, None] + across[:, None] * sin[:, None]
    n, m = len(layers), len(angle)
    rays = np.zeros((n * m, 3))
    rays[:, :2] = direction.reshape(-1, 2)
    begin = np.repeat(np.column_stack([origin, layers]), m, axis=0)
    fan = _Fan(begin=begin, rays=rays, length=np.tile(length, n))
    found = _ways_out(wheel, fan, np.repeat(sample, m))
    if found is None:
        return None
    points = found[0].reshape(n, m, 3)
    lips = np.hypot(points[:, [0, -1], 0], points[:, [0, -1], 1])
    if lips.min() <= blank.radius:
        return None
    when = np.pad(wheel.time_s[found[1]].reshape(n, m), ((0, 0), (0, 1)), constant_values=np.nan)
    return _closed(points, np.column_stack([origin, layers])), when.ravel()


def _directions(
    wheel: PassingWheel, height: float, radius: float, outer: float, step: float
) -> tuple[Floats, Floats]:
    """Angles of the rays from the inward direction, ascending, and about how long they are (m,) [mm].

    `height` is the tip's distance below the rays' beginning. Places on the wheel's outline are evenly spaced,
    up to between the blank's `radius` and the `outer` one of the beginning.
    """
    depth = wheel.profile.tip - wheel.rho[-2::-1]
    half = wheel.half[-2::-1]
    top = height - 0.5 * (outer - radius)
    keep = depth < top
    outline = np.column_stack([half[keep], depth[keep]])
    outline = np.vstack([[0.0, 0.0], outline, [np.interp(top, depth, half), top]])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(outline, axis=0).T))])
    even = np.linspace(0.0, way[-1], max(int(np.ceil(way[-1] / step)), 8) + 1)
    heading = np.arctan2(*np.diff(outline, axis=0).T)
    corners = way[1:-1][np.abs(np.diff(heading)) > CORNER]
    even = np.unique(np.concatenate([even, corners]))
    x, y = (np.interp(even, way, column) for column in outline.T)
    angle, length = np.arctan2(x, height - y), np.hypot(x, height - y)
    return np.concatenate([-angle[:0:-1], angle]), np.concatenate([length[:0:-1], length])


def _ways_out(wheel: PassingWheel, fan: _Fan, sample: Ints) -> tuple[Floats, Ints] | None:
    """(k, 3) where the rays leave what the wheel sweeps, and at which samples (k,) it does that; None where
    one begins outside or comes in again.

    `sample` (k,): when the wheel passes the rays' layers.
    """
    begin, rays, length = fan.begin, fan.rays, fan.length

    def on_ray(way: Floats) -> Floats:
        return begin + way[:, None] * rays

    if (wheel.level(begin, sample) <= 0).any():
        return None
    low, high = np.zeros(len(begin)), 1.3 * length + 1.0
    end = high.copy()
    sample, outside = wheel.deepest(on_ray(high))
    if (outside >= 0).any():
        return None
    for turn in range(ROUNDS):
        way = 0.5 * (low + high)
        sample, level = wheel.uphill(on_ray(way), sample, NEARBY if turn > 2 else 8 * NEARBY)
        low, high = np.where(level > 0, way, low), np.where(level > 0, high, way)
    way = 0.5 * (low + high)
    for share in BEHIND:
        beyond = on_ray(way + share * (end - way) + 1e-3)
        if (wheel.uphill(beyond, sample, 8 * NEARBY)[1] > 0).any():
            return None
    sample, _ = wheel.uphill(on_ray(way), sample, NEARBY)
    return _onto_outline(wheel, on_ray(way), rays, sample)


def _onto_outline(wheel: PassingWheel, points: Floats, rays: Floats, sample: Ints) -> tuple[Floats, Ints]:
    """The points moved along their rays onto the profile itself, which the table follows nearly, and when."""
    sample, _ = wheel.around(points, sample, *HUMPS)
    for _ in range(POLISH):
        sample, _ = wheel.uphill(points, sample, NEARBY)
        away = points - wheel.centre[sample]
        axis = wheel.axis[sample]
        s, rho = wheel.seen(points, sample)
        depth, by_s, by_rho = wheel.profile.depth(s, rho)
        along = np.einsum("nx,nx->n", rays, axis)
        outwards = (np.einsum("nx,nx->n", rays, away) - along * s) / rho
        slope = by_s * along + by_rho * outwards
        step = np.where(slope < -0.05, -depth / np.minimum(slope, -0.05), 0.0)
        points = points + np.clip(step, -0.02, 0.02)[:, None] * rays
    return points, sample


def _closed(points: Floats, origin: Floats) -> Surface:
    """Layers of points (n, m, 3) and what closes them: their origins (n, 3) outside, and both ends."""
    n, m, _ = points.shape
    rings = np.concatenate([points, origin[:, None]], axis=1)
    k = m + 1
    i = np.arange(k)
    j = (i + 1) % k
    base = k * np.arange(n - 1)[:, None]
    a, b, c, d = (side.ravel() for side in (base + i, base + j, base + k + j, base + k + i))
    fan = np.arange(m - 1)
    top = k * (n - 1)
    faces = np.concatenate(
        [
            np.stack([a, b, c], axis=1),
            np.stack([a, c, d], axis=1),
            np.stack([fan + 1, fan, np.full(m - 1, m)], axis=1),
            np.stack([top + fan, top + fan + 1, np.full(m - 1, top + m)], axis=1),
        ]
    )
    vertices = rings.reshape(-1, 3)
    p, q, r = (vertices[faces[:, x]] for x in range(3))
    if np.einsum("nx,nx->n", p, np.cross(q, r)).sum() < 0.0:
        faces = faces[:, ::-1]
    return Surface(vertices, faces)
