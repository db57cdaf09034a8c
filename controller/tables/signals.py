"""The signal table: what comes in from machine and operator, what goes out, and in which frame it is meant.

Inclined axis, 本功能与各轴输入输出信号之间的关系: a Cartesian signal belongs to the commanded axis, a slide
signal to the motion of the machine, whatever commanded it. In a name {x} stands for the letter of an axis. A
name with * is active at 0 and stands at 1 unless it is set.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

from controller.laws.inclined import Frame
from controller.tables.alarms import Alarm, ControllerError
from controller.tables.parameter_table import SWITCHES


class Direction(Enum):
    """Seen from the controller."""

    INPUT = "input"
    OUTPUT = "output"


@dataclass(frozen=True, slots=True, kw_only=True)
class Signal:
    """One row of the signal table."""

    pattern: str
    """the name; {x} = axis letter"""
    direction: Direction
    frame: Frame | None
    """None where the signal belongs to no axis"""
    address: str
    """of the original; empty where it gives none"""
    meaning: str
    clause: str
    instead: str = ""
    """what does it in the twin, which has no such signal; empty = modelled"""

    @property
    def modelled(self) -> bool:
        """Whether the twin has the signal."""
        return not self.instead

    @property
    def per_axis(self) -> bool:
        """Whether every axis has one."""
        return "{x}" in self.pattern

    @property
    def idle(self) -> bool:
        """The level at which nothing is asked for: 1 for an active-low signal."""
        return self.pattern.startswith("*")

    def name(self, letter: str = "") -> str:
        """The signal of one axis."""
        return self.pattern.replace("{x}", letter)


class AxisInput(Enum):
    """Modelled inputs of an axis, by pattern."""

    INTERLOCK = "*IT{x}"
    PLUS_SWITCH = "*+L{x}"
    MINUS_SWITCH = "*-L{x}"
    SERVO_OFF = "SVF{x}"
    DETACH = "DTCH{x}"
    LOCK = "MLK{x}"
    MIRROR = "MI{x}"


_RELATION = "inclined axis, 本功能与各轴输入输出信号之间的关系"
_RULINGS = "rulings, section 5"
_SLIDE, _CART = Frame.SLIDES, Frame.CARTESIAN

_INPUTS: tuple[tuple[str, Frame | None, str, str, str, str], ...] = (
    ("NOZAGC", None, "G63.5", "1 = the orthogonal axis is not compensated", "inclined axis, 三、信号", ""),
    ("*IT{x}", _CART, "G130", "0 = interlock: a block that commands the axis waits", _RELATION, ""),
    ("*+L{x}", _SLIDE, "G114", "0 = the slide stands on its plus limit switch", _RELATION, ""),
    ("*-L{x}", _SLIDE, "G116", "0 = the slide stands on its minus limit switch", _RELATION, ""),
    ("SVF{x}", _SLIDE, "G126", "1 = servo off: a block that moves the slide waits", _RELATION, ""),
    ("DTCH{x}", _SLIDE, "G124", "1 = the axis is detached: as if it were not there", _RELATION, ""),
    ("MLK{x}", _SLIDE, "G108", "1 = machine lock: registers count, the slide stands", _RELATION, ""),
    ("MI{x}", _SLIDE, "G106", "1 = mirror image: the program moves the slide the other way", _RELATION, ""),
    ("+J{x}", _CART, "G100", "jog in the plus direction", _RELATION, "the event jog, as in jog X 5."),
    ("-J{x}", _CART, "G102", "jog in the minus direction", _RELATION, "the event jog, as in jog X -5."),
    ("*DEC{x}", _SLIDE, "X009", "deceleration for reference return", _RELATION, "ideal reference returns"),
    ("+MIT1", _CART, "X004.2", "tool offset write, plus X", _RELATION, "[setup.tool_offsets] or G10"),
    ("-MIT1", _CART, "X004", "tool offset write, minus X", _RELATION, "[setup.tool_offsets] or G10"),
    ("+MIT2", _CART, "X004.4", "tool offset write, plus Z", _RELATION, "[setup.tool_offsets] or G10"),
    ("-MIT2", _CART, "X004", "tool offset write, minus Z", _RELATION, "[setup.tool_offsets] or G10"),
    ("OPTIONAL_STOP", None, "", "1 = M01 stops like M00", _RULINGS, ""),
    *(
        (
            f"BDT{n}",
            None,
            "",
            f"1 = blocks with /{n} are skipped" + (" (also plain /)" if n == 1 else ""),
            _RULINGS,
            "",
        )
        for n in range(1, 10)
    ),
)
_OUTPUTS: tuple[tuple[str, Frame | None, str, str, str], ...] = (
    ("INP{x}", _SLIDE, "F104", "1 = the slide is in position", _RELATION),
    ("MV{x}", _SLIDE, "F102", "1 = the slide moves", _RELATION),
    ("ZP{x}", _CART, "F094", "1 = the axis has returned to its reference point", _RELATION),
    ("ZP2{x}", _CART, "F096", "1 = the axis has returned to its 2nd reference point", _RELATION),
    ("ZP3{x}", _CART, "F098", "1 = the axis has returned to its 3rd reference point", _RELATION),
    ("ZP4{x}", _CART, "F100", "1 = the axis has returned to its 4th reference point", _RELATION),
    ("MMI{x}", _SLIDE, "F108", "1 = mirror image is on", _RELATION),
    ("MDTCH{x}", _SLIDE, "F110", "1 = the axis is detached", _RELATION),
    *(
        (
            f"PSW{n:02d}",
            _SLIDE,
            "F070",
            f"1 = the slide of parameter {6909 + n} stands between {6949 + n} and {6929 + n}",
            "inclined axis, 注意 9",
        )
        for n in range(1, SWITCHES + 1)
    ),
)

SIGNALS: dict[str, Signal] = {
    pattern: Signal(
        pattern=pattern,
        direction=Direction.INPUT,
        frame=frame,
        address=address,
        meaning=meaning,
        clause=clause,
        instead=instead,
    )
    for pattern, frame, address, meaning, clause, instead in _INPUTS
} | {
    pattern: Signal(
        pattern=pattern,
        direction=Direction.OUTPUT,
        frame=frame,
        address=address,
        meaning=meaning,
        clause=clause,
    )
    for pattern, frame, address, meaning, clause in _OUTPUTS
}
"""Every signal, by pattern."""

MISPRINTS = {"NOGAGC": "NOZAGC", "NOZOGC": "NOZAGC"}
"""names that the original misprints (rulings, section 4)"""
AXIS_LETTERS = tuple("XYZABC")
"""letters that an axis can have"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """The levels of all input signals."""

    letters: tuple[str, ...]
    """axis letters in system order"""
    levels: Mapping[str, bool]
    """name -> level, of those that have been set"""

    @classmethod
    def of(cls, given: Mapping[str, bool], letters: Sequence[str]) -> "Inputs":
        """The signals as set from the start. Raises ControllerError for one that the twin does not have."""
        levels = {spelled(name, letters): bool(level) for name, level in given.items()}
        return cls(letters=tuple(letters), levels=levels)

    def changed(self, name: str, level: bool) -> "Inputs":
        """With one signal at another level. Raises ControllerError for one that the twin does not have."""
        return replace(self, levels={**self.levels, spelled(name, self.letters): level})

    def on(self, name: str) -> bool:
        """The level of a signal without axis, such as NOZAGC."""
        return self.levels.get(name, SIGNALS[name].idle)

    def columns(self, kind: AxisInput) -> frozenset[int]:
        """Columns of the axes of which an input asks for something: * signals at 0, others at 1."""
        if not self.levels:
            return frozenset()
        row = SIGNALS[kind.value]
        return frozenset(
            k
            for k, letter in enumerate(self.letters)
            if self.levels.get(row.name(letter), row.idle) is not row.idle
        )


def spelled(name: str, letters: Iterable[str] = AXIS_LETTERS) -> str:
    """The name of an input signal as the table has it, misprints mended.

    Raises ControllerError for an output, for a signal the twin does not model, and for one nobody knows.
    """
    letters = tuple(letters)
    wanted = name.strip().upper()
    wanted = MISPRINTS.get(wanted, wanted)
    row = _row(wanted, letters)
    if row is None:
        raise ControllerError(f"unknown signal {name!r}", remedy=_inputs(letters))
    if row.direction is Direction.OUTPUT:
        found = f"signal {name} is an output ({row.meaning}) and cannot be set"
        raise ControllerError(found, remedy=_inputs(letters))
    if not row.modelled:
        raise ControllerError(
            f"signal {name} ({row.meaning}) is not modelled by the twin", remedy=row.instead
        )
    return wanted


def check_signals(signals: Mapping[str, bool], letters: Iterable[str] = AXIS_LETTERS) -> None:
    """Raise ControllerError for a signal that the controller does not have, or cannot be given."""
    letters = tuple(letters)
    for name in signals:
        spelled(name, letters)


def misprinted(given: Iterable[str]) -> list[Alarm]:
    """A note for every name that the original misprints."""
    return [
        Alarm(number="HT9124", found=f"signal {name}", valid=MISPRINTS[name.strip().upper()])
        for name in given
        if name.strip().upper() in MISPRINTS
    ]


_PER_AXIS = re.compile(r"(?P<head>[*+\-A-Z0-9]+?)(?P<letter>[A-Z])", re.ASCII)


def _row(name: str, letters: Sequence[str]) -> Signal | None:
    if name in SIGNALS:
        return SIGNALS[name]
    found = _PER_AXIS.fullmatch(name)
    if found is None or found["letter"] not in letters:
        return None
    return SIGNALS.get(found["head"] + "{x}")


def _inputs(letters: Sequence[str]) -> str:
    """Every input that the twin models."""
    rows = [row for row in SIGNALS.values() if row.direction is Direction.INPUT and row.modelled]
    return f"{', '.join(row.name('x') for row in rows)} with x = {', '.join(letters)}"
