"""A run under its own cutting forces: some ticks after the other, round after round.

Forces of a tick depend on motion and metal up to it alone. So a run is made in windows of some ticks, each
final before the next one begins. In a window the machine goes ahead under forces that are tried, on a copy;
the metal that it takes away so gives those of the next round, mounts in balance with them, until a round
moves nothing any more. A window that eight rounds do not settle, or will not at their pace, is halved: in
shorter ones the drives have less time to answer, and at the shortest there is nothing left but mounts and
metal.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from controller.clock import Chunk, Feedback
from twin.course import Course, Trial
from twin.cutting.motion import CutterMotion
from twin.job.schema import Job
from twin.load.bench import Bench
from twin.load.change import bound_um, change_um
from twin.load.mounts import balanced
from twin.load.relaxation import Relaxation
from twin.load.removal import Removal
from twin.load.span import Span
from twin.load.stock import Lean, Stock
from twin.load.timeline import CuttingLoad
from twin.machine.pressing import REACH
from twin.session import ticks_of
from twin.setup import Ready

Floats = NDArray[np.float64]

MOST_ROUNDS = 8
FEW_ROUNDS = 5
"""after which a longer window may be tried, and from which on rounds must be on their way to settle"""
SETTLED_UM = 0.1
"""by how much the last round may still have moved the part's surface"""
HOPE = 3.0
"""times as much as that, at the pace of the last two rounds, is worth to go on for"""
TICKS = 128
"""of a window in which metal is cut, where the job's controller knows as many ahead"""
LONGEST = 1024
"""[ticks] of one in which none is"""
SLOWEST = 20_000
"""[ticks] to a turn of the tool, the forces of which are the first guess for the next"""
RECENT = 8
"""[ticks] of the motion before that a window asks for"""
STOPPED = 0.02
"""of the speed that it is told, below which a tool in metal has stopped"""
STOPPING = 0.5
"""the same where rounds do not settle, for forces by an angle that hardly moves on do not"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Window:
    """What the rounds of some ticks have come to."""

    first_tick: int
    ticks: int
    load: CuttingLoad
    """that acts in it"""
    moved_um: tuple[float, ...]
    """by how much each round but the first moved the part's surface at most"""
    settled: bool
    slowest: float
    """speed of the tool in metal over that which it is told, at least"""

    @property
    def rounds(self) -> int:
        """That were needed."""
        return len(self.moved_um) + 1

    @property
    def stalled(self) -> bool:
        """Whether the tool has come to rest in the metal."""
        return self.slowest < (STOPPED if self.settled else STOPPING)


@dataclass(frozen=True, slots=True, kw_only=True)
class _End:
    """A window, and what is behind it."""

    window: Window
    chunk: Chunk
    trial: Trial
    """that went through it last"""
    tail: CuttingLoad
    """of metal that it has cut, on ticks behind it"""
    stock: Stock
    """that it leaves"""


