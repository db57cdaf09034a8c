import math

import manifold3d as m3
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.errors import InputError
from twin.inspection.involute import geometry, inverse_involute
from twin.inspection.nominal import GearNominal

# the tables of geometry.md, section 1
TABLE = [
    (1, 30, 0, 30, 28.19078, 4, 10.75263),
    (2, 20, 0, 40, 37.58770, 3, 15.32088),
    (2.5, 40, 20, 106.41778, 99.23406, 6, 42.26384),
]


@pytest.mark.parametrize("row", TABLE)
def test_reference_table(row):
    module, teeth, helix, d, d_b, k, span = row
    gear = geometry(GearNominal(number_of_teeth=teeth, normal_module_mm=module, helix_angle_deg=helix))
    assert gear.reference_diameter == pytest.approx(d, abs=5e-6)
    assert gear.base_diameter == pytest.approx(d_b, abs=5e-6)
    assert gear.span_teeth() == k
    assert gear.span(k) == pytest.approx(span, abs=5e-6)


def test_form_diameter_of_geometry_md():
    gear = geometry(GearNominal(number_of_teeth=20, normal_module_mm=2.0))
    assert gear.form_diameter == pytest.approx(37.640133, abs=5e-7)


@given(
    teeth=st.integers(18, 200),
    module=st.floats(0.3, 20),
    helix=st.floats(-40, 40),
    shift=st.floats(0, 0.8),
)
def test_laws_agree_with_each_other(teeth, module, helix, shift):
    gear = geometry(
        GearNominal(
            number_of_teeth=teeth, normal_module_mm=module, helix_angle_deg=helix, profile_shift=shift
        )
    )
    r = gear.reference_diameter / 2
    # tooth thickness at d: s_t = (pi/2 + 2 x tan alpha_n) m_n / cos beta
    thickness = (math.pi / 2 + 2 * shift * math.tan(gear.pressure)) * module / math.cos(gear.helix)
    assert 2 * r * gear.half_tooth(r) == pytest.approx(thickness, rel=1e-12)
    # the span is k - 1 base pitches and one base thickness, tilted by the base helix
    base_pitch = 2 * math.pi * gear.base_radius / teeth * math.cos(gear.base_helix)
    base_thickness = (
        2 * gear.base_radius * float(gear.half_tooth(gear.base_radius)) * math.cos(gear.base_helix)
    )
    k = gear.span_teeth()
    assert gear.span(k) == pytest.approx((k - 1) * base_pitch + base_thickness, rel=1e-12)
    # base and reference helix have one lead
    assert gear.twist == pytest.approx(math.tan(gear.base_helix) / gear.base_radius, rel=1e-12, abs=1e-15)
    assert gear.twist == pytest.approx(math.tan(gear.helix) / r, rel=1e-12, abs=1e-15)
    assert gear.radius_at(gear.roll_length(2 * r)) == pytest.approx(r, rel=1e-12)


@pytest.mark.parametrize("teeth", [8, 10, 18, 25])
def test_form_diameter_is_where_a_rolled_rack_leaves_the_involute(teeth):
    """The gap that a rack with a rounded tip leaves, pose by pose, as one boolean union."""
    module, alpha = 3.0, math.radians(20)
    gear = geometry(GearNominal(number_of_teeth=teeth, normal_module_mm=module))
    r, rho = module * teeth / 2, 0.38 * module
    phi = np.linspace(alpha, math.pi / 2, 60)
    centre_x = (
        math.pi * module / 4 - 1.25 * module * math.tan(alpha) - rho * (1 - math.sin(alpha)) / math.cos(alpha)
    )
    corner = np.column_stack([centre_x + rho * np.cos(phi), r - 1.25 * module + rho * (1 - np.sin(phi))])
    right = np.vstack([[math.pi * module / 4 + 2 * module * math.tan(alpha), r + 2 * module], corner])
    rack = np.vstack([right, right[::-1] * [-1, 1]])[::-1]
    poses = []
    for turn in np.radians(np.arange(-50, 50, 0.2)):
        back = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
        poses.append(m3.CrossSection([(rack + np.array([turn * r, 0.0])) @ back], m3.FillRule.Positive))
    outline = np.vstack(m3.CrossSection.batch_boolean(poses, m3.OpType.Add).to_polygons())
    radius, angle = np.hypot(*outline.T), np.arctan2(*outline.T)
    flank = (angle > 0) & (radius > gear.base_radius) & (radius < r + 0.9 * module)
    gap = math.pi / teeth - gear.half_tooth(radius[flank])
    missing_um = 1000 * gear.base_radius * np.abs(angle[flank] - gap)
    at = 2 * radius[flank]
    assert missing_um[at > gear.form_diameter].max() < 0.2
    if teeth < 17:  # undercut: the involute ends above the base circle
        below = at < gear.form_diameter - 0.03
        assert gear.form_diameter > gear.base_diameter
        assert missing_um[below].min() > 0.5


@given(st.floats(0.01, 1.5))
def test_inverse_involute(angle):
    assert inverse_involute(math.tan(angle) - angle) == pytest.approx(angle, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"number_of_teeth": 2}, "number_of_teeth is 2"),
        ({"normal_module_mm": float("nan")}, "normal_module_mm is nan"),
        ({"helix_angle_deg": 90.0}, "helix_angle_deg is 90.0"),
        ({"tip_diameter_mm": 30.0}, "leave no tooth flank"),
        ({"dedendum_factor": 5.0, "number_of_teeth": 5, "tip_diameter_mm": None}, "leave no tooth flank"),
    ],
)
def test_impossible_nominal_is_refused(change, words):
    values = {"number_of_teeth": 20, "normal_module_mm": 2.0} | change
    with pytest.raises(InputError, match=words):
        geometry(GearNominal(**values))
