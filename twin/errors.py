"""The one error root. Every message names the thing, its place, and what would have been valid."""

from dataclasses import dataclass
from enum import IntEnum


class ExitCode(IntEnum):
    """The process exit codes of the contract with the user."""

    FINE = 0
    FINDING = 1
    """an alarm, a part out of tolerance, a collision, a solid that is not the named part"""
    USAGE = 2
    """unusable command line or unreadable input"""
    FAULT = 3
    """a fault of hobtwin itself"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """Where in a user's file something stands; lines and columns count from 1, in characters."""

    file: str
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        parts = [self.file, *(str(n) for n in (self.line, self.column) if n is not None)]
        return ":".join(parts)


class HobtwinError(Exception):
    """Something a user can mend. `str()` is the one line to print."""

    exit_code = ExitCode.FINDING

    def __init__(self, text: str, *, place: Place | None = None, remedy: str = "") -> None:
        super().__init__(text)
        self.text = text
        self.place = place
        self.remedy = remedy

    def __str__(self) -> str:
        head = f"{self.place}: " if self.place else ""
        tail = f" ({self.remedy})" if self.remedy else ""
        return f"{head}error: {self.text}{tail}"


class InputError(HobtwinError):
    """A file or an argument that cannot be used: exit code 2."""

    exit_code = ExitCode.USAGE


class PartError(HobtwinError):
    """A part that cannot be made or measured as asked: exit code 1."""
