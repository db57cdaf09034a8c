"""Fixtures of the language: programs as typed commands, on a machine that only counts positions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import SimpleNamespace

import pytest

from controller.commands import (
    Arc,
    Command,
    Dwell,
    MachineMove,
    Move,
    ReferenceReturn,
    SetCoordinates,
    ShiftCoordinates,
    Skip,
    SpindleSpeed,
    Thread,
)
from controller.language.interpreter import Interpreter
from controller.language.offsets import Offsets
from controller.language.source import Program, parse_program
from controller.tables.alarms import Alarm, AlarmError
from controller.tables.machine_data import machine_data
from controller.tables.parameters import delivered


class CountingMotion:
    """What the interpreter reads of a motion; every command is carried out at once, without any law."""

    def __init__(self, axes: int) -> None:
        self.time = 0.0
        self.slides = [0.0] * axes
        self.zero = [0.0] * axes
        self.turns: dict[int, float] = {}
        self.registers = SimpleNamespace(absolute=[0.0] * axes)
        self.references = SimpleNamespace(require=lambda *_: None, check_order=lambda *_, point=1: None)
        self.spindles = SimpleNamespace(free=set(), turning=lambda axis, _: bool(self.turns.get(axis)))
        self.timeline = SimpleNamespace(
            positions=lambda _: list(self.slides), speed=lambda axis, _: self.turns.get(axis, 0.0) * 6.0
        )
        self.skip_positions: tuple[float, ...] | None = None

    def carry_out(self, command: Command) -> None:
        match command:
            case Move() | Arc() | Thread():
                self._travel(command)
            case Skip():
                self._travel(command.move)
                self.skip_positions = tuple(a + b for a, b in zip(self.slides, self.zero, strict=True))
            case MachineMove():
                self.slides[:] = [command.target.get(k, slide) for k, slide in enumerate(self.slides)]
            case ReferenceReturn():
                self._return(command.axes)
            case SetCoordinates():
                for axis, value in command.absolute.items():
                    self.zero[axis] = value - self.slides[axis]
            case ShiftCoordinates():
                for axis, value in command.shift.items():
                    self.zero[axis] -= value
            case SpindleSpeed():
                self.turns[command.axis] = command.rpm
                self.spindles.free.add(command.axis)
            case Dwell():
                self.time += command.seconds
            case _:
                pass
        self.registers.absolute[:] = [a + b for a, b in zip(self.slides, self.zero, strict=True)]

    def _travel(self, command: Move | Arc | Thread) -> None:
        for axis, value in command.absolute.items():
            self.slides[axis] = value - self.zero[axis]
        for axis, value in command.incremental.items():
            self.slides[axis] += value
        self.time += 1.0

    def _return(self, axes: tuple[int, ...]) -> None:
        for axis in axes:
            self.slides[axis] = 0.0
            self.spindles.free.discard(axis)
            self.turns.pop(axis, None)


@dataclass
class Reading:
    """A program read to its end or its alarm."""

    steps: list[tuple[int, Command]] = field(default_factory=list)
    """line from 1, command"""
    warnings: list[Alarm] = field(default_factory=list)
    alarm: Alarm | None = None
    absolute: dict[str, float] = field(default_factory=dict)
    """programmed units"""
    machine: dict[str, float] = field(default_factory=dict)
    interpreter: Interpreter | None = None

    def of(self, kind: type) -> list:
        return [command for _, command in self.steps if isinstance(command, kind)]

    @property
    def stations(self) -> list[tuple[float, float]]:
        """X in diameter and Z behind every move, arc and thread that names both."""
        return [
            (command.absolute[0] * 2, command.absolute[1])
            for command in self.of((Move, Arc, Thread))
            if {0, 1} <= command.absolute.keys()
        ]


@pytest.fixture
def counting_motion() -> type[CountingMotion]:
    return CountingMotion


@pytest.fixture(scope="session")
def read() -> Callable[..., Reading]:
    def _read(
        text: str | Program,
        setup: str = "hobbing",
        *,
        parameters: Mapping[str, str | float] | None = None,
        offsets: Offsets | None = None,
        signals: Mapping[str, bool] | None = None,
    ) -> Reading:
        machine = machine_data(delivered(setup, parameters))
        motion = CountingMotion(len(machine.axes))
        program = parse_program(text) if isinstance(text, str) else text
        given = offsets or Offsets()
        interpreter = Interpreter(program, machine, given, signals or {})
        for shift in (given.of_work(540, machine), given.of_tool(None, machine)):
            motion.carry_out(ShiftCoordinates(shift=shift))
        reading = Reading(interpreter=interpreter)
        try:
            while step := interpreter.next(motion):
                reading.warnings.extend(step.warnings)
                for command in step.commands:
                    before = motion.time
                    motion.carry_out(command)
                    if motion.time > before:
                        interpreter.moved()
                    reading.steps.append((step.index + 1, command))
        except AlarmError as error:
            reading.alarm = error.alarm
        for k, axis in enumerate(machine.axes):
            reading.absolute[axis.letter] = motion.registers.absolute[k] * axis.factor
            reading.machine[axis.letter] = motion.slides[k] * axis.factor
        return reading

    return _read


@pytest.fixture(scope="session")
def value(read: Callable[..., Reading]) -> Callable[..., float | None]:
    """The number an expression has, read back through a user alarm-free way: Z of a move; None for null."""

    def _value(expression: str, before: str = "") -> float | None:
        reading = read(f"{before}\n#33={expression}\nG00 Z#33\nM30")
        if reading.alarm:
            raise AlarmError(reading.alarm)
        moves = reading.of(Move)
        return moves[-1].absolute[1] if moves else None

    return _value


@pytest.fixture(scope="session")
def alarm_in(read: Callable[..., Reading]) -> Callable[..., tuple[str, int | None, int | None] | None]:
    """Number, line and column of the alarm of a program; None where there is none."""

    def _alarm_in(*args: object, **options: object) -> tuple[str, int | None, int | None] | None:
        found = read(*args, **options).alarm
        return found and (found.number, found.span and found.span.line, found.span and found.span.column)

    return _alarm_in
