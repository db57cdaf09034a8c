"""Interpreter and motion in step: a block is read when the one before it has been planned.

The whole of planning is one generator: it yields None between blocks, a request where the machine or the
operator has to be asked, and returns when nothing more will happen.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

from controller.commands import Command, Coolant
from controller.events import EventKind
from controller.interrupts import EmergencyStop, Interrupt, LeftStanding, Reset
from controller.language.block_log import BlockLog
from controller.language.interpreter import Interpreter
from controller.language.offsets import Offsets
from controller.language.source import Program, is_block
from controller.motion.axes import Circumstances
from controller.motion.motion import Motion
from controller.motion.requests import Answer, Request, Steps
from controller.motion.spindles import DEG_PER_S
from controller.observed import Observed
from controller.operator.actions import OperatorEvent, check_events
from controller.operator.agenda import Agenda
from controller.operator.panel import Panel
from controller.span import Span
from controller.tables.alarms import Alarm, AlarmError, Severity
from controller.tables.machine_data import machine_data
from controller.tables.parameters import Parameters
from controller.tables.signals import Inputs, misprinted

_FIRST_WORK_OFFSET = 540


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """Something to tell, and the time it belongs to."""

    time: float
    """[s]"""
    kind: EventKind
    alarm: Alarm | None = None


class Execution:
    """A program on its way to motion. `step` until `done`, answering each `request`."""

    def __init__(
        self,
        program: Program,
        parameters: Parameters,
        offsets: Offsets,
        signals: Mapping[str, bool],
        *,
        events: Iterable[OperatorEvent] = (),
        circumstances: Circumstances,
        observe: Callable[[Observed], None] | None = None,
    ) -> None:
        """Raises ControllerError for offsets, signals or events of what the machine does not have, AlarmError
        HT9005 for parameters that contradict each other."""
        self.program = program
        self.machine = machine_data(parameters)
        events = tuple(events)
        panel = Panel.of(Inputs.of(signals, self.machine.letters))
        check_events(events, self.machine.letters)
        offsets.check(self.machine)
        self.log = BlockLog(program)
        self.reports: list[Report] = []
        self.done = False
        self.request: Request | None = None
        """what has to be answered at the next step"""
        self._agenda = Agenda(events, circumstances.rate)
        self.motion = Motion(
            self.machine, warn=self._warn, panel=panel, agenda=self._agenda, circumstances=circumstances
        )
        self.motion.run_mdi = self._key_in
        self.motion.take_signals()
        for column, amount in offsets.of_work(_FIRST_WORK_OFFSET, self.machine).items():
            self.motion.registers.shift(column, -amount)
        for column, amount in offsets.of_tool(None, self.machine).items():
            self.motion.registers.shift(column, -amount)
        self.motion.program_extents.start(self.motion.registers.absolute)
        self._offsets = offsets
        self._interpreter = Interpreter(program, self.machine, offsets, panel.levels)
        self._observe = observe
        self._steps = self._life()
        self._warn_at_start(misprinted(signals))

    def step(self, answer: Answer = None) -> None:
        """Plan the next block, or up to where something has to be asked. `answer`: to `request`."""
        try:
            self.request = self._steps.send(answer)
        except StopIteration:
            self.done, self.request = True, None

    @property
    def common(self) -> dict[int, float | None]:
        """The common variables that the program has set, as planned so far."""
        return self._interpreter.common

    def halt(self, alarm: Alarm) -> None:
        """The machine has stopped: nothing more is planned."""
        self._report(EventKind.ALARM, alarm)
        self.done, self.request = True, None

    # The program

    def _life(self) -> Steps[None]:
        """From power-on until nothing more will happen."""
        phase: Phase | None = self._program
        while phase:
            try:
                phase = yield from phase()
            except AlarmError as error:
                yield from self._alarm(error.alarm)
                self._warn_of_the_rest()
                return
            except LeftStanding as left:
                self._warn(Alarm(number="HT9130", found=str(left), span=self.motion.span))
                self._warn_of_the_rest()
                return
            except Reset:
                phase = self._after_reset
            except EmergencyStop:
                phase = self._after_emergency_stop

    def _program(self) -> Steps["Phase | None"]:
        """Block by block, from where the program stands."""
        motion, interpreter, agenda = self.motion, self._interpreter, self._agenda
        while True:
            motion.between_blocks = True
            if agenda.lines:
                yield from self._act_at(self._line_ahead())
            if motion.attention:
                yield from motion.attend()
            step = interpreter.next(motion)
            if step is None:
                return self._idle
            for warning in step.warnings:
                self._warn(warning)
            self.log.begin(motion.time, step.index)
            if agenda.lines:
                yield from self._act_at(step.index)
            yield from self._carry_out(step.commands, step.span)
            if motion.panel.single_block:
                motion.panel.running = False
            yield None

    def _carry_out(self, commands: Iterable[Command], span: Span) -> Steps[None]:
        """The commands of one block."""
        motion = self.motion
        motion.between_blocks = False
        for command in commands:
            if motion.attention:
                yield from motion.attend()
            before = motion.time
            begun = self._begun(command, span) if self._observe else None
            steps = motion.execute(command, span)
            if steps is not None:
                yield from steps
            if begun:
                self._tell(begun)
            if isinstance(command, Coolant):
                self._report(EventKind.COOLANT_ON if command.on else EventKind.COOLANT_OFF)
            if motion.time > before:
                self._interpreter.moved()

    def _key_in(self, text: str) -> Steps[None]:
        """One block from the keyboard (MDI); the program stands again behind it."""
        motion = self.motion
        step = self._interpreter.mdi(text, motion)
        for warning in step.warnings:
            self._warn(warning)
        self.log.begin_mdi(motion.time, text)
        motion.panel.running = True
        yield from self._carry_out(step.commands, step.span)
        motion.panel.running, motion.between_blocks = False, True

    # The operator

    def _line_ahead(self) -> int | None:
        """Index of the line whose block comes next, as far as it can be known before it is read."""
        index, lines = self._interpreter.cursor, self.program.lines
        while index is not None and index < len(lines) and not is_block(lines[index]):
            index += 1
        return index

    def _act_at(self, index: int | None) -> Steps[None]:
        """The events of a line whose block begins."""
        if index is not None:
            events = self._agenda.at_line(index + 1, self.motion.time)
            if events:
                self.motion.enter(replace(self.program.span(index), column=1))
            for event in events:
                yield from self.motion.act(event)
            if self.motion.attention:
                yield from self.motion.attend()

    def _idle(self) -> Steps["Phase | None"]:
        """The program is over: the operator may move axes by hand, or start it anew from its beginning."""
        if (yield from self.motion.idle()):
            self._interpreter.rewind()
            return self._program
        if overdue := self.motion.references.overdue(self.motion.span):
            self._warn(overdue)
        self._warn_of_the_rest()
        return None

    def _warn_of_the_rest(self) -> None:
        """Events that nothing more will let act: an operator's action is never ignored silently."""
        for event in self._agenda.left:
            when = f"line {event.line}" if event.line else f"{event.time_s:g} s"
            self._warn(Alarm(number="HT9137", found=f"{event} at {when}"))

    def _after_reset(self) -> Steps["Phase | None"]:
        self._warn(Alarm(number="HT9134", found="RESET", span=self.motion.span))
        yield from self.motion.reset()
        self._interpreter.stopped(in_sync=self.motion.coupling.gear is not None)
        return self._idle

    def _after_emergency_stop(self) -> Steps["Phase | None"]:
        self._warn(Alarm(number="HT9135", found="the emergency stop", span=self.motion.span))
        self._interpreter.stopped(in_sync=False)
        return self._idle
        yield

    def _alarm(self, alarm: Alarm) -> Steps[None]:
        """An alarm ends the program where it stands; what its class demands happens to the gear box."""
        self._report(EventKind.ALARM, alarm)
        try:
            yield from self.motion.cancel_sync(alarm.kind)
        except (AlarmError, Interrupt):
            return

    # Telling

    def _begun(self, command: Command, span: Span) -> Observed:
        motion = self.motion
        absolute = tuple(motion.registers.absolute)
        slides = tuple(motion.timeline.positions(motion.time))
        gear, rpm = motion.coupling.gear, 0.0
        if gear:
            ready = motion.spindles.ready(gear.master, motion.time)
            rpm = motion.timeline.speed(gear.master, ready) / DEG_PER_S
        return Observed(
            command=command,
            span=span,
            start_s=motion.time,
            end_s=motion.time,
            absolute_before=absolute,
            absolute_after=absolute,
            slides_before=slides,
            slides_after=slides,
            gear=gear,
            master_rpm=rpm,
        )

    def _tell(self, begun: Observed) -> None:
        motion = self.motion
        if self._observe:
            self._observe(
                replace(
                    begun,
                    end_s=motion.time,
                    absolute_after=tuple(motion.registers.absolute),
                    slides_after=tuple(motion.timeline.positions(motion.time)),
                )
            )

    def _report(self, kind: EventKind, alarm: Alarm | None = None) -> None:
        self.reports.append(Report(time=self.motion.time, kind=kind, alarm=alarm))

    def _warn(self, alarm: Alarm) -> None:
        self._report(EventKind.WARNING if alarm.severity is Severity.WARNING else EventKind.ALARM, alarm)

    def _warn_at_start(self, notes: Iterable[Alarm]) -> None:
        for note in notes:
            self._warn(note)
        if self.machine.pair_angle_off is not None:
            found = f"8210 = {self.machine.pair_angle_off:g} deg with 8200#0 = 1"
            self._warn(Alarm(number="HT9111", found=found))
        if self.program.after_tape:
            found = "text behind the closing %"
            self._warn(
                Alarm(number="HT9110", found=found, span=self.program.span(self.program.after_tape - 1))
            )


Phase = Callable[[], Steps["Phase | None"]]
"""A part of the controller's life, which says what comes next"""
