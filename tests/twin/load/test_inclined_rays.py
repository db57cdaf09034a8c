"""An insert that is fed along the work axis: which way rays lean, and what they then count."""

import math

import numpy as np
import pytest
from polygon_job import metal_of, removal_of

from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.motion import CutterMotion
from twin.load.material import MATERIALS
from twin.load.stock import Lean, Stock
from twin.load.walls import lean_of

BAR = Blank(diameter_mm=20.0, length_mm=5.0)
FLY = PolygonHead(inserts=1, tip_radius_mm=30.0, edge_width_mm=2.0)
STEEL = MATERIALS["16MnCr5"]
DEPTH = 1.0
TURNS = 24
"""of the tool over the bar"""
AWAY = 39.0
"""of the tool's axis, at full depth"""


def path(synthetic, x, z, turns=TURNS):
    """A motion of the tool with one insert, whose axis goes through (x, z) evenly, beside a bar at rest."""
    n = 360 * turns
    along = np.linspace(0.0, 1.0, n)
    xs, zs = (np.interp(along, np.linspace(0.0, 1.0, len(v)), v) for v in (x, z))
    return FLY.cutter(), CutterMotion(
        time_s=np.linspace(1e-3, 1e-3 * n, n),
        work_angle=np.zeros(n),
        tool_angle=np.pi + np.linspace(0.0, 2.0 * np.pi * turns, n),
        centre=np.column_stack([xs, np.zeros(n), zs]),
        basis=synthetic.tool_basis(0.0),
    )


@pytest.mark.parametrize(
    ("x", "z", "lean"),
    [
        ((AWAY, AWAY), (2.0, -7.0), Lean(slope=1.0)),  # from the front face to the chuck
        ((AWAY, AWAY), (2.0, -2.5), Lean(slope=1.0)),  # and not to the end
        ((AWAY, AWAY), (-7.0, 2.0), Lean(slope=-1.0)),  # back
        ((AWAY, AWAY), (-7.0, -2.0), Lean(slope=-1.0)),
        ((42.0, AWAY), (-2.5, -2.5), Lean(split=-2.5)),  # plunges: a wall on either side
        ((42.0, AWAY, AWAY), (-2.5, -2.5, 3.0), Lean(split=-2.5)),  # and then out: one wall has gone again
        ((42.0, AWAY, AWAY), (-2.5, -2.5, -7.0), Lean(split=-2.5)),  # and then on to the chuck
        ((41.0, AWAY, 41.0, 41.0, AWAY), (-1.5, -1.5, -1.5, -4.0, -4.0), Lean()),  # in two places
        ((42.0, AWAY), (-4.5, -4.5), Lean(slope=-1.0)),  # at the very end
        (
            (41.0, 38.5),
            (2.0, -7.0),
            Lean(slope=1.0),
        ),  # a cone that gets smaller: the wall before it is higher
        ((41.0, 41.0), (2.0, -7.0), Lean()),  # beside the bar
    ],
)
def test_rays_lean_off_the_walls_that_the_tool_leaves(synthetic, x, z, lean):
    found = lean_of(BAR, [path(synthetic, x, z)])
    assert found.slope == lean.slope
    assert found.split == (None if lean.split is None else pytest.approx(lean.split, abs=0.06))


def test_rays_stand_straight_where_no_wall_is(synthetic):
    """A plunge over the whole length, and a hob, that comes in along a curve."""
    cutter, motion = path(synthetic, (42.0, AWAY), (-0.5, -0.5))
    assert lean_of(Blank(diameter_mm=20.0, length_mm=1.0), [(cutter, motion)]) == Lean()
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=70.0)
    motion = synthetic.hobbing(hob, teeth=20, tip_x=17.5, z=(10.0, -25.0), feed=2.0, step_deg=10.0)
    assert lean_of(Blank(diameter_mm=44.0, length_mm=20.0), [motion]) == Lean()


@pytest.mark.parametrize(
    "lean", [Lean(), Lean(slope=1.0), Lean(slope=-1.0), Lean(split=-3.0), Lean(split=-8.5)]
)
def test_rays_hold_the_whole_blank_with_its_steps_and_bore(lean):
    """Cone, shoulder, groove: the sum of its turned parts by hand."""
    profile = (
        (0.0, 16.0),
        (-2.0, 20.0),
        (-6.0, 20.0),
        (-6.0, 14.0),
        (-8.0, 14.0),
        (-8.0, 18.0),
        (-12.0, 18.0),
    )
    blank = Blank(diameter_mm=20.0, length_mm=12.0, bore_mm=6.0, profile=profile)
    stock = Stock.of(blank, [FLY.cutter()], 0.1, lean=lean)
    found = 0.5 * ((stock.end**2 - stock.inner**2) * stock.rise).sum() * stock.turn
    cone = math.pi * 2.0 / 3.0 * (64.0 + 80.0 + 100.0)
    parts = [100.0 * 4.0, 49.0 * 2.0, 81.0 * 4.0, -9.0 * 12.0]
    assert found == pytest.approx(cone + math.pi * sum(parts), rel=2e-3)
    # rays do not come out of it
    for share in (0.001, 0.3, 0.7, 0.999):
        points = stock.points(np.arange(len(stock.z)), stock.inner + share * (stock.end - stock.inner))
        assert blank.contains(points).all()


def segment(depth, r=10.0, radius=30.0):
    """(area, chord) common to the bar's circle and the tool's."""
    d = r + radius - depth
    one = math.acos((d * d + r * r - radius * radius) / (2 * d * r))
    two = math.acos((d * d + radius * radius - r * r) / (2 * d * radius))
    area = r * r * (one - math.sin(2 * one) / 2) + radius * radius * (two - math.sin(2 * two) / 2)
    return area, 2.0 * r * math.sin(one)


