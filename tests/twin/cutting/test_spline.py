"""The cubic through points, against scipy's."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from twin.cutting.regular.spline import Spline


@pytest.mark.parametrize("count", [4, 5, 57])
@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_it_is_the_spline_of_scipy(count, derivative):
    rng = np.random.default_rng(count)
    at = np.cumsum(rng.uniform(0.1, 2.0, count))
    points = rng.normal(size=(count, 2))
    where = np.concatenate([at, rng.uniform(at[0], at[-1], 200)])
    found = Spline.through(at, points)(where, derivative)
    expected = CubicSpline(at, points)(where, derivative)
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())


def test_a_cubic_is_itself():
    at = np.array([0.0, 0.3, 1.1, 1.9, 2.0, 4.0])
    where = np.linspace(0.0, 4.0, 33)
    spline = Spline.through(at, np.column_stack([at**3, 1.0 - at]))
    assert spline(where) == pytest.approx(np.column_stack([where**3, 1.0 - where]), abs=1e-12)
    assert spline(1.5, 2) == pytest.approx([9.0, 0.0], abs=1e-11)
