"""The controller as the machine sees it: propose setpoints, commit what the machine has made of them.

Time: tick k (from 0) ends at (k + 1) · tick_s, and row k of the setpoints is the position due then; at time
zero every axis stands at machine zero. Setpoints are values of closed forms at that time, so no chunking
changes a bit of them. Planning runs ahead of the machine only where no encoder is needed.
"""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from controller.alarms import ALARMS, Alarm, ControllerError, alarm
from controller.clock import Chunk, Feedback, Follow
from controller.events import Event, EventKind, OperatorEvent
from controller.execution import Execution, Report
from controller.feeding import FEED_PERIOD
from controller.offsets import Offsets
from controller.parameters import Parameters
from controller.source import BlockRef, Program

Floats = NDArray[np.float64]
BATCH = 4096
"""[ticks] a good limit for `propose` where nobody watches"""


@dataclass(frozen=True, slots=True)
class _Encoders:
    """The last rows of feedback, old to new."""

    actual: deque[Floats]
    setpoint: deque[Floats]
    tick_s: float

    def position(self, axis: int) -> float:
        return float(self.actual[-1][axis])

    def command(self, axis: int) -> float:
        return float(self.setpoint[-1][axis])

    def command_speed(self, axis: int) -> float:
        return float(self.setpoint[-1][axis] - self.setpoint[0][axis]) / self.tick_s

    def speed(self, axis: int) -> float:
        span = (len(self.actual) - 1) * self.tick_s
        return float(self.actual[-1][axis] - self.actual[0][axis]) / span


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
    ) -> None:
        """Raises ControllerError for offsets, signals or a tick the controller cannot have, AlarmError HT9005
        for parameters that contradict each other. `tick_s` is the control period, a whole fraction of 1 s."""
        self._rate = round(1.0 / tick_s) if tick_s > 0.0 else 0
        if self._rate < 1 or abs(self._rate * tick_s - 1.0) > 1e-9:
            raise ControllerError(f"a tick of {tick_s} s", remedy="a whole fraction of a second, as 0.001")
        self._execution = Execution(
            program,
            parameters,
            offsets or Offsets(),
            signals or {},
            tick_s=1.0 / self._rate,
            closed_form=False,
        )
        self._motion = self._execution.motion
        self._tick = 0
        self._proposed = 0
        self._halted = False
        rows = max(1, round(FEED_PERIOD * self._rate)) + 1
        self._actual = deque([np.zeros(len(self.axes))] * rows, maxlen=rows)
        self._setpoint = deque([np.zeros(len(self.axes))] * 2, maxlen=2)
        self._told = 0

    @property
    def axes(self) -> tuple[str, ...]:
        """Axis letters in system order: the columns of every setpoint."""
        return self._execution.machine.letters

    @property
    def blocks(self) -> tuple[BlockRef, ...]:
        """The blocks executed so far; `Chunk.block` counts them."""
        return tuple(self._execution.blocks)

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
    def finished(self) -> bool:
        """Whether nothing more will be proposed: the program has ended, by itself or by an alarm."""
        return self._halted or (self._execution.done and self._tick >= self._horizon())

    def propose(self, limit: int = BATCH) -> Chunk:
        """Setpoints of the coming ticks, at most `limit` >= 1; none when the program has finished."""
        if limit < 1:
            raise ControllerError(f"a limit of {limit} ticks", remedy="at least 1")
        self._plan(limit)
        n = 0 if self._halted else min(limit, self._horizon() - self._tick)
        follow, n = self._follow(n)
        self._proposed = n
        time = np.arange(self._tick + 1, self._tick + n + 1) / self._rate
        timeline = self._motion.timeline
        if n == 0:
            return Chunk(
                first_tick=self._tick,
                setpoint=np.zeros((0, len(self.axes))),
                block=np.zeros(0, dtype=np.int32),
                sync=np.zeros(0, dtype=bool),
                tool=np.zeros(0, dtype=np.int16),
            )
        return Chunk(
            first_tick=self._tick,
            setpoint=timeline.sample(time),
            block=timeline.blocks.sample(time).astype(np.int32),
            sync=timeline.in_sync(time),
            tool=timeline.tools.sample(time).astype(np.int16),
            couplings=(follow,) if follow else (),
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
        self._actual.extend(np.array(feedback.actual[-len(self._actual) :]))
        self._setpoint.extend(np.array(feedback.setpoint[-2:]))
        self._tick += feedback.ticks
        for one in feedback.alarms:
            number = one.number if one.number in ALARMS else "HT9013"
            letter = f"{self.axes[one.axis]}: " if one.axis is not None else ""
            prefix = "" if number == one.number else f"{one.number} "
            self._execution.halt(Alarm(number=number, found=f"{prefix}{letter}{one.found}"))
            self._halted = True
        self._motion.timeline.forget(self._tick / self._rate)
        return self._tell()

    def post(self, event: OperatorEvent) -> None:
        """An action of the operator. Raises AlarmError HT9002: none is supported yet."""
        raise alarm(
            "HT9002", f"the operator's {event.action.value}", valid="a program without operator events"
        )

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
        for rows in (self._actual, self._setpoint):
            rows.extend([rows[-1]] * min(ticks, len(rows)))
        self._tick += ticks
        self._proposed = 0
        self._motion.timeline.forget(self._tick / self._rate)
        return self._tell()

    def _plan(self, limit: int) -> None:
        """Plan at least `limit` ticks ahead, or up to where the encoders are needed."""
        execution, motion = self._execution, self._motion
        while not execution.done and self._horizon() - self._tick < limit:
            if motion.waits_for is None:
                execution.step()
            elif self._horizon() > self._tick:
                break
            else:
                execution.resume(_Encoders(self._actual, self._setpoint, 1.0 / self._rate))

    def _horizon(self) -> int:
        """Ticks that are planned: all that end before the planner's time, and the last one as a whole."""
        ticks = int(self._motion.time * self._rate)
        while (ticks + 1) / self._rate <= self._motion.time:
            ticks += 1
        while ticks / self._rate > self._motion.time:
            ticks -= 1
        whole = ticks / self._rate >= self._motion.time
        return ticks if whole or not self._execution.done else ticks + 1

    def _follow(self, ticks: int) -> tuple[Follow | None, int]:
        """The follow-type coupling in force, and how many of `ticks` it holds for."""
        first = (self._tick + 1) / self._rate
        for epoch in self._motion.timeline.epochs:
            if not epoch.gear.follow or first >= epoch.end:
                continue
            if first < epoch.start:
                return None, min(ticks, int(np.ceil(epoch.start * self._rate - 1e-6)) - 1 - self._tick)
            if np.isfinite(epoch.end):
                ticks = min(ticks, int(np.ceil(epoch.end * self._rate - 1e-6)) - 1 - self._tick)
            gear = epoch.gear
            offset = -gear.numerator / gear.denominator * epoch.master_start
            return (
                Follow(
                    slave=gear.slave,
                    master=gear.master,
                    numerator=gear.numerator,
                    denominator=gear.denominator,
                    offset=offset,
                ),
                ticks,
            )
        return None, ticks

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
