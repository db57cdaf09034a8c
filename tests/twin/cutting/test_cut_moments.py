"""When each face was cut: held against all passes, and against cuts whose instants are known by hand."""

from dataclasses import replace

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.field import DepthField
from twin.cutting.moments import face_moments
from twin.cutting.stock import CHORD
from twin.grinding.precut import PrecutGear
from twin.grinding.wheel import GapWheel
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal

HOB = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
TEETH, ROOT, TIP, BORE, FEED = 10, 7.5, 12.0, 3.0, 2.0
LATER = 1000.0
"""[s] by which a second cut follows the first"""


def hobbing(synthetic, z, feed=FEED):
    return synthetic.hobbing(HOB, teeth=TEETH, tip_x=ROOT, z=z, feed=feed, step_deg=6.0)


def centres(found):
    return found.remains.vertices[found.remains.faces].mean(axis=1)


def beside_skin(found, length):
    """(m, 3) which corners of the faces lie in the blank's own surfaces, whose facets are chords."""
    corners = found.remains.vertices[found.remains.faces]
    r, z = np.hypot(corners[..., 0], corners[..., 1]), corners[..., 2]
    return np.minimum.reduce([TIP - r, r - BORE, -z, z + length]) < CHORD + 1e-5


@pytest.fixture(scope="module", params=[0.4, 0.12], ids=["general", "regular"])
def gear(request, synthetic):
    tool = hobbing(synthetic, (14.0, -18.0))
    found = cut(Blank(diameter_mm=2 * TIP, length_mm=4.0, bore_mm=2 * BORE), (tool,), cell_mm=request.param)
    assert found.method.startswith("general" if request.param > 0.3 else "regular")
    return tool, found


def test_only_what_is_left_of_the_blank_was_never_cut(gear):
    _, found = gear
    skin = beside_skin(found, 4.0).all(axis=1)
    uncut = np.isnan(found.face_time_s)
    assert found.face_time_s.shape == (len(found.remains.faces),)
    assert (uncut <= skin).all()
    # of the cut, only slivers at its rim have all three corners in the blank's surface
    corners = found.remains.vertices[found.remains.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert area[skin & ~uncut].sum() < 0.01 * area[~uncut].sum()
    assert area[~uncut].sum() > 0.2 * area.sum()


def test_at_that_time_a_pass_as_deep_as_any_was_at_one_of_its_corners(gear):
    (cutter, motion), found = gear
    field = DepthField(cutter, motion, TIP, (-4.0, 0.0))
    # at the rim a face may be a piece of a larger one
    inner = np.flatnonzero(~np.isnan(found.face_time_s) & ~beside_skin(found, 4.0).any(axis=1))
    passes = np.arange(field.passes.count)
    for face in np.random.default_rng(1).choice(inner, 60, replace=False):
        corners = found.remains.vertices[found.remains.faces[face]]
        meeting = field.evaluate(np.repeat(corners, len(passes), axis=0), np.tile(passes, 3))
        depth = meeting.depth.reshape(3, -1)
        when = 1e-3 * meeting.instant.reshape(3, -1)
        deep = depth > depth.max(axis=1, keepdims=True) - 1e-4
        # snapping moves a corner by nanometres, and its instant with it
        assert np.abs(when[deep] - found.face_time_s[face]).min() < 1e-6


def test_a_root_is_cut_when_the_hob_comes_by(gear):
    (_, motion), found = gear
    place = centres(found)
    low = np.hypot(place[:, 0], place[:, 1]) < ROOT + 0.03
    root = np.flatnonzero(low & ~np.isnan(found.face_time_s))
    assert len(root) > 20
    height = np.interp(found.face_time_s[root], motion.time_s, motion.centre[:, 2])
    # the work comes round once a feed; a face is longer than nothing
    corners = found.remains.vertices[found.remains.faces[root], 2]
    assert np.abs(height - place[root, 2]).max() < 0.5 * FEED + np.ptp(corners, axis=1).max()


def test_two_cuts_from_both_ends_part_in_the_middle(synthetic):
    """The second is the mirror image of the first about z = −8."""
    blank = Blank(diameter_mm=2 * TIP, length_mm=16.0, bore_mm=2 * BORE)
    cutter, first = hobbing(synthetic, (13.0, -5.0), 2.0 * FEED)
    _, second = hobbing(synthetic, (-29.0, -11.0), 2.0 * FEED)
    second = replace(second, time_s=second.time_s + LATER)
    found = cut(blank, ((cutter, first), (cutter, second)), cell_mm=0.8)
    z = centres(found)[:, 2]
    late = found.face_time_s > LATER - 1e-9
    early = found.face_time_s < first.time_s[-1] + 1e-9
    assert (early ^ late ^ np.isnan(found.face_time_s)).all()
    # a gap may have been passed last up to a feed before the end of either cut; a cell is 1.6 mm high
    assert z[early].min() > -8.0 - FEED - 1.6
    assert z[late].max() < -8.0 + FEED + 1.6
    assert early[z > -4.0].sum() > 200
    assert late[z < -12.0].sum() > 200


def ground(synthetic, z):
    law = geometry(GearNominal(number_of_teeth=30, normal_module_mm=3.0))
    section = PrecutGear(stock_per_flank_mm=0.1, number_of_teeth=30, normal_module_mm=3.0).section(
        law.tip_diameter / 2
    )
    blank = Blank(diameter_mm=law.tip_diameter, length_mm=4.0, bore_mm=60.0, section=section)
    wheel = GapWheel(outside_diameter_mm=100.0, chord_um=5.0).dressed(
        GearNominal(number_of_teeth=30, normal_module_mm=3.0)
    )
    cutter, motion = synthetic.grinding(
        wheel, teeth=30, module=3.0, tip_x=law.root_diameter / 2, z=z, gaps=2, samples=200
    )
    return motion, cut(blank, ((cutter, motion),), cell_mm=0.5)


def test_a_wheel_cuts_a_gap_when_its_middle_passes(synthetic):
    """A spur gap stands square to the wheel: each height is cut when the wheel's middle is level with it."""
    motion, found = ground(synthetic, (30.0, -34.0))
    assert found.method.startswith("strokes")
    cut_there = np.flatnonzero(~np.isnan(found.face_time_s))
    assert len(cut_there) > 500
    corners = found.remains.vertices[found.remains.faces[cut_there]]
    place = corners.mean(axis=1)
    when = found.face_time_s[cut_there]
    level = np.interp(when, motion.time_s, motion.centre[:, 2])
    # the latest corner is the lowest
    off = np.abs(level - corners[..., 2].min(axis=1))
    assert np.median(off) < 0.01
    # pieces of faces at the rim are as far off as layers are apart
    assert off.max() < 0.5
    gap = np.rint(np.arctan2(-place[:, 1], place[:, 0]) / (2 * np.pi / 30)).astype(int)
    stroke = (when // (1e-3 * 220)).astype(int)
    assert set(gap.tolist()) == {0, 1}
    assert (gap == stroke).all()


def test_a_face_has_the_latest_time_of_the_face_it_is_a_piece_of():
    times = [np.array([1.0, 2.0, np.nan, 3.0]), np.array([7.0, np.nan, np.nan])]
    faces = [np.array([[0, 1, 2], [1, 3, 2], [2, 2, 2]]), np.array([[1, 2, 0]])]
    found = face_moments(np.array([-1, 0, 1, 2, 3, 0]), faces, times)
    np.testing.assert_array_equal(found, [np.nan, 2.0, 3.0, np.nan, 7.0, 2.0])
    np.testing.assert_array_equal(face_moments(np.array([-1, -1]), [], []), [np.nan, np.nan])
