"""Metal that is followed from one motion to another close by, and where stock meets an edge: foretold."""

from dataclasses import replace

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.field import DepthField
from twin.load.contacts import CLOSE_BY, NEAR
from twin.load.evenly import Evenly
from twin.load.ray_ends import CLOSE, SLACK
from twin.load.removal import looked_for, looked_for_again
from twin.load.stock import Lean, Stock

BLANK = Blank(diameter_mm=28.0, length_mm=3.0)


@pytest.fixture(scope="module")
def hobbing(synthetic):
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
    return synthetic.hobbing(hob, teeth=12, tip_x=9.5, z=(13.0, 9.0), feed=2.0, step_deg=6.0)


def moved(motion, um):
    """The same motion with the tool, and the work's turn, off by waves of at most `um`."""
    wave = np.sin(motion.tool_angle * 0.7), np.cos(motion.tool_angle * 1.1), np.sin(motion.tool_angle * 0.3)
    off = 1e-3 * um / np.sqrt(3.0) * np.column_stack(wave) / 2.0
    turn = 1e-3 * um / 2.0 * np.sin(motion.tool_angle * 0.9) / BLANK.radius
    return replace(motion, centre=motion.centre + off, work_angle=motion.work_angle + turn)


@pytest.mark.parametrize("slope", [0.0, 1.0])
@pytest.mark.parametrize("um", [0.3, 3.0, 1e3 * CLOSE_BY])
def test_metal_that_is_followed_is_the_metal_that_is_looked_for(hobbing, slope, um):
    """Ray by ray and pass by pass, though no ray is looked at that did not meet an edge nearly before."""
    cutter, motion = hobbing
    stock = Stock.of(BLANK, [cutter], 0.4, lean=Lean(slope=slope))
    fields = [DepthField(cutter, m, BLANK.radius, BLANK.z_range) for m in (motion, moved(motion, um))]
    _, known = looked_for(stock, fields[0], motion)
    wanted, _ = looked_for(stock, fields[1], moved(motion, um))
    again = looked_for_again(stock, known, fields[1], moved(motion, um))
    assert again is not None
    found = again[0]
    assert found.volume_mm3.sum() == pytest.approx(wanted.volume_mm3.sum(), rel=1e-4)
    ends = [metal.taken_from(stock).end for metal in (wanted, found)]
    np.testing.assert_allclose(ends[1], ends[0], atol=5.0 * CLOSE)
    count = fields[1].passes.count
    for name in ("volume_mm3", "thickness_mm"):
        old, new = (np.bincount(m.index, getattr(m, name) * m.volume_mm3, count) for m in (wanted, found))
        # ends are known to CLOSE, chips are some 0.05 mm thick
        np.testing.assert_allclose(new, old, atol=5e-4 * old.max())


def test_metal_cannot_be_followed_where_its_passes_are_not(hobbing):
    cutter, motion = hobbing
    stock = Stock.of(BLANK, [cutter], 0.8)
    field = DepthField(cutter, motion, BLANK.radius, BLANK.z_range)
    _, known = looked_for(stock, field, motion)
    # passes are named by the tool's angle
    other = replace(motion, tool_angle=motion.tool_angle + 40.0 * np.pi)
    field = DepthField(cutter, other, BLANK.radius, BLANK.z_range)
    assert looked_for_again(stock, known, field, other) is None


def test_contacts_hold_what_a_motion_close_by_can_bring():
    """The edge comes nearer by CLOSE_BY, and the ray may stand longer by as much, along a slope of 1."""
    assert SLACK >= NEAR >= CLOSE_BY * (1.0 + np.sqrt(2.0))


@pytest.mark.parametrize("um", [0.0, 300.0])
def test_points_meet_edges_where_it_is_foretold_within_the_bound(hobbing, um):
    """Against the kernel's own search for the instant, however unevenly the axes go."""
    cutter, motion = hobbing
    motion = moved(motion, um)
    field = DepthField(cutter, motion, BLANK.radius, BLANK.z_range)
    rng = np.random.default_rng(3)
    number = field.passes.count // 2
    evenly = Evenly.of(motion, float(field.passes.angle[number]), BLANK.radius, 1.0)
    assert evenly is not None
    samples = np.arange(len(motion.time_s))
    work = np.interp(field.passes.at[number], samples, motion.work_angle)
    # points of the blank on the tool's side, where they stand as the edge points to the work
    turn = rng.uniform(-0.8, 0.8, 400)
    radius = BLANK.radius * np.sqrt(rng.uniform(0.3, 1.0, 400))
    place = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), rng.uniform(-3.0, 0.0, 400)])
    cos, sin = np.cos(-work), np.sin(-work)
    part = place @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    own = motion.basis @ (place - evenly.centre).T
    met, bound = evenly.met(own, np.arctan2(own[1], own[0]))
    wanted = field.evaluate(part, np.full(400, number))
    s, rho = met[2] - field.passes.shift[number], np.hypot(met[0], met[1])
    assert np.isfinite(bound).mean() > 0.9
    assert (np.hypot(s - wanted.s, rho - wanted.rho) <= bound + 1e-6).all()
    # which says more than that the stock moves on
    assert bound[np.isfinite(bound)].max() < 0.1 + 4e-3 * um


def test_nothing_is_foretold_where_the_tool_turns_back(hobbing):
    _, motion = hobbing
    back = replace(motion, tool_angle=-np.abs(motion.tool_angle - motion.tool_angle.mean()))
    assert Evenly.of(back, float(back.tool_angle[5]), 14.0, 0.2) is None
    assert Evenly.of(motion, float(motion.tool_angle[-1]), 14.0, 0.2) is None
