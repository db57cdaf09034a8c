"""Slope, form, crowning and the Gaussian filter against their closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.inspection.trace import cut_off, evaluate, figures, smoothing

POINTS = np.linspace(3.0, 11.0, 480)
LIMITS = (3.0, 11.0)


@given(
    level=st.floats(-50, 50),
    rise=st.floats(-50, 50),
    crown=st.floats(-30, 30),
    sense=st.sampled_from([1, -1]),
)
def test_line_and_parabola_are_returned(level, rise, crown, sense):
    u = np.linspace(-1, 1, len(POINTS))
    found = figures(POINTS, level + rise / 2 * u - crown * u**2, LIMITS, sense=sense)
    assert found.slope_um == pytest.approx(sense * rise, abs=1e-9)
    assert found.crowning_um == pytest.approx(crown, abs=1e-9)
    # the points straddle the parabola's middle
    assert found.form_um == pytest.approx(abs(crown), rel=1e-4, abs=1e-9)


def test_cut_off_is_a_thirtieth_but_not_below_a_quarter_millimetre():
    assert cut_off((0.0, 18.0)) == pytest.approx(0.6)
    assert cut_off((2.0, 8.0)) == 0.25


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0, 5.0])
def test_a_wave_passes_as_the_gaussian_says(ratio):
    """ISO 16610-21: a1/a0 = exp(-pi (alpha lambda_c / lambda)²), one half at the cut-off."""
    smooth = smoothing(POINTS, 0.4)
    length = 0.4 * ratio
    passed = np.exp(-math.pi * (0.4697 / ratio) ** 2)
    middle = np.abs(POINTS - 7.0) < 2.0
    for wave in (np.sin, np.cos):
        shown = smooth @ wave(2 * math.pi * POINTS / length)
        expected = passed * wave(2 * math.pi * POINTS / length)
        np.testing.assert_allclose(shown[middle], expected[middle], atol=1e-3)
    if ratio == 1.0:
        assert passed == pytest.approx(0.5, abs=1e-4)


def test_a_line_passes_up_to_the_very_ends():
    np.testing.assert_allclose(smoothing(POINTS, 0.4) @ (3 - 7 * POINTS), 3 - 7 * POINTS, atol=1e-9)


def test_few_holes_are_bridged_and_many_leave_no_trace():
    y = 2.0 * POINTS[:, None] * np.ones((1, 2))
    y[100:104, 0] = np.nan
    y[100:140, 1] = np.nan
    bridged, torn = evaluate(POINTS, y, np.zeros_like(y), LIMITS, teeth=(0, 1), sense=1.0)
    assert torn is None
    assert bridged.slope_um == pytest.approx(16.0)
    assert bridged.filtered.slope_um == pytest.approx(16.0)
    assert len(bridged.position) == 476
