"""What the controller tells its user while it runs."""

from dataclasses import dataclass
from enum import Enum

from controller.tables.alarms import Alarm


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
