"""The canonical trace of a program: one line per typed command, stable enough to be kept beside the program.

    line  COMMAND  values

Values stand in programmed units: lengths in mm (a diameter axis in diameter), angles in degrees, feeds in
mm/min or mm per revolution, speeds in rpm. A line says what is commanded, not what has become of it: no
times, no positions that depend on when a spindle stops, fixed decimals, no minus zero.
"""

from collections.abc import Mapping
from functools import singledispatch

from controller.commands import (
    Arc,
    ClearTable,
    Command,
    Coolant,
    Couple,
    Dwell,
    Feed,
    MachineMove,
    Move,
    ProgramEnd,
    ProgramStop,
    ReferenceCheck,
    ReferenceReturn,
    SelectTool,
    SetCoordinates,
    SetTablePoint,
    ShiftCoordinates,
    Skip,
    SpindleSpeed,
    StrokeCheck,
    SurfaceSpeed,
    SwitchTable,
    Thread,
    Uncouple,
)
from controller.span import Span
from controller.tables.alarms import Alarm
from controller.tables.machine_data import INCREMENT_LETTER, MachineData

_CENTRE_LETTERS = {1: "I", 2: "J", 3: "K"}
"""of the centre of an arc, by parameter 1022 of the axis"""


def number(value: float, digits: int = 3) -> str:
    """Fixed decimals, without minus zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def trace_line(command: Command, span: Span, machine: MachineData, main: str) -> str:
    """One line of the trace; `main` is the file whose name goes without saying."""
    word, values = _said(command, machine)
    return _line(span, main, word, values)


def trace_alarm(alarm: Alarm, main: str) -> str:
    """The last line of a program that ends in an alarm."""
    return _line(alarm.span or Span(file=main), main, "ALARM", [alarm.number])


def _line(span: Span, main: str, word: str, values: list[str]) -> str:
    place = "" if span.line is None else str(span.line)
    if span.file != main:
        place = f"{span.file.rsplit('/', 1)[-1]}:{place}"
    return f"{place:>6}  {word:<16}{' '.join(values)}".rstrip()


@singledispatch
def _said(command: Command, _machine: MachineData) -> tuple[str, list[str]]:
    """The command word and its values."""
    raise TypeError(f"no trace of {type(command).__name__}")


@_said.register
def _(command: Move, machine: MachineData) -> tuple[str, list[str]]:
    values = _targets(command.absolute, command.incremental, machine)
    return ("FEED", [*values, _feed(command.feed)]) if command.feed else ("RAPID", values)


@_said.register
def _(command: Arc, machine: MachineData) -> tuple[str, list[str]]:
    values = _targets(command.absolute, command.incremental, machine)
    word = "ARC_CW" if command.clockwise else "ARC_CCW"
    return word, [*values, *_centre(command, machine), _feed(command.feed)]


@_said.register
def _(command: Thread, machine: MachineData) -> tuple[str, list[str]]:
    values = _targets(command.absolute, command.incremental, machine)
    return "THREAD", [*values, f"F{number(command.lead)}/rev", f"Q{number(command.start_angle)}"]


@_said.register
def _(command: Skip, machine: MachineData) -> tuple[str, list[str]]:
    return "SKIP", _said(command.move, machine)[1]


@_said.register
def _(command: MachineMove, machine: MachineData) -> tuple[str, list[str]]:
    return "MACHINE_RAPID", _positions(command.target, machine)


@_said.register
def _(command: ReferenceReturn, machine: MachineData) -> tuple[str, list[str]]:
    return "REFERENCE", [*_letters(command.axes, machine), f"P{command.point}"]


@_said.register
def _(command: ReferenceCheck, machine: MachineData) -> tuple[str, list[str]]:
    return "REFERENCE_CHECK", _letters(command.axes, machine)


@_said.register
def _(command: StrokeCheck, machine: MachineData) -> tuple[str, list[str]]:
    return "STROKE_CHECK", ["ON" if command.on else "OFF", *_area(command.area or {}, machine)]


@_said.register
def _(command: Dwell, _machine: MachineData) -> tuple[str, list[str]]:
    return "DWELL", [f"{number(command.seconds)}s"]


@_said.register
def _(command: Couple, machine: MachineData) -> tuple[str, list[str]]:
    """slave=master*numerator/denominator, then what shifts it."""
    gear = command.gear
    slave, master = machine.axes[gear.slave].letter, machine.axes[gear.master].letter
    values = [
        "FOLLOW" if gear.follow else "INTERPOLATED",
        f"{slave}={master}*{gear.numerator}/{gear.denominator}",
    ]
    if gear.axial is not None:
        values.append(f"{machine.axes[gear.axial].letter}*{number(gear.axial_rate, 4)}deg/mm")
    if command.phase:
        values.append(f"R{number(command.phase)}")
    return "COUPLE", values


@_said.register
def _(command: ClearTable, _machine: MachineData) -> tuple[str, list[str]]:
    return "TABLE", [f"Q{command.points}"]


@_said.register
def _(command: SetTablePoint, machine: MachineData) -> tuple[str, list[str]]:
    return "TABLE_POINT", [f"P{command.number}", *_positions(command.values, machine)]


@_said.register
def _(command: SwitchTable, _machine: MachineData) -> tuple[str, list[str]]:
    return "TABLE", ["ON" if command.on else "OFF"]


@_said.register
def _(_command: Uncouple, _machine: MachineData) -> tuple[str, list[str]]:
    return "UNCOUPLE", []


@_said.register
def _(command: SpindleSpeed, machine: MachineData) -> tuple[str, list[str]]:
    values = [machine.axes[command.axis].letter, f"S{number(command.rpm)}"]
    return "SPINDLE", [*values, "WAIT"] if command.wait else values


@_said.register
def _(command: SurfaceSpeed, machine: MachineData) -> tuple[str, list[str]]:
    letter = machine.axes[command.axis].letter
    return "SURFACE_SPEED", [letter, f"S{number(command.speed)}", f"MAX{number(command.clamp)}"]


@_said.register
def _(command: SetCoordinates, machine: MachineData) -> tuple[str, list[str]]:
    return "SET", _positions(command.absolute, machine)


@_said.register
def _(command: ShiftCoordinates, machine: MachineData) -> tuple[str, list[str]]:
    return "SHIFT", _positions(command.shift, machine)


@_said.register
def _(command: SelectTool, _machine: MachineData) -> tuple[str, list[str]]:
    return "TOOL", [f"T{command.number}"]


@_said.register
def _(command: Coolant, _machine: MachineData) -> tuple[str, list[str]]:
    return "COOLANT", ["ON" if command.on else "OFF"]


@_said.register
def _(_command: ProgramStop, _machine: MachineData) -> tuple[str, list[str]]:
    return "STOP", []


@_said.register
def _(_command: ProgramEnd, _machine: MachineData) -> tuple[str, list[str]]:
    return "END", []


def _positions(values: Mapping[int, float], machine: MachineData) -> list[str]:
    """Axis values by column as words, in system axis order."""
    axes = machine.axes
    return [f"{axes[k].letter}{number(values[k] * axes[k].factor)}" for k in sorted(values)]


def _targets(
    absolute: Mapping[int, float], incremental: Mapping[int, float], machine: MachineData
) -> list[str]:
    """Absolute values under the letter of the axis, increments under that of its increments."""
    words = _positions(absolute, machine)
    for k in sorted(incremental):
        axis = machine.axes[k]
        letter = INCREMENT_LETTER.get(axis.letter, f"d{axis.letter}")
        words.append(f"{letter}{number(incremental[k] * axis.factor)}")
    return words


def _letters(columns: tuple[int, ...], machine: MachineData) -> list[str]:
    return [machine.axes[k].letter for k in sorted(columns)]


def _feed(feed: Feed) -> str:
    return f"F{number(feed.value)}/rev" if feed.per_revolution else f"F{number(feed.value * 60.0)}/min"


def _centre(arc: Arc, machine: MachineData) -> list[str]:
    """The centre from the start point, under I, J, K of X, Y, Z; radii as programmed."""
    letters = machine.parameters.letters
    words = []
    for column, offset in zip(arc.plane, arc.centre, strict=True):
        basic = machine.parameters.integer(1022, letters[column])
        words.append(f"{_CENTRE_LETTERS.get(basic, machine.axes[column].letter)}{number(offset)}")
    return sorted(words)


def _area(area: Mapping[int, tuple[float, float]], machine: MachineData) -> list[str]:
    words = []
    for column in sorted(area):
        axis, (low, high) = machine.axes[column], area[column]
        words.append(f"{axis.letter}{number(low * axis.factor)}..{number(high * axis.factor)}")
    return words
