"""Where no feed marks are told, the surface is the same at every height; where they are, it is not."""

import math

import numpy as np
import pytest

from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.feed_marks import STEP, unmarked
from twin.cutting.fields import tool_field
from twin.cutting.motion import CutterMotion, RigidTransform
from twin.cutting.sweep import Sweep

BLANK = Blank(diameter_mm=20.0, length_mm=6.0)
FLAT = 8.5
"""[mm] from the work axis"""


def head(**kwargs):
    return PolygonHead(inserts=3, tip_radius_mm=40.0, **{"edge_width_mm": 2.0} | kwargs).cutter()


def motion(feed=0.5, ratio=2.0, nearer=0.0, tilt=0.0):
    """Along the whole length and beyond, `feed` and `nearer` [mm] in each turn of the work."""
    turns = (BLANK.length_mm + 8.0) / feed
    work = np.linspace(0.0, 2.0 * math.pi * turns, math.ceil(turns * 360) + 1)
    turn = work / (2.0 * math.pi)
    centre = np.zeros((len(work), 3))
    centre[:, 0] = FLAT + 40.0 - nearer * turn
    centre[:, 2] = 4.0 - feed * turn
    cos, sin = math.cos(tilt), math.sin(tilt)
    return CutterMotion(
        time_s=turn * 0.2,
        work_angle=work,
        tool_angle=math.pi / 3.0 + ratio * work,
        centre=centre,
        basis=np.array([[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]),
        mount=RigidTransform(rotation=np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])),
    )


def unevenness(cutter, way):
    """How much the radius of the surface changes along the axis at most [mm], by the passes alone."""
    sweep = Sweep((tool_field(cutter, way, BLANK.radius, BLANK.z_range),))
    angle, z = np.meshgrid(np.radians(np.arange(0.0, 120.0, 7.0)), np.linspace(-5.7, -0.3, 37), indexing="ij")
    cos, sin = np.cos(angle.ravel()), np.sin(angle.ravel())
    low, high = np.full(angle.size, 7.0), np.full(angle.size, BLANK.radius)
    for _ in range(24):
        r = 0.5 * (low + high)
        cut_away = sweep.unculled(np.column_stack([r * cos, r * sin, z.ravel()])) > 0
        low, high = np.where(cut_away, low, r), np.where(cut_away, r, high)
    return float(np.ptp(low.reshape(angle.shape), axis=1).max())


@pytest.mark.parametrize(
    ("cutter", "way"),
    [
        (head(), motion()),
        (head(corner_radius_mm=0.6), motion(feed=0.7)),
        (head(), motion(ratio=1.0)),
        (head(), motion(nearer=1e-4)),
    ],
)
def test_a_part_without_marks_is_even(cutter, way):
    assert unmarked(cutter, way, BLANK)
    # from turn to turn, and so for the turns that all of them are
    assert unevenness(cutter, way) < STEP * (1.0 + BLANK.length_mm / 0.5)
    if way.centre[0, 0] == way.centre[-1, 0]:
        assert unevenness(cutter, way) < STEP


@pytest.mark.parametrize(
    ("cutter", "way"),
    [
        (head(), motion(feed=2.4)),
        (head(corner_radius_mm=0.8), motion(feed=0.9)),
        (head(), motion(nearer=0.05)),
        (head(), motion(ratio=2.01)),
        (head(), motion(tilt=0.02)),
    ],
)
def test_a_part_with_marks_is_told_so(cutter, way):
    assert not unmarked(cutter, way, BLANK)
    assert unevenness(cutter, way) > STEP


def test_wide_cells_leave_the_part_as_it_is():
    cutter, way = head(), motion()
    wide = cut(BLANK, ((cutter, way),))
    fine = cut(BLANK, ((cutter, way),), cell_mm=0.1)
    assert wide.cell_mm[0] > 0.15
    assert len(wide.remains.faces) < 0.5 * len(fine.remains.faces)
    assert wide.largest_error_um < 0.1
    assert wide.facet_error_um < 2.0
    assert not wide.notes
    assert wide.remains.volume_mm3 == pytest.approx(fine.remains.volume_mm3, rel=5e-6)
