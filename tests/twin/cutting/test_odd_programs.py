"""Programs that cut something else than a whole gear, against closed forms and the independent evaluator."""

import math
from dataclasses import replace

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.cutting.cut import cut
from twin.cutting.field import DepthField

GRID = 2.0**-17
"""[mm] that snapping may move a vertex of this size"""
HOB = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
TEETH, ROOT, TIP = 10, 7.5, 12.0
BLANK = Blank(diameter_mm=2 * TIP, length_mm=4.0, bore_mm=6.0)


def hobbing(synthetic, *, blank_z=(14.0, -19.0), **more):
    more = {"teeth": TEETH, "tip_x": ROOT, "feed": 2.0, "step_deg": 6.0} | more
    return synthetic.hobbing(HOB, z=blank_z, **more)


def cut_vertices(part, blank):
    """Those inside the blank's outline: made by the tool alone."""
    inner = replace(blank, diameter_mm=blank.diameter_mm - 2e-3, bore_mm=blank.bore_mm + 2e-3)
    low, high = blank.z_range
    z = part.vertices[:, 2]
    return part.vertices[inner.contains(part.vertices) & (z > low + 1e-3) & (z < high - 1e-3)]


def outlines(brute_force):
    drawn, pitch, _ = brute_force.hob_outlines(
        module=2.0,
        outside_diameter=40.0,
        starts=1,
        pressure_angle=20.0,
        addendum=1.25,
        tip_radius=0.38,
        dedendum=1.25,
    )
    return drawn, pitch


def test_plunge_alone_leaves_the_hobs_own_circle(synthetic):
    """No feed along the work: the gap's floor is the hob's circle, and ends where that leaves the blank."""
    blank = Blank(diameter_mm=2 * TIP, length_mm=40.0, bore_mm=6.0)
    cutter, motion = hobbing(synthetic, blank_z=(-20.0, -20.0 - 1e-9), feed=0.5e-9)
    n = len(motion.time_s)
    centre = motion.centre.copy()
    centre[:, 0] += np.clip(np.linspace(9.0, -4.5, n), 0.0, None)
    part = cut(blank, ((cutter, replace(motion, centre=centre)),), cell_mm=0.6).remains
    v = cut_vertices(part, blank)
    # distance from the hob's axis, at the work angle that brings a vertex nearest to it
    axis, middle = motion.basis[2], np.array([ROOT + HOB.outside_diameter_mm / 2, 0.0, -20.0])
    turn = np.exp(1j * np.arctan2(v[:, 1], v[:, 0]))[:, None] * np.exp(1j * np.linspace(0, 2 * math.pi, 721))
    r = np.hypot(v[:, 0], v[:, 1])
    around = r[:, None] * turn
    off = np.stack([around.real, around.imag, np.broadcast_to(v[:, 2:], around.shape)], axis=2) - middle
    nearest = np.linalg.norm(np.cross(off, axis), axis=2).min(axis=1)
    radius = HOB.outside_diameter_mm / 2
    # within one step of the angles
    assert (nearest <= radius + 2e-3).all()
    z = v[:, 2] + 20.0
    reach = math.sqrt((TIP - ROOT) * (2 * radius - (TIP - ROOT)))
    assert reach - 1.0 < np.abs(z).max() < reach + 0.7
    assert ROOT - 1e-4 < r.min() < ROOT + 0.02
    # the floor itself, all along: as near to the hob's circle as the generating flats let it
    for low in (-9.0, -4.0, 0.0, 3.0, 8.0):
        here = (z > low) & (z < low + 1.0)
        assert nearest[here].max() > radius - 0.02


def test_second_pass_at_another_speed_takes_nothing_more(synthetic):
    """Rigid axes: the same path at a third of the speed, sampled three times as finely, is the same cut.

    Its surface is that of the first pass alone. Where two bites are one the mesh need not be divided at the
    same places, so the volumes agree as far as facets do.
    """
    cutter, motion = hobbing(synthetic)
    n = 3 * (len(motion.time_s) - 1)
    slow = synthetic.at_speed(motion, np.full(n, 1.0 / 3.0) * (1 - 1e-12))
    once = cut(BLANK, ((cutter, motion),), cell_mm=0.4).remains
    twice = cut(BLANK, ((cutter, motion), (cutter, slow)), cell_mm=0.4).remains
    assert twice.genus == once.genus == 1
    assert twice.volume_mm3 == pytest.approx(once.volume_mm3, rel=1e-5)
    first = DepthField(cutter, motion, TIP, BLANK.z_range)
    vertices = np.random.default_rng(5).choice(cut_vertices(twice, BLANK), 300, replace=False)
    passes = np.arange(first.passes.count)
    depth = [first.evaluate(np.broadcast_to(v, (len(passes), 3)), passes).depth.max() for v in vertices]
    assert np.abs(depth).max() < 1e-4


