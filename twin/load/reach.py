"""Which rays of the stock the edges of some passes can come to, and about when."""

import math

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.cutting.passes import REACH
from twin.load.evenly import Evenly
from twin.load.ray_ends import SLACK
from twin.load.stock import Stock

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUNDING = 1e-9
"""[rad]"""
UPRIGHT = 0.9
"""cosine of a tool's axis and the work's from which on its edges have a height"""
FASTEST = 0.6
"""share of the edge's speed that the stock may have for its meeting to be foretold"""


def at_samples(motion: CutterMotion, values: Floats, sample: Floats) -> Floats:
    """Values (n, ...) of a motion at fractional samples (m,)."""
    cell = np.clip(sample.astype(np.int64), 0, len(motion.time_s) - 2)
    share = (sample - cell).reshape(-1, *[1] * (values.ndim - 1))
    return values[cell] + share * (values[cell + 1] - values[cell])


def may_meet(cutter: Cutter, motion: CutterMotion, stock: Stock, rows: slice) -> bool:
    """Whether any edge may be in metal between two rows of a motion.

    Stock stands at least `nearest` away from the tool's axis along the way to the work; so edges meet it only
    within acos(nearest / radius) of that way.
    """
    if cutter.revolved or motion.lean is not None or not np.allclose(motion.basis[0], [-1.0, 0.0, 0.0]):
        return True
    high = float(stock.end.max(initial=0.0))
    nearest = float(motion.centre[rows, 0].min()) - high - _clamped(motion, stock)
    if nearest > cutter.radius:
        return False
    half = math.acos(max(nearest / cutter.radius, -1.0)) + abs(cutter.twist) * 2.0 * stock.farthest
    angle = motion.tool_angle[rows]
    if half + float(np.ptp(angle)) / 2.0 >= math.pi:
        return True
    middle = 0.5 * float(angle.min() + angle.max()) + cutter.gash_angle
    return bool((np.cos(middle) > math.cos(half + 0.5 * float(np.ptp(angle)))).any())


def _clamped(motion: CutterMotion, stock: Stock) -> float:
    """How far its clamping shifts any of the stock at most [mm]."""
    turned = float(np.linalg.norm(motion.mount.rotation - np.eye(3), 2))
    return turned * stock.farthest + float(np.linalg.norm(motion.mount.translation))


