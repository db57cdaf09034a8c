"""Both circle fits against points of known circles, and the uncertainty against many measurements."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.probing.centre import find_centre
from twin.probing.circle import geometric_circle, patent_circle, touched_points
from twin.probing.errors import ProbingError


def around(n, x, y, radius, start=0.0):
    angle = start + 2 * math.pi * np.arange(n) / n
    return np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])


@pytest.mark.parametrize("fit", [patent_circle, geometric_circle])
@given(
    e=st.floats(0, 5),
    phase=st.floats(-math.pi, math.pi),
    radius=st.floats(10, 200),
    n=st.integers(3, 40),
    start=st.floats(0, 6),
)
def test_points_of_a_circle_give_that_circle(fit, e, phase, radius, n, start):
    found = fit(around(n, e * math.cos(phase), e * math.sin(phase), radius, start))
    assert found.x == pytest.approx(e * math.cos(phase), abs=1e-9 * radius)
    assert found.y == pytest.approx(e * math.sin(phase), abs=1e-9 * radius)
    assert found.radius == pytest.approx(radius, rel=1e-10)
    assert found.eccentricity == pytest.approx(e, abs=2e-9 * radius)


def test_three_points_by_hand():
    """(0,0), (4,0), (0,2): the middle of the hypotenuse, (2, 1), radius √5."""
    found = patent_circle(np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 2.0]]))
    assert (found.x, found.y, found.radius) == pytest.approx((2.0, 1.0, math.sqrt(5.0)), abs=1e-12)


@pytest.mark.parametrize(
    ("x", "y", "deg"), [(1, 1, 45), (-1, 1, 135), (-1, -1, -135), (1, -1, -45), (-1, 1e-3, 179.9427)]
)
def test_the_quadrant_is_kept(x, y, deg):
    """The original's arctan(x1/y1) would give 45, -45, 45, -45 and -89.9."""
    assert math.degrees(geometric_circle(around(8, x, y, 40.0)).phase) == pytest.approx(deg, abs=1e-4)


def test_gamma_turns_against_c():
    """A work whose axis stands at 0.05 mm and 70° is touched at C = 0, 45°, …; along X the band is met at
    e cos(70° + C) + √(R² − e² sin²(70° + C)) from the spindle's axis."""
    e, phase, radius = 0.05, math.radians(70.0), 38.0
    c = 2 * math.pi * np.arange(8) / 8
    readings = e * np.cos(phase + c) + np.sqrt(radius**2 - (e * np.sin(phase + c)) ** 2)
    found = geometric_circle(touched_points(readings, c))
    assert (found.eccentricity, found.phase) == pytest.approx((e, phase), abs=1e-12)
    mirrored = geometric_circle(touched_points(readings, -c))
    assert mirrored.phase == pytest.approx(-phase, abs=1e-9)


def test_a_constant_offset_changes_the_radius_alone():
    """Of ball radius or X zero: the centre moves by e d/R at most in second order of e."""
    e, phase, radius, offset = 0.05, 2.0, 38.0, 2.0
    c = 2 * math.pi * np.arange(12) / 12
    readings = e * np.cos(phase + c) + np.sqrt(radius**2 - (e * np.sin(phase + c)) ** 2)
    found = geometric_circle(touched_points(readings + offset, c))
    assert (found.x, found.y) == pytest.approx((e * math.cos(phase), e * math.sin(phase)), abs=1e-6)
    assert found.radius == pytest.approx(radius + offset, abs=1e-6)


def test_the_two_fits_differ_as_their_aims_do():
    """On an arc with noise each is the better one by its own measure, checked against small steps aside."""
    rng = np.random.default_rng(5)
    angle = np.linspace(0, 2.0, 30)
    points = np.column_stack([np.cos(angle), np.sin(angle)]) * (20 + 0.1 * rng.standard_normal(30))[:, None]
    patent, geometric = patent_circle(points), geometric_circle(points)

    def algebraic(x, y, r):
        return (((points - [x, y]) ** 2).sum(axis=1) - r * r) @ (((points - [x, y]) ** 2).sum(axis=1) - r * r)

    def distances(x, y, r):
        return ((np.hypot(*(points - [x, y]).T) - r) ** 2).sum()

    for measure, best in ((algebraic, patent), (distances, geometric)):
        least = measure(best.x, best.y, best.radius)
        for step in np.vstack([np.eye(3), -np.eye(3)]) * 1e-4:
            assert measure(best.x + step[0], best.y + step[1], best.radius + step[2]) > least
    assert abs(patent.radius - geometric.radius) > 1e-4


def test_the_stated_uncertainty_holds_the_centre_in_95_of_100():
    rng = np.random.default_rng(1)
    e, scatter, n = 0.05, 0.001, 24
    inside, spread = 0, []
    for _ in range(600):
        angle = 2 * math.pi * np.arange(n) / n
        reach = 40.0 + scatter * rng.standard_normal(n)
        points = np.column_stack([e + reach * np.cos(angle), reach * np.sin(angle)])
        found = find_centre(points)
        off = math.hypot(found.geometric.x - e, found.geometric.y)
        inside += off <= found.uncertainty_mm
        spread.append(found.geometric.x)
    assert 0.92 < inside / 600 < 0.975
    # equally spaced: variance of the centre 2 σ² / n
    assert np.std(spread) == pytest.approx(scatter * math.sqrt(2 / n), rel=0.1)


def test_three_points_have_the_uncertainty_of_the_probe():
    found = find_centre(around(3, 0.05, 0.0, 40.0), repeatability_mm=0.001)
    assert found.out_of_round_mm == pytest.approx(0.0, abs=1e-9)
    assert found.covariance == pytest.approx(np.eye(2) * 2e-6 / 3, abs=1e-9)
    assert found.uncertainty_mm == pytest.approx(2.448 * 1e-3 * math.sqrt(2 / 3), rel=1e-3)


@pytest.mark.parametrize(
    ("points", "said"),
    [
        (np.zeros((0, 2)), "0 touched point"),
        (np.array([[1.0, 0.0], [0.0, 1.0]]), r"2 touched point.*3 or more"),
        (np.array([[1.0, 1.0], [2.0, 2.0], [5.0, 5.0]]), "on one line: 4.163 mm along"),
        (np.full((5, 2), 3.0), "on one line"),
        (np.array([[1.0, 0.0], [0.0, np.nan], [2.0, 2.0]]), "no finite number"),
    ],
)
def test_points_that_make_no_circle_are_refused(points, said):
    for fit in (patent_circle, geometric_circle, find_centre):
        with pytest.raises(ProbingError, match=said):
            fit(points)


@pytest.mark.parametrize(
    ("e", "form", "refused"),
    [(0.2, 0.049, False), (0.2, 0.051, True), (0.04, 0.019, False), (0.04, 0.021, True)],
)
def test_a_band_out_of_round_is_refused_with_figures(e, form, refused):
    """An ellipse of that peak-to-valley: e/4 or 0.02 mm, whichever is larger, is allowed."""
    angle = 2 * math.pi * np.arange(16) / 16
    reach = 40.0 + form / 2 * np.cos(2 * angle)
    points = np.column_stack([e + reach * np.cos(angle), reach * np.sin(angle)])
    if not refused:
        assert find_centre(points).out_of_round_mm == pytest.approx(form, rel=0.01)
        return
    with pytest.raises(ProbingError, match=rf"out of round by {form * 1e3:.0f}\.\d µm.*eccentricity is"):
        find_centre(points)
