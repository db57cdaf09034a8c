"""The closed forms behind the advice, against the tables of geometry.md and independent constructions."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.advice.envelope import HeadEnvelope, HobEnvelope
from twin.advice.gear_law import (
    cutting_speed,
    feed_mark,
    generating_flat,
    helix_slope,
    reference_diameter,
    roll_angle,
    swivel_widening,
    transverse_pressure_angle,
    work_rate,
)
from twin.advice.polygon_law import curvature, face, sides_cut

ALPHA = math.radians(20.0)


@pytest.mark.parametrize(
    ("width", "inserts", "q", "bow_um", "corners"),
    [
        (17.0, 3, 6, 13.04, 19.600),
        (17.0, 2, 6, -82.97, 19.822),
        (17.0, 1, 6, -194.5, 20.079),
        (17.0, 2, -6, -677.0, 21.194),
        (10.0, 2, 4, 8.63, 14.118),
    ],
)
def test_bow_and_corners_are_those_of_the_table(width, inserts, q, bow_um, corners):
    """geometry.md, section 3, R 40."""
    one = face(across_flats=width, radius=40.0, ratio=q / inserts, sides=abs(q))
    assert one is not None
    assert 1000.0 * one.bow == pytest.approx(bow_um, abs=0.5 if abs(bow_um) > 600 else 0.05)
    assert one.across_corners == pytest.approx(corners, abs=5e-4)
    assert one.concave is (bow_um < 0)
    assert sides_cut(inserts, q / inserts) == abs(q)


@given(
    width=st.floats(5.0, 60.0),
    radius=st.floats(25.0, 80.0),
    inserts=st.integers(1, 4),
    sides=st.integers(3, 12),
)
def test_the_corner_lies_on_the_path_and_the_bow_has_the_sign_of_the_curvature(width, radius, inserts, sides):
    """The corner found is a point of w(θ) = A e^(−jθ) − R e^(j(i−1)θ), sampled without the bisection."""
    ratio = sides / inserts
    one = face(across_flats=width, radius=radius, ratio=ratio, sides=sides)
    if one is None:
        return
    distance = width / 2.0 + radius
    theta = np.linspace(0.0, math.pi, 200_001)
    path = distance * np.exp(-1j * theta) - radius * np.exp(1j * (ratio - 1.0) * theta)
    crossed = np.flatnonzero(np.abs(np.angle(path)) >= math.pi / sides)[0]
    assert 2.0 * abs(path[crossed]) == pytest.approx(one.across_corners, abs=2e-2)
    kappa = curvature(width, radius, ratio)
    half = one.across_corners / 2.0 * math.sin(math.pi / sides)
    if abs(kappa) * half < 0.05:  # a flat arc: bow = −κ s²/2 to first order
        assert one.bow == pytest.approx(-kappa * half**2 / 2.0, rel=0.1, abs=1e-4)


def test_curvature_is_that_of_the_path_itself():
    """κ by finite differences of w(θ), + concave; i = 2 convex, i = 3 concave."""
    for ratio in (2.0, 3.0, 6.0, -3.0):
        distance, radius, step = 48.5, 40.0, 1e-4
        points = [
            distance * cmath.exp(-1j * t) - radius * cmath.exp(1j * (ratio - 1.0) * t)
            for t in (-step, 0.0, step)
        ]
        speed = (points[2] - points[0]) / (2.0 * step)
        bend = (points[2] - 2.0 * points[1] + points[0]) / step**2
        # the outward normal in the middle of the face is +x: a concave face bends towards it
        assert curvature(17.0, 40.0, ratio) == pytest.approx(bend.real / abs(speed) ** 2, rel=1e-5)


@pytest.mark.parametrize(
    ("module", "teeth", "starts", "gashes", "pitch_um", "bound_um"),
    [
        (2.0, 20, 1, 12, 0.586, 0.628),
        (2.5, 40, 1, 14, 0.269, 0.277),
        (2.5, 40, 2, 14, 1.076, 1.143),
        (4.0, 17, 1, 10, 1.986, 2.187),
    ],
)
def test_generating_flats_are_those_of_the_table(module, teeth, starts, gashes, pitch_um, bound_um):
    """geometry.md, section 2: at the pitch point, and one flat further."""
    base = teeth * module / 2.0 * math.cos(ALPHA)
    roll = roll_angle(radius=teeth * module / 2.0, base_radius=base)
    assert roll == pytest.approx(math.tan(ALPHA), rel=1e-12)
    for angle, um in ((roll, pitch_um), (roll + 2.0 * math.pi * starts / (gashes * teeth), bound_um)):
        flat = generating_flat(base_radius=base, roll=angle, starts=starts, gashes=gashes, teeth=teeth)
        assert 1000.0 * flat == pytest.approx(um, abs=6e-4)


@pytest.mark.parametrize(
    ("feed", "outside", "helix", "um"),
    [(1, 60, 0, 1.43), (2, 70, 0, 4.89), (3, 80, 0, 9.62), (2, 70, 20, 5.53)],
)
def test_feed_marks_are_those_of_the_table(feed, outside, helix, um):
    """geometry.md, section 2: δ_x = (f_a / cos β)² sin α_n / (4 d_a0)."""
    mark = feed_mark(feed=feed, hob_radius=outside / 2.0, pressure=ALPHA, helix=math.radians(helix))
    assert 1000.0 * mark == pytest.approx(um, abs=6e-3)


def test_a_swivel_of_the_wrong_sign_costs_what_the_text_says():
    """geometry.md, section 2: m2 z20 d_a0 70, δ = 2 γ_0: 0.159 mm."""
    error = 2.0 * math.asin(2.0 / 65.0)
    assert swivel_widening(pitch_diameter=65.0, error=error, pressure=ALPHA) == pytest.approx(0.159, abs=5e-4)


@given(beta=st.floats(-40.0, 40.0), other=st.floats(-40.0, 40.0))
def test_helix_slope_of_another_helix_angle(beta, other):
    """geometry.md, section 5: f_Hβ = L_β (tan β′ − tan β) cos α_t, and the right rate leaves none."""
    z, m, width = 30.0, 2.5, 20.0
    helix, wrong = math.radians(beta), math.radians(other)
    radius = reference_diameter(teeth=z, module=m, helix=helix) / 2.0
    rate = -math.degrees(math.tan(wrong) / radius)
    expected = width * (math.tan(wrong) - math.tan(helix))
    expected *= math.cos(transverse_pressure_angle(pressure=ALPHA, helix=helix))
    slope = helix_slope(rate=rate, teeth=z, module=m, helix=helix, pressure=ALPHA, width=width)
    assert slope == pytest.approx(expected, abs=1e-12)
    right = work_rate(teeth=z, module=m, helix=helix)
    none = helix_slope(rate=right, teeth=z, module=m, helix=helix, pressure=ALPHA, width=width)
    assert none == pytest.approx(0.0, abs=1e-12)


def test_one_lead_is_one_turn():
    """p_z = π z m_n / sin β = 367.4 mm turns the work once, backwards while Z rises (rulings, section 0)."""
    lead = math.pi * 20 * 2 / math.sin(math.radians(20.0))
    assert work_rate(teeth=20, module=2.0, helix=math.radians(20.0)) * lead == pytest.approx(-360.0)


def test_cutting_speed():
    """300 rpm at 70 mm: 65.97 m/min."""
    assert cutting_speed(diameter=70.0, rpm=-300.0) == pytest.approx(65.973, abs=1e-3)


@given(
    swivel=st.floats(-0.6, 0.6),
    distance=st.floats(36.0, 80.0),
    offset=st.floats(-30.0, 30.0),
)
def test_the_reach_of_a_hob_is_the_nearest_point_of_its_cylinder(swivel, distance, offset):
    """Against points of the cylinder: r(φ) and the place along the axis, all of them at the height asked."""
    radius = 35.0
    reach = float(
        HobEnvelope(radius=radius, swivel=swivel).reach(np.array([distance]), np.array([offset]))[0]
    )
    p = np.linspace(-radius, radius, 400_001)  # across the hob's axis, in the plane of Y and Z
    x = distance - np.sqrt(np.maximum(radius**2 - p**2, 0.0))
    if abs(math.sin(swivel)) < 1e-3:
        nearest = distance - math.sqrt(radius**2 - offset**2)
        assert reach == pytest.approx(nearest, abs=2e-3)
        return
    y = (offset * math.cos(swivel) - p) / math.sin(swivel)
    assert reach == pytest.approx(np.hypot(x, y).min(), abs=2e-3)


def test_the_reach_of_a_head_is_a_ring_of_its_edge_width():
    head = HeadEnvelope(radius=40.0, width=2.0)
    reach = head.reach(np.array([48.5]), np.array([-1.01, -1.0, 0.0, 1.0, 1.01]))
    assert reach.tolist() == [math.inf, 8.5, 8.5, 8.5, math.inf]
