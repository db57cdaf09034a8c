"""Turned blanks: their volumes in closed form, what the cut leaves of them, and what is refused."""

import math
from itertools import pairwise

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.stock import blank_solid
from twin.errors import InputError

GRID = 2.0**-17
"""[mm] that snapping may move a vertex of this size"""
STEPPED = ((0.0, 20.0), (-1.0, 24.0), (-4.0, 24.0), (-4.0, 16.0), (-6.0, 16.0), (-6.0, 30.0), (-9.0, 27.0))


def frusta(profile, bore):
    """Volume by the frustum formula."""
    total = 0.0
    for (z0, d0), (z1, d1) in pairwise(profile):
        a, b = d0 / 2, d1 / 2
        total += math.pi * (z0 - z1) / 3.0 * (a * a + a * b + b * b)
    return total + math.pi * bore**2 / 4 * (profile[-1][0] - profile[0][0])


@pytest.mark.parametrize("bore", [0.0, 8.0])
@pytest.mark.parametrize("profile", [STEPPED, ((0.0, 12.0), (-5.0, 12.0)), ((0.0, 9.0), (-3.0, 20.0))])
def test_volume_is_that_of_its_frusta(profile, bore):
    blank = Blank(
        diameter_mm=max(d for _, d in profile), length_mm=-profile[-1][0], bore_mm=bore, profile=profile
    )
    solid = blank_solid(blank)
    assert solid.volume() == pytest.approx(frusta(profile, bore), rel=1e-4)
    assert solid.genus() == (bore > 0)


def test_a_point_is_inside_by_steps_cones_and_bore():
    blank = Blank(diameter_mm=30.0, length_mm=9.0, bore_mm=8.0, profile=STEPPED)
    z = np.array([-0.5, -2.0, -5.0, -7.5])
    outer = np.array([11.0, 12.0, 8.0, 14.25])
    np.testing.assert_allclose(blank.outer_radius(z), outer)
    for r, inside in (
        (outer - 1e-6, True),
        (outer + 1e-6, False),
        (0 * z + 4.001, True),
        (0 * z + 3.999, False),
    ):
        points = np.column_stack([0 * z, r, z])
        assert (blank.contains(points) == inside).all()
    assert not blank.contains(np.array([[0.0, 5.0, 0.1], [0.0, 5.0, -9.1]])).any()


def test_least_radius_between_heights_sees_every_step():
    blank = Blank(diameter_mm=30.0, length_mm=9.0, bore_mm=8.0, profile=STEPPED)
    low, high = np.array([-0.5, -4.5, -5.0, -9.0, -20.0]), np.array([-0.25, -3.5, -4.5, -6.5, 5.0])
    z = [np.linspace(max(a, -9.0), min(b, 0.0), 20_001) for a, b in zip(low, high, strict=True)]
    sampled = [blank.outer_radius(heights).min() for heights in z]
    assert blank.least_radius(low, high) == pytest.approx(sampled, abs=1e-3)


def involute_gap(radius, *, module=2.0, teeth=10):
    """Angle of a gap at a radius of a gear of 20° without profile shift [rad] (ISO 21771, 4.4)."""

    def involute(angle):
        return math.tan(angle) - angle

    normal = math.radians(20.0)
    there = math.acos(0.5 * module * teeth * math.cos(normal) / radius)
    return 2.0 * (0.5 * math.pi / teeth - involute(normal) + involute(there))


def test_gear_on_a_chamfered_hub_keeps_tip_chamfer_and_hub(synthetic):
    """Teeth on the middle collar only; the hub below the root and the chamfers stay as they were turned."""
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
    profile = ((0.0, 12.0), (-3.0, 12.0), (-3.0, 22.0), (-4.0, 24.0), (-8.0, 24.0), (-9.0, 22.0))
    blank = Blank(diameter_mm=24.0, length_mm=9.0, bore_mm=6.0, profile=profile)
    tool = synthetic.hobbing(hob, teeth=10, tip_x=7.5, z=(14.0, -24.0), feed=2.0, step_deg=6.0)
    part = cut(blank, (tool,), cell_mm=0.4).remains
    assert part.blank_volume_mm3 == pytest.approx(frusta(profile, 6.0), rel=1e-4)
    assert part.genus == 1
    r, z = np.hypot(part.vertices[:, 0], part.vertices[:, 1]), part.vertices[:, 2]
    outer = blank.outer_radius(z)
    step = np.abs(z + 3.0) < 1e-6
    assert (r <= outer + GRID)[~step].all()
    assert r.max() == pytest.approx(12.0, abs=GRID)
    # the hub, between its steps and the bore, is untouched
    hub = (z > -2.99) & (z < -0.01)
    assert not hub.any()
    # tooth tips on both cones
    for low, high in ((-3.9, -3.1), (-8.9, -8.1)):
        on = (z > low) & (z < high) & (np.abs(r - outer) < GRID)
        angle = np.sort(np.arctan2(part.vertices[on, 1], part.vertices[on, 0]))
        # ten tips; behind each the gap of the involute gear, at a radius of the cone
        gaps = np.diff(angle, append=angle[0] + 2.0 * math.pi)
        gaps = gaps[gaps > math.radians(10.0)]
        assert len(gaps) == 10
        # feed marks leave some 20 µm on the flanks
        assert ((involute_gap(11.1) - 4e-3 < gaps) & (gaps < involute_gap(11.9))).all()
    # full depth on the collar
    collar = (z < -4.1) & (z > -7.9) & (r > 3.5)
    assert r[collar].min() == pytest.approx(7.5, abs=2.0**2 / (4 * 40.0) + 1e-3)


@pytest.mark.parametrize(
    ("profile", "more", "said"),
    [
        (((0.0, 20.0),), {}, "needs at least two points"),
        (
            ((0.0, 20.0), (-4.0, 20.0), (-3.0, 18.0)),
            {},
            "runs back from z -4 to -3 mm between its points 2 and 3",
        ),
        (((-1.0, 20.0), (-9.0, 20.0)), {}, r"begins at z -1 mm .*valid: 0, the front face"),
        (((0.0, 20.0), (-9.0, 5.0)), {"bore_mm": 6.0}, "diameter of 5 mm .*more than the bore, 6 mm"),
        (((0.0, 20.0), (-9.0, 20.0)), {"diameter_mm": 22.0}, "diameter_mm 22 contradicts .* says 20"),
        (((0.0, 20.0), (-8.0, 20.0)), {}, "length_mm 9 contradicts .* says 8"),
        (((0.0, 20.0), (-3.0, 20.0), (-3.0, 18.0), (-3.0, 15.0), (-9.0, 9.0)), {}, "three points .* at z -3"),
        (((0.0, 20.0), (0.0, 20.0), (-9.0, 9.0)), {}, "points 1 and 2 .* are the same"),
        (None, {"bore_mm": 20.0}, "bore_mm 20 is not inside diameter_mm 20"),
        (None, {"length_mm": 0.0}, "no blank of .* length 0 mm"),
        (((0.0, 20.0), (-9.0, math.nan)), {}, "not finite"),
    ],
)
def test_an_outline_that_is_no_blank_is_refused(profile, more, said):
    with pytest.raises(InputError, match=said):
        Blank(**({"diameter_mm": 20.0, "length_mm": 9.0} | more), profile=profile)