class Rounds:
    """A course under its own forces, as far as it has come."""

    def __init__(
        self, job: Job, ready: Ready, course: Course, *, lean: Lean | None = None, ticks: int = TICKS
    ) -> None:
        """`lean` of the stock's rays, `ticks` of a window in which metal is cut. Raises InputError for a
        material without figures."""
        self.bench = Bench(job, ready)
        self.course = course
        self.stock = self.bench.whole(lean or Lean())
        self.past: list[CuttingLoad] = []
        """what acted in each window so far, by whole ticks"""
        self.windows: list[Window] = []
        """in which metal was cut"""
        self._acted = self._tail = self.bench.no_load
        self._most = self._cutting = ticks
        """ticks of a window in which metal is cut: at most, and as the last ones have settled"""
        self._ticks = LONGEST

    def go(self) -> None:
        """Go on to the program's end, or to a window that does not settle or in which the tool stops."""
        while (chunk := self._ahead(self._ticks)) is not None:
            clear = self._clear(chunk) if chunk.ticks > self._cutting else 0
            if clear >= self._cutting:
                self._take(self._shorter(chunk, clear))
                self._ticks = min(2 * self._ticks, LONGEST)
                continue
            chunk = self._shorter(chunk, self._cutting)
            end = self._settle(chunk)
            while not end.window.settled and end.chunk.ticks > 1:
                self._cutting = end.chunk.ticks // 2
                end = self._settle(self._shorter(chunk, self._cutting))
            window = end.window
            if window.rounds <= FEW_ROUNDS and window.ticks == self._cutting:
                self._cutting = min(2 * self._cutting, self._most)
            self._take(end.chunk, end)
            if len(window.load.cell):
                self.windows.append(window)
            idle = not len(window.load.cell) and not len(self._tail.cell)
            self._ticks = min(2 * self._ticks, LONGEST) if idle else self._cutting
            if not window.settled or window.stalled:
                return

    def _ahead(self, limit: int) -> Chunk | None:
        """The next ticks, all with one tool."""
        chunk = self.course.ahead(limit)
        if chunk is None:
            return None
        change = np.flatnonzero(chunk.tool != chunk.tool[0])
        return self._shorter(chunk, int(change[0])) if len(change) else chunk

    def _shorter(self, chunk: Chunk, ticks: int) -> Chunk:
        """The beginning of it."""
        shorter = self.course.ahead(ticks) if ticks < chunk.ticks else chunk
        return chunk if shorter is None else shorter

    def _take(self, chunk: Chunk, end: _End | None = None) -> None:
        """Go through a window whose end is known; without one nothing is cut in it."""
        first = self.course.tick
        none = self.bench.no_load
        load = none if end is None else end.window.load
        feedback = self.course.take(chunk, tried=None if end is None else end.trial)
        until = first + feedback.ticks
        tool = feedback.actual[:, none.spindle]
        load = replace(load.before(until), angle=(first + np.arange(len(tool)), tool))
        if len(load.cell):
            self.past.append(load.whole())
        self._acted = self._acted.then(load)
        self._acted = self._acted.since(until - (_turn(self._acted, SLOWEST) or SLOWEST) - 2 * REACH)
        if end is not None:
            self._tail, self.stock = end.tail.since(until), end.stock

    def _clear(self, chunk: Chunk) -> int:
        """Ticks at the beginning of a chunk in which nothing is cut."""
        if len(self._tail.cell):
            return 0
        span = self._span(self.course.trial(chunk).feedback)
        tick = self.bench.first_cut(self.stock, int(chunk.tool[0]), span)
        return chunk.ticks if tick is None else max(tick - span.first - 2, 0)

    def _settle(self, chunk: Chunk) -> _End:
        """Go through a window round after round."""
        bench, tool = self.bench, int(chunk.tool[0])
        load, moved = self._guess(chunk), list[float]()
        before: CutterMotion | None = None
        step = Relaxation()
        metal, search = Removal.none(), bench.search(self.stock)
        while True:
            pressed = self._acted.then(load)
            trial = self.course.trial(chunk, pressed if len(load.cell) else None)
            span = self._span(trial.feedback)
            felt = pressed.on(span.tick[span.core], span.actual[span.core, load.spindle])
            give = _give(felt, span)
            motion = bench.motion(tool, span, give)
            if before is not None:
                moved.append(self._moved(before, motion, load.tick[load.tick < span.until]))
                if _over(moved, chunk.ticks):
                    mine = metal.of(metal.middle_s < span.until * bench.tick_s)
                    lasting = mine.time_s[:, 1] > span.until * bench.tick_s
                    slowest = _slowest(self._told(trial.feedback), load, span)
                    return _End(
                        window=_window(chunk, load, moved, slowest),
                        chunk=chunk,
                        trial=trial,
                        tail=bench.forces(tool, mine.of(lasting), before, span).load,
                        stock=mine.taken_from(self.stock),
                    )
            metal = bench.metal(search, tool, motion, span)
            found = bench.forces(tool, metal, motion, span).and_also(self._tail)
            if not len(found.load.cell):
                return _End(
                    window=_window(chunk, bench.no_load, moved, 1.0),
                    chunk=chunk,
                    trial=self.course.trial(chunk) if len(load.cell) else trial,
                    tail=bench.no_load,
                    stock=self.stock,
                )
            row = int(np.searchsorted(span.tick, span.first))
            ends = give[row - 1 : row + span.last - span.first]
            mean = 0.5 * (ends[:-1] + ends[1:])
            load = balanced(found.before(span.last), self._acted, mean, first=span.first)
            load = step.towards(felt.since(span.first).before(span.last), load, span, moved)
            before = motion

    def _span(self, feedback: Feedback) -> Span:
        tick = self.course.tick
        tape = self.course.tape(tick - RECENT)
        return self.bench.span((ticks_of(tape, self.bench.tick_s), tape.actual), feedback, tick)

    def _told(self, feedback: Feedback) -> Floats:
        """(n + 1,) setpoints of the tool, from the tick before on."""
        column = self.bench.no_load.spindle
        return np.concatenate([self.course.tape(self.course.tick - 1).setpoint, feedback.setpoint])[:, column]

    def _moved(self, before: CutterMotion, after: CutterMotion, ticks: NDArray[np.int64]) -> float:
        """By how much the part's surface has moved at most [µm]."""
        sizes = {"radius": self.bench.blank.radius, "tick_s": self.bench.tick_s}
        return bound_um(change_um(before, after, ticks, **sizes))

    def _guess(self, chunk: Chunk) -> CuttingLoad:
        """What acted a turn of the tool ago, else what is left of metal that is cut."""
        back = _turn(self._acted, SLOWEST)
        if not back:
            return self._tail
        ticks, angle = self._acted.angle
        turns = round((angle[-1] - np.interp(ticks[-1] - back, ticks, angle)) / 360.0)
        later = self._acted.later(back, turns)
        return later.since(self.course.tick).before(chunk.first_tick + chunk.ticks + 2 * REACH)


