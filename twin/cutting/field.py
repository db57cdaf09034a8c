"""The depth field: how deep a point of the stock lies inside the sweep of each cutting pass.

A pass is one edge swinging past the work. In it a point of the stock meets the rake plane at one instant;
its depth in the edge's outline at that instant is the pass's field value, positive where the point is cut
away. The removed stock is where the largest of all passes is positive; that largest value is the signed
distance to the cut surface, but for the slow motion of the stock in the rake plane.

A pass is made of *bites*: what one convex piece of a tooth of the edge, or the land between the teeth,
removes of it. That they are convex is what bounds rest on; the field of a pass is that of its deepest bite.

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

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SETTLED = 1e-4
"""Residual angle [rad] of stock and edge below which one linear step ends the search for the meeting
instant: it leaves half the stock's acceleration over that angle, 1e-8 of the work radius."""
STILL = 1e-30
"""[rad per sample] in place of no motion at all, to divide by"""
STEEPEST = 0.63
"""Share of the edge's speed that the stock may have for `bound` to prove anything: slant 1.7"""
ROUNDS = 12
HALVINGS = 60
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
        rows = np.column_stack([motion.work_angle, motion.tool_angle, motion.centre]).T
        # one line per interval between samples: a pair reads it in one piece
        self._table = np.ascontiguousarray(np.vstack([rows[:, :-1], np.diff(rows, axis=1)]).T)
        self._table[:, 0] = np.remainder(self._table[:, 0] + math.pi, 2.0 * math.pi) - math.pi
        self._lean: Floats | None = None
        """as `_table`, of the components of the tool's own axis"""
        if motion.lean is not None:
            self._lean = np.hstack([motion.lean[:-1], np.diff(motion.lean, axis=0)])
        self._moved = not np.array_equal(motion.mount.rotation, np.eye(3)) or motion.mount.translation.any()
        samples = np.arange(rows.shape[1], dtype=float)
        at = [np.interp(self.passes.at, samples, row) for row in rows]
        self._seen = np.stack([np.cos(at[0]), np.sin(at[0]), *at[2:]])
        # what a first guess of the meeting instant needs: position and rates at `passes.at`, per pass
        cell = np.minimum(self.passes.at.astype(np.int64), len(self._table) - 1)
        self._lead = np.stack([at[1] - self.passes.angle, *self._table[cell, 5:].T])
        self._settled = _settled(cutter, self.passes)
        profile = cutter.profile
        stock = StockCylinder.around(motion.mount, stock_radius, stock_z)
        lean, far = sway(cutter, motion, stock)
        self._sway = lean * far
        spread = self._spread(stock)
        teeth = profile.teeth(*spread)
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
        off = -axis @ self._seen[2:] - self.passes.shift
        slack = reach + self.passes.travel + self._sway
        low, high = off + ends.min() - slack, off + ends.max() + slack
        return float(low.min(initial=0.0)), float(high.max(initial=0.0))

    def evaluate(self, points: Floats, index: Ints, *, gradient: bool = False) -> Meeting:
        """Field of pass `index[i]` at `points[i]` (m, 3) in the part frame [mm]."""
        return self._meeting(points, index, self.cutter.profile.depth, gradient=gradient)

    def evaluate_bite(self, points: Floats, bite: Ints, *, gradient: bool = False) -> Meeting:
        """As `evaluate`, for bites: depth in one piece of a tooth, or in the land between the teeth, alone.

        Their outlines are convex, so their depths are concave; the field of a pass is its deepest bite's.
        """
        index = bite // self.bites

        def outline(s: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
            number = bite - index * self.bites
            piece, middle = self._piece.take(number), self._middle.take(number)
            return self.cutter.profile.piece_depth(piece, middle, s, rho)

        return self._meeting(points, index, outline, gradient=gradient)

    def _meeting(
        self,
        points: Floats,
        index: Ints,
        outline: Callable[[Floats, Floats], tuple[Floats, Floats, Floats]],
        *,
        gradient: bool,
    ) -> Meeting:
        """Depth in an `outline` (s, rho) of the edges of passes `index`."""
        state, end, step = self._meet(points, index)
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
            to_rake, rate, met = self._to_rake(state, step, self.passes.run_angle[index], partial)
            ends = rho[partial] * to_rake < depth[partial]
            depth[partial] = np.where(ends, rho[partial] * to_rake, depth[partial])
            by_s[partial[ends]] = 0.0
            by_rho[partial] = np.where(ends, to_rake, by_rho[partial])
            by_turn[partial] = np.where(ends, rate, 0.0)
            follows[partial] = met
        slope = self._gradient(state, (by_s, by_rho), by_turn, follows) if gradient else np.zeros((0, 3))
        return Meeting(depth, slope, along, rho, end)

    def outline(self, bite: Ints, s: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
        """Depth in the bites' outlines at places (m,) of their rake planes, and its derivatives."""
        number = bite % self.bites
        return self.cutter.profile.piece_depth(self._piece.take(number), self._middle.take(number), s, rho)

    def floors(self, points: Floats, corners: Floats, bite: Ints, radius: Floats) -> Floats:
        """Lower bounds (c, m) of the bites' depths, in the convex hulls of `corners` (m, c, 3).

        At any convex combination of the corners, a bite's depth is at least the same combination of these:
        it is concave in the rake plane, and what the map to the rake plane bends within `radius` (m,) of the
        middle counts twice, at the corners and inside.
        """
        middle = self.evaluate_bite(points, bite)
        change, bent = self.bound(middle, bite, radius)
        count = corners.shape[1]
        depth = self.evaluate_bite(corners.reshape(-1, 3), np.repeat(bite, count)).depth
        floors = depth.reshape(-1, count).T - 2.0 * bent
        level = middle.depth - change
        return np.where(level > floors.mean(axis=0), level, floors)

    def bound(self, meeting: Meeting, bite: Ints, radius: Floats) -> tuple[Floats, Floats]:
        """Proved bounds on the depths of bites within `radius` (m,) of the points of a meeting [mm].

        Returns
        - change: how much the depth can change at most;
        - bent: how far the map from space to the rake plane departs from its tangent. With the depth of a
          bite concave in that plane, tangent + bent bounds the field from above, and a convex combination
          of its values − 2 bent from below.

        Writing M(p) = G(p, t(p)) for the map and a for the edge's speed across the rake face, slant = v/a,
        turn = C'/a: |G_pp| <= 1/rho, |G_pt| <= C' + v/rho, |G_tt| <= C'v + v²/rho, |t_p| <= 1/a and
        |t_pp| <= (1/rho + 2 (2 slant/rho + turn) + ...)/a, in sum (1 + slant)^4/rho + 2 (1 + slant)² turn.
        A velocity jump between two samples adds its share of the way that remains. On a helicoid the same
        holds with a = `Cutter.lever` · turn − v, see docs/kernel.md.
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
        partial = self._partial.take(index)
        # the way to the rake face where the sweep ends: rho times an angle
        far = meeting.rho + 2.0 * radius
        change = np.where(partial, radius * (far / self.cutter.lever(far) + WIDEST + slant), change) + creep
        change[~proved] = np.inf
        bent[~proved | partial] = np.inf
        return change, bent

    def near(self, point: Floats, radius: float) -> Ints:
        """Passes whose tool may come within `radius` of a point (3,) of the part [mm]."""
        local = self._mount.rotation @ point + self._mount.translation
        state = self._seen
        x = local[0] * state[0] - local[1] * state[1] - state[2]
        y = local[0] * state[1] + local[1] * state[0] - state[3]
        z = local[2] - state[4]
        a, b, _ = self._basis @ np.stack([x, y, z])
        return np.flatnonzero(np.hypot(a, b) < self.cutter.radius + radius + self.passes.travel + self._sway)

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

    def _meet(self, points: Floats, index: Ints) -> tuple[State, Floats, Floats]:
        """The points near their meeting instants, those instants, and the step that is left to them."""
        p = self.passes
        local = np.ascontiguousarray(points.T)
        if self._moved:
            local = self._mount.rotation @ local + self._mount.translation[:, None]
        first, last, angle = p.first.take(index), p.last.take(index), p.angle.take(index)
        at = np.clip(p.at.take(index) + self._ahead(local, index), first, last)
        state = self._state(local, at, angle)
        rows = self._unsettled(state, at, first, last)
        if len(rows):
            late = local[:, rows], first[rows], last[rows], angle[rows]
            at[rows] = self._search(at[rows] - state.lag[rows] / state.lag_rate[rows], *late)
            state.put(rows, self._state(late[0], at[rows], late[3]))
        end = np.clip(at - state.lag / state.lag_rate, first, last)
        return state, end, end - at

    def _ahead(self, local: Floats, index: Ints) -> Floats:
        """Samples (m,) from `passes.at` to where points (3, m) meet their edges, by one step of Newton's."""
        cos, sin, cx, cy, cz = (row.take(index) for row in self._seen)
        lag, d_work, d_tool, d_cx, d_cy, d_cz = (row.take(index) for row in self._lead)
        x = local[0] * cos - local[1] * sin
        y = local[0] * sin + local[1] * cos
        offset = x - cx, y - cy, local[2] - cz
        rate = -y * d_work - d_cx, x * d_work - d_cy, -d_cz
        (a, b, s), (a_rate, b_rate, s_rate) = (
            [u * row[0] + v * row[1] + w * row[2] for row in self._basis] for u, v, w in (offset, rate)
        )
        lag -= np.arctan2(b, a)
        lag_rate = d_tool - (a * b_rate - b * a_rate) / (a * a + b * b)
        if self.cutter.twist:
            lag += self.cutter.twist * (s - self.cutter.shift)
            lag_rate += self.cutter.twist * s_rate
        lag_rate[lag_rate == 0.0] = STILL
        return -lag / lag_rate

    def _search(self, at: Floats, local: Floats, first: Floats, last: Floats, angle: Floats) -> Floats:
        """Meeting instants to within SETTLED, by Newton's method from `at`."""
        at = np.clip(at, first, last)
        rows = np.arange(len(at))
        for _ in range(ROUNDS):
            state = self._state(local[:, rows], at[rows], angle[rows])
            left = self._unsettled(state, at[rows], first[rows], last[rows])
            if not len(left):
                return at
            wanted = (at[rows] - state.lag / state.lag_rate)[left]
            rows = rows[left]
            at[rows] = np.clip(wanted, first[rows], last[rows])
        at[rows] = self._bisect(local[:, rows], first[rows], last[rows], angle[rows])
        return at

    def _unsettled(self, state: State, at: Floats, first: Floats, last: Floats) -> Ints:
        """Rows of the points that can still come closer to their meeting instant."""
        free = np.abs(state.lag) >= self._settled
        wanted = at - state.lag / state.lag_rate
        held = ((at == first) & (wanted < first)) | ((at == last) & (wanted > last))
        return np.flatnonzero(free & ~held)

    def _bisect(self, local: Floats, first: Floats, last: Floats, angle: Floats) -> Floats:
        """Meeting instants by halving, where Newton's steps go round in circles: S changes too much."""
        low, high = first.copy(), last.copy()
        falling = self._state(local, low, angle).lag > self._state(local, high, angle).lag
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            early = (self._state(local, middle, angle).lag < 0) != falling
            low = np.where(early, middle, low)
            high = np.where(early, high, middle)
        return low

    @staticmethod
    def _to_rake(
        state: State, step: Floats, run: Floats, rows: Ints
    ) -> tuple[Floats, Floats, NDArray[np.bool_]]:
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

    def _state(self, local: Floats, at: Floats, angle: Floats) -> State:
        """Points `local` (3, m) at fractional samples `at` (m,), edges at unwrapped tool `angle`."""
        cell = np.minimum(at.astype(np.int64), len(self._table) - 1)
        part = at - cell
        work, tool, cx, cy, cz, d_work, d_tool, d_cx, d_cy, d_cz = self._table.take(cell, axis=0).T
        work = work + part * d_work
        cos, sin = np.cos(work), np.sin(work)
        x = local[0] * cos - local[1] * sin
        y = local[0] * sin + local[1] * cos
        offset = np.stack([x - cx - part * d_cx, y - cy - part * d_cy, local[2] - cz - part * d_cz])
        rate = np.stack([-y * d_work - d_cx, x * d_work - d_cy, -d_cz])
        a, b, s = self._basis @ offset
        a_rate, b_rate, s_rate = self._basis @ rate
        lean = np.zeros((2, 0))
        if self._lean is not None:
            x, y, d_x, d_y = self._lean.take(cell, axis=0).T
            x, y = x + part * d_x, y + part * d_y
            lean = np.stack([x, y])
            a_rate, b_rate, s_rate = (
                a_rate - x * s_rate - d_x * s,
                b_rate - y * s_rate - d_y * s,
                s_rate + x * a_rate + y * b_rate + d_x * a + d_y * b,
            )
            a, b, s = upright(a, b, s, lean)
        rho2 = a * a + b * b
        rho = np.sqrt(rho2)
        tool = tool + part * d_tool
        lag = tool - angle - np.arctan2(b, a)
        lag_rate = d_tool - (a * b_rate - b * a_rate) / rho2
        if self.cutter.twist:
            lag += self.cutter.twist * (s - self.cutter.shift)
            lag_rate += self.cutter.twist * s_rate
        lag_rate[lag_rate == 0.0] = STILL
        return State(
            cos=cos,
            sin=sin,
            side=np.stack([a, b]),
            rho=rho,
            s=s,
            rho_rate=(a * a_rate + b * b_rate) / rho,
            s_rate=s_rate,
            lag=lag,
            lag_rate=lag_rate,
            tool_angle=tool,
            tool_rate=d_tool,
            lean=lean,
        )

    def _gradient(self, state: State, by: tuple[Floats, Floats], by_turn: Floats, follows: Floats) -> Floats:
        """Gradient (m, 3) in the part frame; the meeting instant `follows` the point (1) or not (0).

        `by` are the derivatives of the depth by s and rho, `by_turn` that by the way across the rake face.
        """
        a, b = state.side / state.rho
        by_s, by_rho = by
        # d instant / d point = (e_psi / rho − twist e_s) / lag_rate
        drift = (
            follows * (by_s * state.s_rate + by_rho * state.rho_rate) / (state.rho * state.lag_rate) + by_turn
        )
        if self.cutter.twist:
            by_s = by_s - drift * state.rho * self.cutter.twist
        across = np.stack([by_rho * a - drift * b, by_rho * b + drift * a, by_s])
        if self._lean is not None:
            across = np.stack(upright(across[0], across[1], across[2], -state.lean))
        gx, gy, gz = self._basis.T @ across
        turned = np.stack([gx * state.cos + gy * state.sin, gy * state.cos - gx * state.sin, gz])
        return (self._mount.rotation.T @ turned if self._moved else turned).T


def upright(a: Floats, b: Floats, s: Floats, lean: Floats) -> tuple[Floats, Floats, Floats]:
    """A vector (a, b, s) along the tool carrier's axes, seen from the tool whose axis leans by (2, m).

    Rodrigues' formula for the shortest way; with −lean the way back.
    """
    x, y = lean
    high = np.sqrt(1.0 - x * x - y * y)
    turn = (x * b - y * a) / (1.0 + high)
    return high * a - x * s - y * turn, high * b - y * s + x * turn, high * s + x * a + y * b


def _settled(cutter: Cutter, passes: Passes) -> float:
    """Residual angle of the edge at which the stock is within SETTLED of the meeting [rad]."""
    if not passes.count or passes.creep.any():
        return SETTLED
    ratio = float((passes.turn * cutter.lever(cutter.radius) + passes.slant).max())
    return SETTLED / max(ratio, 1.0)
