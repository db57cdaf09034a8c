"""What an ideal machine leaves on a hobbed tooth, from the field along normals, against closed forms."""

import math

import numpy as np
import pytest
from rays import crossing

from twin.cutters.hob import Hob
from twin.cutting.field import DepthField

ALPHA = math.radians(20.0)


def spur(synthetic, hob, *, teeth, feed, z):
    """The field of a spur gear of full depth, hobbed past z = 0, a gap centred on the part's +X."""
    module = hob.normal_module_mm
    cutter, motion = synthetic.hobbing(
        hob, teeth=teeth, tip_x=module * (teeth / 2 - 1.25), z=(z, -z), feed=feed, step_deg=6.0
    )
    return DepthField(cutter, motion, module * (teeth / 2 + 1), (-z / 2, z / 2))


def involute(module, teeth, xi, z):
    """Points (n, 3) of the flank on the + side of the gap at +X, unit normals into the tooth."""
    base = module * teeth * math.cos(ALPHA) / 2
    turned = math.pi / (2 * teeth) - (math.tan(ALPHA) - ALPHA) + xi
    normal = np.stack([-np.sin(turned), np.cos(turned), np.zeros_like(turned)], axis=1)
    foot = base * np.stack([np.cos(turned), np.sin(turned), np.zeros_like(turned)], axis=1)
    points = foot - (base * xi)[:, None] * normal
    points[:, 2] = z
    return points, normal


def cusps(deviation):
    """Indices of the peaks of the surplus (−deviation), and their height over the valleys beside them."""
    surplus = -deviation
    inner = slice(1, -1)
    peak = 1 + np.flatnonzero((surplus[inner] > surplus[:-2]) & (surplus[inner] >= surplus[2:]))
    valley = 1 + np.flatnonzero((surplus[inner] < surplus[:-2]) & (surplus[inner] <= surplus[2:]))
    peak = peak[(peak > valley[0]) & (peak < valley[-1])]
    return peak, surplus[peak] - np.interp(peak, valley, surplus[valley])


def test_generating_flats(synthetic):
    """δ_y(ξ) = r_b ξ (2π z_0/(n_i z))²/8: 0.586 µm at the pitch point of m2 z20 with 12 gashes."""
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=70.0)
    field = spur(synthetic, hob, teeth=20, feed=0.2, z=0.7)
    flat = 2 * math.pi / (12 * 20)
    xi = np.linspace(math.tan(ALPHA) - 1.6 * flat, math.tan(ALPHA) + 1.6 * flat, 1200)
    # in the plane that the hob's axis crosses as it cuts here: half a feed off, two turns share the flats
    deviation = crossing(field, *involute(2.0, 20, xi, 0.1))
    peak, height = cusps(deviation)
    expected = 20 * math.cos(ALPHA) * xi[peak] * flat**2 / 8
    assert len(peak) >= 2
    assert np.interp(math.tan(ALPHA), xi[peak], expected) == pytest.approx(0.586e-3, abs=1e-6)
    np.testing.assert_allclose(height, expected, rtol=0.01)
    np.testing.assert_allclose(np.diff(xi[peak]), flat, atol=3 * (xi[1] - xi[0]))
    # nothing is cut beyond the involute but for the bow of the straight-edged hob
    assert deviation.max() < 0.01e-3
    around_pitch = np.abs(xi - math.tan(ALPHA)) < flat
    assert deviation[around_pitch].min() > -0.628e-3 - 0.01e-3