def _window(chunk: Chunk, load: CuttingLoad, moved: list[float], slowest: float) -> Window:
    return Window(
        first_tick=chunk.first_tick,
        ticks=chunk.ticks,
        load=load,
        moved_um=tuple(moved),
        settled=not len(load.cell) or moved[-1] < SETTLED_UM,
        slowest=slowest,
    )


def _give(felt: CuttingLoad, span: Span) -> Floats:
    """(m, 3) how far the mounts give way at the rows of a span [µm] to what is `felt` there; beyond it they
    stand still."""
    core = span.tick[span.core]
    rows = np.searchsorted(core, np.minimum(span.tick, span.last - 2))
    return felt.deflection_um(core)[np.minimum(rows, len(core) - 1)]


def _over(moved: list[float], ticks: int) -> bool:
    """Whether rounds of a window of some `ticks` that have `moved` the part so far [µm] come to their end:
    settled, all of them made, or, where a shorter window may do, at a pace that will not settle it."""
    left = MOST_ROUNDS - 1 - len(moved)
    if moved[-1] < SETTLED_UM or not left:
        return True
    if ticks == 1 or len(moved) < FEW_ROUNDS - 1:
        return False
    return moved[-1] * (moved[-1] / moved[-2]) ** left > HOPE * SETTLED_UM


def _turn(load: CuttingLoad, most: int) -> int:
    """Ticks since the tool was a turn behind, or ahead; 0 where that is unknown or longer ago."""
    ticks, angle = load.angle
    if not len(ticks):
        return 0
    before = np.flatnonzero(np.abs(angle - angle[-1]) >= 360.0)
    back = int(ticks[-1] - ticks[before[-1]]) if len(before) else 0
    return back if back < most else 0


def _slowest(told: Floats, load: CuttingLoad, span: Span) -> float:
    """Speed of the tool over that which it is `told` (n + 1,) [deg], from the tick before the span on, where
    metal is cut."""
    rows = np.searchsorted(span.tick, np.arange(span.first - 1, span.first - 1 + len(told)))
    way, made = np.diff(told), np.diff(span.actual[rows, load.spindle])
    cuts = np.isin(span.first + np.arange(len(way)), load.tick) & (np.abs(way) > 0.0)
    return float((made[cuts] / way[cuts]).min(initial=1.0))
