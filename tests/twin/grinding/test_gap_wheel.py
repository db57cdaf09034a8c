"""Wheel profiles against the surface that the whole wheel sweeps, seen along the helix.

A point of the wheel at height z, taken back along the helix into the transverse plane, is a point of what the
wheel leaves there. All points of the wheel must stay within the wanted gap, and each ring of its flank must
touch the flank somewhere: the distance from an involute is r_b times the angle that the point is off it.
"""

import math

import numpy as np
import pytest

from twin.errors import InputError
from twin.grinding.gap import gap_of
from twin.grinding.wheel import GapWheel, touching, wheel_profile
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal


def rings(half, rho, gear, swivel, distance, count=40_001):
    """(n, m) complex: every ring of the wheel's one side, taken along the helix to z = 0."""
    phi = np.linspace(-0.9, 0.9, count)
    axis = np.array([0.0, -math.cos(swivel), math.sin(swivel)])
    inward = np.array([-1.0, 0.0, 0.0])
    across = np.cross(axis, inward)
    towards = np.cos(phi)[:, None] * inward + np.sin(phi)[:, None] * across
    points = [distance, 0.0, 0.0] + half[:, None, None] * -axis + rho[:, None, None] * towards
    turned = np.exp(-1j * gear.twist * points[..., 2])
    return (points[..., 0] + 1j * points[..., 1]) * turned


def beyond_flank(section, gear):
    """(n, m) how far points outside the base circle lie beyond the wanted flank, + = into the tooth."""
    r, angle = np.abs(section), np.abs(np.angle(section))
    return gear.base_radius * (angle - math.pi / gear.teeth + gear.half_tooth(r))


CASES = [(30, 3.0, 0.0, 60.0), (30, 3.0, 15.0, 60.0), (30, 3.0, -15.0, 40.0), (17, 2.0, 20.0, 30.0),
         (80, 1.0, 30.0, 80.0), (40, 2.5, -35.0, 100.0), (20, 2.0, 30.0, 60.0)]  # fmt: skip


@pytest.mark.parametrize(("teeth", "module", "helix", "radius"), CASES)
def test_the_wheel_touches_the_flank_all_along_and_crosses_it_nowhere(teeth, module, helix, radius):
    nominal = GearNominal(number_of_teeth=teeth, normal_module_mm=module, helix_angle_deg=helix)
    gear = geometry(nominal)
    gap = gap_of(gear)
    distance = gap.root_radius + radius
    roll = np.linspace(gap.roll_at(gear.form_diameter / 2), gap.roll_at(gear.tip_diameter / 2), 25)
    half, rho = touching(*gap.flank(roll), gear.twist, gear.helix, distance)
    beyond = beyond_flank(rings(half, rho, gear, gear.helix, distance), gear).max(axis=1)
    assert np.abs(beyond).max() < 2e-6  # the rings' own steps are 1e-6 of a millimetre deep
    if helix == 0:
        assert half == pytest.approx(gap.flank(roll)[0][:, 1], abs=1e-12)
        assert radius - rho == pytest.approx(gap.flank(roll)[0][:, 0] - gap.root_radius, abs=1e-12)


@pytest.mark.parametrize(("teeth", "module", "helix", "radius"), CASES)
def test_the_dressed_outline_stays_within_its_chords(teeth, module, helix, radius):
    """The straight steps of the wheel overcut the flank by up to the chord asked for and no more; nothing of
    its root crosses the flank."""
    gear = geometry(GearNominal(number_of_teeth=teeth, normal_module_mm=module, helix_angle_deg=helix))
    gap = gap_of(gear)
    chord = 1e-3
    profile = wheel_profile(gap, gear, radius, chord=chord, beyond=0.3 * module)
    depth = np.linspace(0.0, profile[-1][1], 700)
    half = np.interp(depth, [p[1] for p in profile], [p[0] for p in profile])
    section = rings(half, radius - depth, gear, gear.helix, gap.root_radius + radius, 8001)
    r = np.abs(section)
    beyond = np.where(r > gear.form_diameter / 2, beyond_flank(section, gear), -1.0)
    deepest, at = beyond.max(axis=1), r[np.arange(len(r)), beyond.argmax(axis=1)]
    # the chord stands normal to the flank, the section lies across the work's axis
    assert deepest.max() * math.cos(gear.base_helix) < 1.01 * chord
    on_flank = (at > gear.form_diameter / 2 + 0.1 * module) & (at < gear.tip_diameter / 2)
    assert on_flank.sum() > 100
    assert deepest[on_flank].min() > -1e-5
    # the root is no deeper than wanted
    assert np.abs(section).min() > gap.root_radius - 1e-3