def test_feed_marks_on_the_flank(synthetic):
    """f² sin α/(8 ρ) across the flank, ρ the hob's radius there; δ_x takes d_a0/2 for it."""
    feed = 2.0
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=70.0)
    field = spur(synthetic, hob, teeth=20, feed=feed, z=4.4)
    base = 20 * math.cos(ALPHA)
    z = np.linspace(-1.1 * feed, 1.1 * feed, 801)
    for xi in (0.2, math.tan(ALPHA), 0.5):
        deviation = crossing(field, *involute(2.0, 20, np.full(len(z), xi), z))
        peak, height = cusps(deviation)
        rho = 52.5 - base * (math.cos(ALPHA) + xi * math.sin(ALPHA))
        expected = feed**2 * math.sin(ALPHA) / (8 * rho)
        assert len(peak) >= 1
        np.testing.assert_allclose(height, expected, rtol=0.01)
        assert expected >= 4.886e-3  # δ_x with d_a0 is the least of them


def test_feed_marks_in_the_root(synthetic):
    """Radially f²/(4 d_a0) = 14.3 µm for f 2, d_a0 70."""
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=70.0)
    field = spur(synthetic, hob, teeth=20, feed=2.0, z=4.4)
    z = np.linspace(-2.2, 2.2, 801)
    points = np.stack([np.full(len(z), 17.5), np.zeros(len(z)), z], axis=1)
    deviation = crossing(field, points, np.broadcast_to([-1.0, 0.0, 0.0], points.shape))
    _, height = cusps(deviation)
    np.testing.assert_allclose(height, 14.286e-3, rtol=0.01)
    assert deviation.max() == pytest.approx(0.0, abs=0.01e-3)


@pytest.mark.parametrize("gash", ["straight", "helical"])
@pytest.mark.parametrize(
    ("module", "outside", "starts", "bow"),
    [(2.0, 68.0, 1, 0.17e-3), (3.0, 87.5, 1, 0.42e-3), (4.0, 100.0, 1, 0.95e-3), (2.5, 76.25, 2, 1.22e-3)],
)
def test_straight_edged_hob_bows_the_flank(synthetic, module, outside, starts, bow, gash):
    """Peak to valley after a line fit, over −1…+1 m about d_0 = d_a0 − 2.5 m (63, 80, 90, 70).

    An edge that is straight over its axial position lies on the same thread, whatever its gash's helix.
    """
    hob = Hob(normal_module_mm=module, outside_diameter_mm=outside, starts=starts, gashes=48, gash=gash)
    assert hob.pitch_diameter == pytest.approx(outside - 2.5 * module)
    teeth = 41
    field = spur(synthetic, hob, teeth=teeth, feed=0.3, z=0.35)
    radius = module * teeth / 2
    height = np.linspace(-module, module, 61)
    xi = (radius + height - radius * math.cos(ALPHA) ** 2) / (radius * math.cos(ALPHA) * math.sin(ALPHA))
    deviation = crossing(field, *involute(module, teeth, xi, 0.0))
    left = deviation - np.polyval(np.polyfit(height, deviation, 1), height)
    assert np.ptp(left) == pytest.approx(bow, abs=0.06e-3)


def test_root_is_the_trochoid_of_the_rounded_rack_tip(synthetic):
    """geometry.md 1. A slender lead (d_a0 200) keeps the hob's tip arc that of the normal section."""
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=200.0, gashes=72)
    field = spur(synthetic, hob, teeth=20, feed=0.2, z=0.5)
    r, tip, rho = 20.0, 2.5, 0.76
    b_c = math.pi * 2 / 4 - tip * math.tan(ALPHA) - rho * (1 - math.sin(ALPHA)) / math.cos(ALPHA)
    a_c = tip - rho
    # from straight below the tip arc's centre to the end of the involute
    u = np.linspace(-b_c, -b_c + a_c / math.tan(ALPHA), 40)
    centre = np.stack([u + b_c, np.full(len(u), r - a_c)], axis=1)
    e = centre - [0.0, r]
    e /= np.linalg.norm(e, axis=1, keepdims=True)
    turn = u / r
    cos, sin = np.cos(turn), np.sin(turn)

    def rotated(p):
        return np.stack([cos * p[:, 0] - sin * p[:, 1], sin * p[:, 0] + cos * p[:, 1]], axis=1)

    def in_part(p):
        """The gap of the formula opens at +Y; ours at +X."""
        return np.stack([p[:, 1], -p[:, 0], np.zeros(len(p))], axis=1)

    points, normals = in_part(rotated(centre + rho * e)), in_part(rotated(e))
    deviation = crossing(field, points, normals)
    assert np.abs(deviation).max() < 0.3e-3


