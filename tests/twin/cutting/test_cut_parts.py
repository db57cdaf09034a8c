"""The mesh of a cut part: closed, on the envelope of the passes, and of the right volume."""

import math
from dataclasses import replace

import numpy as np
import pytest
from rays import deepest

from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.cutting.check import CHECKED
from twin.cutting.cut import cut
from twin.cutting.field import DepthField
from twin.errors import PartError

HOB = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
TEETH = 10
ROOT, TIP = 7.5, 12.0
GEAR_BLANK = Blank(diameter_mm=2 * TIP, length_mm=4.0, bore_mm=6.0)
CELL = 0.4
GRID = 2.0**-17
"""[mm] that snapping may move a vertex of this size"""


def hobbing(synthetic, *, z_end=-19.0, **more):
    return synthetic.hobbing(HOB, teeth=TEETH, tip_x=ROOT, z=(14.0, z_end), feed=2.0, step_deg=6.0, **more)


@pytest.fixture(scope="module")
def gear(synthetic):
    return cut(GEAR_BLANK, (hobbing(synthetic),), cell_mm=CELL)


def enclosed_volume(remains):
    """By the divergence theorem over the triangles."""
    a, b, c = remains.vertices[remains.faces].transpose(1, 0, 2)
    return float(np.einsum("nx,nx->", a, np.cross(b, c)) / 6.0)


def surface_area(remains):
    a, b, c = remains.vertices[remains.faces].transpose(1, 0, 2)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)


def euler_characteristic(faces):
    """V − E + F; raises unless each directed edge stands once beside its opposite."""
    a, b = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    n = faces.max() + 1
    directed = a * n + b
    assert len(np.unique(directed)) == len(directed)
    assert set(directed.tolist()) == set((b * n + a).tolist())
    assert len(np.unique(faces)) == n
    return int(n - len(directed) // 2 + len(faces))


def test_gear_is_a_closed_ring(gear):
    assert euler_characteristic(gear.remains.faces) == 0
    assert gear.remains.genus == 1
    assert gear.remains.loose_volumes_mm3 == ()
    rounding = GRID * surface_area(gear.remains)
    assert enclosed_volume(gear.remains) == pytest.approx(gear.remains.volume_mm3, abs=rounding)


def test_every_vertex_lies_on_blank_or_envelope(gear, synthetic):
    v = gear.remains.vertices
    r = np.hypot(v[:, 0], v[:, 1])
    assert v[:, 2].max() <= 1e-9
    assert v[:, 2].min() >= -4.0 - 1e-9
    assert r.max() <= TIP + GRID
    cut_there = (r < TIP - 1e-3) & (r > 3.0 + 1e-3) & (v[:, 2] < -1e-6) & (v[:, 2] > -4.0 + 1e-6)
    chosen = np.random.default_rng(5).choice(np.flatnonzero(cut_there), 250, replace=False)
    cutter, motion = hobbing(synthetic)
    depth, _ = deepest(DepthField(cutter, motion, TIP, (-4.0, 0.0)), v[chosen])
    assert np.abs(depth).max() < 1e-4
    assert gear.checked == CHECKED // 2
    assert gear.largest_error_um < 0.1
    assert 0 < gear.facet_error_um < 100


def test_volume_is_that_of_the_points_no_pass_removes(gear, synthetic):
    """V_blank = V_part + V_removed, the removed share counted over random points with the field alone."""
    assert gear.remains.blank_volume_mm3 == pytest.approx(math.pi * (TIP**2 - 3.0**2) * 4.0, rel=1e-4)
    rng = np.random.default_rng(6)
    n = 1500
    # stratified in r² and angle: every gap gets its share
    r = np.sqrt(7.0**2 + (TIP**2 - 7.0**2) * (np.arange(n) + rng.random(n)) / n)
    angle = 2 * math.pi * (rng.permutation(n) + rng.random(n)) / n
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle), -4.0 * rng.random(n)])
    cutter, motion = hobbing(synthetic)
    share = (deepest(DepthField(cutter, motion, TIP, (-4.0, 0.0)), points)[0] > 0).mean()
    zone = math.pi * (TIP**2 - 7.0**2) * 4.0
    removed = gear.remains.blank_volume_mm3 - gear.remains.volume_mm3
    assert removed / zone == pytest.approx(share, abs=3.0 * math.sqrt(share * (1 - share) / n))


def test_two_runs_give_the_same_bits(gear, synthetic):
    again = cut(GEAR_BLANK, (hobbing(synthetic),), cell_mm=CELL).remains
    np.testing.assert_array_equal(again.vertices, gear.remains.vertices)
    np.testing.assert_array_equal(again.faces, gear.remains.faces)


def test_stopped_halfway_is_right_on_both_sides(synthetic):
    """Tools that end at z = 0 have cut full depth above it and nothing below their circle's reach."""
    blank = Blank(diameter_mm=2 * TIP, length_mm=16.0, bore_mm=6.0)
    part = cut(blank, (hobbing(synthetic, z_end=-1.0),), cell_mm=0.6).remains
    r = np.hypot(part.vertices[:, 0], part.vertices[:, 1])
    z = part.vertices[:, 2]
    wall = r > 3.5
    # the circle leaves the blank's surface √(h (d_a0 − h)) beyond the hob's axis
    reach = math.sqrt((TIP - ROOT) * (HOB.outside_diameter_mm - (TIP - ROOT)))
    untouched = wall & (z < -1.0 - reach - 1.0)
    np.testing.assert_allclose(r[untouched], TIP, atol=GRID, rtol=0)
    assert untouched.sum() > 100
    full = wall & (z > -0.9)
    assert r[full].min() == pytest.approx(ROOT, abs=2.0**2 / (4 * 40.0))
    # the ramp between, where the gap's floor follows the hob's own circle
    floor = wall & (z < -4.0) & (z > -8.0)
    law = (
        ROOT
        + HOB.outside_diameter_mm / 2
        - np.sqrt((HOB.outside_diameter_mm / 2) ** 2 - (z[floor] + 1.0) ** 2)
    )
    assert (r[floor] >= law - 0.01).all()
    assert (r[floor] < law + 0.1).any()
    assert part.genus == 1