class Reach:
    """The edges of one tool's passes, seen from the stock; `between` two times [s] metal is asked for."""

    def __init__(
        self, field: DepthField, motion: CutterMotion, stock: Stock, between: tuple[float, float]
    ) -> None:
        self._field, self._motion, self._stock = field, motion, stock
        p = field.passes
        self._between = between
        self._work = at_samples(motion, motion.work_angle, p.at)
        self._centre = at_samples(motion, motion.centre, p.at)
        self._time = at_samples(motion, motion.time_s, p.at)
        cell = np.minimum(p.at.astype(np.int64), len(motion.time_s) - 2)
        self._rate = (np.diff(motion.tool_angle) / np.diff(motion.time_s))[cell]
        # `at` stands at the end of a run of one-way turning where the edge would point to the work after it
        standing = np.interp(p.at, np.arange(len(motion.time_s)), motion.tool_angle)
        with np.errstate(divide="ignore", invalid="ignore"):
            self._time = self._time + np.nan_to_num((p.angle - standing) / self._rate)
        self._spread = np.where(p.slant < FASTEST, p.slant / (1.0 - np.minimum(p.slant, FASTEST)), np.inf)
        self._shift = _clamped(motion, stock)
        self._along = abs(field.cutter.twist) * 2.0 * stock.farthest

    def passes(self) -> Ints:
        """Passes that may meet stock in the time asked for."""
        index = np.arange(self._field.passes.count)
        low, high = self._between
        if not len(index) or not (math.isfinite(low) or math.isfinite(high)):
            return index
        nearest = self._nearest(index)
        arc = np.arccos(np.clip(nearest / self._field.cutter.radius, -1.0, 1.0)) + self._along
        with np.errstate(divide="ignore", invalid="ignore"):
            late = np.nan_to_num(arc * (1.0 + self._spread) / np.abs(self._rate), nan=np.inf)
        return np.flatnonzero((self._time + late > low) & (self._time - late < high))

    def pairs(self, passes: Ints) -> tuple[Ints, Ints]:
        """Pairs of rays and passes whose edges come to the rays' ends or further in, in that time."""
        field, motion, stock, p = self._field, self._motion, self._stock, self._field.passes
        standing = self._facing(passes)
        points = np.ascontiguousarray(motion.mount.moved(stock.points(standing, stock.end[standing])).T)
        radius, profile = field.cutter.radius, field.cutter.profile
        rays: list[Ints] = [np.zeros(0, np.int64)]
        for index in passes:
            cos, sin = math.cos(self._work[index]), math.sin(self._work[index])
            turned = motion.basis @ np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
            own = turned @ points - (motion.basis @ self._centre[index])[:, None]
            near = np.flatnonzero(own[0] ** 2 + own[1] ** 2 < (radius + p.travel[index] + SLACK) ** 2)
            own = own.take(near, axis=1)
            rho, turn, s = np.hypot(own[0], own[1]), np.arctan2(own[1], own[0]), own[2]
            # the sooner or later the edge comes, the further the stock has gone on
            later = (np.abs(turn) + self._along) / (REACH + self._along)
            way = p.travel[index] * np.minimum(later, 1.0)
            if (evenly := self._evenly(index)) is not None:
                met, bound = evenly.met(own, turn)
                known = bound < way
                rho, s = np.where(known, np.hypot(met[0], met[1]), rho), np.where(known, met[2], s)
                way = np.minimum(bound, way)
            way += SLACK
            # depth grows no faster than the way
            meets = profile.depth(s - p.shift[index], rho)[0] > -way
            rays.append(standing[near[meets & self._timely(index, turn, radius + way - rho)]])
        return np.concatenate(rays), np.repeat(passes, [len(one) for one in rays[1:]])

    def _evenly(self, index: int) -> Evenly | None:
        """The motion in a pass, where that tells when points meet its edge."""
        if self._along or self._motion.lean is not None:
            return None
        nearest = float(self._nearest(np.array([index]))[0])
        arc = math.acos(min(max(nearest / self._field.cutter.radius, -1.0), 1.0))
        far = float(self._stock.end.max(initial=0.0)) + self._shift
        return Evenly.of(self._motion, float(self._field.passes.angle[index]), far, min(2.0 * arc, REACH))

    def _timely(self, index: int, turn: Floats, deep: Floats) -> NDArray[np.bool_] | bool:
        """Which rays (n,), `turn` [rad] from where the edge points to the work, it may meet in the time
        asked for; what it takes of them is at most twice as long as they stand `deep` in its way."""
        (low, high), rate = self._between, abs(float(self._rate[index]))
        if not rate or not (math.isfinite(low) or math.isfinite(high)):
            return True
        meets = self._time[index] + turn / self._rate[index]
        off = np.abs(turn) * self._spread[index] + self._along + 4.0 * deep / self._field.cutter.radius
        return (meets + off / rate > low) & (meets - off / rate < high)

    def _nearest(self, passes: Ints) -> Floats:
        """(n,) how near to the tool's axis, along the way to the work, stock can stand in each pass [mm]."""
        if not np.allclose(self._motion.basis[0], [-1.0, 0.0, 0.0]):
            return np.full(len(passes), -np.inf)
        high = float(self._stock.end.max(initial=0.0))
        travel = self._field.passes.travel[passes]
        return self._centre[passes, 0] - travel - high - SLACK - self._shift

    def _facing(self, passes: Ints) -> Ints:
        """Rays that still stand, and where some passes' edges can come to them: at their height, and on the
        side of the work that the tool is on.

        Metal at an angle φ from the tool stands at most its radius · cos φ nearer to it, and what the
        clamping shifts.
        """
        stock, work = self._stock, self._work[passes]
        low, high = self._heights(passes)
        height = stock.z + stock.slope * stock.end
        standing = (stock.end > stock.inner) & (height > low) & (height < high)
        far = float(stock.end.max(initial=0.0))
        least = float(self._nearest(passes).min(initial=np.inf)) + far - self._field.cutter.radius
        if least > 0.0:
            half = math.acos(min(least / far, 1.0)) + 0.5 * float(np.ptp(work)) + ROUNDING
            middle = -0.5 * float(work.min() + work.max())
            if half < math.pi:
                standing &= stock.cos * math.cos(middle) + stock.sin * math.sin(middle) >= math.cos(half)
        return np.flatnonzero(standing)

    def _heights(self, passes: Ints) -> tuple[float, float]:
        """Lowest and highest z that the edges of some passes come to, where they are single teeth [mm]."""
        profile, axis, p = self._field.cutter.profile, self._motion.basis[2], self._field.passes
        if math.isfinite(profile.pitch) or not len(passes) or abs(axis[2]) < UPRIGHT:
            return -math.inf, math.inf
        lean = math.hypot(axis[0], axis[1]) * (2.0 * self._field.cutter.radius + self._stock.farthest)
        half = profile.half_width + float(np.abs(p.shift[passes]).max()) + lean
        reach = half / abs(axis[2]) + float(p.carried[passes].max()) + self._shift + SLACK
        middle = self._centre[passes, 2]
        return float(middle.min()) - reach, float(middle.max()) + reach