@pytest.fixture(scope="module")
def passes(synthetic):
    """Volume and energy of every pass in full contact, feed per turn, by resolution."""
    tool = path(synthetic, (AWAY, AWAY), (2.0, -7.0))
    feed = 9.0 / TURNS
    found = {}
    for step in (0.2, 0.1):
        metal = removal_of(Stock.of(BAR, [tool[0]], step, lean=Lean(slope=1.0)), BAR, tool)
        energy = STEEL.specific_force(metal.thickness_mm) * metal.volume_mm3
        sums = np.array([np.bincount(metal.index, v) for v in (metal.volume_mm3, energy)])
        middle = np.bincount(metal.index, metal.middle_s) / np.maximum(np.bincount(metal.index), 1)
        z = np.interp(middle, tool[1].time_s, tool[1].centre[:, 2])
        found[step] = sums[:, (z < 1.0 - 2.0 * feed) & (z > -4.0 + 2.0 * feed) & (sums[0] > 0)]
    return feed, found


@pytest.mark.parametrize("step", [0.2, 0.1])
def test_every_pass_takes_its_feed_and_pays_kienzle_s_energy_for_it(passes, step):
    """Feed times the segment, at k_c of a chip as thick as the feed. Where the chip ends, at the tip and on
    the bar's surface, rays run out of it in triangles f × f: there thickness falls from f to 0 evenly, and
    metal costs 2/(2 − m_c) as much."""
    feed, found = passes
    volume, energy = found[step]
    assert len(volume) > 8
    area, chord = segment(DEPTH)
    np.testing.assert_allclose(volume, feed * area, rtol=0.02)
    assert volume.mean() == pytest.approx(feed * area, rel=3e-3)
    taper = (2.0 / (2.0 - STEEL.m_c) - 1.0) * feed * chord / area
    (k_c,) = STEEL.specific_force(np.array([feed]))
    np.testing.assert_allclose(energy, k_c * feed * area * (1.0 + taper), rtol=0.02)


def test_no_pass_differs_from_the_next_and_rays_half_as_far_apart_change_nothing(passes):
    (_, coarse), (_, fine) = (passes[1][step] for step in (0.2, 0.1))
    assert coarse.std() < 0.01 * coarse.mean()
    assert fine.std() < 0.005 * fine.mean()
    assert coarse.mean() == pytest.approx(fine.mean(), rel=2e-3)


def test_radial_rays_would_jump_by_a_row(passes, synthetic):
    """What inclined rays are for: the same cut on radial ones."""
    tool = path(synthetic, (AWAY, AWAY), (2.0, -7.0))
    metal = metal_of(BAR, tool, 0.2)
    volume = np.bincount(metal.index, metal.volume_mm3)
    assert volume[volume > 0][3:-3].std() > 10.0 * passes[1][0.2][0].std()


@pytest.mark.parametrize("slope", [0.0, 1.0])
def test_metal_of_a_hob_is_what_the_part_has_lost_whatever_the_rays(synthetic, slope):
    """Twelve gaps alike, and rays that come round twelve times alike, would err twelve times alike."""
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
    tool = synthetic.hobbing(hob, teeth=12, tip_x=9.5, z=(13.0, -16.0), feed=2.0, step_deg=6.0)
    blank = Blank(diameter_mm=28.0, length_mm=3.0)
    part = cut(blank, (tool,), cell_mm=0.3).remains
    metal = removal_of(Stock.of(blank, [tool[0]], 0.5, lean=Lean(slope=slope)), blank, tool)
    assert metal.volume_mm3.sum() == pytest.approx(part.blank_volume_mm3 - part.volume_mm3, rel=4e-3)


def test_an_insert_that_plunges_and_is_then_fed_along_takes_the_same_every_pass(synthetic):
    """Rays lean off the first cut to either side: behind it stands a wall that faces the other way. On
    straight rays passes would jump by a row; the sum is what the part has lost."""
    tool = path(synthetic, (41.2, AWAY, AWAY, AWAY), (-3.0, -3.0, -5.0, -7.0), turns=48)
    lean = lean_of(BAR, [tool])
    assert lean.split == pytest.approx(-3.0, abs=0.06)
    metal = removal_of(Stock.of(BAR, [tool[0]], 0.07, lean=lean), BAR, tool)
    part = cut(BAR, (tool,), cell_mm=0.1).remains
    assert metal.volume_mm3.sum() == pytest.approx(part.blank_volume_mm3 - part.volume_mm3, rel=4e-3)
    energy = STEEL.specific_force(metal.thickness_mm) * metal.volume_mm3
    index = np.arange(metal.index.max() + 1)
    middle = np.bincount(metal.index, metal.middle_s) / np.maximum(np.bincount(metal.index), 1)
    z = np.interp(middle, tool[1].time_s, tool[1].centre[:, 2])
    fed = index[(z < -3.2) & (z > -3.75)]  # the insert's end is 1 mm ahead of it
    volume, spent = (np.bincount(metal.index, v)[fed] for v in (metal.volume_mm3, energy))
    assert len(fed) >= 4
    area, _ = segment(DEPTH)
    np.testing.assert_allclose(volume, 2.0 / 16.0 * area, rtol=0.01)
    np.testing.assert_allclose(spent, spent.mean(), rtol=0.01)
    straight = np.bincount((m := metal_of(BAR, tool, 0.1)).index, m.volume_mm3)[fed]
    assert straight.std() > 10.0 * volume.std()
