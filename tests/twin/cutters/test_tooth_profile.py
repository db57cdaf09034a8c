"""The depth of a tooth outline against its definition: signed distance, concave per tooth, zero on it."""

import math

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutters.profile import ToothProfile
from twin.errors import InputError

HOBS = {
    "m2": Hob(normal_module_mm=2.0, outside_diameter_mm=70.0),
    "m4 three starts left": Hob(normal_module_mm=4.0, outside_diameter_mm=90.0, starts=3, hand="left"),
    "m1 sharp tip": Hob(normal_module_mm=1.0, outside_diameter_mm=50.0, tip_radius_factor=0.0),
    "m3 shallow": Hob(normal_module_mm=3.0, outside_diameter_mm=80.0, dedendum_factor=0.4, starts=2),
}
HEADS = {
    "square insert": PolygonHead(inserts=3, tip_radius_mm=40.0),
    "rounded insert": PolygonHead(inserts=2, tip_radius_mm=25.0, corner_radius_mm=0.4),
}
PROFILES = {name: hob.profile() for name, hob in HOBS.items()} | {
    name: head.cutter().profile for name, head in HEADS.items()
}


@pytest.fixture(params=PROFILES)
def profile(request):
    return PROFILES[request.param]


def cloud(profile, n, seed=0):
    """(2, n) random places of one and a half teeth around the outline."""
    rng = np.random.default_rng(seed)
    width = 1.5 * profile.pitch if math.isfinite(profile.pitch) else 3.0
    return np.array([rng.uniform(-width, width, n), profile.tip + rng.uniform(-10.0, 3.0, n)])


def flank_and_land(hob):
    """Points on the straight flank and on the land, straight from ISO 53 and geometry.md 2."""
    lead = math.asin(hob.starts * hob.normal_module_mm / hob.pitch_diameter)
    slope = math.tan(math.radians(20.0)) / math.cos(lead)
    pitch = math.pi * hob.normal_module_mm / math.cos(lead)
    above = np.linspace(-hob.dedendum_factor, 0.6, 7) * hob.normal_module_mm
    flank = np.array([pitch / 4.0 - above * slope, hob.pitch_diameter / 2.0 + above])
    root = hob.pitch_diameter / 2.0 - hob.dedendum_factor * hob.normal_module_mm
    return flank, np.array([np.linspace(flank[0, 0], pitch / 2.0, 5), np.full(5, root)]), pitch


@pytest.mark.parametrize("name", HOBS)
def test_hob_outline_is_the_rack_of_iso_53_in_the_axial_plane(name):
    hob = HOBS[name]
    flank, land, pitch = flank_and_land(hob)
    for side in (1, -1):
        for tooth in (-1, 0, 2):
            for s, rho in (flank, land):
                depth, _, _ = hob.profile().depth(side * s + tooth * pitch, rho)
                np.testing.assert_allclose(depth, 0.0, atol=1e-12)
    tip, _, _ = hob.profile().depth(np.zeros(1), np.array([hob.outside_diameter_mm / 2.0]))
    assert tip == pytest.approx(0.0, abs=1e-12)


def test_tip_corner_is_a_circle_tangent_to_tip_and_flank():
    profile = PROFILES["m2"]
    turn = np.linspace(profile.flank_angle, math.pi / 2, 9)
    s = profile.corner_s + 0.76 * np.cos(turn)
    rho = profile.tip - 0.76 + 0.76 * np.sin(turn)
    depth, by_s, by_rho = profile.depth(s, rho)
    np.testing.assert_allclose(depth, 0.0, atol=1e-12)
    np.testing.assert_allclose(by_s, -np.cos(turn), atol=1e-9)
    np.testing.assert_allclose(by_rho, -np.sin(turn), atol=1e-9)


def test_depth_is_1_lipschitz(profile):
    one, other = cloud(profile, 20_000), cloud(profile, 20_000, seed=1)
    near = one + 0.05 * (other - one)
    for there in (other, near):
        change = np.abs(profile.depth(*there)[0] - profile.depth(*one)[0])
        assert (change <= np.hypot(*(there - one)) + 1e-12).all()


