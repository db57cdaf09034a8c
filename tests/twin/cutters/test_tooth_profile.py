"""The depth of a tooth outline against its definition: signed distance, concave per tooth, zero on it."""

import math

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.errors import InputError

HOBS = {
    "m2": Hob(normal_module_mm=2.0, outside_diameter_mm=70.0),
    "m4 three starts left": Hob(normal_module_mm=4.0, outside_diameter_mm=90.0, starts=3, hand="left"),
    "m1 sharp tip": Hob(normal_module_mm=1.0, outside_diameter_mm=50.0, tip_radius_factor=0.0),
    "m3 shallow": Hob(normal_module_mm=3.0, outside_diameter_mm=80.0, dedendum_factor=0.4, starts=2),
}
SHAPED = {
    "m2 protuberance": {"protuberance_mm": 0.12},
    "m3 semi-topping": {"chamfer_height_mm": 0.9},
    "m2 all, helical gashes": {
        "protuberance_mm": 0.08,
        "chamfer_height_mm": 0.5,
        "gash": "helical",
        "starts": 3,
    },
}
HOBS |= {
    name: Hob(normal_module_mm=float(name[1]), outside_diameter_mm=70.0, **more)
    for name, more in SHAPED.items()
}
HEADS = {
    "square insert": PolygonHead(inserts=3, tip_radius_mm=40.0),
    "rounded insert": PolygonHead(inserts=2, tip_radius_mm=25.0, corner_radius_mm=0.4),
}
PROFILES = {name: hob.tooth() for name, hob in HOBS.items()} | {
    name: head.edge() for name, head in HEADS.items()
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
    axial = math.cos(lead) if hob.gash == "helical" else 1.0 / math.cos(lead)
    slope = math.tan(math.radians(20.0)) * axial
    pitch = math.pi * hob.normal_module_mm * axial
    below = hob.chamfer_height_mm / hob.normal_module_mm - hob.dedendum_factor
    above = np.linspace(below, 0.0 if hob.protuberance_mm else 0.6, 7) * hob.normal_module_mm
    flank = np.array([pitch / 4.0 - above * slope, hob.pitch_diameter / 2.0 + above])
    root = hob.pitch_diameter / 2.0 - hob.dedendum_factor * hob.normal_module_mm
    return flank, np.array([np.linspace(hob.tooth().half_width, pitch / 2.0, 5), np.full(5, root)]), pitch


@pytest.mark.parametrize("name", HOBS)
def test_hob_outline_is_the_rack_of_iso_53_in_the_axial_plane(name):
    hob = HOBS[name]
    flank, land, pitch = flank_and_land(hob)
    for side in (1, -1):
        for tooth in (-1, 0, 2):
            for s, rho in (flank, land):
                depth, _, _ = hob.tooth().depth(side * s + tooth * pitch, rho)
                np.testing.assert_allclose(depth, 0.0, atol=1e-12)
    tip, _, _ = hob.tooth().depth(np.zeros(1), np.array([hob.outside_diameter_mm / 2.0]))
    assert tip == pytest.approx(0.0, abs=1e-12)


def test_tip_corner_is_a_circle_tangent_to_tip_and_flank():
    profile = PROFILES["m2"]
    lead = math.asin(2.0 / 65.0)
    flank = math.atan(math.tan(math.radians(20.0)) / math.cos(lead))
    turn = np.linspace(flank, math.pi / 2, 9)
    tip = math.pi * 2.0 / math.cos(lead) / 4.0 - 2.5 * math.tan(flank)
    s = tip - 0.76 * (1.0 - math.sin(flank)) / math.cos(flank) + 0.76 * np.cos(turn)
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


def test_depth_of_every_piece_is_concave(profile):
    one, other = cloud(profile, 20_000), cloud(profile, 20_000, seed=1)
    middle = 0.5 * (one + other)
    for number in range(len(profile.pieces)):
        at = np.full(20_000, number)
        depth = [profile.piece_depth(at, 0.3, *points)[0] for points in (one, middle, other)]
        assert (depth[1] >= 0.5 * (depth[0] + depth[2]) - 1e-12).all()


def test_depth_is_that_of_the_deepest_piece_or_the_land(profile):
    s, rho = cloud(profile, 20_000)
    middles = profile.teeth(s.min(), s.max()) * (profile.pitch if math.isfinite(profile.pitch) else 0.0)
    pieces = [
        profile.piece_depth(np.full(len(s), number), middle, s, rho)[0]
        for middle in middles
        for number in range(len(profile.pieces) + math.isfinite(profile.root))
    ]
    np.testing.assert_allclose(profile.depth(s, rho)[0], np.max(pieces, axis=0), atol=1e-12)


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


def assert_same_outline(profile, s, rho, drawn, *, off=0.0):
    """Equal outside and, where the outline is convex, inside; else inside no more than the distance.

    `off`: how far the profile may stand out of the drawing.
    """
    depth = profile.depth(s, rho)[0]
    exact = drawn < 0 if len(profile.pieces) > 1 else np.ones(len(s), dtype=bool)
    assert (depth <= drawn + off + 2e-7).all()
    assert (depth[exact] >= drawn[exact] - 2e-7).all()
    assert (depth[drawn > off + 2e-7] > 0).all()


@pytest.mark.parametrize("name", HOBS)
def test_hob_depth_is_the_distance_to_the_drawn_outline(name, brute_force):
    hob = HOBS[name]
    outlines, pitch, _ = brute_force.hob_outlines(
        module=hob.normal_module_mm,
        outside_diameter=hob.outside_diameter_mm,
        starts=hob.starts,
        pressure_angle=20.0,
        addendum=1.25,
        tip_radius=hob.tip_radius_factor,
        dedendum=hob.dedendum_factor,
        helical=hob.gash == "helical",
        protuberance=hob.protuberance_mm,
        chamfer=hob.chamfer_height_mm,
    )
    s, rho = cloud(hob.tooth(), 200)
    drawn = [brute_force.depth_in_outlines(outlines, pitch, *at) for at in zip(s, rho, strict=True)]
    assert_same_outline(hob.tooth(), s, rho, np.array(drawn))


@pytest.mark.parametrize("name", HEADS)
def test_insert_depth_is_the_distance_to_the_drawn_outline(name, brute_force):
    head = HEADS[name]
    outlines = brute_force.insert_outlines(
        tip_radius=head.tip_radius_mm, width=head.edge_width_mm, corner_radius=head.corner_radius_mm
    )
    s, rho = cloud(head.edge(), 200)
    drawn = [brute_force.depth_in_outlines(outlines, 0.0, *at) for at in zip(s, rho, strict=True)]
    np.testing.assert_allclose(head.edge().depth(s, rho)[0], drawn, atol=2e-7)


def test_too_round_a_tip_is_refused_with_the_largest_that_fits():
    with pytest.raises(
        InputError, match=r"a tip radius of 1\.8 mm leaves the tooth no tip .*valid: 0 to 0\.9"
    ):
        Hob(normal_module_mm=2.0, outside_diameter_mm=70.0, tip_radius_factor=0.9)
    with pytest.raises(
        InputError, match=r"corner_radius_mm 1\.2 is more than half of edge_width_mm 2 .*0 to 1"
    ):
        PolygonHead(inserts=3, tip_radius_mm=40.0, corner_radius_mm=1.2)


def test_too_small_a_hob_is_refused_with_the_smallest_that_fits():
    with pytest.raises(InputError, match="too small for module 2 mm, 3 start"):
        Hob(normal_module_mm=2.0, outside_diameter_mm=10.0, starts=3)
