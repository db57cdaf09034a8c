"""What the controller tells its user while it runs, and what an operator can do to it."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from controller.alarms import Alarm, ControllerError


class EventKind(Enum):
    """What has happened."""

    ALARM = "alarm"
    WARNING = "warning"
    COOLANT_ON = "coolant on"
    COOLANT_OFF = "coolant off"


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Something that happened at a tick."""

    tick: int
    kind: EventKind
    alarm: Alarm | None = None
    """of an alarm or a warning"""


class OperatorAction(Enum):
    """What an operator can do (rulings, section 5)."""

    CYCLE_START = "cycle start"
    FEED_HOLD = "feed hold"
    SINGLE_BLOCK = "single block"
    OPTIONAL_STOP = "optional stop"
    BLOCK_SKIP = "block skip"
    OVERRIDE = "override"
    MACHINE_LOCK = "machine lock"
    DRY_RUN = "dry run"
    RESET = "reset"
    EMERGENCY_STOP = "emergency stop"
    JOG = "jog"
    MANUAL_REFERENCE_RETURN = "manual reference return"
    MDI = "MDI block"


@dataclass(frozen=True, slots=True, kw_only=True)
class OperatorEvent:
    """An action of the operator at a tick or at a program line; neither = now."""

    action: OperatorAction
    tick: int | None = None
    line: int | None = None


SIGNALS: dict[str, str] = {
    "NOZAGC": "G63.5: 1 = the orthogonal axis is not compensated for the inclined axis",
    "OPTIONAL_STOP": "1 = M01 stops like M00",
    **{
        f"BDT{n}": f"1 = blocks with /{n} are skipped" + (" (also plain /)" if n == 1 else "")
        for n in range(1, 10)
    },
}
"""Signals that may be set from the start, with their meaning."""


def check_signals(signals: Mapping[str, bool]) -> None:
    """Raise ControllerError for a signal that the controller does not have."""
    for name in signals:
        if name not in SIGNALS:
            raise ControllerError(f"unknown signal {name!r}", remedy=", ".join(SIGNALS))
