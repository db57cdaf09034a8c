"""The variables of custom macro B: local, common, and those of the system behind them."""

from typing import Protocol

from controller.language.macro.functions import Value
from controller.span import Span
from controller.tables.alarms import alarm

LOCALS = 33
_VALID = "#1 to #33, #100 to #199, #500 to #999, or a system variable of this controller"


class System(Protocol):
    """The variables from #1000 on."""

    def read(self, number: int) -> Value:
        """Raises KeyError for a number that is no variable."""
        ...

    def write(self, number: int, value: Value) -> None:
        """Raises KeyError for a number that is no variable, PermissionError for one that is only read."""
        ...


def is_common(number: int) -> bool:
    """Whether #number is one of the common variables."""
    return 100 <= number <= 199 or 500 <= number <= 999


def empty_locals() -> list[Value]:
    """#1 to #33, all null; index 0 is #0, which always is."""
    return [None] * (LOCALS + 1)


class Variables:
    """All variables as the program sees them at its present level."""

    def __init__(self, system: System) -> None:
        self.local: list[Value] = empty_locals()
        """#1 to #33 of the level that is being executed"""
        self.common: dict[int, Value] = {}
        self.changes = 0
        """grows with every write, and with every look at a machine that may have moved on"""
        self.increment_digits = 0
        """decimals that ROUND keeps"""
        self._system = system

    def read(self, number: int, place: Span) -> Value:
        """The value of #number, None for null. Raises AlarmError PS0115."""
        if 0 <= number <= LOCALS:
            return self.local[number]
        if is_common(number):
            return self.common.get(number)
        self.changes += 1
        try:
            return self._system.read(number)
        except KeyError:
            raise alarm("PS0115", f"#{number}", place, valid=_VALID) from None

    def write(self, number: int, value: Value, place: Span) -> None:
        """Raises AlarmError PS0115, PS0116."""
        self.changes += 1
        if 1 <= number <= LOCALS:
            self.local[number] = value
        elif is_common(number):
            self.common[number] = value
        elif number == 0:
            raise alarm("PS0116", "#0", place)
        else:
            try:
                self._system.write(number, value)
            except KeyError:
                raise alarm("PS0115", f"#{number}", place, valid=_VALID) from None
            except PermissionError:
                raise alarm("PS0116", f"#{number}", place) from None
            except ValueError as error:
                raise alarm("PS0119", f"#{number} = {value}", place, valid=str(error)) from None