def test_helical_gashes_cut_the_flank_that_straight_ones_do(synthetic):
    """Many edges on one thread: the envelope does not know how the gashes run. Three starts: 6° of lead."""
    teeth, module = 31, 2.0
    deviation = []
    for gash in ("straight", "helical"):
        hob = Hob(normal_module_mm=module, outside_diameter_mm=62.0, starts=3, gashes=72, gash=gash)
        field = spur(synthetic, hob, teeth=teeth, feed=0.3, z=0.35)
        xi = np.linspace(0.18, 0.55, 40)
        deviation.append(crossing(field, *involute(module, teeth, xi, 0.0)))
    # the generating flats of 72 gashes and three starts, which fall elsewhere
    flat = module * teeth / 2 * math.cos(ALPHA) * 0.55 * (2 * math.pi * 3 / (72 * teeth)) ** 2 / 8
    assert flat < 0.15e-3
    np.testing.assert_allclose(deviation[0], deviation[1], atol=1.1 * flat)
    # a bow of many times that is common to both
    assert np.ptp(deviation[0]) > 10 * flat


def test_protuberance_relieves_the_root_and_leaves_the_flank(synthetic):
    """Above the protuberance's reach the flank is the plain hob's; at the root it is undercut by pr_P0.

    The tip of the hob then cuts what a basic rack of the same tip radius, moved out by pr_P0, cuts.
    """
    pr = 0.06
    plain = Hob(normal_module_mm=2.0, outside_diameter_mm=200.0, gashes=72)
    relieved = Hob(
        normal_module_mm=2.0,
        outside_diameter_mm=200.0,
        gashes=72,
        protuberance_mm=pr,
        protuberance_angle_deg=8.0,
    )
    fields = [spur(synthetic, hob, teeth=40, feed=0.2, z=0.5) for hob in (plain, relieved)]
    # the flank that the protuberance does not touch
    xi = np.linspace(math.tan(ALPHA), 0.5, 30)
    high = [crossing(field, *involute(2.0, 40, xi, 0.0)) for field in fields]
    np.testing.assert_allclose(high[0], high[1], atol=0.02e-3)
    # where the hob's tip arc swings through: the rack's arc, moved out along the flank's normal
    r, tip, rho = 40.0, 2.5, 0.76
    b_c = math.pi * 2 / 4 - tip * math.tan(ALPHA) - (rho * (1 - math.sin(ALPHA)) - pr) / math.cos(ALPHA)
    a_c = tip - rho
    # the arc's normal runs from straight down to the flank's, where it stands out the most
    u = -b_c + a_c / np.tan(np.linspace(math.pi / 2, ALPHA, 40))
    centre = np.stack([u + b_c, np.full(len(u), r - a_c)], axis=1)
    e = centre - [0.0, r]
    e /= np.linalg.norm(e, axis=1, keepdims=True)
    cos, sin = np.cos(u / r), np.sin(u / r)

    def in_part(p):
        x, y = cos * p[:, 0] - sin * p[:, 1], sin * p[:, 0] + cos * p[:, 1]
        return np.stack([y, -x, np.zeros(len(p))], axis=1)

    low = crossing(fields[1], in_part(centre + rho * e), in_part(e))
    assert np.abs(low).max() < 0.3e-3
    # the plain hob leaves pr_P0 more there
    beside = crossing(fields[0], in_part(centre + rho * e), in_part(e))
    assert beside[-1] == pytest.approx(-pr, abs=0.03 * pr)
