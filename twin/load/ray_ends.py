"""Where a pass cuts a ray of the stock off: where its depth along the ray is zero."""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from twin.cutting.field import DepthField
from twin.cutting.meeting import Meeting
from twin.load.stock import Stock

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STEPS = 20
"""towards the end of a ray, at most"""
FEW_STEPS = 4
"""towards one that was known on a motion close by"""
HALVED = 3
"""steps after which the bound that has stood is taken to lie nearer"""
FLAT = 1e-9
"""[mm] of a way over which no growth is found"""
CLOSE = 1e-5
"""[mm] of depth at which the end of a ray counts as found"""
SLACK = 0.03
"""[mm] added to the way of the stock until it meets an edge"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ends:
    """Pairs of rays and passes, (n,) each."""

    radius: Floats
    """at which the pass cuts the ray off [mm]; inf where it does not"""
    depth: Floats
    """of the edge at the end that the ray had before [mm]"""
    growth: Floats
    """of the depth per radius where the ray is cut off; 0 where the edge goes through to its inner end"""
    s: Floats
    """where the edge meets the new end, or the old one that stays: along its outline, against it [mm]"""
    rho: Floats
    """and from the tool's axis [mm]"""
    instant: Floats
    """and when [samples]"""

    @classmethod
    def unknown(cls, count: int) -> "Ends":
        """Of pairs that do not meet."""
        return cls(radius=np.full(count, np.inf), **{f.name: np.zeros(count) for f in fields(cls)[1:]})

    @classmethod
    def joined(cls, parts: list["Ends"]) -> "Ends":
        """One after the other."""
        if not parts:
            return cls.unknown(0)
        return cls(**{f.name: np.concatenate([getattr(one, f.name) for one in parts]) for f in fields(cls)})

    def of(self, rows: Ints) -> "Ends":
        """Some of the pairs."""
        return Ends(**{f.name: getattr(self, f.name)[rows] for f in fields(Ends)})

    def put(self, rows: Ints, part: "Ends") -> None:
        """Replace some pairs."""
        for f in fields(Ends):
            getattr(self, f.name)[rows] = getattr(part, f.name)

    def meet(self, rows: Ints, meeting: Meeting) -> None:
        """Note where edges meet the ends of some pairs."""
        self.s[rows], self.rho[rows], self.instant[rows] = meeting.s, meeting.rho, meeting.instant


def cut_at(
    field: DepthField, rays: Stock, pairs: tuple[Ints, Ints], high: Floats, near: Floats | None = None
) -> Ends:
    """Where passes cut rays, in pairs, off that reach to the radii `high` (n,); `near` (n,) samples about
    when edges come there, where that is known."""
    out = Ends.unknown(len(high))
    ray, index = pairs
    meeting = field.evaluate(rays.points(ray, high), index, near=near)
    out.depth[:] = meeting.depth
    out.meet(np.arange(len(high)), meeting)
    cut = np.flatnonzero(meeting.depth > 0)
    ray, index, high, above = ray[cut], index[cut], high[cut], meeting.depth[cut]
    low = high - 2.0 * (field.cutter.radius - meeting.rho[cut]) - SLACK
    below = np.ones(len(cut))
    inside = np.arange(len(cut))
    while len(inside):
        # inclined rays may leave an edge further in than their ends stand in it
        low[inside] = np.maximum(low[inside], rays.inner[ray[inside]])
        below[inside] = field.evaluate(rays.points(ray[inside], low[inside]), index[inside]).depth
        inside = inside[(below[inside] >= 0) & (low[inside] > rays.inner[ray[inside]])]
        low[inside] -= high[inside] - low[inside]
    through = below >= 0  # the edge comes from below, or through to the bore
    ends, gone = np.flatnonzero(~through), np.flatnonzero(through)
    some = (
        (ray[ends], index[ends]),
        (low[ends], below[ends]),
        (high[ends], above[ends], meeting.instant[cut[ends]]),
    )
    out.put(cut[ends], _zero(field, rays, *some))
    inner = rays.inner[ray[gone]]
    out.radius[cut[gone]] = inner
    out.meet(cut[gone], field.evaluate(rays.points(ray[gone], inner), index[gone]))
    return out