def test_wrong_ratio_destroys_the_teeth(gear, synthetic):
    wrong = cut(GEAR_BLANK, (hobbing(synthetic, ratio_factor=-1.0),), cell_mm=CELL)
    assert euler_characteristic(wrong.remains.faces) == 2 - 2 * wrong.remains.genus
    tips = np.hypot(*wrong.remains.vertices[:, :2].T).max()
    # with a lead angle of 3.3° the crossing cuts leave next to nothing above the root
    assert wrong.remains.volume_mm3 < gear.remains.volume_mm3
    assert tips < TIP
    # what is left is full of sharp edges: vertices stand on the cut there, too
    assert wrong.largest_error_um < 0.1


HEAD = PolygonHead(inserts=3, tip_radius_mm=40.0)


def test_hexagon_of_a_full_bar(synthetic):
    blank = Blank(diameter_mm=19.0, length_mm=3.0)
    tool = synthetic.polygon_turning(
        HEAD, ratio=2, across_flats=17.0, work_turns=8, z=(2.0, -5.0), step_deg=2.0
    )
    result = cut(blank, (tool,), cell_mm=0.4)
    assert result.remains.genus == 0
    assert euler_characteristic(result.remains.faces) == 2
    # six faces of the hexagon, bowed outwards by 13 µm, within the bar's circle
    r, half = 9.5, 8.5
    angle = math.acos(half / r)
    segment = r * r * angle - half * math.sqrt(r * r - half * half)
    expected = 3.0 * (math.pi * r * r - 6 * segment)
    assert result.remains.volume_mm3 == pytest.approx(expected, rel=2e-3)


def test_a_tool_that_stays_away_leaves_the_blank(synthetic):
    blank = Blank(diameter_mm=19.0, length_mm=3.0)
    tool = synthetic.polygon_turning(
        HEAD, ratio=2, across_flats=60.0, work_turns=2, z=(1.0, -4.0), step_deg=2.0
    )
    result = cut(blank, (tool,), cell_mm=0.5)
    assert result.remains.volume_mm3 == pytest.approx(result.remains.blank_volume_mm3, rel=1e-14)
    assert result.notes == ("no edge ever swung past the blank: nothing was cut",)


@pytest.mark.parametrize("gap", [1e-4, 0.01, 1.0])
def test_a_tool_that_passes_just_beside_the_blank_is_told(synthetic, gap):
    blank = Blank(diameter_mm=19.0, length_mm=3.0)
    tool = synthetic.polygon_turning(
        HEAD, ratio=2, across_flats=19.0 + 2 * gap, work_turns=2, z=(1.0, -4.0), step_deg=2.0
    )
    result = cut(blank, (tool,), cell_mm=0.5)
    assert result.remains.volume_mm3 == pytest.approx(result.remains.blank_volume_mm3, rel=1e-14)
    assert any(note.endswith("nothing was cut") for note in result.notes)


def test_a_standing_tool_that_the_work_rubs_on_is_told(synthetic):
    blank = Blank(diameter_mm=19.0, length_mm=3.0)
    cutter, motion = synthetic.polygon_turning(
        HEAD, ratio=2, across_flats=17.0, work_turns=1, z=(-1.0, -1.0), step_deg=2.0
    )
    standing = replace(motion, tool_angle=np.zeros_like(motion.tool_angle))
    result = cut(blank, ((cutter, standing),), cell_mm=0.5)
    assert result.remains.volume_mm3 == pytest.approx(result.remains.blank_volume_mm3, rel=1e-14)
    assert (
        "the tool stood still within the blank's outline while the blank moved 59.7 mm past it"
        in result.notes[0]
    )


def test_a_cut_through_the_wall_severs_the_ring(synthetic):
    """Two rings of one length: one is the part, the other is told."""
    blank = Blank(diameter_mm=20.0, length_mm=8.0, bore_mm=10.0)
    tool = synthetic.polygon_turning(
        HEAD, ratio=2, across_flats=8.0, work_turns=3, z=(-4.0, -4.0), step_deg=2.0
    )
    result = cut(blank, (tool,), cell_mm=0.4)
    ring = math.pi * (10.0**2 - 5.0**2) * 3.0
    assert result.remains.volume_mm3 == pytest.approx(ring, rel=1e-3)
    assert result.remains.loose_volumes_mm3 == pytest.approx((ring,), rel=1e-3)
    assert any("1 severed piece(s)" in note for note in result.notes)


def test_nothing_left_is_an_error(synthetic):
    blank = Blank(diameter_mm=20.0, length_mm=1.0, bore_mm=10.0)
    tool = synthetic.polygon_turning(
        HEAD, ratio=2, across_flats=8.0, work_turns=3, z=(-0.5, -0.5), step_deg=2.0
    )
    with pytest.raises(PartError, match="nothing is left of the blank"):
        cut(blank, (tool,), cell_mm=0.4)
