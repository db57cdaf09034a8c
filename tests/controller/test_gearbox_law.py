"""The gear box law against group laws, closed forms and hand-worked numbers."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.laws.gearbox import GearBox, SyncKind, helix_rate, helix_rate_inch, polygon_rate, slave_travel


def box(numerator: int, denominator: int) -> GearBox:
    return GearBox(kind=SyncKind.HOBBING, master=0, slave=1, numerator=numerator, denominator=denominator)


starts = st.integers(-1000, 1000).filter(bool)
teeth = st.integers(1, 1000)
counts = st.integers(-(10**9), 10**9)


def test_t20_l1_turns_the_work_18_degrees() -> None:
    """Hobbing, 编程示例, N0030."""
    assert slave_travel(box(1, 20), 360.0) == 18.0


def test_p2_q6_turns_the_tool_three_times() -> None:
    """Polygon, 编程示例, N0030."""
    assert slave_travel(box(6, 2), 360.0) == 1080.0


@given(starts, teeth)
def test_a_million_turns_are_exact(numerator: int, denominator: int) -> None:
    """Rulings, section 2: after 10⁶ hob turns the commanded error is zero, for every T and L."""
    turns = 1_000_000 * denominator
    assert slave_travel(box(numerator, denominator), 360.0 * turns) == 360.0 * 1_000_000 * numerator


@given(starts, teeth, st.floats(-4e8, 4e8))
def test_the_error_is_rounding_whatever_the_distance(numerator: int, denominator: int, master: float) -> None:
    """Against exact rational arithmetic: never more than two roundings."""
    exact = Fraction(master) * numerator / denominator
    error = abs(Fraction(slave_travel(box(numerator, denominator), master)) - exact)
    assert error <= 2 * Fraction(math.ulp(float(exact)))


@given(starts, teeth, counts, counts)
def test_travel_is_additive(numerator: int, denominator: int, first: int, second: int) -> None:
    """Group law: going a, then b, is going a + b; there and back is nowhere."""
    gear = box(numerator, denominator)
    whole = slave_travel(gear, float((first + second) * denominator))
    assert (
        slave_travel(gear, float(first * denominator)) + slave_travel(gear, float(second * denominator))
        == whole
    )
    assert slave_travel(gear, float(first)) + slave_travel(gear, float(-first)) == 0.0


@given(starts, teeth, starts, teeth, st.integers(-1000, 1000))
def test_ratios_compose(l1: int, t1: int, l2: int, t2: int, turns: int) -> None:
    """Two gear boxes in series are one with the product of the ratios."""
    master = float(turns * t1 * t2)
    in_series = slave_travel(box(l2, t2), slave_travel(box(l1, t1), master))
    assert in_series == pytest.approx(slave_travel(box(l1 * l2, t1 * t2), master), rel=1e-14)


@given(starts, teeth, st.floats(1e-3, 1e8) | st.floats(-1e8, -1e-3))
def test_sense(numerator: int, denominator: int, master: float) -> None:
    """Rulings, section 2: sgn(C) = sgn(L) · sgn(S); the opposite L is the mirror image."""
    gear, mirror = box(numerator, denominator), box(-numerator, denominator)
    assert slave_travel(gear, master) == -slave_travel(mirror, master)
    assert np.sign(slave_travel(gear, master)) == np.sign(numerator) * np.sign(master)


@given(st.integers(12, 80), st.floats(0.5, 10.0), st.floats(1.0, 60.0))
def test_one_lead_of_axial_travel_is_one_turn_of_the_work(z: int, module: float, beta: float) -> None:
    """Hobbing, 斜齿轮加工, against the lead of ISO 21771, p_z = π z m_n / sin β: right-hand, ΔC < 0 for
    ΔZ > 0."""
    lead = math.pi * z * module / math.sin(math.radians(beta))
    rate = helix_rate(teeth=z, normal_module=module, helix_angle=beta, sense=-1)
    assert rate * lead == pytest.approx(-360.0, rel=1e-12)
    assert helix_rate(teeth=z, normal_module=module, helix_angle=-beta, sense=-1) == -rate


def test_hand_worked_helical_compensation() -> None:
    """m 2, z 20, β 20°, 20 mm: 360 · 20 · 0.342020143 / (π · 20 · 2) = 19.5963°."""
    rate = helix_rate(teeth=20, normal_module=2.0, helix_angle=20.0, sense=-1)
    assert 20.0 * rate == pytest.approx(-19.59631, abs=5e-5)


def test_inch_and_metric_describe_the_same_gear() -> None:
    """Hobbing, 英制输入: ΔC = 360 ΔZ Q sin P / (π T) with ΔZ in inch, Q in 1/inch."""
    delta_inch = 1.5
    by_formula = 360.0 * delta_inch * 12.7 * math.sin(math.radians(15.0)) / (math.pi * 30)
    rate = helix_rate_inch(teeth=30, diametral_pitch=12.7, helix_angle=15.0, sense=1)
    assert rate * delta_inch * 25.4 == pytest.approx(by_formula, rel=1e-12)
    assert rate == pytest.approx(
        helix_rate(teeth=30, normal_module=2.0, helix_angle=15.0, sense=1), rel=1e-12
    )


@pytest.mark.parametrize(
    ("cutters", "sides", "lead", "shift"), [(3, 6, 100.0, 720.0), (2, 6, -50.0, -1080.0)]
)
def test_helical_polygon(cutters: int, sides: int, lead: float, shift: float) -> None:
    """Rulings, section 3: over |A| of Z travel the tool is shifted by as much as one turn of the work
    gives it."""
    assert polygon_rate(sides=sides, cutters=cutters, lead=lead) * abs(lead) == pytest.approx(shift)
