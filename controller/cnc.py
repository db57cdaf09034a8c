"""The controller as the machine sees it: propose setpoints, commit what the machine has made of them.

Time: tick k (from 0) ends at (k + 1) · tick_s, and row k of the setpoints is the position due then; at time
zero every axis stands at machine zero. Setpoints are values of closed forms at that time, so no chunking
changes a bit of them. Planning runs ahead of the machine only where no encoder is needed; what the operator
does meanwhile takes effect by planning anew from the start with the machine's answers as they were.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from controller.clock import Chunk, Feedback, Watch, WatchKind
from controller.events import Event, EventKind
from controller.execution import Execution, Report
from controller.language.block_numbers import BlockNumbers
from controller.language.offsets import Offsets
from controller.language.source import BlockRef, Program
from controller.motion.axes import Circumstances
from controller.motion.encoders import Encoders
from controller.motion.feeding import FEED_PERIOD
from controller.motion.follow_type import follow_in
from controller.motion.requests import Attendance, Reading, SkipWatch
from controller.motion.sampling import engaged, geared, marked, setpoints
from controller.operator.actions import OperatorEvent, check_events
from controller.span import Span
from controller.tables.alarms import ALARMS, Alarm, ControllerError
from controller.tables.parameters import Parameters

BATCH = 4096
"""[ticks] a good limit for `propose` where nobody watches"""
_FOR_EVER = 1 << 40
"""[ticks] longer than anything"""
_TIDY = 1024
"""steps of planning after which memory of the past is freed"""


class Controller:
    """The CNC with one program, on a clock that the machine shares."""

    def __init__(
        self,
        program: Program,
        *,
        parameters: Parameters,
        offsets: Offsets | None = None,
        tick_s: float = 0.001,
        signals: Mapping[str, bool] | None = None,
        events: Iterable[OperatorEvent] = (),
        attended: bool = False,
    ) -> None:
        """`tick_s` is the control period, a whole fraction of 1 s. `events`: what the operator will do; M00
        waits for cycle start where there are any. `attended`: a program that waits for the operator goes on
        waiting, for somebody may `post` something; else it is over, with a warning.

        Raises ControllerError for offsets, signals, events or a tick the controller cannot have, AlarmError
        HT9005 for parameters that contradict each other.
        """
        self._rate = round(1.0 / tick_s) if tick_s > 0.0 else 0
        if self._rate < 1 or abs(self._rate * tick_s - 1.0) > 1e-9:
            raise ControllerError(f"a tick of {tick_s} s", remedy="a whole fraction of a second, as 0.001")
        self._given = (program, parameters, offsets or Offsets(), dict(signals or {}))
        self._events = tuple(_at_once(event) for event in events)
        self._circumstances = Circumstances(
            rate=self._rate,
            closed_form=False,
            attended=attended,
            operator_from=0.0 if self._events else math.inf,
        )
        self._execution = Execution(*self._given, events=self._events, circumstances=self._circumstances)
        self._motion = self._execution.motion
        rows = max(1, round(FEED_PERIOD * self._rate)) + 1
        self._encoders = Encoders(len(self.axes), rows=rows, rate=self._rate)
        self._posted: list[OperatorEvent] = []
        self._tick = 0
        self._proposed = 0
        self._halted = False
        self._told = 0
        self._blocks = BlockNumbers()

    @property
    def axes(self) -> tuple[str, ...]:
        """Axis letters in system order: the columns of every setpoint."""
        return self._execution.machine.letters

    @property
    def blocks(self) -> tuple[BlockRef, ...]:
        """The blocks executed so far; `Chunk.block` counts them."""
        until = math.inf if self.finished else self._tick / self._rate
        return self._blocks.up_to(self._execution.log, until)

    @property
    def tick(self) -> int:
        """Ticks committed so far."""
        return self._tick

    @property
    def tick_s(self) -> float:
        """The control period [s]."""
        return 1.0 / self._rate

    @property
    def alarms(self) -> tuple[Alarm, ...]:
        """Alarms up to now, in the order of time."""
        return self._until_now(EventKind.ALARM)

    @property
    def warnings(self) -> tuple[Alarm, ...]:
        """Warnings up to now, in the order of time."""
        return self._until_now(EventKind.WARNING)

    @property
    def common_variables(self) -> dict[int, float | None]:
        """Common variables (#100 to #199, #500 to #999) that the program has set, None = null; as planned,
        which is what they are once it has finished."""
        return self._execution.common

    @property
    def finished(self) -> bool:
        """Whether nothing more will be proposed: the program has ended, by itself, by an alarm, or because it
        waits for an operator who is not there. What is posted then may let it go on."""
        return self._halted or (self._execution.done and self._tick >= self._horizon())

    def propose(self, limit: int = BATCH) -> Chunk:
        """Setpoints of the coming ticks, at most `limit` >= 1; none when the program has finished."""
        if limit < 1:
            raise ControllerError(f"a limit of {limit} ticks", remedy="at least 1")
        self._plan(limit)
        n = 0 if self._halted else min(limit, self._horizon() - self._tick)
        follow, n = follow_in(self._motion.timeline.epochs, self._tick, n, self._rate)
        watch, n = self._watch(n)
        self._proposed = n
        if n == 0:
            return Chunk(
                first_tick=self._tick,
                setpoint=np.zeros((0, len(self.axes))),
                block=np.zeros(0, dtype=np.int32),
                sync=np.zeros(0, dtype=bool),
                tool=np.zeros(0, dtype=np.int16),
            )
        time = np.arange(self._tick + 1, self._tick + n + 1) / self._rate
        timeline = self._motion.timeline
        gears = geared(timeline, time)
        return Chunk(
            first_tick=self._tick,
            setpoint=setpoints(timeline, time),
            block=self._blocks.numbers(self._execution.log, time),
            sync=engaged(gears, n),
            tool=marked(timeline.tools, time).astype(np.int16),
            rapid=marked(timeline.rapids, time).astype(bool),
            couplings=(follow,) if follow else (),
            gears=gears,
            watch=watch,
        )

    def commit(self, feedback: Feedback) -> tuple[Event, ...]:
        """Advance by exactly `feedback.ticks`; returns what has happened in them.

        Raises ControllerError for more ticks than were proposed.
        """
        if not 0 <= feedback.ticks <= self._proposed:
            raise ControllerError(
                f"feedback of {feedback.ticks} ticks", remedy=f"at most {self._proposed} as proposed"
            )
        self._proposed = 0
        self._tick += feedback.ticks
        self._encoders.take(self._tick, feedback.setpoint, feedback.readings)
        if feedback.latch is not None:
            self._encoders.touched(feedback.latch)
        self._act_on_posted()
        for one in feedback.alarms:
            number = one.number if one.number in ALARMS else "HT9013"
            letter = f"{self.axes[one.axis]}: " if one.axis is not None else ""
            prefix = "" if number == one.number else f"{one.number} "
            found = f"{prefix}{letter}{one.found}, at {self._tick / self._rate:.3f} s"
            self._execution.halt(Alarm(number=number, found=found, span=self._place()))
            self._halted = True
        self._forget()
        return self._tell()

    def post(self, event: OperatorEvent) -> None:
        """The operator does something: at a time, at a line from now on, or now, which is the next commit's
        tick, or the present one where the program has finished. Raises ControllerError for an event of what
        the machine does not have, or of the past."""
        check_events((event,), self.axes)
        if event.time_s is not None and event.time_s * self._rate < self._tick:
            now = self._tick / self._rate
            raise ControllerError(f"{event} at {event.time_s:g} s, now is {now:g} s", remedy="a time to come")
        self._posted.append(event)
        if self.finished:
            self._act_on_posted()

    def idle_ticks(self) -> int:
        """Ticks from now on in which no axis moves (a long dwell): `skip` may pass them unseen."""
        self._plan(1)
        if self._halted or self._motion.timeline.follows:
            return 0
        now = self._tick / self._rate
        still = min(self._motion.timeline.still_until(now), self._motion.time)
        return max(0, min(int(still * self._rate), self._horizon()) - self._tick)

    def skip(self, ticks: int) -> tuple[Event, ...]:
        """Pass `ticks` in which nothing moves, as if they had been proposed and committed."""
        if not 0 <= ticks <= (idle := self.idle_ticks()):
            raise ControllerError(f"skipping {ticks} ticks", remedy=f"at most the {idle} idle ones")
        self._tick += ticks
        self._encoders.rest(self._tick)
        self._proposed = 0
        self._act_on_posted()
        self._forget()
        return self._tell()

    # Planning

    def _plan(self, limit: int) -> None:
        """Plan at least `limit` ticks ahead, or up to where the machine has to answer."""
        execution, motion = self._execution, self._motion
        steps = 0
        while not execution.done:
            request, touch = execution.request, None
            if isinstance(request, SkipWatch):
                touch = self._encoders.touch(request.begin, motion.time)
            if touch is None and self._horizon() - self._tick >= limit:
                break
            if isinstance(request, Reading):
                tick = round(motion.time * self._rate)
                if tick > self._tick:
                    break
                execution.step(self._encoders.at(tick))
            elif isinstance(request, SkipWatch):
                if touch is None and self._horizon() > self._tick:
                    break
                execution.step(touch)
            else:
                execution.step()
            steps += 1
            if steps % _TIDY == 0:
                self._forget()

    def _act_on_posted(self) -> None:
        """Plan anew from the start, with what has been posted, up to now."""
        if not self._posted or self._halted:
            return
        now = self._tick / self._rate
        new = [
            replace(event, since_s=now)
            if event.line is not None
            else replace(event, time_s=now if event.time_s is None else max(event.time_s, now))
            for event in self._posted
        ]
        self._posted = []
        self._events = (*self._events, *new)
        present = min(self._circumstances.operator_from, now)
        self._circumstances = replace(self._circumstances, operator_from=present)
        self._execution = Execution(*self._given, events=self._events, circumstances=self._circumstances)
        self._motion = self._execution.motion
        self._plan(1)
        self._blocks.planned_anew(self._execution.log, now)
        self._told = min(self._told, sum(self._is_due(report) for report in self._execution.reports))

    def _place(self) -> Span | None:
        """The block of the last tick."""
        blocks = self.blocks
        if not blocks or not self._tick:
            return None
        (number,) = self._blocks.numbers(self._execution.log, np.array([self._tick / self._rate]))
        block = blocks[min(int(number), len(blocks) - 1)]
        return Span(file=block.file, line=block.line)

    def _forget(self) -> None:
        self._motion.timeline.forget(min(self._tick / self._rate, self._motion.time))

    def _horizon(self) -> int:
        """Ticks that are planned: all that end before the planner's time, and the last one as a whole."""
        if isinstance(self._execution.request, Attendance):
            return self._tick + _FOR_EVER
        time = self._motion.time
        ticks = int(time * self._rate)
        while (ticks + 1) / self._rate <= time:
            ticks += 1
        while ticks / self._rate > time:
            ticks -= 1
        whole = ticks / self._rate >= time
        return ticks if whole or not self._execution.done else ticks + 1

    # What goes into a chunk

    def _watch(self, ticks: int) -> tuple[Watch | None, int]:
        """The skip signal to be watched, and how many of `ticks` lie before it, or in it."""
        request = self._execution.request
        if not isinstance(request, SkipWatch):
            return None, ticks
        before = int(request.begin * self._rate + 1e-6) - self._tick
        if before > 0:
            return None, min(ticks, before)
        left = self._horizon() - self._tick
        axes = tuple(range(len(self.axes)))
        return Watch(kind=WatchKind.SKIP, latch_axes=axes, timeout_ticks=left) if left else None, ticks

    # Telling

    def _is_due(self, report: Report) -> bool:
        return self.finished or report.time * self._rate <= self._tick

    def _tell(self) -> tuple[Event, ...]:
        """Reports whose time has come."""
        reports = self._execution.reports
        first = self._told
        while self._told < len(reports) and self._is_due(reports[self._told]):
            self._told += 1
        return tuple(
            Event(tick=self._tick, kind=report.kind, alarm=report.alarm)
            for report in reports[first : self._told]
        )

    def _until_now(self, kind: EventKind) -> tuple[Alarm, ...]:
        return tuple(
            r.alarm for r in self._execution.reports if r.alarm and r.kind is kind and self._is_due(r)
        )


def _at_once(event: OperatorEvent) -> OperatorEvent:
    """An event without time or line is one of the very beginning."""
    return replace(event, time_s=0.0) if event.time_s is None and event.line is None else event
