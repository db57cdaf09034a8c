"""The quick way for complete regular gears: on the envelope, closed, never taken where it would be wrong."""

import math
from dataclasses import replace

import numpy as np
import pytest
from rays import deepest

from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.field import DepthField
from twin.cutting.fields import tool_field
from twin.cutting.regular.indexing import find_indexing
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.regular import regular_cut
from twin.cutting.sweep import Sweep

FACE = 1.2
CELL = 0.07


def gear(synthetic, *, teeth=12, helix_deg=0.0, module=1.0, hob=None, feed=1.0, **more):
    """Blank and tool of a gear of full depth, hobbed from well above its face to well below."""
    hob = hob or Hob(normal_module_mm=module, outside_diameter_mm=30.0 * module, gashes=9)
    reference = module * teeth / math.cos(math.radians(helix_deg))
    # the tool starts and ends its turning clear of the blank, swivelled or not
    run = math.sqrt(2.25 * module * hob.outside_diameter_mm) + 3.0 * module
    run += 2.0 * module * abs(math.tan(math.radians(helix_deg))) * math.sqrt(teeth)
    tool = synthetic.hobbing(
        hob,
        teeth=teeth,
        helix_deg=helix_deg,
        tip_x=reference / 2.0 - 1.25 * module,
        z=(run, -FACE - run),
        feed=feed * module,
        step_deg=8.0,
        **more,
    )
    blank = Blank(diameter_mm=reference + 2.0 * module, length_mm=FACE, bore_mm=0.3 * reference)
    return blank, tool


def swept(blank, *tools):
    reach = blank.radius + 1.0
    z = -blank.length_mm - 1.0, 1.0
    return Sweep(tuple(tool_field(cutter, motion, reach, z) for cutter, motion in tools))


def quick(blank, *tools, cell_mm=CELL):
    return regular_cut(blank, tools, swept(blank, *tools), cell_mm=cell_mm)


def jittered(tool, synthetic):
    """With servo noise of two tenths of a micrometre."""
    cutter, motion = tool
    rng = np.random.default_rng(4)
    return cutter, synthetic.jittered(motion, rng, slide=2e-4, work=1e-5, tool=2e-5)


def hollow_hob(radius):
    """Tip arcs, hollow flanks and a land, by a chain of points."""
    return Hob(
        normal_module_mm=1.0,
        outside_diameter_mm=36.0,
        profile=((0.065, 0.0, 0.38), (0.4215, 0.25, -radius), (1.24, 2.5)),
    )


FAMILY = {
    "spur": {},
    "right-hand": {"helix_deg": 20.0},
    "left-hand": {"helix_deg": -12.0, "teeth": 17},
    "undercut": {"teeth": 8},
    "many teeth": {"teeth": 45},
    "two starts": {
        "teeth": 15,
        "hob": Hob(normal_module_mm=1.0, outside_diameter_mm=40.0, starts=2, gashes=10),
    },
    "helical gashes": {
        "helix_deg": 8.0,
        "hob": Hob(normal_module_mm=1.0, outside_diameter_mm=36.0, gash="helical"),
    },
    "protuberance": {
        "teeth": 16,
        "hob": Hob(normal_module_mm=1.0, outside_diameter_mm=36.0, protuberance_mm=0.04),
    },
    "flanks by 200 mm": {"teeth": 20, "hob": hollow_hob(200.0)},
    "flanks by 20 mm": {"teeth": 20, "hob": hollow_hob(20.0)},
}


@pytest.mark.parametrize("name", FAMILY)
def test_vertices_lie_on_the_envelope_and_facets_near_it(name, synthetic):
    """Against all passes by themselves: no tile, no bound, no culling."""
    blank, tool = gear(synthetic, **FAMILY[name])
    made = quick(blank, tool)
    points = made.surface.vertices
    corners = points[made.surface.faces]
    field = DepthField(*tool, blank.radius + 1.0, (-FACE - 1.0, 1.0))
    rng = np.random.default_rng(1)
    inside = points[blank.contains(points)]
    depth, _ = deepest(field, rng.choice(inside, 60, replace=False))
    assert np.abs(depth).max() < 1e-4
    middles = corners.mean(axis=1)
    middles = middles[blank.contains(middles)]
    depth, _ = deepest(field, rng.choice(middles, 60, replace=False))
    # sagittas of cells in fillets of a third of a module, and what ridges between vertices leave
    assert np.abs(depth).max() < CELL**2


@pytest.mark.parametrize("name", ["right-hand", "undercut", "flanks by 20 mm"])
def test_both_ways_agree(name, synthetic, monkeypatch):
    """The same part, but for what the cells of both cost."""
    blank, tool = gear(synthetic, **FAMILY[name])
    one = cut(blank, (tool,), cell_mm=CELL)
    monkeypatch.setattr("twin.cutting.cut.regular_cut", refused)
    other = cut(blank, (tool,), cell_mm=CELL)
    assert one.method.startswith("regular")
    assert other.method == "general (cylindrical grid), for the sake of a comparison"
    assert one.largest_error_um < 0.1
    for result in (one, other):
        assert result.remains.genus == 1
        assert result.remains.loose_volumes_mm3 == ()
    removed = [r.remains.blank_volume_mm3 - r.remains.volume_mm3 for r in (one, other)]
    assert removed[0] == pytest.approx(removed[1], rel=2e-3)


