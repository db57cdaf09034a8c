"""The axes in time: one function lets time pass up to where the operator acts, one lets the axes stand."""

import math
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from controller.interrupts import LeftStanding, Reset
from controller.motion.coupling import Coupling
from controller.motion.limits import StrokeLimits
from controller.motion.path import AnyPath
from controller.motion.peaks import Extents, Peaks
from controller.motion.reference import References
from controller.motion.registers import Registers
from controller.motion.requests import Attendance, Reading, Sensor, Steps, Touch
from controller.motion.spindles import Spindles
from controller.motion.timeline import Timeline
from controller.operator.actions import OperatorEvent
from controller.operator.agenda import Agenda
from controller.operator.panel import Panel
from controller.span import Span
from controller.tables.alarms import Alarm
from controller.tables.machine_data import MachineData
from controller.tables.signals import Inputs


@dataclass(frozen=True, slots=True, kw_only=True)
class Circumstances:
    """Under what a program runs, beside program and parameters."""

    rate: int = 1000
    """control ticks per second"""
    closed_form: bool = True
    """nothing is sampled: the machine is ideal, constant measured speed is the commanded one"""
    attended: bool = False
    """somebody may act at any time: a program that waits for it goes on waiting"""
    operator_from: float = math.inf
    """[s] from when on somebody stands at the panel: M00 waits for cycle start"""


class Axes(ABC):
    """State of the machine as planned so far, and the passing of time."""

    def __init__(
        self,
        machine: MachineData,
        *,
        warn: Callable[[Alarm], None],
        panel: Panel | None = None,
        agenda: Agenda | None = None,
        circumstances: Circumstances | None = None,
    ) -> None:
        """By default nobody stands at the panel, and nothing is sampled."""
        axes = len(machine.axes)
        self.machine = machine
        self.panel = panel or Panel.of(Inputs.of({}, machine.letters))
        self.circumstances = circumstances or Circumstances()
        self.agenda = agenda or Agenda((), self.circumstances.rate)
        self.time = 0.0
        self.timeline = Timeline(axes)
        self.registers = Registers.at_power_on(axes)
        self.references = References.at_power_on(axes, machine.pair)
        self.limits = StrokeLimits.of(machine)
        self.peaks = Peaks(axes)
        self.spindles = Spindles(machine, self.timeline, self.peaks)
        self.coupling = Coupling(machine, self.timeline, self.registers, self.spindles, self.peaks)
        self.slide_extents = Extents([0.0] * axes)
        self.program_extents = Extents([0.0] * axes)
        self.between_blocks = True
        """no block is on its way: MDI may put one in"""
        self._warn = warn
        self._span: Span | None = None
        self._underway: AnyPath | None = None
        self._version = 0
        """counts what makes a path on its way obsolete: manual motion, machine lock, NOZAGC"""
        self._by_hand: deque[OperatorEvent] = deque()
        """manual actions that wait for the axes to stand"""
        self._reset = False
        """RESET has been pressed, and the motion brakes"""

    def note_extents(self) -> None:
        """Count the present position in the extents."""
        self.slide_extents.include(self.timeline.positions(self.time))
        self.program_extents.include(self.registers.absolute)

    @property
    def span(self) -> Span | None:
        """The block that is being carried out."""
        return self._span

    def enter(self, span: Span) -> None:
        """The block at `span` is the present one from now on."""
        self._span = span

    @property
    def _line(self) -> int | None:
        """Of the present block."""
        return self._span.line if self._span else None

    @property
    def attention(self) -> bool:
        """Whether the operator has to be heard before anything else moves."""
        return not self.panel.running or self.agenda.next_time <= self.time

    def attend(self) -> Steps[None]:
        """Let the operator act where it is time; stand while the program is held."""
        yield from self._operate_at_rest()
        if not self.panel.running:
            yield from self._stand("a single block" if self.panel.single_block else "a hold")

    def act(self, event: OperatorEvent) -> Steps[None]:
        """Let an event of a line act, between two blocks."""
        yield from self._act(event)

    def idle(self) -> Steps[bool]:
        """No program runs: True once cycle start begins one, False where nothing will move any more."""
        self.panel.running, self.between_blocks = False, True
        while not self.panel.running:
            if self._by_hand:
                yield from self._manual(self._by_hand.popleft())
            elif self.agenda.moves_again:
                yield from self._await_operator("the end of the program")
            else:
                return False
        return True

    @abstractmethod
    def _act(self, event: OperatorEvent) -> Steps[None]:
        """Let one event act at the present time."""

    @abstractmethod
    def _manual(self, event: OperatorEvent) -> Steps[None]:
        """A motion by hand, or a block of MDI, now that the axes stand."""

    def _operate(self) -> Steps[None]:
        """Let every event act whose time has come."""
        while self.agenda.next_time <= self.time:
            yield from self._act(self.agenda.pop())

    def _operate_at_rest(self) -> Steps[None]:
        """The same while no path is under way: RESET need not wait for anything to brake."""
        yield from self._operate()
        if self._reset:
            raise Reset

    def _await_operator(self, what: str) -> Steps[None]:
        """Stand until the next event. Raises LeftStanding where none is to come."""
        if self.agenda.next_time == math.inf:
            if not self.circumstances.attended:
                raise LeftStanding(what)
            while True:
                yield Attendance()
        self.time = max(self.time, self.agenda.next_time)
        yield from self._operate_at_rest()

    def _stand(self, what: str) -> Steps[None]:
        """Stand until the program runs again."""
        self.note_extents()
        while not self.panel.running or self._by_hand:
            if self._by_hand:
                yield from self._manual(self._by_hand.popleft())
            else:
                yield from self._await_operator(what)

    def _wait(self, until: float) -> Steps[None]:
        """Let time pass up to `until`; nothing moves along a path."""
        while self.agenda.next_time < until:
            self.time = max(self.time, self.agenda.next_time)
            yield from self._operate_at_rest()
        self.time = max(self.time, until)

    def _dwell(self, seconds: float) -> Steps[None]:
        """G04: the clock stops in a hold."""
        left = seconds
        while left > 0.0:
            if self.attention:
                yield from self._operate_at_rest()
                if not self.panel.running:
                    yield from self._stand("a hold in a dwell")
            until = min(self.time + left, max(self.agenda.next_time, self.time))
            left = 0.0 if until == self.time + left else left - (until - self.time)
            self.time = until

    def _ready(self, axis: int) -> Steps[None]:
        """Wait until a spindle has its commanded speed, whatever the override makes of it on the way."""
        while (ready := self.spindles.ready(axis, self.time)) > self.time:
            yield from self._wait(min(ready, max(self.agenda.next_time, self.time)))
            if self.agenda.next_time <= self.time:
                yield from self._operate_at_rest()

    def _to_tick(self) -> Steps[None]:
        """Wait for the next tick, where the encoders are read."""
        rate = self.circumstances.rate
        yield from self._wait(math.ceil(round(self.time * rate, 6)) / rate)

    def _encoders(self) -> Steps[Sensor]:
        """The encoders at the next tick."""
        yield from self._to_tick()
        sensor = yield Reading()
        if sensor is None or isinstance(sensor, Touch):
            raise TypeError("a reading is answered by a sensor")
        return sensor
