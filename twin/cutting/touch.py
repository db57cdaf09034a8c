"""When a point of the stock is deepest inside a body of revolution that moves past it."""

import math

import numpy as np
from numpy.typing import NDArray

from twin.cutters.profile import ToothProfile
from twin.cutting.meeting import Meeting
from twin.cutting.motion import CutterMotion
from twin.cutting.windows import Way

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SETTLED = 2e-7
"""[mm] that another instant could still be deeper by, at which the search ends"""
ROUNDS = 80
STEP_IN = 0.02
"""Share of the bracket by which a new instant stays inside of it"""


class Touch:
    """Points of the part seen from the tool, and their depths in the pieces of its outline."""

    def __init__(self, profile: ToothProfile, motion: CutterMotion, way: Way) -> None:
        self.profile = profile
        self.mount = motion.mount
        self.basis = motion.basis
        self.way = way
        step = np.diff(way.length)[:, None]
        self._table = np.hstack([way.place[:-1], np.diff(way.place, axis=0) / step])
        self._table[:, 0] = np.remainder(self._table[:, 0] + math.pi, 2.0 * math.pi) - math.pi

    def clamped(self, points: Floats) -> Floats:
        """(3, m) in the work spindle's frame at work angle 0."""
        return self.mount.rotation @ points.T + self.mount.translation[:, None]

    def seen(self, local: Floats, at: Floats, *, before: bool = False) -> tuple[Floats, Floats, Floats]:
        """Position (3, m) along the tool's basis `at` (m,) [mm] of the way, its rate, and the work angle.

        At a sample the rate is that of the interval behind it, or `before` it.
        """
        cell = np.searchsorted(self.way.length, at, side="left" if before else "right") - 1
        cell = np.clip(cell, 0, len(self._table) - 1)
        part = at - self.way.length[cell]
        work, cx, cy, cz, d_work, d_cx, d_cy, d_cz = self._table.take(cell, axis=0).T
        work = work + part * d_work
        cos, sin = np.cos(work), np.sin(work)
        x = local[0] * cos - local[1] * sin
        y = local[0] * sin + local[1] * cos
        offset = np.stack([x - cx - part * d_cx, y - cy - part * d_cy, local[2] - cz - part * d_cz])
        rate = np.stack([-y * d_work - d_cx, x * d_work - d_cy, -d_cz])
        return self.basis @ offset, self.basis @ rate, work

    def depth(self, place: Floats, piece: Ints) -> tuple[Floats, Floats]:
        """Depth (m,) at a place (3, m) seen from the tool, and its gradient (3, m) there."""
        rho = np.maximum(np.hypot(place[0], place[1]), 1e-12)
        depth, by_s, by_rho = self.profile.piece_depth(piece, np.zeros(len(rho)), place[2], rho)
        return depth, np.stack([by_rho * place[0] / rho, by_rho * place[1] / rho, by_s])

    def rate(self, local: Floats, piece: Ints, at: Floats, *, before: bool = False) -> Floats:
        """Rate of the depth over the way (m,)."""
        place, way, _ = self.seen(local, at, before=before)
        return (self.depth(place, piece)[1] * way).sum(axis=0)


def deepest(
    touch: Touch, points: Floats, piece: Ints, ends: tuple[Floats, Floats], *, gradient: bool
) -> Meeting:
    """Where `points` (m, 3) are deepest in a `piece` (m,) of the outline between two places of the way each.

    The meeting's slack is how far, along the chord of the point's way, the depth's tangent rises above it.
    """
    local = touch.clamped(points)
    low, high = ends
    early, late = _bracket(touch, local, piece, low, high)
    sides = []
    for at in (early, late):
        place, _, work = touch.seen(local, at)
        sides.append((at, place, work, *touch.depth(place, piece)))
    better = sides[1][3] > sides[0][3]
    at, place, work, depth = (np.where(better, sides[1][k], sides[0][k]) for k in range(4))
    s, rho = place[2], np.hypot(place[0], place[1])
    instant = np.interp(at, touch.way.length, touch.way.sample)
    if not gradient:
        return Meeting(depth, np.zeros((0, 3)), s, rho, instant, np.zeros(len(at)))
    # on a ridge of the depth, the slope between its two sides along which the way is level
    rates = [(sides[k][4] * touch.seen(local, sides[k][0], before=k == 1)[1]).sum(axis=0) for k in (0, 1)]
    level = (rates[0] > 0) & (rates[1] < 0)
    share = np.where(level, -rates[1] / np.where(level, rates[0] - rates[1], 1.0), ~better)
    slope = share * sides[0][4] + (1.0 - share) * sides[1][4]
    chord = [touch.seen(local, end)[0] - place for end in (low, high)]
    slack = np.maximum(*((slope * way).sum(axis=0) for way in chord)).clip(min=0.0)
    gx, gy, gz = touch.basis.T @ slope
    cos, sin = np.cos(work), np.sin(work)
    turned = np.stack([gx * cos + gy * sin, gy * cos - gx * sin, gz])
    return Meeting(depth, (touch.mount.rotation.T @ turned).T, s, rho, instant, slack)


def _bracket(touch: Touch, local: Floats, piece: Ints, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Places of the way (m,) just before and just after the depth is the largest, by the sign of its rate.

    False position with bisections between, until neither side could still rise by SETTLED.
    """
    low, high = low.copy(), high.copy()
    rising, falling = touch.rate(local, piece, low), touch.rate(local, piece, high, before=True)
    done = (rising <= 0) | (falling >= 0)
    late = (rising > 0) & (falling >= 0)
    high[done & ~late] = low[done & ~late]
    low[late] = high[late]
    rows = np.flatnonzero(~done)
    weight = np.stack([rising, falling])
    for turn in range(ROUNDS):
        open_ = np.minimum(rising[rows], -falling[rows]) * (high[rows] - low[rows]) > SETTLED
        rows = rows[open_]
        if not len(rows):
            break
        a, b = low[rows], high[rows]
        share = weight[0, rows] / (weight[0, rows] - weight[1, rows]) if turn % 3 < 2 else 0.5
        at = a + np.clip(share, STEP_IN, 1.0 - STEP_IN) * (b - a)
        rate = touch.rate(local[:, rows], piece[rows], at)
        up = rate > 0
        for side, mine in ((0, up), (1, ~up)):
            here = rows[mine]
            (low, high)[side][here] = at[mine]
            (rising, falling)[side][here] = rate[mine]
            weight[side, here] = rate[mine]
            # the side that stays loses weight, so that it moves soon
            weight[1 - side, here] *= 0.5
    return low, high
