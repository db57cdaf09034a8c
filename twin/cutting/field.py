"""The depth field: how deep a point of the stock lies inside the sweep of each cutting pass.

A pass is one edge swinging past the work. In it a point of the stock meets the rake plane at one instant;
its depth in the edge's outline at that instant is the pass's field value, positive where the point is cut
away. The removed stock is where the largest of all passes is positive; that largest value is the signed
distance to the cut surface, but for the slow motion of the stock in the rake plane.

A pass is made of *bites*: what one piece of a tooth of the edge, or the land between the teeth, removes of
it. That pieces are convex, but for hollow arcs of known radii, is what bounds rest on; the field of a pass is
that of its deepest bite.

Where the rake face is a helicoid, the edge at axial position s stands `twist` · s further about the axis.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.engagement import StockCylinder, inner_radius, sway, twisted
from twin.cutting.meeting import Meeting, State
from twin.cutting.motion import CutterMotion
from twin.cutting.passes import Passes, find_passes
from twin.cutting.rake import SETTLED, Rake

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STEEPEST = 0.63
"""Share of the edge's speed that the stock may have for `bound` to prove anything: slant 1.7"""
WIDEST = 0.5
"""[rad] at which the distance from the end of a sweep stops to count"""


class DepthField:
    """The field of all passes of one tool."""

    def __init__(
        self, cutter: Cutter, motion: CutterMotion, stock_radius: float, stock_z: tuple[float, float]
    ) -> None:
        self.cutter = cutter
        self._lever = cutter.lever(inner_radius(cutter))
        self.passes: Passes = find_passes(cutter, motion, stock_radius, stock_z)
        self._basis = motion.basis
        self._mount = motion.mount
        self._rake = Rake(cutter, motion, self.passes)
        self._seen: Floats = self._rake.across()
        self._tool_angle = motion.tool_angle
        self._turned = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(motion.tool_angle)))])
        profile = cutter.profile
        stock = StockCylinder.around(motion.mount, stock_radius, stock_z)
        lean, far = sway(cutter, motion, stock)
        self._sway = lean * far
        self._reach: Floats = cutter.radius + self.passes.carried + self._sway
        self._widest: tuple[float, float] = (
            float(self._reach.max(initial=0.0)),
            float(self.passes.swing.max(initial=0.0)),
        )
        """largest of the reaches and the swings"""
        self.spread: tuple[float, float] = self._spread(stock)
        """lowest and highest place of stock along the outlines of all passes [mm]"""
        teeth = profile.teeth(*self.spread)
        pieces = len(profile.pieces)
        self.has_land: bool = math.isfinite(profile.root)
        """whether the last bite of a pass is the land"""
        self.samples: int = len(motion.tool_angle)
        """of the motion"""
        self._land = len(teeth) * pieces
        self.bites: int = self._land + self.has_land
        """of a pass: the pieces of the teeth that can reach the stock and, last, the land between them"""
        pitch = profile.pitch if math.isfinite(profile.pitch) else 0.0
        self.tooth: Ints = np.append(np.repeat(teeth, pieces), 0)[: self.bites]
        """(bites,) number of each bite's tooth along the edge; 0 for the land"""
        self._middle = np.asarray(self.tooth * pitch, dtype=np.float64)
        self._piece = np.append(np.tile(np.arange(pieces), len(teeth)), pieces)[: self.bites]
        hollow = np.tile([piece.hollow for piece in profile.pieces], len(teeth))
        self._hollow = np.append(hollow, np.inf)[: self.bites]
        self._bends = bool(np.isfinite(self._hollow).any())
        self._half_width = np.tile([piece.half_width for piece in profile.pieces], len(teeth))
        swing = math.pi + twisted(cutter, motion, stock)
        gap = np.abs(self.passes.angle[:, None] - self.passes.run_angle) < swing
        self._partial: NDArray[np.bool_] = np.asarray(gap.any(axis=1))

    @property
    def count(self) -> int:
        """Number of bites."""
        return self.passes.count * self.bites

    def _spread(self, stock: StockCylinder) -> tuple[float, float]:
        """Lowest and highest axial position of stock on the outlines of all passes."""
        axis = self._basis[2]
        reach = stock.radius * math.hypot(axis[0], axis[1])
        ends = np.array([stock.z_low, stock.z_high]) * axis[2]
        off = -axis @ self._rake.seen[2:] - self.passes.shift
        slack = reach + self.passes.travel + self._sway
        low, high = off + ends.min() - slack, off + ends.max() + slack
        return float(low.min(initial=0.0)), float(high.max(initial=0.0))

    def evaluate(
        self, points: Floats, index: Ints, *, gradient: bool = False, near: Floats | None = None
    ) -> Meeting:
        """Field of pass `index[i]` at `points[i]` (m, 3) in the part frame [mm]; `near` (m,) samples about
        when they meet, where that is known."""
        return self._meeting(points, index, self.cutter.profile.depth, gradient=gradient, near=near)

    def evaluate_bite(self, points: Floats, bite: Ints, *, gradient: bool = False) -> Meeting:
        """As `evaluate`, for bites: depth in one piece of a tooth, or in the land between the teeth, alone.

        The field of a pass is its deepest bite's.
        """
        index = bite // self.bites

        def outline(s: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
            return self.cutter.profile.piece_depth(*self.piece(bite), s, rho)

        return self._meeting(points, index, outline, gradient=gradient)

    def _meeting(
        self,
        points: Floats,
        index: Ints,
        outline: Callable[[Floats, Floats], tuple[Floats, Floats, Floats]],
        *,
        gradient: bool,
        near: Floats | None = None,
    ) -> Meeting:
        """Depth in an `outline` (s, rho) of the edges of passes `index`."""
        state, end, step = self._rake.meet(points, index, near)
        s = state.s + state.s_rate * step
        rho = state.rho + state.rho_rate * step
        along = s - self.passes.shift.take(index)
        depth, by_s, by_rho = outline(along, rho)
        if math.isfinite(self.cutter.half_length):
            off = s - self.cutter.shift
            inside = self.cutter.half_length - np.abs(off)
            past = inside < depth
            depth = np.where(past, inside, depth)
            by_s = np.where(past, -np.sign(off), by_s)
            by_rho = np.where(past, 0.0, by_rho)
        by_turn = np.zeros(len(depth))
        follows = np.ones(len(depth))
        partial = np.flatnonzero(self._partial.take(index))
        if len(partial):
            # where the tool stops turning, its sweep ends at the rake plane itself
            to_rake, rate, met = _to_rake(state, step, self.passes.run_angle[index], partial)
            ends = rho[partial] * to_rake < depth[partial]
            depth[partial] = np.where(ends, rho[partial] * to_rake, depth[partial])
            by_s[partial[ends]] = 0.0
            by_rho[partial] = np.where(ends, to_rake, by_rho[partial])
            by_turn[partial] = np.where(ends, rate, 0.0)
            follows[partial] = met
        slope = self._rake.gradient(state, (by_s, by_rho), by_turn, follows) if gradient else np.zeros((0, 3))
        return Meeting(depth, slope, along, rho, end)

    def turn(self, bite: Ints, instant: Floats) -> Floats:
        """How far (m,) the tool has turned at instants since the bites' edges pointed at the work [rad]."""
        return np.interp(instant, np.arange(self.samples), self._tool_angle) - self.passes.angle.take(
            bite // self.bites
        )

    def instant(self, bite: Ints, turn: Floats) -> Floats:
        """When (m,) the tool has turned that far; NaN beyond the run of turning that the bite belongs to."""
        p, index = self.passes, bite // self.bites
        at, first, last = p.at.take(index), p.first.take(index), p.last.take(index)
        own = np.arange(self.samples)
        way = np.sign(np.interp(last, own, self._tool_angle) - np.interp(first, own, self._tool_angle))
        ahead = p.angle.take(index) + turn - np.interp(at, own, self._tool_angle)
        found = np.interp(np.interp(at, own, self._turned) + way * ahead, self._turned, own)
        return np.where((found > first) & (found < last), found, np.nan)

    def placed(self, bite: Ints, instant: Floats, s: Floats, rho: Floats) -> Floats:
        """Points (m, 3) of the part that are at places of the bites' outlines at some instants."""
        index = bite // self.bites
        return self._rake.placed(index, instant, s + self.passes.shift.take(index), rho)

    def on_tool(self, bite: Ints, s: Floats) -> NDArray[np.bool_]:
        """Whether (m,) axial positions `s` against the bites' outlines are between the tool's ends."""
        off = s + self.passes.shift.take(bite // self.bites) - self.cutter.shift
        return np.abs(off) <= self.cutter.half_length

    def piece(self, bite: Ints) -> tuple[Ints, Floats]:
        """Which piece of its tooth each bite (m,) is, and the tooth's middle along the edge [mm]."""
        number = bite - bite // self.bites * self.bites  # numpy's own remainder takes four times as long
        return self._piece.take(number), self._middle.take(number)

    def floors(self, points: Floats, corners: Floats, bite: Ints, radius: Floats) -> Floats:
        """Lower bounds (c, m) of the bites' depths, in the convex hulls of `corners` (m, c, 3).

        At any convex combination of the corners, a bite's depth is at least the same combination of these:
        what is `bent` within `radius` (m,) of the middle counts twice (`bound`).

        A hollow arc of radius R adds c²/(D + R) to that, see there, and proves nothing at D + R < 2c. For let
        y be a combination of places in the rake plane and D' its depth, D − c at least. Each place is no
        deeper than the tangent at y allows, plus its w²/(2 (D' + R)). Of these the combination is at most
        c²/(2 (D − c + R)), for its mean square about y is no more than that about the middle.
        """
        middle = self.evaluate_bite(points, bite)
        change, bent = self.bound(middle, bite, radius)
        count = corners.shape[1]
        depth = self.evaluate_bite(corners.reshape(-1, 3), np.repeat(bite, count)).depth
        floors = depth.reshape(-1, count).T - 2.0 * bent
        if self._bends:
            floors[:, self._to_centre(middle, bite) < 2.0 * change] = -np.inf
        level = middle.depth - change
        return np.where(level > floors.mean(axis=0), level, floors)

    def bound(self, meeting: Meeting, bite: Ints, radius: Floats) -> tuple[Floats, Floats]:
        """Proved bounds on the depths of bites within `radius` (m,) of the points of a meeting [mm].

        Returns
        - change: how much the depth can change at most;
        - bent: tangent + bent bounds the depth from above, and a convex combination of its values − 2 bent
          from below (`floors`). With the depth of a bite concave in the rake plane it is how far the map
          from space to that plane departs from its tangent: once above, and below at the values and where
          they meet.

        A hollow arc of radius R adds c²/(2 (D + R)), by the law of `hollow.py`, and proves nothing above at
        D <= −R: D is the depth here, and c = `change` holds how far off places in the rake plane are.

        Writing M(p) = G(p, t(p)) for the map and a for the edge's speed across the rake face, slant = v/a,
        turn = C'/a: |G_pp| <= 1/rho, |G_pt| <= C' + v/rho, |G_tt| <= C'v + v²/rho, |t_p| <= 1/a and
        |t_pp| <= (1/rho + 2 (2 slant/rho + turn) + ...)/a, in sum (1 + slant)^4/rho + 2 (1 + slant)² turn.
        A velocity jump between two samples adds its share of the way that remains. On a helicoid the same
        holds with a = `Cutter.lever` · turn − v, see docs/kernel.md. The tool turns by at most
        (1 + slant)/`lever` from meeting to meeting within 1 mm: a run that ends later than that, and further
        off than the bite is deep, is as one without end. Near the end nothing bounds what the map bends.
        """
        index = bite // self.bites
        p = self.passes
        # no point of the block can meet the edge further in than this, if `change` is less than 2 radius
        low = np.maximum(meeting.rho - 2.0 * radius, 1e-6)
        own = p.slant.take(index)
        nearer = self._lever / ((1.0 + own) * self.cutter.lever(low))
        share = own * nearer
        proved = share < STEEPEST
        slant = np.where(proved, share / (1.0 - np.where(proved, share, 0.0)), 0.0)
        slower = (1.0 + slant) * nearer
        change = radius * np.sqrt(1.0 + slant**2)
        square = (1.0 + slant) * (1.0 + slant)
        curvature = square * (square / low + 2.0 * slower * p.turn.take(index))
        jumps = 1.0 + 2.0 * radius * slower * p.samples.take(index)
        jolt = p.jolt.take(index) * slower * np.maximum(slower, 1.0)
        creep = p.creep.take(index)
        bent = 0.5 * curvature * radius * radius + jolt * radius * jumps + creep
        rows = np.flatnonzero(self._partial.take(index))
        if len(rows):
            away = radius[rows] * (1.0 + slant[rows]) / self.cutter.lever(low[rows])
            left = self._rake.left_to_run(meeting.instant[rows], index[rows]) - away
            high = np.maximum(meeting.depth[rows] + change[rows], 0.0)
            rows = rows[(low[rows] * np.minimum(left, WIDEST) <= high) | (creep[rows] > 0)]
            # the way to the rake face where the sweep ends: rho times an angle
            far = meeting.rho[rows] + 2.0 * radius[rows]
            change[rows] = radius[rows] * (far / self.cutter.lever(far) + WIDEST + slant[rows])
            bent[rows] = np.inf
        change += creep
        if self._bends:
            away = self._to_centre(meeting, bite)
            bent += np.where(away > 0, 0.5 * change * change / np.where(away > 0, away, 1.0), np.inf)
        change[~proved] = np.inf
        bent[~proved] = np.inf
        return change, bent

    def _to_centre(self, meeting: Meeting, bite: Ints) -> Floats:
        """How far (m,) off the centre is of a disc that fits against the bites' outlines beside a meeting."""
        return meeting.depth + self._hollow.take(bite % self.bites)

    def near(self, point: Floats, radius: float, among: Ints | None = None) -> Ints:
        """Passes, of all or `among` some (m,), whose tool may come within `radius` [mm] of a point (3,).

        While the work turns by up to `swing`, the point stays on an arc: it comes nearer to the tool's axis
        by its way along the arc's tangent, seen along that axis, and by what the arc leaves the tangent.
        """
        x, y, z = self._mount.rotation @ point + self._mount.translation
        away = math.hypot(x, y)
        rows: slice | Ints = slice(None) if among is None else among
        (a, a_rate), (b, b_rate) = np.array([[x, y, z, 1.0], [-y, x, 0.0, 0.0]]) @ self._seen[:, :, rows]
        square = a * a + b * b
        # most are too far off whichever way the arc leads
        reach, swing = self._widest
        some = np.flatnonzero(square < (reach + radius + swing * away * (1.0 + 0.5 * swing)) ** 2)
        own = some if among is None else among[some]
        a_rate, b_rate, swing = a_rate.take(some), b_rate.take(some), self.passes.swing.take(own)
        nearer = np.sqrt(a_rate * a_rate + b_rate * b_rate) + 0.5 * away * swing
        reach = self._reach.take(own) + swing * nearer + radius
        return own[square.take(some) < reach * reach]

    def bites_near(self, points: Floats, index: Ints, radius: Floats) -> tuple[Ints, Ints]:
        """Rows and bites of the passes `index` (m,) that may cut within `radius` (m,) of `points` (m, 3)."""
        meeting = self.evaluate(points, index)
        change, _ = self.bound(meeting, index * self.bites, radius)
        profile = self.cutter.profile
        tall = np.flatnonzero(profile.tip - meeting.rho + change > 0)
        beside = np.abs(meeting.s[tall, None] - self._middle[: self._land]) - change[tall, None]
        within = np.zeros((len(tall), self.bites), dtype=bool)
        within[:, : self._land] = beside < self._half_width
        if self._land < self.bites:
            within[:, self._land] = profile.root - meeting.rho[tall] + change[tall] > 0
        row, number = np.nonzero(within)
        row = tall[row]
        return row, index[row] * self.bites + number


def _to_rake(state: State, step: Floats, run: Floats, rows: Ints) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Angle (k,) from the end of the sweep, its rate across the rake plane, and whether they meet.

    Negative for a point that the edge never comes to.
    """
    ahead = state.tool_angle + state.tool_rate * step
    ahead = np.stack([ahead - run[:, 0], run[:, 1] - ahead])[:, rows]
    side = np.where(ahead[0] < ahead[1], 1.0, -1.0)
    lag = (state.lag + state.lag_rate * step)[rows]
    met = np.abs(lag) < SETTLED**2
    angle = ahead.min(axis=0) - np.abs(lag)
    rate = np.where(met, side * state.tool_rate[rows] / state.lag_rate[rows], np.sign(lag))
    return np.clip(angle, -WIDEST, WIDEST), np.where(np.abs(angle) < WIDEST, rate, 0.0), met
