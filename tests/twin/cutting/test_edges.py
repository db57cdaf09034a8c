"""Cutting edges as lines: lengths by hand, and places in the part against the search for them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.edge_line import edge_lines
from twin.cutting.engaged import ABOVE, Edges
from twin.cutting.field import DepthField


@pytest.mark.parametrize("corner", [0.0, 0.3])
def test_an_insert_is_two_sides_two_arcs_and_its_flat(corner):
    profile = PolygonHead(inserts=1, tip_radius_mm=30.0, edge_width_mm=2.0, corner_radius_mm=corner).edge()
    (line,) = edge_lines(profile, (-2.0, 2.0))
    flat, arc, side = 2.0 - 2.0 * corner, math.pi / 2.0 * corner, 30.0 - corner
    assert line.length == pytest.approx(2.0 * side + 2.0 * arc + flat, abs=1e-5)
    # up the left side, over the corner by half of it, the middle of the flat
    along = np.array([side - 5.0, side + arc / 2.0, side + arc + flat / 2.0])
    bend = corner * (1.0 - math.sqrt(0.5))
    by_hand = [[-1.0, 25.0 - corner], [-1.0 + bend, 30.0 - bend], [0.0, 30.0]]
    if corner:
        np.testing.assert_allclose(line.at(along), by_hand, atol=1e-5)
        inwards = 0.1 * math.sqrt(0.5)
        np.testing.assert_allclose(
            line.at(along, 0.1)[1], [-1.0 + bend + inwards, 30.0 - bend - inwards], atol=1e-6
        )
    else:
        np.testing.assert_allclose(line.at(along)[[0, 2]], [by_hand[0], by_hand[2]], atol=1e-5)
    assert line.cuts(along).all()


def test_hollow_arcs_of_an_edge_have_their_true_length():
    """A flat, two arcs of a sixth of a circle by 5 mm, and the sides below."""
    profile = PolygonHead(
        inserts=1, tip_radius_mm=30.0, profile=((0.5, 0.0, -5.0), (3.0, 2.5 * math.sqrt(3.0)), (3.0, 6.0))
    ).edge()
    (line,) = edge_lines(profile, (-2.0, 2.0))
    arc, side = 5.0 * math.pi / 3.0, 30.0 - 2.5 * math.sqrt(3.0)
    assert line.length == pytest.approx(2.0 * side + 2.0 * arc + 1.0, abs=1e-9)
    # the centre is a corner of the triangle of equal sides on the chord
    centre = np.array([5.5, 30.0])
    turn = math.pi - np.linspace(0.0, math.pi / 3.0, 9)
    along = side + arc + 1.0 + 5.0 * (math.pi - turn)
    out = np.column_stack([np.cos(turn), -np.sin(turn)])
    for above in (0.0, 0.2):
        np.testing.assert_allclose(
            line.at(along[1:-1], above), (centre + (5.0 + above) * out)[1:-1], atol=1e-9
        )
        left = line.at(line.length - along[1:-1], above)
        np.testing.assert_allclose(left, (centre + (5.0 + above) * out)[1:-1] * [-1.0, 1.0], atol=1e-9)
    np.testing.assert_allclose(line.nearest(line.at(along, 0.1))[1:-1], along[1:-1], atol=1e-9)
    assert line.cuts(along).all()


def test_a_hobs_flanks_cut_down_to_its_land_alone():
    cutter = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8, protuberance_mm=0.05).cutter(0.0)
    for line in edge_lines(cutter.profile, (-10.0, 10.0)):
        along = np.linspace(0.01, line.length - 0.01, 2000)
        place = line.at(along)
        # without gaps: chords are as long as the line between them, but across corners
        chord = np.linalg.norm(np.diff(place, axis=0), axis=1) / np.diff(along)
        assert (chord < 1.0 + 1e-4).all()
        assert (chord < 1.0 - 1e-3).sum() <= 4
        np.testing.assert_allclose(line.nearest(line.at(along, 1e-3)), along, atol=1e-6)
        depth = cutter.profile.depth(*place.T)[0]
        cuts = line.cuts(along)
        assert cuts.any()
        assert (depth[cuts] < 0.02).all()
        assert (place[cuts, 1] > cutter.profile.root - 0.02).all()


@pytest.mark.parametrize("gash", ["straight", "helical"])
@pytest.mark.parametrize("crooked", [False, True])
def test_places_of_edges_meet_them_there_and_then(synthetic, gash, crooked):
    hob = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8, gash=gash)
    cutter, motion = synthetic.hobbing(
        hob, teeth=10, helix_deg=15.0, tip_x=7.5, z=(1.0, -3.0), feed=2.0, step_deg=6.0
    )
    rng = np.random.default_rng(0)
    if crooked:
        motion = synthetic.jittered(motion, rng)
        motion = synthetic.clamped(motion, eccentricity=0.1, tilt=0.01)
        motion = replace(motion, lean=np.full((len(motion.time_s), 2), 1e-3))
    field = DepthField(cutter, motion, 14.0, (-3.0, 0.0))
    edges = Edges(field)
    n = 1000
    bite, turn = rng.integers(0, field.count, n), rng.uniform(-0.6, 0.6, n)
    along = rng.uniform(0.0, 1.0, n) * edges.length(bite)
    points, cuts = edges.at(bite, along, turn)
    points, bite, along, turn = points[cuts], bite[cuts], along[cuts], turn[cuts]
    assert len(bite) > 20
    met = field.evaluate_bite(points, bite)
    np.testing.assert_allclose(met.depth, ABOVE, atol=1e-6)
    foot, when = edges.foot(bite, met.s, met.rho, met.instant)
    np.testing.assert_allclose(foot, along, atol=1e-4)
    np.testing.assert_allclose(when, turn, atol=1e-6)
