"""The functions of custom macro B against their definitions."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.language.macro import functions as f

ANGLES = st.floats(-1e4, 1e4, allow_nan=False)
NUMBERS = st.floats(-1e6, 1e6, allow_nan=False)


@given(ANGLES)
def test_trigonometry_is_that_of_degrees(angle: float) -> None:
    """Pythagoras, the quotient, and Euler's formula of the standard library."""
    assert f.sine(angle) ** 2 + f.cosine(angle) ** 2 == pytest.approx(1.0, abs=1e-12)
    turn = complex(math.cos(math.radians(angle)), math.sin(math.radians(angle)))
    assert complex(f.cosine(angle), f.sine(angle)) == pytest.approx(turn, abs=1e-11)
    if abs(f.cosine(angle)) > 1e-3:
        assert f.tangent(angle) * f.cosine(angle) == pytest.approx(f.sine(angle), abs=1e-12)


@pytest.mark.parametrize(
    ("angle", "sine", "cosine"),
    [(0, 0, 1), (30, 0.5, None), (60, None, 0.5), (90, 1, 0), (180, 0, -1), (270, -1, 0), (-30, -0.5, None)],
)
def test_round_angles_are_exact(angle: float, sine: float | None, cosine: float | None) -> None:
    assert sine is None or f.sine(angle) == sine
    assert cosine is None or f.cosine(angle) == cosine


def test_tangent() -> None:
    assert (f.tangent(45), f.tangent(-45), f.tangent(225), f.tangent(0)) == (1.0, -1.0, 1.0, 0.0)
    for angle in (90.0, -90.0, 270.0):
        with pytest.raises(ValueError, match="right angle"):
            f.tangent(angle)


@given(st.floats(-89.9, 89.9))
def test_inverse_functions(angle: float) -> None:
    assert f.arc_sine(f.sine(angle)) == pytest.approx(angle, abs=1e-6)
    assert f.arc_tangent(f.tangent(angle)) == pytest.approx(angle, abs=1e-9)
    assert f.arc_cosine(f.cosine(angle)) == pytest.approx(abs(angle), abs=1e-5)


@given(st.floats(0, 359.99), st.floats(0.1, 1000))
def test_arc_tangent_of_two_finds_every_quadrant(angle: float, radius: float) -> None:
    found = f.arc_tangent_of_two(radius * f.sine(angle), radius * f.cosine(angle))
    assert math.remainder(found - angle, 360.0) == pytest.approx(0.0, abs=1e-9)
    assert 0.0 <= found < 360.0


@given(NUMBERS)
def test_rounding(value: float) -> None:
    """FIX towards zero, FUP away from it, ROUND to the nearer of the two, halves outwards."""
    inner, outer, nearest = f.truncate(value), f.outwards(value), f.nearest(value)
    assert abs(inner) <= abs(value) <= abs(outer) < abs(inner) + 1.0 + 1e-9
    assert inner * value >= 0.0 and outer * value >= 0.0
    assert abs(nearest - value) <= 0.5
    assert nearest in (inner, outer)
    assert (f.nearest(2.5), f.nearest(-2.5), f.nearest(0.4)) == (3.0, -3.0, 0.0)


@given(st.integers(0, 99_999_999))
def test_bcd_is_the_decimal_digits_in_four_bits_each(number: int) -> None:
    packed = sum(int(digit) << 4 * k for k, digit in enumerate(reversed(str(number))))
    assert f.to_bcd(float(number)) == packed
    assert f.from_bcd(float(packed)) == number


def test_bcd_out_of_range() -> None:
    for wrong in (0x1A, -1, 2**33):
        with pytest.raises(ValueError, match=r"invalid literal|natural"):
            f.from_bcd(float(wrong))
    with pytest.raises(ValueError, match="at most"):
        f.to_bcd(1e8)


@given(st.integers(-(10**6), 10**6), st.integers(-(10**4), 10**4).filter(bool))
def test_modulus_leaves_the_rest_of_an_integer_division(a: int, b: int) -> None:
    """a = b · k + rest with |rest| < |b| and the sign of a."""
    rest = f.modulus(float(a), float(b))
    assert (a - rest) % b == 0
    assert abs(rest) < abs(b)
    assert rest * a >= 0


@given(st.integers(0, 2**32 - 1), st.integers(0, 2**32 - 1))
def test_bits(a: int, b: int) -> None:
    both, either, one = (int(law(a, b)) for law in (f.bits_and, f.bits_or, f.bits_xor))
    assert both + either == a + b
    assert either - both == one


@pytest.mark.parametrize(
    ("name", "table"),
    [
        ("EQ", (True, False, False)),
        ("NE", (False, True, True)),
        ("GE", (True, True, True)),
        ("LE", (True, True, True)),
        ("GT", (False, False, False)),
        ("LT", (False, False, False)),
    ],
)
def test_null_value_in_comparisons(name: str, table: tuple[bool, bool, bool]) -> None:
    """The null value equals itself alone, and counts as 0 where size is compared."""
    law = f.COMPARISONS[name]
    assert (law(None, None), law(None, 0.0), law(0.0, None)) == table
