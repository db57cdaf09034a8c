"""A hob with runout, wobble, a wrong swivel or wrong gashes, against a rigid hob followed point by point."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))


def turned(axis, angle):
    """Rotation about a unit vector, as the exponential of its cross product by its series."""
    x, y, z = axis
    cross = angle * np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    result, term = np.eye(3), np.eye(3)
    for k in range(1, 12):
        term = term @ cross / k
        result = result + term
    return result


@pytest.mark.parametrize(
    ("fault", "helix"), [("runout", 0.0), ("wobble", 0.0), ("both, twice as large, shifted gashes", 20.0)]
)
def test_depths_are_those_of_a_rigid_hob(hobbed, brute_force, fault, helix):
    from rigid_hob import deepest

    runout, wobble = {"runout": (0.03, 0.0), "wobble": (0.0, 0.03)}.get(fault, (0.06, 0.06))
    gash_error = [0.0, 0.1, 0.0, -0.2, 0.0, 0.0, 0.15, 0.0] if runout and wobble else [0.0] * 8
    lead_error = 15.0 if runout and wobble else 0.0
    settings = {
        "teeth": 17,
        "length": 1.0,
        "feed": 1.0,
        "gashes": 8,
        "hob": 50.0,
        "helix": helix,
        "over": 1.0,
    }
    gear = hobbed(
        f"hob_runout_mm = {runout}\nhob_runout_angle_deg = 70.0\nhob_wobble_mm = {wobble}\n"
        f"hob_wobble_angle_deg = 200.0\nhob_gash_error_deg = {gash_error}\n"
        f"hob_lead_error_um_per_turn = {lead_error}",
        **settings,
    )
    clean = hobbed(**settings)
    assert clean.motion.lean is None
    assert (gear.motion.lean is None) == (wobble == 0.0)
    outlines, pitch, _ = brute_force.hob_outlines(
        module=2.0, outside_diameter=50.0, starts=1, pressure_angle=20.0, addendum=1.25, tip_radius=0.38,
        dedendum=1.25,
    )  # fmt: skip
    longer = lead_error / 1e3
    # the teeth beside the middle one stand as much further off
    outlines = [line + np.array([k * longer, 0.0]) for line, k in zip(outlines, (-1, 0, 1, 0), strict=True)]
    pitch += longer
    gashes = [
        (2 * math.pi * k / 8 + math.radians(error), pitch * k / 8) for k, error in enumerate(gash_error)
    ]
    lean = math.radians(200.0)
    arbor = (
        turned([-math.sin(lean), math.cos(lean), 0.0], math.atan(wobble / 25.0)),
        runout * np.array([math.cos(math.radians(70.0)), math.sin(math.radians(70.0)), 0.0]),
    )
    rng = np.random.default_rng(3)
    radius = gear.gear.reference_diameter / 2
    for tooth, side, off in ((0, 1, 0.0), (0, -1, 1.2), (5, 1, -1.4), (9, -1, -0.7), (12, 1, 1.6)):
        z = rng.uniform(-0.9, -0.1)
        (point,), _ = gear.nominal(np.array([tooth]), side, np.array([radius + off]), np.array([z]))
        index = gear.field.near(point, 1.0)
        found = gear.field.evaluate(np.broadcast_to(point, (len(index), 3)), index).depth.max()
        expected = deepest(point, clean.motion, gashes, arbor, outlines, pitch)
        assert found == pytest.approx(expected, abs=1e-4)
        # and the fault is what makes the difference
        plain = clean.field.evaluate(
            np.broadcast_to(point, (len(index), 3)), index % clean.field.passes.count
        )
        assert expected != pytest.approx(plain.depth.max(), abs=1e-4)


def test_rays_find_the_surface_of_all_passes(hobbed):
    """The rays' own culling leaves out nothing that matters: every pass of the run is asked there."""
    gear = hobbed("hob_wobble_mm = 0.05\nhob_runout_mm = 0.05", length=2.0, feed=1.0)
    rng = np.random.default_rng(5)
    n = 60
    tooth, side = rng.integers(0, 20, n), rng.choice([-1, 1], n)
    radius, z = rng.uniform(18.9, 21.8, n), rng.uniform(-2.0, 0.0, n)
    points, along = gear.nominal(tooth, side, radius, z)
    way = gear.deviation(tooth, side, radius, z) / 1e3
    assert np.isfinite(way).all()
    index = np.arange(gear.field.passes.count)
    for point, out, step in zip(points, along, way, strict=True):
        at = np.broadcast_to(point + step * out, (len(index), 3))
        assert abs(gear.field.evaluate(at, index).depth.max()) < 1e-6


def test_bounds_of_a_wobbling_hob_hold(hobbed):
    """How much a depth can change, and rise above its tangent, within a ball: held by random points in it."""
    gear = hobbed("hob_wobble_mm = 0.3\nhob_runout_mm = 0.2", length=2.0, feed=1.0)
    field = gear.field
    rng = np.random.default_rng(7)
    n = 300
    points, _ = gear.nominal(rng.integers(0, 20, n), 1, rng.uniform(18.0, 22.0, n), rng.uniform(-2.0, 0.0, n))
    for point in points[:40]:
        index = field.near(point, 0.4)
        rows, bites = field.bites_near(
            np.broadcast_to(point, (len(index), 3)), index, np.full(len(index), 0.4)
        )
        assert len(rows)
        middle = field.evaluate_bite(np.broadcast_to(point, (len(bites), 3)), bites, gradient=True)
        change, bent = field.bound(middle, bites, np.full(len(bites), 0.4))
        for _ in range(5):
            off = rng.standard_normal(3)
            off *= 0.4 * rng.uniform() ** (1 / 3) / np.linalg.norm(off)
            there = field.evaluate_bite(np.broadcast_to(point + off, (len(bites), 3)), bites).depth
            assert (np.abs(there - middle.depth) <= change + 1e-9).all()
            assert (there <= middle.depth + middle.gradient @ off + bent + 1e-9).all()
