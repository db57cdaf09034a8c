"""Chips: their sum against the part, single ones against areas of circles, and twice the resolution."""

import math

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.cutting.chips import chips
from twin.cutting.cut import cut
from twin.cutting.fields import tool_field
from twin.cutting.motion import CutterMotion
from twin.cutting.section import Section
from twin.cutting.sweep import Sweep
from twin.errors import InputError
from twin.grinding.precut import PrecutGear
from twin.grinding.wheel import GapWheel
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal

BAR = Blank(diameter_mm=20.0, length_mm=3.0)
FLY = PolygonHead(inserts=1, tip_radius_mm=30.0)
STEPS = (0.8, 0.6, 0.5, 0.9)
"""Infeed before each turn of the fly cutter [mm]"""


def fly_cutting(synthetic, *, fed_before=None):
    """One insert, the bar at rest: the slide steps in while the insert is on its far side, then one turn."""
    turn = np.linspace(0.0, 2.0 * math.pi, 721)
    tool, centre = [], []
    depth = 0.0
    for number, step in enumerate(STEPS):
        # half a turn away from the bar at both ends
        tool.append(turn[:-1] + 2.0 * math.pi * number + math.pi)
        centre.append(np.full(720, 10.0 + 30.0 - depth))
        early = slice(0, 60)
        centre[-1][early] = 10.0 + 30.0 - depth - step * np.clip(np.linspace(0.0, 1.2, 60), 0.0, 1.0)
        depth += step
        centre[-1][60:] = 10.0 + 30.0 - depth
    x = np.concatenate(centre)
    n = len(x)
    return FLY.cutter(), CutterMotion(
        time_s=1e-3 * np.arange(n),
        work_angle=np.zeros(n),
        tool_angle=np.concatenate(tool),
        centre=np.column_stack([x, np.zeros(n), np.full(n, -1.5)]),
        basis=synthetic.tool_basis(0.0),
    )


def lens(depth, r=10.0, radius=30.0):
    """Area common to the bar's circle and the tool's, `depth` into each other."""
    d = r + radius - depth
    one = math.acos((d * d + r * r - radius * radius) / (2 * d * r))
    two = math.acos((d * d + radius * radius - r * r) / (2 * d * radius))
    return r * r * (one - math.sin(2 * one) / 2) + radius * radius * (two - math.sin(2 * two) / 2)


@pytest.fixture(scope="module")
def flown(synthetic):
    return chips(BAR, (fly_cutting(synthetic),), resolution_mm=0.1)


def test_each_chip_is_the_crescent_between_two_turns(flown):
    depth = np.cumsum(STEPS)
    areas = np.diff([0.0, *(lens(d) for d in depth)])
    assert len(flown.volume_mm3) == len(STEPS)
    np.testing.assert_allclose(flown.volume_mm3, 2.0 * areas, rtol=0.02)
    # two millimetres of the edge and, up to the chip's thickness, its ends: they slide along the wall behind
    np.testing.assert_allclose(flown.width_mm, 2.0 + 2.0 * np.array(STEPS), rtol=0.01)
    # thickest in the middle, where the slide's step is the height above the edge; the first on the bar itself
    np.testing.assert_allclose(flown.thickness_max_mm, STEPS, rtol=1e-3)
    assert (np.diff(flown.time_s) > 0.5).all()
    np.testing.assert_array_equal(flown.tooth, 0)


def test_mean_thickness_is_twice_the_mean_height(flown):
    """By quadrature of the last crescent: each point's height above the tool's circle."""
    depth = sum(STEPS)
    x, y = np.meshgrid(np.linspace(5.0, 10.0, 1201), np.linspace(-10.0, 10.0, 1601), indexing="ij")
    before = np.hypot(x - (40.0 - depth + STEPS[-1]), y)
    now = np.hypot(x - (40.0 - depth), y)
    chip = (np.hypot(x, y) < 10.0) & (before > 30.0) & (now < 30.0)
    # the edge has two ends as well: near them they are closer than its line
    height = np.minimum((30.0 - now)[chip][:, None], np.linspace(0.01, 0.99, 50))
    assert flown.thickness_mean_mm[-1] == pytest.approx(2.0 * height.mean(), rel=0.03)


