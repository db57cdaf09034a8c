"""What an operator can do, in words: one table for job files, the command line and `Controller.post`.

Rulings, section 5. An action stands in a text such as `feed override 80`; an event is an action at a time, at
a line of the main program, or now.
"""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from controller.tables.alarms import ControllerError
from controller.tables.signals import spelled


class OperatorAction(Enum):
    """The actions, by their first words."""

    CYCLE_START = "cycle start"
    FEED_HOLD = "feed hold"
    SINGLE_BLOCK = "single block"
    OPTIONAL_STOP = "optional stop"
    BLOCK_SKIP = "block skip"
    FEED_OVERRIDE = "feed override"
    RAPID_OVERRIDE = "rapid override"
    SPINDLE_OVERRIDE = "spindle override"
    MACHINE_LOCK = "machine lock"
    DRY_RUN = "dry run"
    RESET = "reset"
    EMERGENCY_STOP = "emergency stop"
    MANUAL = "manual"
    AUTO = "auto"
    JOG = "jog"
    REFERENCE_RETURN = "reference return"
    MDI = "mdi"
    SIGNAL = "signal"


@dataclass(frozen=True, slots=True, kw_only=True)
class ActionEntry:
    """One row of the table of actions."""

    action: OperatorAction
    form: str
    """how it is written"""
    pattern: re.Pattern[str]
    meaning: str


_SWITCH = r" (?P<switch>on|off)"
_PERCENT = r" (?P<value>\d+(\.\d*)?) ?%?"
_NUMBER = r"[+-]?(\d+\.?\d*|\.\d+)"
_AXIS = r"(?P<axis>[A-Z])"
_ROWS: tuple[tuple[OperatorAction, str, str, str], ...] = (
    (
        OperatorAction.CYCLE_START,
        "cycle start",
        "",
        "begins the program, or goes on after a hold, a stop or a single block",
    ),
    (
        OperatorAction.FEED_HOLD,
        "feed hold",
        "",
        "axes brake along their path and stand, a dwell stops counting; not master and slave of a gear box, "
        "not a threading pass",
    ),
    (
        OperatorAction.SINGLE_BLOCK,
        "single block on|off",
        _SWITCH,
        "stops after every block until cycle start",
    ),
    (OperatorAction.OPTIONAL_STOP, "optional stop on|off", _SWITCH, "M01 stops like M00"),
    (
        OperatorAction.BLOCK_SKIP,
        "block skip [1-9] on|off",
        r"( (?P<number>[1-9]))?" + _SWITCH,
        "blocks with / or /1, or with /n, are skipped",
    ),
    (
        OperatorAction.FEED_OVERRIDE,
        "feed override 0-254",
        _PERCENT,
        "of every feed but a thread's [%]; 0 = the axes stand",
    ),
    (
        OperatorAction.RAPID_OVERRIDE,
        "rapid override 100|50|25|0",
        _PERCENT,
        "of every rapid motion [%]; 0 = F0, the speed of parameter 1421",
    ),
    (
        OperatorAction.SPINDLE_OVERRIDE,
        "spindle override 0-254",
        _PERCENT,
        "of every spindle speed [%], the ratio of a gear box held; a change while cutting in sync warns",
    ),
    (
        OperatorAction.MACHINE_LOCK,
        "machine lock [axis] on|off",
        f"( {_AXIS})?" + _SWITCH,
        "displays count, slides stand, but for master and slave of a gear box; of one axis like signal MLKx",
    ),
    (OperatorAction.DRY_RUN, "dry run on|off", _SWITCH, "every feed becomes the speed of parameter 1410"),
    (
        OperatorAction.RESET,
        "reset",
        "",
        "motion brakes, spindles stop, the program is rewound; a gear box is released unless 201#3 = 1",
    ),
    (
        OperatorAction.EMERGENCY_STOP,
        "emergency stop",
        "",
        "every axis brakes as hard as it can, a gear box is released, the program is over; reset mends it",
    ),
    (OperatorAction.MANUAL, "manual", "", "manual mode: holds the program; a gear box stays in force"),
    (OperatorAction.AUTO, "auto", "", "back to the program, which goes on at cycle start"),
    (
        OperatorAction.JOG,
        "jog Z -5.0 [F500]",
        rf" {_AXIS} ?(?P<value>{_NUMBER})( ?F ?(?P<feed>\d+\.?\d*))?",
        "an axis moves by so much in programmed units, while the program stands; at F [mm/min], or 1423",
    ),
    (
        OperatorAction.REFERENCE_RETURN,
        "reference return Y",
        f" {_AXIS}",
        "manual return of an axis to its reference point, while the program stands",
    ),
    (
        OperatorAction.MDI,
        "mdi G00 X100.",
        r" (?P<text>.+)",
        "one block from the keyboard, between two blocks",
    ),
    (
        OperatorAction.SIGNAL,
        "signal NOZAGC=1",
        r" (?P<text>[*+\-A-Z_0-9]+) ?= ?(?P<value>[01])",
        "an input signal changes",
    ),
)
ACTIONS: dict[OperatorAction, ActionEntry] = {
    action: ActionEntry(
        action=action,
        form=form,
        pattern=re.compile(re.escape(action.value) + rest, re.ASCII | re.IGNORECASE),
        meaning=meaning,
    )
    for action, form, rest, meaning in _ROWS
}
"""Everything an operator can do."""