def followed(field: DepthField, rays: Stock, pairs: tuple[Ints, Ints], high: Floats, known: Ends) -> Ends:
    """The same as `cut_at`, of rays that reach to `high` (n,), where the ends are `known` on a motion close
    by: secants from there; an end that is not found so is looked for as if nothing were known."""
    ray, index = pairs
    out = Ends.unknown(len(ray))
    rows = np.flatnonzero(np.isfinite(known.radius) & (known.growth > 0.0))
    found = np.zeros(len(ray), dtype=bool)
    at, growth = known.radius.copy(), known.growth.copy()
    before, depth_before, instant = at.copy(), np.zeros(len(ray)), known.instant.copy()
    for _ in range(FEW_STEPS):
        points = rays.points(ray[rows], at[rows])
        meeting = field.evaluate(points, index[rows], near=instant[rows])
        instant[rows] = meeting.instant
        growth[rows] = _growth(at[rows] - before[rows], meeting.depth - depth_before[rows], growth[rows])
        close = np.abs(meeting.depth) < CLOSE
        done, rows, left = rows[close], rows[~close], meeting.depth[~close]
        out.meet(done, meeting.of(close))
        found[done] = True
        if not len(rows):
            break
        before[rows], depth_before[rows] = at[rows], left
        at[rows] = np.maximum(at[rows] - left / growth[rows], rays.inner[ray[rows]])
    out.radius[found], out.growth[found], out.depth[found] = at[found], growth[found], known.depth[found]
    lost = np.flatnonzero(~found)
    out.put(lost, cut_at(field, rays, (ray[lost], index[lost]), high[lost], instant[lost]))
    return out


def _zero(
    field: DepthField,
    rays: Stock,
    pairs: tuple[Ints, Ints],
    outside: tuple[Floats, Floats],
    inside: tuple[Floats, Floats, Floats],
) -> Ends:
    """Between radii, (n,) each with their depths below and above 0, where the depth is zero.

    Secants between the last two, which start from `inside`, where it is known when edges come: depth grows no
    faster than the way along the ray, so nothing is passed over. A secant that leaves the bounds gives way to
    false position between them.
    """
    (low, below), (high, above, instant) = (tuple(v.copy() for v in values) for values in (outside, inside))
    before, depth_before = high.copy(), above.copy()
    at = np.maximum(high - above / np.hypot(1.0, rays.slope[pairs[0]]), low)
    out = Ends.unknown(len(at))
    out.depth[:] = above
    rows = np.arange(len(at))
    for step in range(STEPS):
        points = rays.points(pairs[0][rows], at[rows])
        meeting = field.evaluate(points, pairs[1][rows], near=instant[rows])
        depth, instant[rows] = meeting.depth, meeting.instant
        out.meet(rows, meeting)
        change = depth - depth_before[rows]
        out.growth[rows] = _growth(at[rows] - before[rows], change, np.ones(len(rows)))
        cuts = depth > 0
        ins, outs = rows[cuts], rows[~cuts]
        high[ins], above[ins] = at[ins], depth[cuts]
        low[outs], below[outs] = at[outs], depth[~cuts]
        if step % HALVED == HALVED - 1:
            below[ins] *= 0.5
            above[outs] *= 0.5
        open_ = np.abs(depth) > CLOSE
        rows, depth, change = rows[open_], depth[open_], change[open_]
        if not len(rows):
            break
        x, lower, upper = at[rows], low[rows], high[rows]
        secant = x - depth * (x - before[rows]) / np.where(change == 0.0, 1.0, change)
        false = upper - above[rows] / (above[rows] - below[rows]) * (upper - lower)
        fits = (change != 0.0) & (secant > lower) & (secant < upper)
        before[rows], depth_before[rows] = x, depth
        at[rows] = np.where(fits, secant, false)
    out.radius[:] = at
    return out


def _growth(way: Floats, change: Floats, known: Floats) -> Floats:
    """(n,) of the depth over a `way` in which it has changed; as it is `known` where that says nothing."""
    with np.errstate(divide="ignore", invalid="ignore"):
        growth = change / way
    return np.where((np.abs(way) > FLAT) & (growth > 0.0), growth, known)
