"""Steady hobbing: one turn of the hob later the same happens again, some gaps on and a little along the axis.

Seen from the part the tool then moves on a screw. What is proved of one stretch of a gap so holds for all its
images under the screw, as far as the recorded motion keeps to it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.engagement import StockCylinder, sway
from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.cutting.passes import REACH
from twin.cutting.regular.indexing import Indexing, at_depth

Floats = NDArray[np.float64]

ROUNDS = 8
"""of fitting the screw to what keeps to it"""
HARMONICS = 2
"""of the tool's turn: an arbor off its axis, for one"""
TRUE = 6.0
"""Times as far off as in the middle of its samples that a steady stretch may be."""
SETTLED = 1e-5
"""[mm] off the screw that never ends a steady stretch"""
MOST = 0.9
"""Share of a stretch that is left when its worse ends are taken off, or it keeps them."""
LEAST = 3
"""Turns of the hob that a steady stretch has at least."""
SAME = 1e-9
"""[rad] by which edges of equal passes may stand apart"""
SAMPLES = 48
"""per turn of the hob in a motion without end"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Steady:
    """The passes that repeat, and the screw."""

    made: tuple[int, int]
    """numbers of the first and last of them, in numbers that go on beyond those that come near the stock"""
    near: tuple[int, int]
    """of those that do"""
    per_turn: int
    """passes in one turn of the hob"""
    angle: Floats
    """(per_turn,) tool angles [rad] of the first of `near`"""
    step: int
    """gaps by which the cut moves on in one turn"""
    rise: float
    """way along the work's axis in one turn [mm]"""
    astray: float
    """how far the tool may stand off its place on the screw, anywhere in the stock [mm]"""
    drift: float
    """the same per turn, between the screw of the motion and that of the gaps [mm]"""
    way: float
    """+1 or −1, as the hob turns"""
    begin: float
    """turn of the hob from which the following count"""
    shape: Floats
    """(2 + 2 HARMONICS, 6) of work angle, tool centre and lean: waves of the tool's turn, level and slope"""
    source: CutterMotion

    def margin(self, turns: int) -> float:
        """By how much depths may differ from their images' within so many turns [mm]."""
        return self.astray + abs(turns) * self.drift

    def endless(self, z: float, reach: float) -> CutterMotion:
        """The steady motion as far as the tool's centre is within `reach` of a height [mm]."""
        middle = self.begin + (z - self.shape[-2, 3]) / self.shape[-1, 3]
        half = math.ceil(reach / abs(self.rise))
        turns = middle + np.arange(-half * SAMPLES, half * SAMPLES + 1) / SAMPLES
        columns = _base(turns, self.begin) @ self.shape
        return CutterMotion(
            time_s=np.arange(len(turns), dtype=np.float64),
            work_angle=columns[:, 0],
            tool_angle=self.way * 2.0 * math.pi * turns,
            centre=np.ascontiguousarray(columns[:, 1:4]),
            basis=self.source.basis,
            lean=None if self.source.lean is None else np.ascontiguousarray(columns[:, 4:]),
            mount=self.source.mount,
        )

    def number(self, angle: float) -> int:
        """Number of the pass whose edge points along tool angle 0 at an unwrapped angle [rad]."""
        off = (angle - self.angle) / (self.way * 2.0 * math.pi)
        gash = int(np.abs(off - np.rint(off)).argmin())
        return self.near[0] + gash + round(float(off[gash])) * self.per_turn


def find_steady(
    field: DepthField, motion: CutterMotion, indexing: Indexing, stock: StockCylinder, limit: float
) -> Steady | None:
    """The steady part of the last tool's motion, within `limit` [mm] of a screw; None where there is none."""
    deep = at_depth(motion, indexing.root, stock.radius)
    way = float(np.sign(motion.tool_angle[deep][-1] - motion.tool_angle[deep][0]))
    turns = way * motion.tool_angle / (2.0 * math.pi)
    lean = np.zeros((len(turns), 2)) if motion.lean is None else motion.lean
    columns = np.column_stack([motion.work_angle, motion.centre, lean])
    # what of it moves the stock by how much
    weight = np.array([stock.radius, 1.0, 1.0, 1.0, *[sway(field.cutter, motion, stock)[1]] * 2])
    found = _tried(turns, columns, weight, deep, limit)
    if found is None:
        return None
    run, shape, off, begin = found
    numbers = _passes_in(field, motion, run)
    rise = float(shape[-1, 3])
    if numbers is None or not rise or (np.diff(turns[run]) <= 0).any():
        return None
    first, last = numbers
    passes, per_turn = field.passes, len(field.cutter.gash_angle)
    pitch = 2.0 * math.pi / indexing.teeth
    turned = -float(shape[-1, 0]) - indexing.twist * rise
    step = round(turned / pitch)
    bow = weight @ np.abs(shape[: 2 * HARMONICS]).sum(axis=0) * (HARMONICS * math.pi / SAMPLES) ** 2 / 2.0
    # a point that is off its place meets the edge at another instant, too
    widened = 1.0 + 2.0 * float(passes.slant[first : last + 1].max())
    return Steady(
        made=_made(motion.tool_angle[run], passes.angle[[first, last]], (first, last), per_turn),
        near=(first, last),
        per_turn=per_turn,
        angle=passes.angle[first : first + per_turn],
        step=step % indexing.teeth,
        rise=rise,
        astray=(float(off.max()) + float(bow)) * widened,
        drift=stock.radius * abs(turned - step * pitch) * widened,
        way=way,
        begin=begin,
        shape=shape,
        source=motion,
    )


