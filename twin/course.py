"""A program under way on a machine, chunk after chunk.

What the controller proposes can be tried on a copy of the machine first, as often as one likes: a proposal
changes nothing, and a machine in the same state does the same again.
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """A chunk gone through on a copy of the machine."""

    feedback: Feedback
    machine: Machine
    """as it stands after it"""


class Course:
    """How far a program has come, and what it has left on tape."""

    def __init__(
        self,
        controller: Controller,
        machine: Machine,
        *,
        progress: Callable[[float], None] = lambda _seconds: None,
    ) -> None:
        """Of a controller at the start of its program."""
        self.controller = controller
        self._machine = machine
        self._progress = progress
        self._tapes: list[Tape] = []
        self._recorded = 0
        self.skipped = 0
        """idle ticks that were passed over"""

    @property
    def tick(self) -> int:
        """Ticks so far."""
        return self.controller.tick

    def go(self, *, load: Load | None = None) -> None:
        """Go on to the program's end or its first alarm. Raises PartError for a run beyond LONGEST_RUN_S."""
        while (chunk := self.ahead(CHUNK)) is not None:
            self.take(chunk, load)

    def ahead(self, limit: int) -> Chunk | None:
        """What comes next, at most `limit` ticks; None at the end. Long idle time is passed over first."""
        controller = self.controller
        settle = round(SETTLE_S / controller.tick_s)
        idle = controller.idle_ticks()
        if idle > 4 * settle:
            if self._tapes:
                controller.skip(idle - 2 * settle)
                self._machine.rest(idle - 2 * settle)
                self.skipped += idle - 2 * settle
            limit = min(limit, settle)
        chunk = controller.propose(limit)
        return chunk if chunk.ticks else None

    def trial(self, chunk: Chunk, load: Load | None = None) -> Trial:
        """What the machine would make of a chunk; it stays where it is."""
        machine = copy.deepcopy(self._machine)
        return Trial(feedback=machine.advance(chunk, load), machine=machine)

    def take(self, chunk: Chunk, load: Load | None = None, *, tried: Trial | None = None) -> Feedback:
        """Go through a chunk, as it was `tried` last if it was. Raises PartError for a run beyond
        LONGEST_RUN_S."""
        controller = self.controller
        if tried is not None:
            self._machine = tried.machine
        feedback = self._machine.advance(chunk, load) if tried is None else tried.feedback
        self._tapes.append(Tape.of(chunk, feedback, controller.tick_s))
        controller.commit(feedback)
        self._recorded += feedback.ticks
        if self._recorded * controller.tick_s > LONGEST_RUN_S:
            raise PartError(
                f"the program moves for more than {LONGEST_RUN_S / 3600:g} hours",
                remedy="check the feed; run a part of the program",
            )
        self._progress(chunk.first_tick * controller.tick_s)
        return feedback

    def tape(self, since: int = 0) -> Tape:
        """What was recorded, from tick `since` on."""
        controller = self.controller
        first = (since + 0.5) * controller.tick_s
        recent: list[Tape] = []
        for tape in reversed(self._tapes):
            if len(tape.time) and tape.time[-1] <= first:
                break
            recent.append(tape)
        joined = Tape.joined(recent[::-1], len(controller.axes))
        some = slice(int(np.searchsorted(joined.time, first)), None)
        return Tape(**{f.name: getattr(joined, f.name)[some] for f in fields(Tape)})