def test_a_gap_joins_its_parts_smoothly_on_the_nominal_involute():
    for teeth in (12, 17, 24, 30, 80):
        gear = geometry(GearNominal(number_of_teeth=teeth, normal_module_mm=2.0, helix_angle_deg=10.0))
        gap = gap_of(gear)
        fillet, along = gap.fillet(40)
        assert fillet[0, 0] == pytest.approx(gap.root_radius, abs=1e-12)
        assert along[0] == pytest.approx([0.0, 1.0], abs=1e-12)
        foot, upward = gap.flank(np.array([gap.first_roll]))
        assert along[-1] == pytest.approx(upward[0], abs=1e-9)
        step = foot[0] - fillet[-1]
        assert step[0] * upward[0, 1] == pytest.approx(step[1] * upward[0, 0], abs=1e-9)
        points, _ = gap.flank(np.linspace(gap.first_roll, 5.0, 20))
        r, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
        assert angle == pytest.approx(math.pi / teeth - gear.half_tooth(r), abs=1e-12)
        assert math.hypot(gap.base_radius, gap.first_roll) <= gear.form_diameter / 2 + 1e-9


def test_stock_stands_on_the_flank_along_its_normal():
    """0.1 mm normal to the flank is 0.1 / cos β_b in the transverse section, along the line of action."""
    gear = geometry(GearNominal(number_of_teeth=30, normal_module_mm=3.0, helix_angle_deg=15.0))
    roll = np.linspace(3.0, 20.0, 9)
    reach = 0.1 / math.cos(gear.base_helix)
    # along the line of action, which is tangent to the base circle and grows the roll length
    near, far = gap_of(gear).flank(roll)[0], gap_of(gear, stock=0.1).flank(roll + reach)[0]
    assert np.hypot(*(far - near).T) == pytest.approx(reach, rel=1e-9)
    assert gap_of(gear, stock=0.1).root_radius == pytest.approx(gear.root_diameter / 2 + 0.1)


def test_dressing_errors_widen_the_wheel_by_what_they_say():
    nominal = GearNominal(number_of_teeth=30, normal_module_mm=3.0)
    true = GapWheel(outside_diameter_mm=120.0).dressed(nominal).profile
    wide = GapWheel(outside_diameter_mm=120.0, dressing_width_um=5.0).dressed(nominal).profile
    slope = GapWheel(outside_diameter_mm=120.0, dressing_slope_um=6.75).dressed(nominal).profile
    assert [w[0] - t[0] for w, t in zip(wide, true, strict=True)] == pytest.approx([0.005] * len(true))
    assert [s[0] - t[0] for s, t in zip(slope, true, strict=True)] == pytest.approx(
        [1e-3 * t[1] for t in true]
    )


def test_a_gap_that_no_wheel_can_grind_is_refused():
    """Six teeth shifted by 0.6 modules end in a point below their tip circle: there the gap has no flank."""
    pointed = GearNominal(number_of_teeth=6, normal_module_mm=3.0, profile_shift=0.6)
    with pytest.raises(InputError, match=r"cannot grind this gap: its profile folds back \d\.\d+ mm below"):
        GapWheel(outside_diameter_mm=60.0).dressed(pointed)
    gear = geometry(GearNominal(number_of_teeth=30, normal_module_mm=3.0))
    with pytest.raises(InputError, match=r"no round fillet joins the root circle"):
        gap_of(gear, stock=4.0)