def test_three_runs_give_the_same_bits_by_both_ways(synthetic, monkeypatch):
    blank, tool = gear(synthetic, teeth=8)
    blank = replace(blank, length_mm=0.6)
    for way in ("regular", "general"):
        one, *others = (cut(blank, (tool,), cell_mm=CELL) for _ in range(3))
        assert one.method.startswith(way)
        for other in others:
            np.testing.assert_array_equal(other.remains.vertices, one.remains.vertices)
            np.testing.assert_array_equal(other.remains.faces, one.remains.faces)
        monkeypatch.setattr("twin.cutting.cut.regular_cut", refused)


def refused(*_, **__):
    raise IrregularError("the sake of a comparison")


def test_servo_noise_and_a_blank_clamped_badly(synthetic):
    blank, tool = gear(synthetic)
    cutter, motion = jittered(tool, synthetic)
    clamped = cutter, synthetic.clamped(motion, eccentricity=0.06, tilt=1e-3)
    result = cut(blank, (clamped,), cell_mm=CELL)
    assert result.method.startswith("regular")
    assert result.largest_error_um < 0.1
    assert result.remains.genus == 1


def test_indexing_puts_gaps_where_the_tool_cuts(synthetic):
    """On the pitch circle a gap is open about its middle by as much as on the other side."""
    for name in ("right-hand", "two starts", "helical gashes"):
        blank, (cutter, motion) = gear(synthetic, **FAMILY[name])
        indexing = find_indexing(cutter, motion, blank.radius)
        assert indexing.teeth == FAMILY[name].get("teeth", 12)
        helix = math.radians(FAMILY[name].get("helix_deg", 0.0))
        radius = indexing.teeth / math.cos(helix) / 2.0
        assert math.tan(helix) == pytest.approx(indexing.twist * radius, abs=1e-9)
        field = DepthField(cutter, motion, blank.radius, (-FACE, 0.0))
        half = math.pi / (2.0 * indexing.teeth)
        for z in (-0.4, -1.3):
            turn = indexing.phase + indexing.twist * z + half * np.array([-1.02, -0.98, 0.98, 1.02])
            points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(4, z)])
            assert (deepest(field, points)[0] > 0).tolist() == [False, True, True, False]


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"ratio_factor": -1.0}, "there is no gap where the rolling"),
        ({"swivel_error": 0.2}, "there is no gap where the rolling|the gap is wider|left standing|open at"),
    ],
)
def test_wrong_motions_are_handed_over(change, why, synthetic):
    blank, tool = gear(synthetic, **change)
    with pytest.raises(IrregularError, match=why):
        quick(blank, tool)


def test_a_feed_that_ends_halfway_is_handed_over(synthetic):
    blank, (cutter, motion) = gear(synthetic)
    blank = replace(blank, length_mm=9.0)
    keep = motion.centre[:, 2] > -3.0
    halfway = replace(
        motion,
        **{name: getattr(motion, name)[keep] for name in ("time_s", "work_angle", "tool_angle", "centre")},
    )
    with pytest.raises(IrregularError):
        quick(blank, (cutter, halfway))


def test_a_turn_of_the_work_left_out_is_handed_over(synthetic):
    """The tool is lifted for one turn of the work: ridges as high as the teeth stay across the gaps."""
    blank, (cutter, motion) = gear(synthetic)
    blank = replace(blank, length_mm=6.0)
    away = np.abs(motion.centre[:, 2] + 3.0) < 2.5
    centre = motion.centre.copy()
    centre[away, 0] += 5.0
    with pytest.raises(IrregularError):
        quick(blank, (cutter, replace(motion, centre=centre)))


def test_a_nick_in_one_tooth_is_found(synthetic):
    """A second tool that takes a scratch out of one tooth's flank, or of one tip: no regular gear."""
    blank, tool = gear(synthetic)
    indexing = find_indexing(*tool, blank.radius)
    _, motion = tool
    hob = Hob(normal_module_mm=0.2, outside_diameter_mm=8.0)
    for height, turn in ((0.6, math.pi / indexing.teeth), (-0.3, 0.62 * math.pi / indexing.teeth)):
        angle = indexing.phase + turn
        short = replace(
            motion,
            time_s=motion.time_s[:200],
            tool_angle=0.15 * np.arange(200.0),
            work_angle=np.full(200, -angle),
            centre=np.column_stack(
                [np.full(200, blank.radius - 1.0 + height + 4.0), np.zeros(200), np.full(200, -0.8)]
            ),
        )
        nick = hob.cutter(0.0), replace(short, basis=synthetic.tool_basis(math.pi / 2.0))
        tools = nick, tool
        assert swept(blank, nick).passes > 0
        with pytest.raises(IrregularError):
            regular_cut(blank, tools, swept(blank, *tools), cell_mm=CELL)
        assert cut(blank, tools, cell_mm=0.25).method.startswith("general")