def test_twice_the_resolution_changes_no_chip_by_two_percent(flown, synthetic):
    finer = chips(BAR, (fly_cutting(synthetic),), resolution_mm=flown.resolution_mm / 2.0)
    np.testing.assert_allclose(flown.volume_mm3, finer.volume_mm3, rtol=0.02)
    np.testing.assert_allclose(flown.thickness_max_mm, finer.thickness_max_mm, rtol=1e-3)
    np.testing.assert_allclose(flown.thickness_mean_mm, finer.thickness_mean_mm, rtol=0.02)


def test_all_chips_together_are_what_the_part_lost(synthetic):
    """A sound gear, and one whose teeth a wrong ratio destroys: true unions count nothing twice."""
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
    blank = Blank(diameter_mm=24.0, length_mm=1.0, bore_mm=10.0)
    for factor in (1.0, 0.93):
        tool = synthetic.hobbing(
            hob, teeth=10, tip_x=7.5, z=(13.0, -14.0), feed=4.0, step_deg=6.0, ratio_factor=factor
        )
        part = cut(blank, (tool,), cell_mm=0.12).remains
        lost = part.blank_volume_mm3 - part.volume_mm3 + 0.0 - sum(part.loose_volumes_mm3)
        made = chips(blank, (tool,), resolution_mm=0.12)
        assert made.total_mm3 == pytest.approx(lost, rel=1e-3)
        assert (np.diff(made.time_s) >= 0).all()
        assert made.thickness_max_mm.max() < 2.25 * 2.0


def test_twice_the_resolution_changes_no_hobbed_chip_by_two_percent(synthetic):
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
    blank = Blank(diameter_mm=24.0, length_mm=0.5, bore_mm=14.0)
    tool = synthetic.hobbing(hob, teeth=10, tip_x=7.5, z=(1.0, -1.5), feed=2.0, step_deg=6.0)
    coarse, fine = (chips(blank, (tool,), resolution_mm=step) for step in (0.08, 0.04))
    # what is a twentieth of the largest, or more
    rows = np.flatnonzero(fine.volume_mm3 > 0.05 * fine.volume_mm3.max())
    assert len(rows) > 30
    named = {key: row for row, key in enumerate(zip(coarse.turn, coarse.tooth, strict=True))}
    same = [named[key] for key in zip(fine.turn[rows], fine.tooth[rows], strict=True)]
    np.testing.assert_allclose(coarse.volume_mm3[same], fine.volume_mm3[rows], rtol=0.02)
    np.testing.assert_allclose(coarse.thickness_mean_mm[same], fine.thickness_mean_mm[rows], rtol=0.02)
    np.testing.assert_allclose(coarse.thickness_max_mm[same], fine.thickness_max_mm[rows], rtol=0.02)
    assert coarse.total_mm3 == pytest.approx(fine.total_mm3, rel=1e-3)


