"""Expressions of custom macro B: parsed once into a function of the variables, evaluated when executed.

Precedence: functions and signs, then * / MOD AND, then + - OR XOR, then the comparisons. Brackets nest five
deep (PS0118).
"""

import math
import operator
import re
from collections.abc import Callable
from typing import Protocol

from controller.language.macro.functions import (
    COMPARISONS,
    FUNCTIONS,
    FUNCTIONS_OF_TWO,
    Value,
    bits_and,
    bits_or,
    bits_xor,
    divide,
    modulus,
    nearest,
)
from controller.span import Span
from controller.tables.alarms import AlarmError, alarm

DEEPEST_BRACKETS = 5
LONGEST_NUMBER = 12
"""[digits] of a number in an expression"""


class Scope(Protocol):
    """What an expression needs of the variables."""

    increment_digits: int
    """decimals that ROUND keeps: 0 in a macro statement, those of the increment system in a word"""

    def read(self, number: int, place: Span) -> Value:
        """The value of #number. Raises AlarmError PS0115."""
        ...


Expression = Callable[[Scope], Value]

_NUMBER = re.compile(r"\d+\.?\d*|\.\d+", re.ASCII)
_NAME = re.compile(r"[A-Za-z]+")
_BLANKS = re.compile(r"(?:[ \t\u3000]|\([^)]*\))*")
_PRODUCT = re.compile(r"\*|/|MOD|AND", re.IGNORECASE)
_DIGITS = re.compile(r"\d+", re.ASCII)
_QUOTIENT = re.compile(r"/[ \t]*\[")
_SUM = re.compile(r"\+|-|XOR|OR", re.IGNORECASE)
_COMPARISON = re.compile(r"EQ|NE|GT|LT|GE|LE", re.IGNORECASE)
_OPERATIONS: dict[str, Callable[[float, float], float]] = {
    "*": operator.mul,
    "/": divide,
    "MOD": modulus,
    "AND": bits_and,
    "+": operator.add,
    "-": operator.sub,
    "OR": bits_or,
    "XOR": bits_xor,
}


def printable(text: str) -> str:
    """The text such that any terminal can print it."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


class Scanner:
    """A place in a line of text that moves forward."""

    def __init__(self, text: str, position: int, file: str, line: int) -> None:
        self.text = text
        self.position = position
        self.comparisons = 0
        """how many have been parsed so far"""
        self._file = file
        self._line = line

    def place(self, position: int | None = None) -> Span:
        """The span of a position, by default of what comes next."""
        at = self._behind_blanks() if position is None else position
        return Span(file=self._file, line=self._line, column=at + 1)

    def match(self, pattern: re.Pattern[str]) -> str | None:
        """Take what matches here, behind blanks and comments."""
        found = pattern.match(self.text, self._behind_blanks())
        if found is None:
            return None
        self.position = found.end()
        return found.group()

    def take(self, character: str) -> bool:
        """Take one character, behind blanks and comments."""
        at = self._behind_blanks()
        if not self.text.startswith(character, at):
            return False
        self.position = at + 1
        return True

    @property
    def finished(self) -> bool:
        """Whether nothing follows but blanks, comments, and what stands behind ;"""
        rest = self.text[self._behind_blanks() :]
        return not rest or rest[0] in ";；"

    def fault(self, number: str, valid: str = "", found: str | None = None) -> AlarmError:
        """An alarm at the present place."""
        rest = (self.text[self._behind_blanks() :].split() or ["the end of the block"])[0][:20]
        return alarm(number, found or printable(rest), self.place(), valid=valid)

    def _behind_blanks(self) -> int:
        found = _BLANKS.match(self.text, self.position)
        return found.end() if found else self.position


def parse_expression(scanner: Scanner, depth: int = 0) -> Expression:
    """An arithmetic expression. Raises AlarmError PS0003, PS0114, PS0118."""
    left = _product(scanner, depth)
    while name := scanner.match(_SUM):
        place = scanner.place(scanner.position - len(name))
        left = _operation(name, left, _product(scanner, depth), place)
    return left


def _product(scanner: Scanner, depth: int) -> Expression:
    left = parse_primary(scanner, depth)
    while name := scanner.match(_PRODUCT):
        place = scanner.place(scanner.position - len(name))
        left = _operation(name, left, parse_primary(scanner, depth), place)
    return left


def parse_condition(scanner: Scanner) -> Expression:
    """[a EQ b], also several joined in brackets by AND, OR, XOR. Raises AlarmError PS0114."""
    before, place = scanner.comparisons, scanner.place()
    if not scanner.take("["):
        raise scanner.fault("PS0114", "a comparison in brackets, as in IF [#1 EQ 0]")
    condition = _brackets(scanner, 1)
    if scanner.comparisons == before:
        valid = "a comparison: EQ, NE, GT, LT, GE or LE"
        raise alarm("PS0114", "brackets without a comparison", place, valid=valid)
    return condition


def parse_primary(scanner: Scanner, depth: int = 0) -> Expression:
    """A number, a variable, a function or an expression in brackets, with signs before it."""
    negative = False
    while True:
        if scanner.take("-"):
            negative = not negative
        elif not scanner.take("+"):
            break
    inner = _operand(scanner, depth)
    return (lambda scope: -(inner(scope) or 0.0)) if negative else inner


def parse_variable(scanner: Scanner, depth: int = 0) -> Expression:
    """The number of a variable behind #: digits, or an expression in brackets."""
    place = scanner.place(scanner.position - 1)
    if text := scanner.match(_DIGITS):
        number = _literal(scanner, text)
        return lambda _: number
    if not scanner.take("["):
        raise scanner.fault("PS0114", "the number of a variable behind #, as in #101 or #[#1+1]")
    index = _brackets(scanner, depth + 1)

    def whole(scope: Scope) -> Value:
        value = index(scope)
        if value is None or value != round(value):
            raise alarm("PS0115", f"#[{value if value is None else f'{value:g}'}]", place)
        return value

    return whole