HIGHEST_OVERRIDE = 254.0
"""[%]"""
RAPID_STEPS = (100.0, 50.0, 25.0, 0.0)
"""[%] of the rapid override"""
LATEST = 1e9
"""[s] no event comes later"""


@dataclass(frozen=True, slots=True, kw_only=True)
class OperatorEvent:
    """An action of the operator, at a time or at a program line; neither = now."""

    action: OperatorAction
    time_s: float | None = None
    """acts at the first tick that is not before it"""
    line: int | None = None
    """acts when the block of this line of the main file begins, before its motion, the first time"""
    since_s: float = 0.0
    """an event at a line counts from this time on"""
    on: bool = True
    """of a switch, or the level of a signal"""
    axis: str = ""
    """letter, where the action has one"""
    number: int = 1
    """of a block skip"""
    value: float = 0.0
    """override [%], or distance of a jog in programmed units"""
    feed: float | None = None
    """of a jog [mm/min | deg/min]"""
    text: str = ""
    """block of MDI, name of a signal"""
    words: str = ""
    """as written"""

    def __str__(self) -> str:
        return self.words or self.action.value


def operator_event(do: str, *, time_s: float | None = None, line: int | None = None) -> OperatorEvent:
    """An event from the words of its action. Raises ControllerError with what would be valid."""
    if time_s is not None and line is not None:
        raise ControllerError(f"{do!r} at a time and at a line", remedy="time_s or line, not both")
    if time_s is not None and not 0.0 <= time_s <= LATEST:
        raise ControllerError(f"{do!r} at {time_s} s", remedy=f"a time from 0 to {LATEST:g} s")
    if line is not None and line < 1:
        raise ControllerError(f"{do!r} at line {line}", remedy="a line from 1")
    words = " ".join(do.split())
    for entry in ACTIONS.values():
        if found := entry.pattern.fullmatch(words):
            return _event(entry, found.groupdict(), words, time_s, line)
    raise ControllerError(
        f"unknown operator action {do!r}", remedy=", ".join(e.form for e in ACTIONS.values())
    )


def _event(
    entry: ActionEntry, parts: dict[str, str | None], words: str, time_s: float | None, line: int | None
) -> OperatorEvent:
    value = float(parts.get("value") or 0.0)
    _check_value(entry.action, value, words)
    text = (parts.get("text") or "").strip()
    feed = parts.get("feed")
    if feed is not None and not 0.0 < float(feed) < math.inf:
        raise ControllerError(f"{words!r}", remedy="F greater than 0")
    signal = entry.action is OperatorAction.SIGNAL
    return OperatorEvent(
        action=entry.action,
        time_s=time_s,
        line=line,
        on=value == 1.0 if signal else (parts.get("switch") or "on").lower() == "on",
        axis=(parts.get("axis") or "").upper(),
        number=int(parts.get("number") or 1),
        value=value,
        feed=float(feed) if feed else None,
        text=spelled(text) if signal else text,
        words=words,
    )


def _check_value(action: OperatorAction, value: float, words: str) -> None:
    if action is OperatorAction.RAPID_OVERRIDE and value not in RAPID_STEPS:
        raise ControllerError(f"{words!r}", remedy="rapid override 100, 50, 25 or 0 (F0)")
    if action in (OperatorAction.FEED_OVERRIDE, OperatorAction.SPINDLE_OVERRIDE) and value > HIGHEST_OVERRIDE:
        raise ControllerError(f"{words!r}", remedy=f"0 to {HIGHEST_OVERRIDE:g} percent")
    if action is OperatorAction.JOG and abs(value) > 99999.999:
        raise ControllerError(f"{words!r}", remedy="a distance within 99999.999")


_WHEN = re.compile(r"(?:line (?P<line>\d{1,9})|(?P<time>\d+\.?\d*|\.\d+) ?s?) (?P<do>.+)", re.ASCII)


def read_event(text: str) -> OperatorEvent:
    """An event as on the command line: `3.0 feed hold`, `line 12 reset`. Raises ControllerError."""
    found = _WHEN.fullmatch(" ".join(text.split()))
    if found is None:
        raise ControllerError(
            f"operator event {text!r}",
            remedy="seconds or a line, then an action: 3.0 feed hold, line 12 reset",
        )
    if found["line"]:
        return operator_event(found["do"], line=int(found["line"]))
    return operator_event(found["do"], time_s=float(found["time"]))


def check_events(events: Iterable[OperatorEvent], letters: tuple[str, ...]) -> None:
    """Raise ControllerError for an event of an axis or a signal that the machine does not have."""
    for event in events:
        if event.axis and event.axis not in letters:
            raise ControllerError(f"{event}: no axis {event.axis}", remedy=", ".join(letters))
        if event.action is OperatorAction.SIGNAL:
            spelled(event.text, letters)