@pytest.mark.parametrize("profile", [None, ((0.13, 0.0, 0.76), (0.843, 0.5, -10.0), (2.48, 5.0))])
def test_chips_are_what_random_points_say(synthetic, profile):
    """Of each point the first of all bites that is deeper owns it: volumes by their number, none thicker.

    By a hob with straight flanks, and with hollow ones.
    """
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8, profile=profile)
    blank = Blank(diameter_mm=24.0, length_mm=0.6, bore_mm=15.0)
    tool = synthetic.hobbing(hob, teeth=10, tip_x=7.5, z=(1.0, -1.5), feed=2.0, step_deg=6.0)
    found = chips(blank, (tool,))
    cutter, motion = tool
    sweep = Sweep((tool_field(cutter, motion, 14.0, blank.z_range),))
    rng = np.random.default_rng(0)
    n = 6000
    r, angle = np.sqrt(rng.uniform(7.5**2, 12.0**2, n)), rng.uniform(0.0, 2.0 * math.pi, n)
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle), rng.uniform(-0.6, 0.0, n)])
    owner, height = np.full(n, -1), np.zeros(n)
    for bite in range(sweep.count):
        left = np.flatnonzero(owner < 0)
        depth = sweep.evaluate(points[left], np.full(len(left), bite)).depth
        owner[left[depth > 0]], height[left[depth > 0]] = bite, depth[depth > 0]
    field = sweep.fields[0]
    each = math.pi * (12.0**2 - 7.5**2) * 0.6 / n
    counted, largest = {}, {}
    for bite, depth in zip(owner[owner >= 0], height[owner >= 0], strict=True):
        key = bite // field.bites, field.tooth[bite % field.bites]
        counted[key] = counted.get(key, 0) + 1
        largest[key] = max(largest.get(key, 0.0), depth)
    rows = {key: row for row, key in enumerate(zip(found.turn, found.tooth, strict=True))}
    assert len(counted) > 40
    for key, number in counted.items():
        volume = found.volume_mm3[rows[key]]
        assert abs(number * each - volume) < 4.5 * math.sqrt(volume * each) + each
        assert largest[key] < 1.005 * found.thickness_max_mm[rows[key]]
    assert (owner >= 0).sum() * each == pytest.approx(found.total_mm3, rel=0.03)


def test_a_second_pass_over_the_same_way_takes_nothing(synthetic):
    cutter, motion = fly_cutting(synthetic)
    once = chips(BAR, ((cutter, motion),), resolution_mm=0.2)
    twice = chips(BAR, ((cutter, motion), (cutter, motion)), resolution_mm=0.2)
    assert twice.total_mm3 == pytest.approx(once.total_mm3, rel=1e-9)
    assert twice.volume_mm3[twice.stretch == 1].sum() == pytest.approx(0.0, abs=1e-9)


def test_no_cut_makes_no_chips(synthetic):
    tool = synthetic.polygon_turning(
        FLY, ratio=2, across_flats=60.0, work_turns=1, z=(0.0, -3.0), step_deg=2.0
    )
    none = chips(BAR, (tool,), resolution_mm=0.3)
    assert none.total_mm3 == 0.0
    assert len(none.time_s) == 0


@pytest.mark.parametrize(
    ("resolution", "said"),
    [(0.0, "above 0"), (math.nan, "above 0"), (1e-4, "more memory than allowed .*or more")],
)
def test_a_resolution_that_cannot_be_is_refused(synthetic, resolution, said):
    with pytest.raises(InputError, match=said):
        chips(BAR, (fly_cutting(synthetic),), resolution_mm=resolution)


def test_gaps_of_a_circle_are_where_the_section_is_not():
    angle = 2.0 * math.pi * np.arange(400) / 400
    rho = 20.0 + 2.0 * np.sin(6.0 * angle + 0.3) + 0.7 * np.sin(5.0 * angle)
    section = Section(outline=rho[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]), twist=0.1)
    at = np.random.default_rng(0).uniform(0.0, 2.0 * math.pi, 5000)
    for radius in (17.0, 19.0, 20.3, 22.5, 23.0):
        gaps = section.gaps(radius)
        turns = at[:, None] + [0.0, 2.0 * math.pi]
        out = ((turns[..., None] >= gaps[:, 0]) & (turns[..., None] < gaps[:, 1])).any(axis=(1, 2))
        points = np.column_stack([radius * np.cos(at), radius * np.sin(at), np.zeros(len(at))])
        np.testing.assert_array_equal(out, ~section.contains(points))
    height = np.full(len(at), -3.0)
    reach = section.reach(np.column_stack([np.full(len(at), 7.0), at, height]))
    for share, inside in ((1.0 - 1e-9, True), (1.0 + 1e-9, False)):
        points = np.column_stack([share * reach * np.cos(at), share * reach * np.sin(at), height])
        np.testing.assert_array_equal(section.contains(points), inside)


