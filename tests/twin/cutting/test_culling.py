"""No pass that matters is ever culled: the deepest one survives, exactly, at every point of a block."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_cuts import cuts

from twin.cutters.hob import Hob
from twin.cutting.engagement import StockCylinder, scraped
from twin.cutting.fields import tool_field
from twin.cutting.motion import RigidTransform
from twin.cutting.passes import find_passes
from twin.cutting.refine import cull, first_cull
from twin.cutting.sweep import Sweep
from twin.cutting.touch import SETTLED
from twin.errors import PartError

few = settings(derandomize=True, deadline=None, max_examples=12, database=None)

SIGNS = np.array(list(itertools.product([-1.0, 1.0], repeat=3)))


def all_depths(field, points):
    """(points, passes)"""
    n = field.passes.count
    index = np.tile(np.arange(n), len(points))
    return field.evaluate(np.repeat(points, n, axis=0), index).depth.reshape(len(points), n)


def bite_depths(field, points, bites):
    """(points, bites)"""
    n = len(bites)
    depth = field.evaluate_bite(np.repeat(points, n, axis=0), np.tile(bites, len(points))).depth
    return depth.reshape(len(points), n)


@few
@given(cut=cuts, seed=st.integers(0, 1000))
def test_culling_keeps_the_deepest_pass(cut, seed):
    field = cut.field()
    sweep = Sweep((field,))
    rng = np.random.default_rng(seed)
    for start in cut.points(3, seed):
        middle = start
        half = cut.feature * rng.uniform(0.2, 1.0, 3)
        tangents = None
        # a box of any attitude, then ever smaller ones inside it
        while half.max() > 3e-3 * cut.feature:
            axes = np.linalg.qr(rng.standard_normal((3, 3)))[0]
            corners = middle + (SIGNS * half) @ axes
            if tangents is None:
                done = first_cull(sweep, middle[None], corners[None])
            else:
                done = cull(sweep, middle[None], corners[None], np.zeros(1, dtype=int), tangents)
            # the corners of the box and points of its inside and faces
            inside = np.clip(rng.uniform(-1.4, 1.4, (16, 3)), -1.0, 1.0)
            points = middle + (np.vstack([SIGNS, inside]) * half) @ axes
            depth = all_depths(field, points)
            deepest = depth.max(axis=1)
            cut_away = deepest > 0
            if done.whole[0]:
                assert cut_away.all()
                break
            if not len(done.alive):
                assert not cut_away.any()
                break
            tangents = done.tangents
            left = tangents.lists.bites
            depth = bite_depths(field, points, left)
            survivors = depth.max(axis=1)
            assert survivors[cut_away] == pytest.approx(deepest[cut_away], abs=1e-12)
            # the tangents bound their bites from above in the whole ball, and tell the deepest
            ball = rng.standard_normal((16, 3))
            ball *= rng.uniform(0.0, tangents.radius) / np.linalg.norm(ball, axis=1, keepdims=True)
            level, slope = tangents.plane[0], tangents.plane[1:]
            bound = level + ball @ slope + tangents.over
            assert (bite_depths(field, middle + ball, left) <= bound + 1e-7).all()
            home = np.zeros(len(points), dtype=int)
            found = sweep.deepest(points, home, tangents, gradient=True)
            assert found.depth == pytest.approx(survivors, abs=1e-7)
            own = bite_depths(field, points, found.bite).diagonal()
            assert own == pytest.approx(found.depth, abs=1e-9)
            best = left[depth.argmax(axis=1)]
            # where one bite alone is the deepest, and on neither side of a corner of its edge
            single = (depth > survivors[:, None] - 1e-6).sum(axis=1) == 1
            expected = field.evaluate_bite(points, best, gradient=True).gradient
            step = 1e-6 * rng.standard_normal(points.shape)
            for way in (-1.0, 1.0):
                beside = field.evaluate_bite(points + way * step, best, gradient=True).gradient
                single &= np.abs(beside - expected).max(axis=1) < 1e-4
            assert found.gradient[single] == pytest.approx(expected[single], abs=1e-6)
            signs = sweep.deepest(points, home, tangents, sign=True).depth
            assert ((signs > 0) == (survivors > 0))[np.abs(survivors) > 1e-7].all()
            middle, half = points[rng.integers(8, len(points))], half / 3.0


@few
@given(cut=cuts, seed=st.integers(0, 1000))
def test_no_pass_that_cuts_is_left_out_at_the_start(cut, seed):
    """The passes found for the stock, against those found for one a hundred times its size."""
    field = cut.field()
    points = cut.points(20, seed)
    everything = tool_field(cut.cutter, cut.motion, 1.01 * cut.radii[1], (-1e4, 1e4))
    expected = all_depths(everything, points).max(axis=1, initial=-np.inf)
    near = Sweep((field,)).near(points, np.full(len(points), 1e-6))
    # windows that begin elsewhere end the search for a wheel's deepest instant elsewhere
    settled = SETTLED if cut.cutter.revolved else 1e-8
    for point, all_of_them, row in zip(points, expected, range(len(points)), strict=True):
        mine = near.of(np.array([row])).bites
        found = field.evaluate_bite(np.repeat(point[None], len(mine), axis=0), mine).depth.max(
            initial=-np.inf
        )
        if all_of_them > 0:
            assert found == pytest.approx(all_of_them, abs=settled)
        else:
            assert found <= settled


@given(
    swivel=st.floats(-80.0, 80.0),
    offset=st.floats(-30.0, 30.0),
    height=st.floats(-90.0, 90.0),
    x=st.floats(0.0, 90.0),
)
@settings(few, max_examples=200)
def test_clear_tool_touches_no_point_of_the_cylinder(swivel, offset, height, x, synthetic):
    """Large swivels and tools far off the middle: distance to the axis line of points all over the stock."""
    stock = StockCylinder(radius=12.0, z_low=-9.0, z_high=4.0)
    basis = synthetic.tool_basis(np.pi / 2 - np.radians(swivel))
    centre = np.array([[x, offset, height]])
    angle, r, z = np.meshgrid(np.linspace(0, 2 * np.pi, 73), [0.0, 6.0, 12.0], np.linspace(-9.0, 4.0, 9))
    points = np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1).reshape(-1, 3)
    nearest = np.linalg.norm(np.cross(points - centre, basis[2]), axis=1).min()
    for reach in (0.5 * nearest, 0.97 * nearest - 0.2, nearest + 1e-9, 40.0):
        if stock.clear_of(centre, basis, reach)[0]:
            assert nearest > reach
        elif nearest > 5.0:
            # the directions tried stand 11° apart: nothing far off is kept
            assert nearest < (reach + 24.0) / np.cos(np.pi / 32)


@given(eccentricity=st.floats(0.0, 2.0), tilt=st.floats(0.0, 0.3), seed=st.integers(0, 1000))
@settings(few, max_examples=100)
def test_stock_cylinder_holds_the_clamped_blank(eccentricity, tilt, seed):
    rng = np.random.default_rng(seed)
    axis = rng.standard_normal(3)
    axis /= np.linalg.norm(axis)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    rotation = np.eye(3) + np.sin(tilt) * cross + (1 - np.cos(tilt)) * cross @ cross
    mount = RigidTransform(rotation=rotation, translation=eccentricity * rng.standard_normal(3))
    stock = StockCylinder.around(mount, 10.0, (-8.0, 3.0))
    angle, z = rng.uniform(0, 2 * np.pi, 500), rng.choice([-8.0, 3.0, 0.0], 500)
    points = np.column_stack([10 * np.cos(angle), 10 * np.sin(angle), z]) @ rotation.T + mount.translation
    assert np.hypot(points[:, 0], points[:, 1]).max() <= stock.radius + 1e-9
    assert stock.z_low - 1e-9 <= points[:, 2].min()
    assert points[:, 2].max() <= stock.z_high + 1e-9


HOB = Hob(normal_module_mm=2.0, outside_diameter_mm=70.0)
STOCK = StockCylinder(radius=22.0, z_low=-4.0, z_high=4.0)


def test_feed_past_a_standing_tool_is_told(synthetic):
    cutter, motion = synthetic.hobbing(HOB, teeth=20, tip_x=17.5, z=(3, -3), feed=3, step_deg=5)
    still = np.linspace(0.0, -1.5, 400)[:, None] * [0.0, 0.0, 1.0]
    stopped = type(motion)(
        time_s=1e-3 * np.arange(1400),
        work_angle=np.append(motion.work_angle[:1000], np.full(400, motion.work_angle[999])),
        tool_angle=np.append(motion.tool_angle[:1000], np.full(400, motion.tool_angle[999])),
        centre=np.vstack([motion.centre[:1000], motion.centre[999] + still]),
        basis=motion.basis,
    )
    assert scraped(cutter, motion, STOCK) == 0.0
    assert scraped(cutter, stopped, STOCK) == pytest.approx(1.5, abs=0.01)
    far = StockCylinder(radius=22.0, z_low=-300.0, z_high=-200.0)
    assert scraped(cutter, stopped, far) == 0.0


def test_work_faster_than_the_tool_is_refused(synthetic):
    cutter, motion = synthetic.hobbing(
        HOB, teeth=20, tip_x=17.5, z=(3, -3), feed=3, step_deg=5, ratio_factor=60.0
    )
    with pytest.raises(
        PartError, match=r"faster than the tool turns.*check S, the ratio T:L or P:Q, and the feed"
    ):
        scraped(cutter, motion, STOCK)


def test_tool_that_never_turns_makes_no_pass(synthetic):
    cutter, motion = synthetic.hobbing(HOB, teeth=20, tip_x=17.5, z=(3, -3), feed=3, step_deg=5)
    frozen = synthetic.at_speed(motion, np.zeros(50))
    assert find_passes(cutter, frozen, 22.0, (-4.0, 4.0)).count == 0


def test_bites_near_points_are_the_same_however_many_points_are_asked_at_once(synthetic):
    """Two tools, points within reach of both, of one, and of none."""
    fields = []
    for tip_x, z in ((14.0, (2.0, -2.0)), (15.0, (12.0, 6.0))):
        hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
        cutter, motion = synthetic.hobbing(
            hob, teeth=16, helix_deg=0.0, tip_x=tip_x, z=z, feed=2.0, step_deg=6.0
        )
        fields.append(tool_field(cutter, motion, 20.0, (-10.0, 20.0)))
    sweep = Sweep(tuple(fields))
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.uniform(-20, 20, (30, 2)), np.linspace(-60.0, 60.0, 30)])
    radius = rng.uniform(0.1, 2.0, 30)
    together = sweep.near(points, radius)
    assert (np.diff(together.start) == 0).any()
    for row in range(30):
        alone = sweep.near(points[[row]], radius[[row]])
        own = together.bites[together.start[row] : together.start[row + 1]]
        expected = [
            first
            + f.bites_near(np.tile(points[row], (len(index), 1)), index, np.full(len(index), radius[row]))[1]
            for f, first in zip(sweep.fields, (0, sweep.fields[0].count), strict=True)
            for index in [f.near(points[row], radius[row])]
        ]
        assert own.tolist() == alone.bites.tolist() == np.concatenate(expected).tolist()