_Screw = tuple[slice, Floats, Floats, float]
"""Samples, shape, how far off those are (n,), and the turn from which the shape counts."""


def _tried(turns: Floats, columns: Floats, weight: Floats, deep: slice, limit: float) -> _Screw | None:
    """The longest stretch on a screw, without ends that stand off it much more than its middle does."""
    # some samples of each turn tell about where it is
    every = max(int(len(turns[deep]) / (SAMPLES * max(np.ptp(turns[deep]), 1.0))), 1)
    some = slice(deep.start, deep.stop, every)
    rough = _on_screw(turns[some], columns[some], weight, slice(0, len(turns[some])), lambda _: limit)
    if rough is None:
        return None
    first, stop = rough[0].start * every, (rough[0].stop - 1) * every + 1
    about = slice(deep.start + first, deep.start + stop)
    # the whole of a steady stretch keeps to the screw about as well as its middle, but for its ends
    tight = _on_screw(
        turns, columns, weight, about, lambda off: min(limit, TRUE * float(np.median(off)) + SETTLED)
    )
    if tight and np.ptp(turns[tight[0]]) > MOST * np.ptp(turns[about]):
        return tight
    return tight and _on_screw(turns, columns, weight, about, lambda _: limit)


def _on_screw(
    turns: Floats, columns: Floats, weight: Floats, within: slice, limit: Callable[[Floats], float]
) -> _Screw | None:
    """The longest stretch of samples within a limit, told by how far off all are, and the screw it is on."""
    turns, columns, first = turns[within], columns[within], within.start
    run = slice(0, len(turns))
    base = _base(turns, 0.0)
    for _ in range(ROUNDS):
        if run.stop - run.start < 2 or np.ptp(turns[run]) < LEAST:
            return None
        begin = float(turns[run].mean())
        base[:, -1] = turns - begin
        shape = _fit(base[run], columns[run])
        away = columns - base @ shape
        away *= weight
        off = np.sqrt(np.einsum("nc,nc->n", away, away))
        before, run = run, _longest(off < limit(off[run]))
        if run == before:
            return slice(first + run.start, first + run.stop), shape, off[run], begin
    return None


def _base(turns: Floats, begin: float) -> Floats:
    """(n, 2 + 2 HARMONICS) waves of the tool's turn, 1, and the turns from `begin` on."""
    waves = [f(2.0 * math.pi * n * turns) for n in range(1, HARMONICS + 1) for f in (np.cos, np.sin)]
    return np.column_stack([*waves, np.ones_like(turns), turns - begin])


def _fit(base: Floats, columns: Floats) -> Floats:
    """What makes `base` (n, b) nearest to columns (n, 6). Only the work's turn and z go on with the turns."""
    span = float(np.ptp(base[:, -1]))
    scaled = base / np.append(np.ones(base.shape[1] - 1), span)
    square, pull = scaled.T @ scaled, scaled.T @ columns
    shape = np.zeros((base.shape[1], columns.shape[1]))
    goes_on, stays = [0, 3], [1, 2, 4, 5]
    shape[:, goes_on] = np.linalg.solve(square, pull[:, goes_on])
    shape[:-1, stays] = np.linalg.solve(square[:-1, :-1], pull[:-1, stays])
    shape[-1] /= span
    return shape


def _longest(good: NDArray[np.bool_]) -> slice:
    """The longest stretch of good samples."""
    edges = np.flatnonzero(np.diff(good, prepend=False, append=False)).reshape(-1, 2)
    if not len(edges):
        return slice(0, 0)
    first, stop = edges[int(np.argmax(edges[:, 1] - edges[:, 0]))]
    return slice(int(first), int(stop))


def _passes_in(field: DepthField, motion: CutterMotion, run: slice) -> tuple[int, int] | None:
    """Numbers of the first and last of the passes that are made within a run; None for too few."""
    angle = motion.tool_angle[run]
    passes = field.passes
    if not len(angle):
        return None
    reach = REACH + math.pi
    within = (passes.angle > angle.min() + reach) & (passes.angle < angle.max() - reach)
    within &= (passes.at > run.start) & (passes.at < run.stop - 1)
    stretch = _longest(within)
    per_turn = len(field.cutter.gash_angle)
    own = passes.angle[stretch]
    if len(own) < LEAST * per_turn:
        return None
    way = math.copysign(2.0 * math.pi, own[-1] - own[0])
    if np.abs(own[per_turn:] - own[:-per_turn] - way).max() > SAME:
        return None
    return stretch.start, stretch.stop - 1


def _made(angle: Floats, own: Floats, near: tuple[int, int], per_turn: int) -> tuple[int, int]:
    """Numbers of the first and last passes made within tool angles (n,), given the ends of those `near`."""
    rest = np.array([abs(own[0] - angle[0]), abs(angle[-1] - own[1])]) - REACH - math.pi
    more = np.maximum(np.floor(rest / (2.0 * math.pi)), 0).astype(int) * per_turn
    return int(near[0] - more[0]), int(near[1] + more[1])
