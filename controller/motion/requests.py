"""What planning may have to know before it can go on, and the shape of the answers.

Motion is planned by generators: they yield a request where only the machine, or the operator, knows how it
goes on, and are sent the answer. All other time passes in closed form.
"""

from collections.abc import Generator
from dataclasses import dataclass
from typing import Protocol, TypeVar


class Sensor(Protocol):
    """The encoders at the time of a reading."""

    def position(self, axis: int) -> float:
        """Measured position [mm | deg]."""
        ...

    def command(self, axis: int) -> float:
        """The setpoint as the drive saw it last [mm | deg]."""
        ...

    def command_speed(self, axis: int) -> float:
        """Speed of that setpoint over the last tick [mm/s | deg/s]."""
        ...

    def speed(self, axis: int) -> float:
        """Measured speed over the last feed period [mm/s | deg/s]."""
        ...


@dataclass(frozen=True, slots=True)
class Reading:
    """The encoders at the planner's time, which is a tick. Answer: a Sensor."""


@dataclass(frozen=True, slots=True)
class SkipWatch:
    """The skip signal from `begin` to the planner's time. Answer: a Touch, or None where there was none."""

    begin: float
    """[s]"""


@dataclass(frozen=True, slots=True)
class Touch:
    """The skip signal has come."""

    time: float
    """[s] at a tick"""
    latch: tuple[float, ...]
    """(axes,) measured positions at the signal [mm | deg]"""


@dataclass(frozen=True, slots=True)
class Attendance:
    """Everything but spindles stands until the operator acts. Nobody answers: planning begins anew with what
    the operator does."""


Request = Reading | SkipWatch | Attendance
Answer = Sensor | Touch | None
Result = TypeVar("Result")
Steps = Generator[Request | None, Answer, Result]
"""Planning on its way; None is yielded between blocks."""
