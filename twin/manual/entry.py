"""One thing that the manual explains."""

from dataclasses import dataclass
from enum import Enum


class Chapter(Enum):
    """The chapters of the manual, in their order."""

    G_CODE = "G codes"
    M_CODE = "M codes"
    ALARM = "Alarms"
    WARNING = "Warnings"
    ADVICE = "Advice"
    PARAMETER = "Parameters"
    SIGNAL = "Signals"
    EVENT = "Operator events"


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A code, an alarm, a parameter, a signal, an event."""

    chapter: Chapter
    name: str
    """as users write it"""
    title: str
    """one line"""
    rows: tuple[tuple[str, str], ...]
    """label and text: meaning, clause, remedy, …"""
    names: frozenset[str]
    """all spellings by which it is found, as `spelled` gives them"""


def spelled(name: str) -> str:
    """A name as it is looked up: upper case, without blanks."""
    return "".join(name.upper().split())
