"""The corrections of a gap, by where they put the gap: on the tool's line, its root on the tool's tip."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from twin.probing.circle import Circle
from twin.probing.errors import ProbingError
from twin.probing.law import patent_correction, plain_correction, turned_correction

sizes = {
    "e": st.floats(0, 3),
    "phase": st.floats(-10, 10),
    "gap": st.floats(-20, 20),
    "radius": st.floats(5, 100),
}


def circle(e, phase):
    return Circle(x=e * math.cos(phase), y=e * math.sin(phase), radius=30.0)


def placed(e, phase, gap, radius, c):
    """O1 and A after C has turned the work by `c`, as complex numbers."""
    turn = np.exp(1j * np.asarray(c))
    centre = e * np.exp(1j * phase) * turn
    return centre, centre + radius * np.exp(1j * gap) * turn


@given(**sizes)
def test_the_plain_form_puts_the_gap_before_the_tool(e, phase, gap, radius):
    """O1 A lies along X, at the tool's Y, and A as far beyond the root circle as X was moved."""
    found = plain_correction(circle(e, phase), np.array([gap]))
    centre, root = placed(e, phase, gap, radius, found.c)
    assert (root - centre).imag == pytest.approx(0.0, abs=1e-10)
    assert (root - centre).real == pytest.approx(radius)
    assert root.imag == pytest.approx(found.y, abs=1e-10)
    assert root.real == pytest.approx(radius + found.x, abs=1e-10)


@given(**sizes)
def test_the_patents_form_is_the_same(e, phase, gap, radius):
    assume(e < 0.99 * radius)
    patent = patent_correction(circle(e, phase), np.array([gap]), radius)
    plain = plain_correction(circle(e, phase), np.array([gap]))
    for name in ("c", "x", "y"):
        assert getattr(patent, name) == pytest.approx(getattr(plain, name), abs=1e-9)


@given(**sizes)
def test_without_y_the_point_lies_on_x_and_the_line_is_off_by_beta(e, phase, gap, radius):
    assume(e < 0.99 * radius)
    found = turned_correction(circle(e, phase), np.array([gap]), radius)
    centre, point = placed(e, phase, gap, radius, found.c)
    assert point.imag == pytest.approx(0.0, abs=1e-9)
    assert point.real == pytest.approx(radius + found.x, abs=1e-9)
    assert np.angle((point - centre) * np.exp(1j * found.beta)) == pytest.approx(0.0, abs=1e-9)
    assert abs(found.beta[0]) <= math.asin(min(e / radius, 1.0)) + 1e-12


def test_worked_figures():
    """e 0.05 mm at φ 90°, gap at ψ 0, m3 z30 (r 45, r_f 41.25): Y 0.05, X 0; β = e / r_f = 1.2 mrad."""
    one = np.array([0.0])
    plain = plain_correction(circle(0.05, math.pi / 2), one)
    assert (plain.x[0], plain.y[0]) == pytest.approx((0.0, 0.05), abs=1e-15)
    patent = patent_correction(circle(0.05, math.pi / 2), one, 41.25)
    assert patent.beta[0] == pytest.approx(0.05 / 41.25, rel=1e-5)
    assert patent.alpha[0] == pytest.approx(math.pi / 2 - 0.05 / 41.25, abs=1e-8)
    turned = turned_correction(circle(0.05, math.pi / 2), one, 41.25)
    assert math.degrees(turned.c[0]) == pytest.approx(-0.06945, abs=1e-5)
    assert 6.0 * turned.beta[0] * 1e3 == pytest.approx(7.27, abs=0.01)  # [µm] over 6 mm of flank


def test_an_eccentricity_beyond_the_root_circle_is_refused():
    for law in (patent_correction, turned_correction):
        with pytest.raises(ProbingError, match=r"measured is 42 mm.*41\.25 mm"):
            law(circle(42.0, 1.0), np.zeros(3), 41.25)
