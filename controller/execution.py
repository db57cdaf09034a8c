"""Interpreter and motion in step: a block is read when the one before it has been planned."""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

from controller.alarms import Alarm, AlarmError, Severity
from controller.commands import Command, Coolant
from controller.coupling import Sensor
from controller.events import EventKind, check_signals
from controller.interpreter import Interpreter
from controller.machine_data import machine_data
from controller.motion import Motion
from controller.offsets import Offsets
from controller.parameters import Parameters
from controller.source import BlockRef, Program
from controller.span import Span

_FIRST_WORK_OFFSET = 540


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """Something to tell, and the time it belongs to."""

    time: float
    """[s]"""
    kind: EventKind
    alarm: Alarm | None = None


class Execution:
    """A program on its way to motion. `step` until `done`; when `motion.waits_for` is set, `resume`."""

    def __init__(
        self,
        program: Program,
        parameters: Parameters,
        offsets: Offsets,
        signals: Mapping[str, bool],
        *,
        tick_s: float,
        closed_form: bool,
    ) -> None:
        check_signals(signals)
        self.program = program
        self.machine = machine_data(parameters)
        offsets.check(self.machine)
        self.blocks: list[BlockRef] = []
        self.reports: list[Report] = []
        self.motion = Motion(
            self.machine,
            tick_s=tick_s,
            compensated=not signals.get("NOZAGC", False),
            warn=self._warn,
            closed_form=closed_form,
        )
        for column, amount in offsets.of_work(_FIRST_WORK_OFFSET, self.machine).items():
            self.motion.registers.shift(column, -amount)
        for column, amount in offsets.of_tool(None, self.machine).items():
            self.motion.registers.shift(column, -amount)
        self.motion.program_extents.start(self.motion.registers.absolute)
        self._interpreter = Interpreter(program, self.machine, offsets, signals)
        self._queue: deque[Command] = deque()
        self._span: Span = program.span(0)
        self._lines: dict[int, int] = {}
        self._ended = False
        if self.machine.pair_angle_off is not None:
            found = f"8210 = {self.machine.pair_angle_off:g} deg with 8200#0 = 1"
            self._warn(Alarm(number="HT9111", found=found))
        if program.after_tape:
            found = "text behind the closing %"
            self._warn(Alarm(number="HT9110", found=found, span=program.span(program.after_tape - 1)))

    @property
    def done(self) -> bool:
        """Whether all motion is planned."""
        return self._ended and self.motion.waits_for is None and not self._queue

    def step(self) -> None:
        """Read the next block, or plan the next command of the last one."""
        try:
            if self._queue:
                self._execute(self._queue.popleft())
                return
            step = self._interpreter.next(self.motion)
        except AlarmError as error:
            self._stop(error.alarm)
            return
        if step is None:
            self._ended = True
            return
        for warning in step.warnings:
            self._warn(warning)
        self._span = step.span
        self.motion.timeline.blocks.add(self.motion.time, self._block(step.index))
        self._queue.extend(step.commands)

    def resume(self, sensor: Sensor) -> None:
        """Go on with the encoders at `motion.waits_for`."""
        try:
            self.motion.resume(sensor)
        except AlarmError as error:
            self._stop(error.alarm)

    def halt(self, alarm: Alarm) -> None:
        """The machine has stopped: nothing more is planned."""
        self.reports.append(Report(time=self.motion.time, kind=EventKind.ALARM, alarm=alarm))
        self._queue.clear()
        self._ended = True
        self.motion.waits_for = None

    def _execute(self, command: Command) -> None:
        before = self.motion.time
        self.motion.execute(command, self._span)
        if isinstance(command, Coolant):
            kind = EventKind.COOLANT_ON if command.on else EventKind.COOLANT_OFF
            self.reports.append(Report(time=before, kind=kind))
        if self.motion.time > before or self.motion.waits_for is not None:
            self._interpreter.moved()

    def _stop(self, alarm: Alarm) -> None:
        """An alarm ends the program where it stands; what its class demands happens to the gear box."""
        self.reports.append(Report(time=self.motion.time, kind=EventKind.ALARM, alarm=alarm))
        self._queue.clear()
        self._ended = True
        self.motion.cancel_sync(alarm.kind)

    def _warn(self, alarm: Alarm) -> None:
        kind = EventKind.WARNING if alarm.severity is Severity.WARNING else EventKind.ALARM
        self.reports.append(Report(time=self.motion.time, kind=kind, alarm=alarm))

    def _block(self, index: int) -> int:
        """The number of a line in `blocks`, which grows with the lines that are executed."""
        if index not in self._lines:
            self._lines[index] = len(self.blocks)
            self.blocks.append(self.program.ref(index))
        return self._lines[index]