def _operand(scanner: Scanner, depth: int) -> Expression:
    if scanner.take("["):
        return _brackets(scanner, depth + 1)
    start = scanner.position
    if scanner.take("#"):
        place = scanner.place(scanner.position - 1)
        index = parse_variable(scanner, depth)
        return lambda scope: scope.read(int(index(scope) or 0.0), place)
    if text := scanner.match(_NUMBER):
        number = _literal(scanner, text)
        return lambda _: number
    name = (scanner.match(_NAME) or "").upper()
    if name in FUNCTIONS or name in FUNCTIONS_OF_TWO:
        return _function(scanner, name, depth)
    scanner.position = start
    names = ", ".join(dict.fromkeys([*FUNCTIONS, *FUNCTIONS_OF_TWO]))
    raise scanner.fault("PS0114", f"a number, a variable, brackets, or a function: {names}")


def _brackets(scanner: Scanner, depth: int) -> Expression:
    """What stands in brackets, the first being taken: an expression, or a comparison, which is 1 or 0."""
    if depth > DEEPEST_BRACKETS:
        raise alarm(
            "PS0118", f"bracket number {depth} within each other", scanner.place(scanner.position - 1)
        )
    inner = parse_expression(scanner, depth)
    if name := scanner.match(_COMPARISON):
        compare, left, right = COMPARISONS[name.upper()], inner, parse_expression(scanner, depth)
        scanner.comparisons += 1
        inner = lambda scope: float(compare(left(scope), right(scope)))  # noqa: E731 - one of many closures
    if not scanner.take("]"):
        raise scanner.fault("PS0114", "]")
    return inner


def _function(scanner: Scanner, name: str, depth: int) -> Expression:
    """NAME[a], NAME[a,b], ATAN[a]/[b]."""
    place = scanner.place(scanner.position - len(name))
    if depth + 1 > DEEPEST_BRACKETS:
        raise scanner.fault("PS0118", found=f"bracket number {depth + 1} within each other")
    if not scanner.take("["):
        raise scanner.fault("PS0114", f"[ behind {name}")
    first = parse_expression(scanner, depth + 1)
    second = None
    if name in FUNCTIONS_OF_TWO and scanner.take(","):
        second = parse_expression(scanner, depth + 1)
    if not scanner.take("]"):
        raise scanner.fault("PS0114", "]")
    if name == "ATAN" and second is None and scanner.match(_QUOTIENT):
        second = parse_expression(scanner, depth + 1)
        if not scanner.take("]"):
            raise scanner.fault("PS0114", "]")
    if second is not None:
        return _guarded(FUNCTIONS_OF_TWO[name], first, second, name, place)
    if name not in FUNCTIONS:
        raise scanner.fault("PS0114", f"two arguments, {name}[a,b]")
    one = FUNCTIONS[name]
    if name == "ROUND":
        return lambda scope: _rounded(first(scope) or 0.0, scope.increment_digits)
    return _guarded(lambda value, _: one(value), first, _nothing, name, place)


def _rounded(value: float, digits: int) -> float:
    scale = 10.0**digits
    return nearest(value * scale) / scale


def _nothing(_: Scope) -> Value:
    return None


def _operation(name: str, left: Expression, right: Expression, place: Span) -> Expression:
    return _guarded(_OPERATIONS[name.upper()], left, right, name.upper(), place)


def _guarded(
    law: Callable[[float, float], float], left: Expression, right: Expression, name: str, place: Span
) -> Expression:
    """A law of two numbers whose faults are alarms at a place; the null value counts as 0."""

    def evaluate(scope: Scope) -> Value:
        a, b = left(scope) or 0.0, right(scope) or 0.0
        try:
            value = law(a, b)
        except ZeroDivisionError:
            raise alarm("PS0112", f"{a:g} {name} {b:g}", place) from None
        except ValueError:
            found = f"{name}[{a:g}]" if right is _nothing else f"{name} of {a:g} and {b:g}"
            raise alarm("PS0119", found, place) from None
        except OverflowError:
            value = math.inf
        if not math.isfinite(value):
            raise alarm("PS0111", f"the result of {name}", place)
        return value

    return evaluate


def _literal(scanner: Scanner, text: str) -> float:
    if sum(map(str.isdigit, text)) > LONGEST_NUMBER:
        place = scanner.place(scanner.position - len(text))
        raise alarm("PS0003", text[:20], place, valid=f"at most {LONGEST_NUMBER} digits in an expression")
    return float(text)