def test_depth_of_one_tooth_is_concave(profile):
    one, other = cloud(profile, 20_000), cloud(profile, 20_000, seed=1)
    one[0], other[0] = np.abs(one[0]), np.abs(other[0])
    middle = 0.5 * (one + other)
    single = ToothProfile(
        tip=profile.tip,
        corner_s=profile.corner_s,
        corner_radius=profile.corner_radius,
        flank_angle=profile.flank_angle,
        root=-math.inf,
        pitch=math.inf,
    )
    lowest = 0.5 * (single.depth(*one)[0] + single.depth(*other)[0])
    assert (single.depth(*middle)[0] >= lowest - 1e-12).all()


def test_depth_is_that_of_the_deepest_tooth_or_the_land(profile):
    s, rho = cloud(profile, 20_000)
    middles = profile.teeth(s.min(), s.max()) * (profile.pitch if math.isfinite(profile.pitch) else 0.0)
    teeth = [profile.tooth_depth(middle, s, rho) for middle in middles]
    deepest = np.max([depth for depth, _, _ in teeth] + [profile.root - rho], axis=0)
    np.testing.assert_allclose(profile.depth(s, rho)[0], deepest, atol=1e-12)


def test_derivatives_are_the_slope_of_the_depth(profile):
    s, rho = cloud(profile, 2_000)
    _, by_s, by_rho = profile.depth(s, rho)
    h = 1e-6
    along_s = (profile.depth(s + h, rho)[0] - profile.depth(s - h, rho)[0]) / (2.0 * h)
    along_rho = (profile.depth(s, rho + h)[0] - profile.depth(s, rho - h)[0]) / (2.0 * h)
    # all but the few points within h of a ridge
    smooth = (np.abs(along_s - by_s) < 1e-5) & (np.abs(along_rho - by_rho) < 1e-5)
    assert smooth.mean() > 0.998
    np.testing.assert_allclose(np.hypot(by_s, by_rho), 1.0, atol=1e-9)


@pytest.mark.parametrize("name", HOBS)
def test_hob_depth_is_the_distance_to_the_drawn_outline(name, brute_force):
    hob = HOBS[name]
    outlines, pitch = brute_force.hob_outlines(
        module=hob.normal_module_mm,
        outside_diameter=hob.outside_diameter_mm,
        starts=hob.starts,
        pressure_angle=20.0,
        addendum=1.25,
        tip_radius=hob.tip_radius_factor,
        dedendum=hob.dedendum_factor,
    )
    s, rho = cloud(hob.profile(), 200)
    drawn = [brute_force.depth_in_outlines(outlines, pitch, *at) for at in zip(s, rho, strict=True)]
    np.testing.assert_allclose(hob.profile().depth(s, rho)[0], drawn, atol=2e-7)


@pytest.mark.parametrize("name", HEADS)
def test_insert_depth_is_the_distance_to_the_drawn_outline(name, brute_force):
    head = HEADS[name]
    outlines = brute_force.insert_outlines(
        tip_radius=head.tip_radius_mm, width=head.edge_width_mm, corner_radius=head.corner_radius_mm
    )
    s, rho = cloud(head.cutter().profile, 200)
    drawn = [brute_force.depth_in_outlines(outlines, 0.0, *at) for at in zip(s, rho, strict=True)]
    np.testing.assert_allclose(head.cutter().profile.depth(s, rho)[0], drawn, atol=2e-7)


def test_too_round_a_tip_is_refused_with_the_largest_that_fits():
    with pytest.raises(
        InputError, match=r"tip_radius_factor 0\.9 leaves the hob tooth no tip .*valid: 0 to 0\.4"
    ):
        Hob(normal_module_mm=2.0, outside_diameter_mm=70.0, tip_radius_factor=0.9)
    with pytest.raises(
        InputError, match=r"corner_radius_mm 1\.2 is more than half of edge_width_mm 2 .*0 to 1"
    ):
        PolygonHead(inserts=3, tip_radius_mm=40.0, corner_radius_mm=1.2)


def test_too_small_a_hob_is_refused_with_the_smallest_that_fits():
    with pytest.raises(InputError, match="too small for module 2 mm, 3 start"):
        Hob(normal_module_mm=2.0, outside_diameter_mm=10.0, starts=3)