def test_second_pass_that_lags_takes_a_slice_off_one_flank(synthetic):
    """Shifted by a work angle: each gap grows by that angle, V = z ∫ r δ dr over the teeth's own height."""
    cutter, motion = hobbing(synthetic)
    shift = 2e-3
    late = replace(motion, work_angle=motion.work_angle + shift)
    once = cut(BLANK, ((cutter, motion),), cell_mm=0.25).remains
    twice = cut(BLANK, ((cutter, motion), (cutter, late)), cell_mm=0.25).remains
    # from the deepest point that both flanks of a gap reach, up to the tip
    v = cut_vertices(once, BLANK)
    r = np.hypot(v[:, 0], v[:, 1])
    assert r.min() == pytest.approx(ROOT, abs=0.03)
    expected = TEETH * BLANK.length_mm * shift * (TIP**2 - ROOT**2) / 2
    assert once.volume_mm3 - twice.volume_mm3 == pytest.approx(expected, rel=0.03)


def test_overlapping_gaps_stand_on_the_independent_evaluator(synthetic, brute_force):
    """A ratio for 10½ teeth: every other turn the gaps fall between those of the turn before."""
    cutter, motion = hobbing(synthetic, ratio_factor=TEETH / (TEETH + 0.5))
    result = cut(BLANK, ((cutter, motion),), cell_mm=0.4)
    v = cut_vertices(result.remains, BLANK)
    drawn, pitch = outlines(brute_force)
    points = v[np.random.default_rng(2).choice(len(v), 25, replace=False)]
    off = np.array([brute_force.field(point, motion, cutter, drawn, pitch)[0] for point in points])
    assert np.median(np.abs(off)) < GRID
    assert np.abs(off).max() < 1e-4
    # the tooth space of the gear is gone twice over
    assert np.hypot(v[:, 0], v[:, 1]).min() > ROOT - 2e-3
    assert result.remains.volume_mm3 < cut(BLANK, (hobbing(synthetic),), cell_mm=0.4).remains.volume_mm3


GROOVER = PolygonHead(inserts=4, tip_radius_mm=40.0, edge_width_mm=2.0)


def grooves(synthetic, *heights):
    """Plunges at several z: rings of 8 mm across flats, as wide as the insert."""
    return tuple(
        synthetic.polygon_turning(GROOVER, ratio=2, across_flats=14.0, work_turns=2, z=(z, z), step_deg=2.0)
        for z in heights
    )


def test_a_wall_thinner_than_a_cell_is_reported_with_its_place(synthetic):
    blank = Blank(diameter_mm=19.0, length_mm=5.0)
    wall = 0.06
    result = cut(blank, grooves(synthetic, -1.4, -3.4 - wall), cell_mm=0.25)
    (note,) = [note for note in result.notes if "thinner than a cell" in note]
    assert note.startswith("fins thinner than a cell")
    thick = float(note.split("up to ")[1].split(" µm")[0])
    assert 0.7 * 60 < thick <= 60
    assert "z -2.5 and -2.4 mm" in note
    # the wall between the octagon that the head turns and the bar
    area = math.pi * 9.5**2 - 8 * 7.0**2 * math.tan(math.pi / 8)
    assert float(note.split("about ")[1].split(" mm³")[0]) == pytest.approx(wall * area, rel=0.5)


def test_a_wall_of_several_cells_is_cut_and_nothing_reported(synthetic):
    blank = Blank(diameter_mm=19.0, length_mm=6.0)
    result = cut(blank, grooves(synthetic, -1.4, -4.4), cell_mm=0.25)
    assert not [note for note in result.notes if "thinner than a cell" in note]
