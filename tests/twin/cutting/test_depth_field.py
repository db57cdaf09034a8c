"""The field against an evaluator that shares nothing with it, and its gradient against differences."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from random_cuts import cuts, hollow_cuts

from twin.benchmark.cases import gear_case
from twin.cutters.hob import Hob
from twin.cutting.field import DepthField
from twin.cutting.passes import REACH

few = settings(derandomize=True, deadline=None, max_examples=20, database=None)

TOLERANCE = 1e-6
"""[mm] of two evaluators that both settle far below 0.1 µm"""


def over_all_passes(field, point):
    passes = np.arange(field.passes.count)
    return field.evaluate(np.repeat(point[None], len(passes), axis=0), passes, gradient=True)


@few
@given(cut=cuts, seed=st.integers(0, 1000))
def test_field_is_the_deepest_crossing_of_all_edges(cut, seed):
    field = cut.field()
    ends = np.unique(np.concatenate([field.passes.first, field.passes.last]))
    for point in cut.points(3, seed):
        depth = over_all_passes(field, point).depth.max(initial=-math.inf)
        expected, instant = cut.truth(point)
        if abs(expected) > cut.chords + TOLERANCE:
            assert (depth > 0) == (expected > 0)
        # far off passes are left out, and a sweep that ends there may be nearer than any crossing
        if expected < -0.5 * cut.feature or math.isnan(instant):
            continue
        # next to the rake plane at which the tool stopped, that plane is the nearer surface
        turned = np.interp(instant, np.arange(len(cut.motion.tool_angle)), cut.motion.tool_angle)
        at_end = np.interp(ends, np.arange(len(cut.motion.tool_angle)), cut.motion.tool_angle)
        if cut.cutter.revolved or np.abs(turned - at_end).min() > math.pi:
            assert depth <= expected + cut.chords + TOLERANCE
            # inside a hollow outline the depth is no distance
            assert depth >= expected - TOLERANCE or (cut.hollow and expected > 0)


@few
@given(cut=cuts, seed=st.integers(0, 1000))
def test_gradient_is_the_slope_of_the_field(cut, seed):
    field = cut.field()
    rng = np.random.default_rng(seed)
    points = cut.points(60, seed)
    passes = rng.integers(0, field.passes.count, len(points))
    meeting = field.evaluate(points, passes, gradient=True)
    h = 1e-5
    ahead, behind = (
        np.stack(
            [(field.evaluate(points + e, passes).depth - meeting.depth) / way for e in way * np.eye(3)],
            axis=1,
        )
        for way in (h, -h)
    )
    # but for the points within h of a ridge, or of a sample at which the motion changes
    smooth = np.abs(ahead - behind).max(axis=1) < 1e-3
    assert smooth.mean() > 0.75
    # far off, an edge that stops on its way and a wheel's body are only about right
    near = meeting.depth > -0.5 * cut.feature
    off = np.linalg.norm(0.5 * (ahead + behind) - meeting.gradient, axis=1)
    assert (off[smooth & near] < 1e-3).all()


@few
@given(cut=cuts, seed=st.integers(0, 1000))
def test_bounds_hold_around_a_point(cut, seed):
    """The change of the field and its departure from the tangent, anywhere within the radius."""
    field = cut.field()
    rng = np.random.default_rng(seed)
    n = 400
    points = cut.points(n, seed)
    bites = rng.integers(0, field.count, n)
    radius = cut.feature * 10.0 ** rng.uniform(-2.5, 0.0, n)
    step = rng.standard_normal((n, 3))
    step *= (radius * rng.uniform(0.0, 1.0, n) / np.linalg.norm(step, axis=1))[:, None]
    here = field.evaluate_bite(points, bites, gradient=True)
    there = field.evaluate_bite(points + step, bites)
    change, bent = field.bound(here, bites, radius)
    assert (np.abs(there.depth - here.depth) <= change + 1e-9).all()
    tangent = here.depth + (here.gradient * step).sum(axis=1)
    assert (there.depth <= tangent + bent + 1e-9).all()


@settings(few, max_examples=10)
@given(cut=hollow_cuts, seed=st.integers(0, 1000))
def test_bounds_hold_beside_hollow_arcs(cut, seed):
    """Of tangents and of floors; and, next to arcs much rounder than the tool, not without what they add."""
    field = cut.field()
    rng = np.random.default_rng(seed)
    n = 20_000
    points = cut.points(n, seed)
    # passes that no end of a run is near to
    whole = np.flatnonzero(np.abs(field.passes.angle[:, None] - field.passes.run_angle).min(axis=1) > 4.0)
    assume(len(whole))
    bites = rng.choice(whole, n) * field.bites + rng.integers(0, field.bites, n)
    radius = cut.feature * 10.0 ** rng.uniform(-2.5, -0.3, n)
    corners = rng.standard_normal((n, 8, 3))
    corners *= (radius[:, None] / np.linalg.norm(corners, axis=2))[:, :, None]
    here = field.evaluate_bite(points, bites, gradient=True)
    # there is a corner, or between two of them
    share = np.where(rng.uniform(size=n) < 0.5, 1.0, rng.uniform(0.0, 1.0, n))
    step = share[:, None] * corners[:, 0] + (1.0 - share)[:, None] * corners[:, 1]
    there = field.evaluate_bite(points + step, bites).depth
    change, bent = field.bound(here, bites, radius)
    near = here.depth > -10.0
    assert (np.abs(there - here.depth) <= change + 1e-9)[near].all()
    tangent = here.depth + (here.gradient * step).sum(axis=1)
    assert (there <= tangent + bent + 1e-9).all()
    floors = field.floors(points, points[:, None] + corners, bites, radius)
    assert (there >= share * floors[0] + (1.0 - share) * floors[1] - 1e-9)[near].all()
    rounder = cut.cutter.radius / min(piece.hollow for piece in cut.cutter.profile.pieces)
    field._bends = False
    straight = field.bound(here, bites, radius)[1]
    assert (straight <= bent).all()
    assert rounder < 10.0 or (there > tangent + straight + 1e-9).any()


@pytest.mark.parametrize("gash", ["straight", "helical"])
def test_bounds_hold_where_the_tool_stops_and_starts_again(synthetic, gash):
    """Passes whose run ends while they are at the work: bounded, but next to the edges that stand."""
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, starts=3, gash=gash)
    cutter, motion = synthetic.hobbing(hob, teeth=20, tip_x=17.5, z=(2, -2), feed=2, step_deg=5)
    speed = np.concatenate([np.ones(600), np.linspace(1, 0, 50), np.linspace(0, 1, 50), np.ones(200)])
    field = DepthField(cutter, synthetic.at_speed(motion, speed), 22.0, (-3.0, 3.0))
    rng = np.random.default_rng(3)
    n = 40_000
    r, angle = rng.uniform(17.0, 22.0, n), rng.uniform(0.0, 2.0 * math.pi, n)
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle), rng.uniform(-2.0, 2.0, n)])
    ended = np.flatnonzero(np.ptp(field.passes.run_angle, axis=1) < np.ptp(motion.tool_angle))
    bites = rng.choice(ended, n) * field.bites + rng.integers(0, field.bites, n)
    radius = 10.0 ** rng.uniform(-2.0, 0.5, n)
    way = rng.standard_normal((n, 3))
    way *= (radius * rng.uniform(0.5, 1.0, n) / np.linalg.norm(way, axis=1))[:, None]
    here = field.evaluate_bite(points, bites, gradient=True)
    change, bent = field.bound(here, bites, radius)
    depth = field.evaluate_bite(points + way, bites).depth
    near = here.depth > -10.0
    assert (np.abs(depth - here.depth) <= change + 1e-9)[near].all()
    assert (depth <= here.depth + (here.gradient * way).sum(axis=1) + bent + 1e-9).all()
    met_at_the_end = np.isin(here.instant, np.concatenate([field.passes.first, field.passes.last]))
    assert np.isinf(bent[met_at_the_end]).all()
    assert np.isfinite(bent[~met_at_the_end & near]).mean() > 0.5


@few
@given(cut=cuts, seed=st.integers(0, 1000))
def test_a_pass_is_as_deep_as_its_deepest_bite(cut, seed):
    field = cut.field()
    points = cut.points(20, seed)
    for index in np.random.default_rng(seed).integers(0, field.passes.count, 5):
        whole = field.evaluate(points, np.full(len(points), index)).depth
        each = np.tile(index * field.bites + np.arange(field.bites), len(points))
        bites = field.evaluate_bite(np.repeat(points, field.bites, axis=0), each).depth
        # far off a wheel's body its field is only about right
        near = whole > -1.0 if cut.cutter.revolved else np.ones(len(points), dtype=bool)
        assert bites.reshape(len(points), -1).max(axis=1)[near] == pytest.approx(whole[near], abs=1e-9)


def nearest(field, motion, point):
    """How near each pass's tool axis comes to a point, at the samples in which its edge faces the work."""
    work, tool = motion.work_angle, motion.tool_angle
    x, y, z = motion.mount.moved(point[None])[0]
    there = np.stack([x * np.cos(work) - y * np.sin(work), x * np.sin(work) + y * np.cos(work), z + 0 * work])
    off = there.T - motion.centre
    axis = np.tile(motion.basis[2], (len(work), 1))
    if motion.lean is not None:
        axis = np.column_stack([motion.lean, np.sqrt(1.0 - (motion.lean**2).sum(axis=1))]) @ motion.basis
    away = np.linalg.norm(off - np.einsum("nx,nx->n", off, axis)[:, None] * axis, axis=1)
    p, sample = field.passes, np.arange(len(work))
    found = np.full(p.count, np.inf)
    for n in range(p.count):
        facing = np.abs(tool - p.angle[n]) <= REACH
        facing &= (sample >= p.first[n]) & (sample <= p.last[n])
        found[n] = away[facing].min(initial=np.inf)
    return found


