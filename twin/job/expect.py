"""`[expect]`: what a job must come to, so that a change of the program that spoils it is seen."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

from twin.inspection.keys import CUTTING_LOAD, KEYS, Quantity

FIGURES = {**KEYS, **CUTTING_LOAD}
"""what can be expected"""
LISTS = ("alarms", "warnings")
"""numbers that must come up, these and no others"""
LIMITS = {"value", "tolerance", "min", "max"}
FORMS = "{value = 15.33, tolerance = 0.005}, {min = 0.0}, {max = 12.0} or {min = 0.0, max = 12.0}"

Fail = Callable[[tuple[str, ...], str, str], Exception]
"""keys within [expect], what is wrong, what would be valid -> the error to raise"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Between:
    """A number from `low` to `high`, both allowed."""

    low: float
    high: float

    def __str__(self) -> str:
        if math.isinf(self.high):
            return f"at least {self.low:.10g}"
        if math.isinf(self.low):
            return f"at most {self.high:.10g}"
        if self.low == self.high:
            return f"{self.low:.10g}"
        return f"{self.low:.10g} to {self.high:.10g}"

    def off(self, value: float) -> float:
        """How far a value lies outside: + above, − below, 0 = inside."""
        return value - min(max(value, self.low), self.high)


@dataclass(frozen=True, slots=True, kw_only=True)
class Expectation:
    """One line of `[expect]`."""

    key: str
    """of FIGURES, or one of LISTS"""
    wanted: Between | str | bool | tuple[str, ...]


def read_expectations(raw: Mapping[str, Any], fail: Fail) -> tuple[Expectation, ...]:
    """Read the table; `fail` makes the error for what is not known or not possible."""
    return tuple(
        Expectation(key=".".join(way), wanted=_wanted(way, value, fail)) for way, value in _leaves(raw, ())
    )


def _leaves(raw: Mapping[str, Any], way: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Keys, quoted or dotted, and what they are set to."""
    for name, value in raw.items():
        here = (*way, name)
        if isinstance(value, dict) and not (value.keys() & LIMITS) and value:
            yield from _leaves(value, here)
        else:
            yield here, value


def _wanted(way: tuple[str, ...], value: Any, fail: Fail) -> Between | str | bool | tuple[str, ...]:
    key = ".".join(way)
    if key in LISTS:
        if not isinstance(value, list) or not all(isinstance(number, str) for number in value):
            raise fail(way, f"{key} is a list of numbers", f'{key} = [], {key} = ["PS1594"]')
        return tuple(value)
    quantity = FIGURES.get(key)
    if quantity is None:
        near = get_close_matches(key, (*FIGURES, *LISTS), n=3, cutoff=0.75)
        raise fail(way, f"unknown key {key!r} in [expect]", ", ".join(near or (*LISTS, *FIGURES)))
    if isinstance(value, dict):
        return _between(way, key, quantity, value, fail)
    if quantity is Quantity.COUNT and isinstance(value, int) and not isinstance(value, bool):
        return Between(low=value, high=value)
    if quantity.words:
        fits = value in quantity.words
    else:
        fits = quantity is Quantity.FLAG and isinstance(value, bool)
    if fits:
        return value
    if quantity is Quantity.NUMBER and not isinstance(value, bool | str | list):
        raise fail(way, f"{key} is measured and has a tolerance", FORMS)
    valid = FORMS if quantity is Quantity.NUMBER else quantity.value
    raise fail(way, f"{key} = {value!r} is not {quantity.value}", valid)


def _between(
    way: tuple[str, ...], key: str, quantity: Quantity, value: Mapping[str, Any], fail: Fail
) -> Between:
    """Limits written out, or a value with a tolerance to both sides."""
    if quantity not in (Quantity.NUMBER, Quantity.COUNT):
        raise fail(way, f"{key} has no limits", quantity.value)
    names = set(value)
    if names != {"value", "tolerance"} and not (names and names <= {"min", "max"}):
        raise fail(way, f"{key} has {', '.join(sorted(names)) or 'no limits'}", FORMS)
    for name, number in value.items():
        if isinstance(number, bool) or not isinstance(number, int | float) or not math.isfinite(number):
            raise fail(way, f"{key}: {name} = {number!r} is not a finite number", FORMS)
    if "value" in value:
        if value["tolerance"] < 0:
            raise fail(way, f"{key}: tolerance = {value['tolerance']:g} is below 0", FORMS)
        middle, half = float(value["value"]), float(value["tolerance"])
        return Between(low=middle - half, high=middle + half)
    low, high = float(value.get("min", -math.inf)), float(value.get("max", math.inf))
    if low > high:
        raise fail(way, f"{key}: min = {low:g} lies above max = {high:g}", FORMS)
    return Between(low=low, high=high)
