"""A full set of parameter values: those delivered, and overrides by the user."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from controller.tables.alarms import ControllerError
from controller.tables.delivered import DELIVERED, SETUPS
from controller.tables.parameter_table import PARAMETERS, ParameterEntry, ParameterKind

Value = int | float | str


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameters:
    """A full set of parameter values. Axis values are keyed by the delivered axis letter."""

    setup: str
    letters: tuple[str, ...]
    """delivered axis letters in system axis order"""
    values: Mapping[tuple[int, str], float]
    """(number, axis letter or "") -> value; bits as the whole byte"""

    def number(self, number: int, axis: str = "") -> float:
        """The value of a parameter."""
        return self.values[number, axis]

    def integer(self, number: int, axis: str = "") -> int:
        """The value of an integer parameter."""
        return int(self.values[number, axis])

    def bit(self, number: int, bit: int, axis: str = "") -> bool:
        """One bit of a bit parameter."""
        return bool(int(self.values[number, axis]) >> bit & 1)


def delivered(setup: str = "hobbing", overrides: Mapping[str, Value] | None = None) -> Parameters:
    """The delivered parameters of a set-up, with overrides such as {"201#4": "1", "1320.Z": 250.0}.

    Raises ControllerError for an unknown set-up, parameter, bit or axis and for a value out of range.
    """
    if setup not in DELIVERED:
        raise ControllerError(f"unknown set-up {setup!r}", remedy=" or ".join(SETUPS))
    common, axes = DELIVERED[setup]
    values: dict[tuple[int, str], float] = {(number, ""): value for number, value in common.items()}
    for letter, axis in axes.items():
        values |= {(int(number), letter): value for number, value in axis.items()}
        values[1020, letter] = ord(letter)
    letters = tuple(axes)
    for key, value in (overrides or {}).items():
        _override(values, letters, key, value)
    return Parameters(setup=setup, letters=letters, values=values)


_KEY = re.compile(r"(\d{1,5})(?:#(\d))?(?:\.([A-Z]))?", re.ASCII)


def _override(values: dict[tuple[int, str], float], letters: tuple[str, ...], key: str, value: Value) -> None:
    found = _KEY.fullmatch(key.strip())
    if not found:
        raise ControllerError(
            f"{key!r} names no parameter", remedy="a number, #bit, .axis, as in 201#4 or 1320.Z"
        )
    number, bit, axis = int(found.group(1)), found.group(2), found.group(3) or ""
    entry = PARAMETERS.get(number)
    if entry is None:
        raise ControllerError(f"unknown parameter {number}", remedy=_numbers())
    if entry.per_axis and axis not in letters:
        raise ControllerError(f"{key}: parameter {number} belongs to an axis", remedy=_keys(entry, letters))
    if not entry.per_axis and axis:
        raise ControllerError(f"{key}: parameter {number} belongs to no axis", remedy=_keys(entry, letters))
    if entry.kind is ParameterKind.BITS:
        if bit is None or int(bit) not in entry.bits:
            raise ControllerError(
                f"{key}: parameter {number} is set bit by bit", remedy=_keys(entry, letters)
            )
        on = _parsed(entry, key, value)
        mask = 1 << int(bit)
        before = int(values[number, axis])
        values[number, axis] = before | mask if on else before & ~mask
    elif bit is not None:
        raise ControllerError(f"{key}: parameter {number} has no bits", remedy=_keys(entry, letters))
    else:
        values[number, axis] = _parsed(entry, key, value)


def _numbers() -> str:
    """All numbers of the table, neighbours as a range."""
    runs: list[list[int]] = []
    for number in sorted(PARAMETERS):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs)


def _keys(entry: ParameterEntry, letters: tuple[str, ...]) -> str:
    heads = [f"{entry.number}#{bit}" for bit in entry.bits] or [str(entry.number)]
    return (
        ", ".join(f"{head}.{letter}" for head in heads for letter in letters)
        if entry.per_axis
        else ", ".join(heads)
    )


def _parsed(entry: ParameterEntry, key: str, value: Value) -> float:
    """The value as a number of the table's unit, or a message that names the range."""
    text = str(value).strip()
    valid = f"{entry.low:g} to {entry.high:g} {entry.unit}".strip()
    if entry.kind is ParameterKind.ANGLE_COUNT:
        valid += f", or with a point {entry.low / 1000.0:g}. to {entry.high / 1000.0:g}. deg"
    if entry.kind is ParameterKind.LETTER and len(text) == 1 and text.isalpha():
        return ord(text.upper())
    try:
        number = float(int(value)) if isinstance(value, bool) else float(text)
    except ValueError:
        raise ControllerError(f"parameter {key} = {text!r} is no number", remedy=valid) from None
    if entry.kind is ParameterKind.ANGLE_COUNT and "." in text:
        number = round(number * 1000.0)
    if not entry.low <= number <= entry.high:
        raise ControllerError(f"parameter {key} = {text} is out of range", remedy=valid)
    if entry.kind is not ParameterKind.REAL and number != int(number):
        raise ControllerError(f"parameter {key} = {text} is no integer", remedy=valid)
    return number