def test_chips_of_a_gear_that_has_its_gaps_are_what_grinding_takes_off(synthetic):
    """One gap of a pre-cut gear: its stock alone, not the air in it."""
    gear = GearNominal(number_of_teeth=12, normal_module_mm=3.0)
    law = geometry(gear)
    radius = law.tip_diameter / 2
    section = PrecutGear(stock_per_flank_mm=0.3, number_of_teeth=12, normal_module_mm=3.0).section(radius)
    blank = Blank(diameter_mm=2 * radius, length_mm=1.0, bore_mm=26.0, section=section)
    cutter, motion = synthetic.grinding(
        GapWheel(outside_diameter_mm=60.0, chord_um=5.0).dressed(gear), teeth=12, module=3.0, helix_deg=0.0,
        tip_x=law.root_diameter / 2, z=(16.0, -17.0), gaps=1, samples=200,
    )  # fmt: skip
    part = cut(blank, ((cutter, motion),), cell_mm=0.3).remains
    made = chips(blank, ((cutter, motion),), resolution_mm=0.1)
    lost = part.blank_volume_mm3 - part.volume_mm3
    assert 2.0 < lost < 8.0
    assert made.total_mm3 == pytest.approx(lost, rel=0.01)


@pytest.mark.parametrize("name", ["wheel", "stepped insert"])
def test_height_is_that_above_all_pieces_of_an_outline(synthetic, name):
    """Thickness against random points of the first pass that cuts, in the deepest piece of its outline."""
    if name == "wheel":
        gear = GearNominal(number_of_teeth=12, normal_module_mm=3.0)
        law = geometry(gear)
        blank = Blank(diameter_mm=law.tip_diameter, length_mm=1.0, bore_mm=26.0)
        cutter, motion = synthetic.grinding(
            GapWheel(outside_diameter_mm=60.0, chord_um=5.0).dressed(gear), teeth=12, module=3.0,
            tip_x=law.root_diameter / 2, z=(16.0, -17.0), gaps=1, samples=200,
        )  # fmt: skip
    else:
        blank = Blank(diameter_mm=20.0, length_mm=2.0)
        head = PolygonHead(
            inserts=1, tip_radius_mm=35.0,
            profile=((0.3, 0.0), (0.4, 0.5), (0.8, 0.5), (0.9, 1.0), (1.2, 4.0)),
        )  # fmt: skip
        cutter, motion = synthetic.polygon_turning(
            head, ratio=1, across_flats=17.0, work_turns=1, z=(-1.0, -1.0), step_deg=1.0
        )
    made = chips(blank, ((cutter, motion),), resolution_mm=0.1)
    field = tool_field(cutter, motion, blank.radius / math.cos(math.pi / 6.0), blank.z_range)
    assert field.bites > 1
    rng = np.random.default_rng(0)
    n = 300_000
    low = max(blank.bore_mm / 2.0, 8.0)
    r, angle = np.sqrt(rng.uniform(low**2, blank.radius**2, n)), rng.uniform(0.0, 2.0 * math.pi, n)
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle), rng.uniform(-blank.length_mm, 0.0, n)])
    depth = field.evaluate(points, np.full(n, made.turn[0])).depth
    height = depth[depth > 0]
    assert len(height) > 2000
    assert made.thickness_mean_mm[0] == pytest.approx(2.0 * height.mean(), rel=0.03)
    # on from the highest of them, by ever shorter steps at random
    best, top = points[depth.argmax()], depth.max()
    for reach in np.geomspace(0.3, 1e-4, 60):
        near = best + rng.uniform(-reach, reach, (200, 3))
        near = near[blank.contains(near)]
        level = field.evaluate(near, np.full(len(near), made.turn[0])).depth
        if len(near) and level.max() > top:
            best, top = near[level.argmax()], level.max()
    assert made.thickness_max_mm[0] == pytest.approx(top, rel=5e-3)
