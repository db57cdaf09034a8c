"""Form grinding wheels: the field against the independent evaluator, gaps against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_cuts import grindings

from twin.cutters.disc_wheel import DiscWheel
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.errors import InputError

few = settings(derandomize=True, deadline=None, max_examples=10, database=None)


@few
@given(cut=grindings(), seed=st.integers(0, 1000))
def test_field_is_the_deepest_place_in_the_body_over_all_time(cut, seed):
    field = cut.field()
    windows = np.arange(field.passes.count)
    for point in cut.points(4, seed):
        depth = field.evaluate(np.repeat(point[None], len(windows), axis=0), windows).depth
        depth = depth.max(initial=-math.inf)
        expected, _ = cut.truth(point)
        if expected < -0.5:
            assert depth < 0
        elif cut.hollow and expected > 0:
            assert 0 < depth <= expected + cut.chords + 3e-6
        else:
            assert expected - 3e-6 <= depth <= expected + cut.chords + 3e-6


GRID = 2.0**-17
"""[mm] that snapping may move a vertex of this size"""
FLOOR, TIP = 17.5, 22.0
WHEEL = DiscWheel(outside_diameter_mm=60.0, normal_module_mm=2.0, tip_radius_factor=0.0)
TAN = math.tan(math.radians(20.0))


def half_gap(height):
    """Half the width of the straight-sided wheel m2 at a height above its tip."""
    return math.pi / 2.0 + (height - 2.5) * TAN


@pytest.fixture(scope="module")
def ground(synthetic):
    """A blank with three ground gaps."""
    blank = Blank(diameter_mm=2 * TIP, length_mm=4.0, bore_mm=20.0)
    tool = synthetic.grinding(WHEEL, teeth=20, module=2.0, tip_x=FLOOR, z=(16.0, -20.0), gaps=3)
    return cut(blank, (tool,), cell_mm=0.25)


def test_ground_gap_is_the_wheels_own_profile(ground):
    """The gap of a spur gear is the wheel's axial profile itself (geometry.md 4), at every z."""
    v = ground.remains.vertices
    z, r, angle = v[:, 2], np.hypot(v[:, 0], v[:, 1]), np.arctan2(v[:, 1], v[:, 0])
    cut_there = (r < TIP - 1e-3) & (r > 10.0 + 1e-3) & (z < -1e-3) & (z > -4.0 + 1e-3)
    pitch = 2 * math.pi / 20
    gap = np.rint(angle / pitch)
    assert set(np.unique(gap[cut_there] % 20)) == {0.0, 18.0, 19.0}
    x, y = r * np.cos(angle - gap * pitch), np.abs(r * np.sin(angle - gap * pitch))
    off_floor, off_flank = x - FLOOR, (y - half_gap(x - FLOOR)) * math.cos(math.radians(20.0))
    on_floor = cut_there & (np.abs(off_floor) < GRID)
    on_flank = cut_there & (np.abs(off_flank) < GRID)
    assert on_floor.sum() > 50
    assert on_flank.sum() > 300
    # the rest stands in the corner between the two
    rest = cut_there & ~on_floor & ~on_flank
    assert (np.hypot(off_floor, off_flank)[rest] < 0.02).all()
    assert ground.largest_error_um < 0.1
    assert ground.remains.genus == 1


def test_volume_of_ground_gaps_is_their_section_times_the_width(ground):
    x = np.linspace(FLOOR, TIP, 200_001)
    wide = np.minimum(half_gap(x - FLOOR), np.sqrt(TIP**2 - x**2))
    area = 2.0 * float(np.trapezoid(wide, x))
    removed = ground.remains.blank_volume_mm3 - ground.remains.volume_mm3
    assert removed == pytest.approx(3 * area * 4.0, rel=1e-3)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({}, "either its profile or normal_module_mm"),
        ({"normal_module_mm": 2.0, "profile": ((0.5, 0.0), (1.0, 2.0))}, "either its profile or"),
        ({"profile": ((0.5, 0.0), (1.0, 2.0)), "tip_radius_factor": 0.2}, "tip_radius_factor stands beside"),
        ({"profile": ((0.5, 0.0), (1.0, 2.0), (0.8, 3.0))}, "gets narrower"),
        ({"profile": ((0.5, 0.0), (1.0, 2.0)), "width_mm": 1.5}, r"width_mm 1\.5 is less than .* 2 mm"),
        ({"normal_module_mm": 2.0, "tip_radius_factor": 0.6}, "leaves the tooth no tip"),
        ({"profile": ((0.5, 0.0), (1.0, 40.0))}, "ends at depth 40"),
    ],
)
def test_a_wheel_that_contradicts_itself_is_refused(data, said):
    with pytest.raises(InputError, match=said):
        DiscWheel(outside_diameter_mm=60.0, **data)
