"""When a point of the stock meets the rake face of an edge, and where it stands against the tool then.

The angle of the point about the tool axis equals the edge's: one equation for the instant, solved by
Newton's method. Where the rake face is a helicoid, the edge at axial position s stands `twist` · s further
about the axis.
"""

import math

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.meeting import State
from twin.cutting.motion import CutterMotion
from twin.cutting.passes import Passes

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SETTLED = 1e-4
"""Residual angle [rad] of stock and edge below which one linear step ends the search for the meeting
instant: it leaves half the stock's acceleration over that angle, 1e-8 of the work radius."""
STILL = 1e-30
"""[rad per sample] in place of no motion at all, to divide by"""
ROUNDS = 12
HALVINGS = 60


class Rake:
    """The rake faces of one tool's passes, and the motion in which they are made."""

    def __init__(self, cutter: Cutter, motion: CutterMotion, passes: Passes) -> None:
        self.passes = passes
        self._twist, self._shift = cutter.twist, cutter.shift
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
        self.seen = np.stack([np.cos(at[0]), np.sin(at[0]), *at[2:]])
        """(5, k) cosine and sine of the work angle, and the tool centre, at `passes.at`"""
        # what a first guess of the meeting instant needs: position and rates at `passes.at`, per pass
        cell = np.minimum(self.passes.at.astype(np.int64), len(self._table) - 1)
        self._lead = np.stack([at[1] - self.passes.angle, *self._table[cell, 5:].T])
        self._settled = _settled(cutter, self.passes)

    def meet(self, points: Floats, index: Ints, near: Floats | None = None) -> tuple[State, Floats, Floats]:
        """The points near their meeting instants, those instants, and the step that is left to them; `near`
        (m,) is about when they meet, where that is known."""
        p = self.passes
        local = np.ascontiguousarray(points.T)
        if self._moved:
            local = self._mount.rotation @ local + self._mount.translation[:, None]
        first, last, angle = p.first.take(index), p.last.take(index), p.angle.take(index)
        if near is None:
            near = p.at.take(index) + self._ahead(local, index)
        at = np.clip(near, first, last)
        state = self._state(local, at, angle)
        rows = self._unsettled(state, at, first, last)
        if len(rows):
            late = local[:, rows], first[rows], last[rows], angle[rows]
            at[rows] = self._search(at[rows] - state.lag[rows] / state.lag_rate[rows], *late)
            state.put(rows, self._state(late[0], at[rows], late[3]))
        end = np.clip(at - state.lag / state.lag_rate, first, last)
        return state, end, end - at

    def placed(self, index: Ints, at: Floats, s: Floats, rho: Floats) -> Floats:
        """Points (m, 3) of the part that meet the rake faces of passes `index` (m,) at instants `at` (m,), at
        axial positions `s` and distances `rho` from the tool's axis."""
        work, tool, cx, cy, cz = self._at(at)
        angle = self.passes.angle.take(index)
        turn = tool - angle + self._twist * (s - self._shift)
        a, b = rho * np.cos(turn), rho * np.sin(turn)
        if self._lean is not None:
            cell = np.minimum(at.astype(np.int64), len(self._table) - 1)
            x, y, d_x, d_y = self._lean.take(cell, axis=0).T
            a, b, s = upright(a, b, s, -np.stack([x + (at - cell) * d_x, y + (at - cell) * d_y]))
        x, y, z = self._basis.T @ np.stack([a, b, s]) + np.stack([cx, cy, cz])
        cos, sin = np.cos(work), np.sin(work)
        local = np.stack([x * cos + y * sin, y * cos - x * sin, z])
        if self._moved:
            local = self._mount.rotation.T @ (local - self._mount.translation[:, None])
        return local.T

    def across(self) -> Floats:
        """(2, 4, k) what takes (x, y, z, 1) in the spindle's frame across the tool's axis, at `passes.at`."""
        cos, sin, cx, cy, cz = self.seen
        return np.array(
            [
                (x * cos + y * sin, y * cos - x * sin, np.full(len(cos), z), -(x * cx + y * cy + z * cz))
                for x, y, z in self._basis[:2]
            ]
        )

    def _at(self, at: Floats) -> list[Floats]:
        """Work angle, tool angle and tool centre at fractional samples `at` (m,)."""
        cell = np.minimum(at.astype(np.int64), len(self._table) - 1)
        rows = self._table.take(cell, axis=0).T
        return [value + (at - cell) * step for value, step in zip(rows[:5], rows[5:], strict=True)]

    def _ahead(self, local: Floats, index: Ints) -> Floats:
        """Samples (m,) from `passes.at` to where points (3, m) meet their edges, by one step of Newton's."""
        cos, sin, *centre = (row.take(index) for row in self.seen)
        lag, d_work, d_tool, d_cx, d_cy, d_cz = (row.take(index) for row in self._lead)
        x, y = local[0] * cos - local[1] * sin, local[0] * sin + local[1] * cos
        way = np.stack([x - centre[0], y - centre[1], local[2] - centre[2]])
        rate = np.stack([y * -d_work - d_cx, x * d_work - d_cy, -d_cz])
        (a, b, s), (a_rate, b_rate, s_rate) = self._basis @ way, self._basis @ rate
        lag -= np.arctan2(b, a)
        lag_rate = d_tool - (a * b_rate - b * a_rate) / (a * a + b * b)
        if self._twist:
            lag += self._twist * (s - self._shift)
            lag_rate += self._twist * s_rate
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
        at[rows] = self._between(local[:, rows], first[rows], last[rows], angle[rows])
        return at

    def _unsettled(self, state: State, at: Floats, first: Floats, last: Floats) -> Ints:
        """Rows of the points that can still come closer to their meeting instant."""
        free = np.flatnonzero(np.abs(state.lag) >= self._settled)
        if not len(free):
            return free
        at, first, last = at.take(free), first.take(free), last.take(free)
        wanted = at - state.lag.take(free) / state.lag_rate.take(free)
        held = ((at == first) & (wanted < first)) | ((at == last) & (wanted > last))
        return free[~held]

    def _between(self, local: Floats, first: Floats, last: Floats, angle: Floats) -> Floats:
        """Meeting instants where Newton's steps go round in circles: S changes too much, or everything rests.

        The meeting lies between two instants, which Newton's steps and halvings bring together.
        """
        at_first, at_last = (self._state(local, at, angle).lag for at in (first, last))
        falling = at_first > at_last
        low, high = first.copy(), last.copy()
        at = np.where((at_first < 0) != falling, last, first)
        rows = np.flatnonzero((at_first < 0) != (at_last < 0))
        at[rows] = 0.5 * (low[rows] + high[rows])
        for turn in range(HALVINGS):
            state = self._state(local[:, rows], at[rows], angle[rows])
            early = (state.lag < 0) != falling[rows]
            low[rows[early]], high[rows[~early]] = at[rows[early]], at[rows[~early]]
            left = self._unsettled(state, at[rows], first[rows], last[rows])
            if not len(left):
                break
            step = (at[rows] - state.lag / state.lag_rate)[left]
            rows = rows[left]
            within = (step > low[rows]) & (step < high[rows]) & (turn % 3 < 2)
            at[rows] = np.where(within, step, 0.5 * (low[rows] + high[rows]))
        return at

    def _state(self, local: Floats, at: Floats, angle: Floats) -> State:
        """Points `local` (3, m) at fractional samples `at` (m,), edges at unwrapped tool `angle`."""
        cell = np.minimum(at.astype(np.int64), len(self._table) - 1)
        part = at - cell
        # columns of their own: every one is read several times
        rows = np.ascontiguousarray(self._table.take(cell, axis=0).T)
        work, tool, _, _, _, d_work, d_tool, d_cx, d_cy, d_cz = rows
        work = work + part * d_work
        cos, sin = np.cos(work), np.sin(work)
        x = local[0] * cos - local[1] * sin
        y = local[0] * sin + local[1] * cos
        way = part * rows[7:]
        way += rows[2:5]
        np.subtract((x, y, local[2]), way, out=way)
        rate = np.stack([y * -d_work - d_cx, x * d_work - d_cy, -d_cz])
        a, b, s = self._basis @ way
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
        if self._twist:
            lag += self._twist * (s - self._shift)
            lag_rate += self._twist * s_rate
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

    def left_to_run(self, instant: Floats, index: Ints) -> Floats:
        """Angle (m,) of the tool from an `instant` (m,) to the nearer end of its pass's run."""
        tool = self._at(instant)[1]
        return np.minimum(*np.abs(self.passes.run_angle.take(index, axis=0) - tool[:, None]).T)

    def gradient(self, state: State, by: tuple[Floats, Floats], by_turn: Floats, follows: Floats) -> Floats:
        """Gradient (m, 3) in the part frame; the meeting instant `follows` the point (1) or not (0).

        `by` are the derivatives of the depth by s and rho, `by_turn` that by the way across the rake face.
        """
        a, b = state.side / state.rho
        by_s, by_rho = by
        # d instant / d point = (e_psi / rho − twist e_s) / lag_rate
        drift = (
            follows * (by_s * state.s_rate + by_rho * state.rho_rate) / (state.rho * state.lag_rate) + by_turn
        )
        if self._twist:
            by_s = by_s - drift * state.rho * self._twist
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
