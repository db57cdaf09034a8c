"""Takes checked values out of a machine's parameter file; every message names the key and its place."""

import math
from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any

from twin.errors import InputError, Place
from twin.machine.drive import Drive, DriveKind

Path = tuple[str, ...]

_MAY_BE_ZERO = (
    "motor_inertia",
    "coulomb_friction",
    "viscous_friction",
    "backlash",
    "encoder_counts",
    "encoder_cyclic_error",
    "encoder_cyclic_order",
    "velocity_feedforward",
    "acceleration_feedforward",
    "breakdown_slip",
)


class ParameterReader:
    """The tables of one parameter file, with what a job changes laid over them."""

    def __init__(
        self, table: Mapping[str, Any], changes: Mapping[str, Any], place: Callable[[Path], Place]
    ) -> None:
        """`place`: where a key stands, for messages."""
        self._place = place
        self._table = self._laid_over(table, changes, ())

    def table(self, path: Path) -> dict[str, Any]:
        """A table by its keys."""
        found: Any = self._table
        for depth, key in enumerate(path, start=1):
            found = found.get(key, {})
            if not isinstance(found, dict):
                raise self._error(path[:depth], f"{_name(path[:depth])}: expected a table, got {found!r}")
        return found

    def keys(self, path: Path, expected: tuple[str, ...]) -> None:
        """Raise InputError unless the table has exactly these keys."""
        table = self.table(path)
        for key in table:
            if key not in expected:
                raise self._error(
                    (*path, key), f"{_name(path)}: unknown key {key!r}", f"valid: {', '.join(expected)}"
                )
        for key in expected:
            if key not in table:
                raise self._error(path, f"{_name(path)}: key {key!r} is missing")

    def number(self, path: Path) -> float:
        """A finite number that is not negative."""
        key, value = path[-1], self.table(path[:-1])[path[-1]]
        where = _name(path[:-1])
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise self._error(path, f"{where}: {key} = {value!r}: expected a finite number")
        if value < 0:
            raise self._error(path, f"{where}: {key} = {value} must not be negative")
        return float(value)

    def positive(self, path: Path) -> float:
        """A finite number above zero."""
        if (value := self.number(path)) == 0:
            raise self._error(path, f"{_name(path[:-1])}: {path[-1]} = 0: must be above 0")
        return value

    def joints(self, path: Path) -> tuple[str, ...]:
        """A list of joint names, each once."""
        value = self.table(path[:-1])[path[-1]]
        where = ".".join(path)
        if not isinstance(value, list) or not all(isinstance(j, str) for j in value):
            raise self._error(path, f"{where}: expected a list of joint names, got {value!r}")
        if len(set(value)) != len(value):
            raise self._error(path, f"{where}: a joint is named twice: {value}")
        return tuple(value)

    def drive(self, joint: str) -> Drive:
        """The drive of a joint."""
        path = ("drives", joint)
        numbers = tuple(f.name for f in fields(Drive) if f.name != "kind")
        self.keys(path, ("kind", *numbers))
        kind = self.table(path)["kind"]
        kinds = [k.value for k in DriveKind]
        if kind not in kinds:
            raise self._error(
                (*path, "kind"), f"drives.{joint}: unknown kind {kind!r}", f"valid: {', '.join(kinds)}"
            )
        values = {
            name: (self.number if name in _MAY_BE_ZERO else self.positive)((*path, name)) for name in numbers
        }
        drive = Drive(kind=DriveKind(kind), **values)
        if drive.kind is DriveKind.VARIABLE_FREQUENCY and not drive.breakdown_slip:
            raise self._error(
                (*path, "kind"),
                f"drives.{joint}: an induction motor needs its breakdown_slip",
                "the speed it loses at its breakdown torque [1/min], above 0",
            )
        return drive

    def _laid_over(self, own: Mapping[str, Any], changes: Mapping[str, Any], path: Path) -> dict[str, Any]:
        """The tables with the changes in them; what is not there cannot be changed."""
        laid = dict(own)
        for key, value in changes.items():
            here = (*path, key)
            if key not in own:
                raise self._error(here, f"{_name(path)}: unknown key {key!r}", f"valid: {', '.join(own)}")
            if isinstance(own[key], dict) != isinstance(value, Mapping):
                expected = "a table" if isinstance(own[key], dict) else "a value"
                raise self._error(here, f"{_name(here)}: expected {expected}, got {value!r}")
            laid[key] = self._laid_over(own[key], value, here) if isinstance(value, Mapping) else value
        return laid

    def _error(self, path: Path, text: str, remedy: str = "") -> InputError:
        return InputError(text, place=self._place(path), remedy=remedy)


def _name(path: Path) -> str:
    return ".".join(path) or "machine"
