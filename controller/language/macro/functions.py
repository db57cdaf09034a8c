"""The functions of custom macro B as pure functions of numbers; angles in degrees.

They raise ValueError for an argument out of range (PS0119) and OverflowError where the result is none.
Angles at which a shop expects a round result give it exactly: SIN[30] is 0.5, TAN[45] is 1.
"""

import math
from collections.abc import Callable

Value = float | None
"""a number, or None for the null value"""

_SINES = {0.0: 0.0, 30.0: 0.5, 90.0: 1.0, 150.0: 0.5, 180.0: 0.0, 210.0: -0.5, 270.0: -1.0, 330.0: -0.5}
_TANGENTS = {45.0: 1.0, 135.0: -1.0}
_INTEGER_BITS = 32
LARGEST_BCD = 99_999_999


def sine(angle: float) -> float:
    """SIN."""
    exact = _SINES.get(angle % 360.0)
    return math.sin(math.radians(angle % 360.0)) if exact is None else exact


def cosine(angle: float) -> float:
    """COS."""
    exact = _SINES.get((angle + 90.0) % 360.0)
    return math.cos(math.radians(angle % 360.0)) if exact is None else exact


def tangent(angle: float) -> float:
    """TAN; none at 90 degrees and its odd multiples."""
    turned = angle % 180.0
    if turned == 90.0:
        raise ValueError("the tangent of a right angle")
    exact = _TANGENTS.get(turned)
    return sine(angle) / cosine(angle) if exact is None else exact


def arc_sine(value: float) -> float:
    """ASIN, -90 to 90."""
    return _round_angle(math.degrees(math.asin(value)))


def arc_cosine(value: float) -> float:
    """ACOS, 0 to 180."""
    return _round_angle(math.degrees(math.acos(value)))


def arc_tangent(value: float) -> float:
    """ATAN of one argument, -90 to 90."""
    return _round_angle(math.degrees(math.atan(value)))


def arc_tangent_of_two(opposite: float, adjacent: float) -> float:
    """ATAN[a]/[b], 0 to 360."""
    return _round_angle(math.degrees(math.atan2(opposite, adjacent)) % 360.0)


def _round_angle(angle: float) -> float:
    """Whole angles come out whole: the inverse functions are good to 1e-13 degrees."""
    whole = float(round(angle))
    return whole if abs(angle - whole) < 1e-13 else angle


def nearest(value: float) -> float:
    """ROUND: to the nearest integer, halves away from zero."""
    return math.copysign(math.floor(abs(value) + 0.5), value)


def truncate(value: float) -> float:
    """FIX: the integer towards zero."""
    return float(math.trunc(value))


def outwards(value: float) -> float:
    """FUP: the integer away from zero."""
    return math.copysign(math.ceil(abs(value)), value)


def from_bcd(value: float) -> float:
    """BIN: four bits a decimal digit, read as that digit."""
    digits = f"{_natural(value):x}"
    return float(int(digits))


def to_bcd(value: float) -> float:
    """BCD: every decimal digit as four bits."""
    whole = _natural(value)
    if whole > LARGEST_BCD:
        raise ValueError(f"at most {LARGEST_BCD}")
    return float(int(str(whole), 16))


def _natural(value: float) -> int:
    whole = round(value)
    if whole < 0 or whole >> _INTEGER_BITS:
        raise ValueError("not a natural number of 32 bits")
    return whole


def modulus(dividend: float, divisor: float) -> float:
    """MOD of the nearest integers, with the sign of the dividend. Raises ZeroDivisionError."""
    if nearest(divisor) == 0.0:
        raise ZeroDivisionError
    return math.fmod(nearest(dividend), nearest(divisor))


def bits_and(first: float, second: float) -> float:
    """AND of the nearest integers, bit by bit."""
    return float(_bits(first) & _bits(second))


def bits_or(first: float, second: float) -> float:
    """OR of the nearest integers, bit by bit."""
    return float(_bits(first) | _bits(second))


def bits_xor(first: float, second: float) -> float:
    """XOR of the nearest integers, bit by bit."""
    return float(_bits(first) ^ _bits(second))


def _bits(value: float) -> int:
    whole = round(value)
    if abs(whole) >> _INTEGER_BITS:
        raise ValueError("not an integer of 32 bits")
    return whole


def divide(dividend: float, divisor: float) -> float:
    """/. Raises ZeroDivisionError."""
    return dividend / divisor


FUNCTIONS: dict[str, Callable[[float], float]] = {
    "SIN": sine,
    "COS": cosine,
    "TAN": tangent,
    "ASIN": arc_sine,
    "ACOS": arc_cosine,
    "ATAN": arc_tangent,
    "SQRT": math.sqrt,
    "ABS": abs,
    "ROUND": nearest,
    "FIX": truncate,
    "FUP": outwards,
    "LN": math.log,
    "EXP": math.exp,
    "BIN": from_bcd,
    "BCD": to_bcd,
}
"""functions of one argument"""

FUNCTIONS_OF_TWO: dict[str, Callable[[float, float], float]] = {
    "ATAN": arc_tangent_of_two,
    "POW": math.pow,
}
"""functions that are written with two arguments in brackets, POW[a,b]"""

COMPARISONS: dict[str, Callable[[Value, Value], bool]] = {
    # the null value differs from zero for EQ and NE alone (Fanuc custom macro, undefined variables)
    "EQ": lambda a, b: a == b,
    "NE": lambda a, b: a != b,
    "GT": lambda a, b: (a or 0.0) > (b or 0.0),
    "LT": lambda a, b: (a or 0.0) < (b or 0.0),
    "GE": lambda a, b: (a or 0.0) >= (b or 0.0),
    "LE": lambda a, b: (a or 0.0) <= (b or 0.0),
}
