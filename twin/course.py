"""A program under way on a machine: it goes on to any tick, and can be forked there and gone on with again.

The machine's state is copied. The controller plans ahead in generators, which cannot be; given the same
answers it comes to the same state, so a fork's controller is told all of them anew.
"""

import copy
from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from controller.clock import Chunk, Feedback, Load, Machine
from controller.cnc import Controller
from twin.errors import PartError
from twin.sync import sync_error

Floats = NDArray[np.float64]

CHUNK = 4096
"""[ticks] proposed at once where nobody watches"""
SETTLE_S = 0.5
"""[s] of a dwell that are run before the rest is passed over"""
LONGEST_RUN_S = 6 * 3600.0
"""[s] of recorded motion; more would not fit the memory of a small machine"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tape:
    """What some chunks left: the columns of a recording, row by row."""

    time: Floats
    setpoint: Floats
    actual: Floats
    block: NDArray[np.int32]
    sync: NDArray[np.bool_]
    sync_error: Floats
    tool: NDArray[np.int16]
    rapid: NDArray[np.bool_]

    @staticmethod
    def of(chunk: Chunk, feedback: Feedback, tick_s: float) -> "Tape":
        """The rows of one chunk that the machine has really made."""
        n = feedback.ticks
        return Tape(
            time=np.arange(chunk.first_tick + 1, chunk.first_tick + n + 1, dtype=np.float64) * tick_s,
            setpoint=feedback.setpoint,
            actual=feedback.actual,
            block=chunk.block[:n],
            sync=chunk.sync[:n],
            sync_error=sync_error(chunk, feedback),
            tool=chunk.tool[:n],
            rapid=np.zeros(n, dtype=bool) if chunk.rapid is None else chunk.rapid[:n],
        )

    @staticmethod
    def joined(tapes: list["Tape"], axes: int) -> "Tape":
        """All rows, one after the other."""
        empty = np.zeros((0, axes))
        none = Tape(
            time=empty[:, 0],
            setpoint=empty,
            actual=empty,
            block=np.zeros(0, dtype=np.int32),
            sync=np.zeros(0, dtype=bool),
            sync_error=empty[:, 0],
            tool=np.zeros(0, dtype=np.int16),
            rapid=np.zeros(0, dtype=bool),
        )
        names = [f.name for f in fields(Tape)]
        return Tape(**{name: np.concatenate([getattr(t, name) for t in (none, *tapes)]) for name in names})


class Course:
    """How far a program has come, and what it has left on tape."""

    def __init__(
        self,
        begin: Callable[[], Controller],
        machine: Machine,
        *,
        progress: Callable[[float], None] = lambda _seconds: None,
    ) -> None:
        """`begin` gives a controller at the start of the program."""
        self._begin = begin
        self._machine = machine
        self._progress = progress
        self._controller: Controller | None = None
        self._answers: list[tuple[int, Feedback | None]] = []
        self._tapes: list[Tape] = []
        self._recorded = 0
        self.tick = 0
        """ticks so far"""
        self.skipped = 0
        """idle ticks that were passed over"""
        self.finished = False

    @property
    def controller(self) -> Controller:
        """The controller as it stands now."""
        if self._controller is None:
            self._controller = self._begin()
            for ticks, answer in self._answers:
                if answer is None:
                    self._controller.skip(ticks)
                else:
                    self._controller.propose(ticks)
                    self._controller.commit(answer)
        return self._controller

    def fork(self) -> "Course":
        """Another course that has come as far as this one, and goes on by itself."""
        other = Course(self._begin, copy.deepcopy(self._machine), progress=self._progress)
        other._answers, other._tapes = self._answers.copy(), self._tapes.copy()
        other._recorded = self._recorded
        other.tick, other.skipped, other.finished = self.tick, self.skipped, self.finished
        return other

    def go(self, *, until: int | None = None, load: Load | None = None) -> None:
        """Go on to the program's end or its first alarm, or up to tick `until`; idle time may lead further.

        Raises PartError for a run beyond LONGEST_RUN_S.
        """
        controller = self.controller
        settle = round(SETTLE_S / controller.tick_s)
        while not self.finished and (until is None or self.tick < until):
            idle = controller.idle_ticks()
            if idle > 4 * settle and self._tapes:
                self._skip(idle - 2 * settle)
            limit = min(CHUNK, settle) if idle > 4 * settle else CHUNK
            if until is not None:
                limit = min(limit, max(until - self.tick, 1))
            chunk = controller.propose(limit)
            if chunk.ticks == 0:
                self.finished = True
                return
            feedback = self._machine.advance(chunk, load)
            self._tapes.append(Tape.of(chunk, feedback, controller.tick_s))
            self._answers.append((limit, feedback))
            controller.commit(feedback)
            self.tick = controller.tick
            self._recorded += feedback.ticks
            if self._recorded * controller.tick_s > LONGEST_RUN_S:
                raise PartError(
                    f"the program moves for more than {LONGEST_RUN_S / 3600:g} hours",
                    remedy="check the feed; run a part of the program",
                )
            self._progress(chunk.first_tick * controller.tick_s)

    def tape(self, since: int = 0) -> Tape:
        """What was recorded, from tick `since` on."""
        controller = self.controller
        first = (since + 0.5) * controller.tick_s
        tapes = [tape for tape in self._tapes if len(tape.time) and tape.time[-1] > first]
        joined = Tape.joined(tapes, len(controller.axes))
        some = slice(int(np.searchsorted(joined.time, first)), None)
        return Tape(**{f.name: getattr(joined, f.name)[some] for f in fields(Tape)})

    def _skip(self, ticks: int) -> None:
        self.controller.skip(ticks)
        self._machine.rest(ticks)
        self._answers.append((ticks, None))
        self.skipped += ticks
        self.tick = self.controller.tick
