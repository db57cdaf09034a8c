"""A straight program written anew with every place corrected: G00 and G01, block by block, as it runs."""

import math
import re
from dataclasses import dataclass, field

from controller.commands import (
    Coolant,
    Dwell,
    Feed,
    Move,
    ProgramEnd,
    ProgramStop,
    ReferenceReturn,
    SelectTool,
    ShiftCoordinates,
    SpindleSpeed,
)
from controller.dry_run import dry_run
from controller.language.source import Program
from controller.observed import Observed
from controller.tables.machine_data import INCREMENT_LETTER, MachineData, machine_data
from twin.compensation.correction import corrected, widest_step
from twin.errors import InputError, Place
from twin.presets import ControllerSettings
from twin.probing.circle import Circle

DIGITS = 3
"""decimals of a place: what the control resolves"""
_WORDS = re.compile(r"(?<![A-Z#])(T\d{3,4}|G5[4-9])(?!\d|\.)")
"""words of a source block that are taken over as they stand"""


def rewritten(
    program: Program,
    settings: ControllerSettings,
    circle: Circle,
    *,
    work: int,
    radius: float,
    title: str,
) -> str:
    """Write a program anew for a gear whose axis stands at `circle`'s centre.

    `work`: column of the work spindle; `radius` [mm]: where gaps are put right on a machine without a Y axis.
    Raises InputError, at the line, for what is not straight, and for a program that ends in an alarm.
    """
    machine = machine_data(settings.parameters)
    writer = _Writer(program=program, machine=machine, circle=circle, work=work, radius=radius)
    found = dry_run(
        program,
        settings.parameters,
        settings.offsets,
        settings.signals,
        events=settings.events,
        observe=writer.see,
    )
    if found.alarms:
        raise InputError(f"the program to be compensated ends in an alarm: {found.alarms[0]}")
    blocks = [f"N{10 * k:04d} {block} ;" for k, block in enumerate(writer.blocks, start=1)]
    return "\n".join(["%", f"O0001 ({title})", *blocks, "%", ""])


def across(machine: MachineData) -> bool:
    """Whether the machine can move its tool across the work: a linear Y."""
    return any(axis.letter == "Y" and not axis.rotary for axis in machine.axes)


@dataclass(slots=True, kw_only=True)
class _Writer:
    program: Program
    machine: MachineData
    circle: Circle
    work: int
    radius: float
    blocks: list[str] = field(default_factory=lambda: ["G54 G98"])
    _said: dict[str, str] = field(default_factory=dict)
    """axis letter -> the number last written for it"""
    _per_revolution: bool = False

    def see(self, seen: Observed) -> None:
        """Write one command of the program."""
        command = seen.command
        match command:
            case Move():
                self._move(seen, command)
            case ReferenceReturn():
                self._return(seen, command)
            case SpindleSpeed():
                self._turn(seen, command)
            case Dwell():
                self.blocks.append(f"G04 X{command.seconds:.3f}")
            case Coolant():
                self.blocks.append("M08" if command.on else "M09")
            case ShiftCoordinates() | SelectTool():
                self._take_over(seen)
            case ProgramStop():
                self.blocks.append("M00")
            case ProgramEnd():
                self.blocks.append("M30")
            case _:
                raise self._refused(seen, f"a block that is no straight move: {type(command).__name__}")

    def _move(self, seen: Observed, move: Move) -> None:
        letters = self.machine.letters
        before, after = list(seen.absolute_before), list(seen.absolute_after)
        # absolute angles are wrapped, slides are not
        turn = seen.slides_after[self.work] - seen.slides_before[self.work]
        after[self.work] = before[self.work] + turn
        named = {letters[k] for k in (*move.absolute, *move.incremental)}
        steps = math.ceil(abs(turn) / widest_step(self.circle) - 1e-9) if move.feed else 1
        for k in range(1, max(steps, 1) + 1):
            share = k / max(steps, 1)
            place = [a + share * (b - a) for a, b in zip(before, after, strict=True)]
            self._write_move(move.feed, place, named)

    def _write_move(self, feed: Feed | None, place: list[float], named: set[str]) -> None:
        letters, c = self.machine.letters, place[self.work]
        change = corrected(self.circle, c, radius=self.radius, has_y=across(self.machine))
        added = {"X": change.x}
        if across(self.machine):
            added["Y"] = change.y
        else:
            added[letters[self.work]] = change.c
        words = []
        for k, axis in enumerate(self.machine.axes):
            value = place[k] + added.get(axis.letter, 0.0)
            if axis.type_a:
                value %= 360.0
            text = _number(value * axis.factor)
            wanted = axis.letter in named or axis.letter in added
            if wanted and self._said.get(axis.letter) != text:
                self._said[axis.letter] = text
                words.append(f"{axis.letter}{text}")
        if not words:
            return
        if feed is None:
            self.blocks.append(" ".join(["G00", *words]))
            return
        if feed.per_revolution is not self._per_revolution:
            self._per_revolution = feed.per_revolution
            self.blocks.append("G99" if feed.per_revolution else "G98")
        value = feed.value if feed.per_revolution else 60.0 * feed.value
        self.blocks.append(" ".join(["G01", *words, f"F{_number(value)}"]))

    def _return(self, seen: Observed, command: ReferenceReturn) -> None:
        letters = [self.machine.letters[k] for k in command.axes]
        if command.point != 1 or any(letter not in INCREMENT_LETTER for letter in letters):
            raise self._refused(seen, "a return to another point than G28's")
        for letter in letters:
            self._said.pop(letter, None)
        self.blocks.append(" ".join(["G28", *(f"{INCREMENT_LETTER[letter]}0" for letter in letters)]))

    def _turn(self, seen: Observed, command: SpindleSpeed) -> None:
        if command.axis == self.work:
            raise self._refused(seen, "the work turns by S: no gap is ground one by one")
        if not command.rpm:
            self.blocks.append("M05")
            return
        self.blocks.append(f"S{abs(command.rpm):.10g} {'M03' if command.rpm > 0 else 'M04'}")

    def _take_over(self, seen: Observed) -> None:
        """T and G54 to G59 as they stand in the block, once for the commands they make."""
        line = seen.span.line or 0
        if not line or seen.span.file != self.program.span(0).file:
            raise self._refused(seen, "a zero point or a tool that a subprogram changes")
        words = " ".join(_WORDS.findall(self.program.lines[line - 1].split("(")[0].split(";")[0]))
        if not words:
            raise self._refused(seen, "a zero point that moves")
        self._said.clear()
        if self.blocks[-1] != words:
            self.blocks.append(words)

    def _refused(self, seen: Observed, what: str) -> InputError:
        span = seen.span
        return InputError(
            f"cannot compensate {what}",
            place=Place(file=span.file, line=span.line),
            remedy="straight moves of X, Y, Z, C with the work at rest; or G81 on the hobbing set-up",
        )


def _number(value: float) -> str:
    """A number as a program has it, without minus zero, always with its point."""
    return f"{round(value, DIGITS) + 0.0:.{DIGITS}f}".rstrip("0")