@few
@given(cut=cuts.filter(lambda cut: not cut.cutter.revolved), seed=st.integers(0, 1000))
def test_a_pass_whose_tool_comes_near_a_point_is_among_those_near_it(cut, seed):
    field, radius = cut.field(), 0.2 * cut.feature
    for point in cut.points(3, seed):
        way = nearest(field, cut.motion, point)
        assert set(np.flatnonzero(way < cut.cutter.radius + radius)) <= set(field.near(point, radius))


def test_few_others_are_among_them():
    case = gear_case(module=2.0, teeth=20, width=6.0, hob_diameter=70.0)
    field = DepthField(case.cutter, case.motion, case.blank.radius, case.blank.z_range)
    for x, y in ((21.5, 0.0), (15.0, 10.0), (0.0, -18.0)):
        point = np.array([x, y, -3.0])
        way = nearest(field, case.motion, point)
        near = field.near(point, 1.0)
        assert len(near) < 1.3 * np.count_nonzero(way < case.cutter.radius + 1.0)
        few = field.near(point, 1.0, np.arange(0, field.passes.count, 7))
        assert few.tolist() == [n for n in near if n % 7 == 0]


@pytest.mark.parametrize("tremble", [0.0, 1e-9, 1e-7, 1e-6])
def test_standing_spindle_trembling_in_its_servo_adds_nothing(synthetic, tremble):
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=70.0)
    cutter, motion = synthetic.hobbing(hob, teeth=20, tip_x=17.5, z=(2, -2), feed=2, step_deg=5)
    speed = np.concatenate(
        [np.ones(700), np.linspace(1, 0, 50), np.zeros(300), np.linspace(0, 1, 50), np.ones(300)]
    )
    whole = DepthField(cutter, synthetic.at_speed(motion, speed[speed > 0]), 22.0, (-3.0, 3.0))
    noise = {"slide": 20 * tremble, "work": tremble, "tool": tremble}
    dwelling = synthetic.jittered(synthetic.at_speed(motion, speed), np.random.default_rng(0), **noise)
    field = DepthField(cutter, dwelling, 22.0, (-3.0, 3.0))
    rng = np.random.default_rng(1)
    r, angle = rng.uniform(17.0, 22.0, 20), rng.uniform(0.0, 2.0 * math.pi, 20)
    for point in np.column_stack([r * np.cos(angle), r * np.sin(angle), rng.uniform(-2.0, 2.0, 20)]):
        expected = over_all_passes(whole, point).depth.max()
        # the tremble itself, on the tips' radius and across the work
        assert over_all_passes(field, point).depth.max() == pytest.approx(expected, abs=1e-9 + 200 * tremble)
