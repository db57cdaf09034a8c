"""Teeth given as chains of lines and arcs: their depth against a drawing of them, and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from twin.cutters.chain import CHORD
from twin.cutters.disc_wheel import DiscWheel
from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutters.profile import tooth_profile
from twin.errors import InputError

few = settings(derandomize=True, deadline=None, max_examples=60, database=None)
TIP = 30.0


@st.composite
def chains(draw):
    """Two to six points from the tip down: wider, narrower, ledges, bulging and hollow arcs."""
    count = draw(st.integers(2, 6))
    points = [[draw(st.sampled_from([0.0, 0.3, 1.0])), 0.0]]
    for _ in range(count - 1):
        ledge = len(points) > 1 and points[-1][1] > points[-2][1] and draw(st.booleans())
        down = 0.0 if ledge else draw(st.floats(0.1, 2.0))
        width = draw(st.floats(0.2, 3.0))
        assume(down > 0 or abs(width - points[-1][0]) > 0.05)
        chord = math.hypot(width - points[-1][0], down)
        bend = draw(st.sampled_from([0.0, 0.0, 0.55, -0.55, 1.5, -1.5, 8.0, -8.0]))
        if bend and not ledge:
            points[-1].append(bend * chord)
        points.append([width, points[-1][1] + down])
    assume(points[-1][1] > 0)
    return points


def read(points, **more):
    """The profile, if the arcs drawn stay in the range of their ends' depths."""
    try:
        return tooth_profile(points, tip=TIP, **more)
    except InputError as error:
        assume(not any(words in error.text for words in ("runs up again before", "crosses the middle")))
        raise


@few
@given(points=chains(), seed=st.integers(0, 1000), chords=st.booleans())
def test_tooth_is_what_its_chain_draws(points, seed, chords, brute_force):
    profile = read(points, land=False, chords=chords)
    (outline,) = brute_force.chain_outlines(points, tip=TIP)
    rng = np.random.default_rng(seed)
    n = 60
    # half of them near the outline, where the sign turns
    on = outline[rng.integers(1, len(outline) - 1, n)]
    s, rho = np.vstack(
        [
            on + rng.normal(0.0, 0.02, (n, 2)),
            np.column_stack([rng.uniform(-4, 4, n), TIP + rng.uniform(-points[-1][1] - 1, 1, n)]),
        ]
    ).T
    depth, by_s, by_rho = profile.depth(s, rho)
    drawn = np.array([brute_force.depth_in_outline(outline, *at) for at in zip(s, rho, strict=True)])
    # chords in place of hollow arcs stand out of them
    off = CHORD * chords + 2e-6
    assert (depth <= drawn + off).all()
    assert (depth[drawn > off] > 0).all()
    outside = drawn < 0
    assert (depth[outside] >= drawn[outside] - 2e-6).all()
    steep = np.hypot(by_s, by_rho)
    np.testing.assert_allclose(steep, 1.0, atol=1e-9)


@few
@given(points=chains(), seed=st.integers(0, 1000), chords=st.booleans())
def test_every_piece_keeps_to_its_tangents_and_lies_inside_the_tooth(points, seed, chords, brute_force):
    """But for what hollow arcs bend it: not at all where there are none, as in a tooth of chords."""
    profile = read(points, land=False, chords=chords)
    (outline,) = brute_force.chain_outlines(points, tip=TIP)
    rng = np.random.default_rng(seed)
    one, other = (
        np.array([rng.uniform(-4, 4, 400), TIP + rng.uniform(-points[-1][1] - 1, 1, 400)]) for _ in range(2)
    )
    # far ones and near ones
    way = (other - one) * np.where(rng.uniform(size=400) < 0.5, 1.0, 0.05)
    for number, piece in enumerate(profile.pieces):
        at = np.full(400, number)
        depth, by_s, by_rho = profile.piece_depth(at, 0.0, *one)
        there = profile.piece_depth(at, 0.0, *(one + way))[0]
        assert (np.abs(there - depth) <= np.hypot(*way) + 1e-12).all()
        assert piece.hollow == math.inf or not chords
        room = depth + piece.hollow
        bent = np.where(room > 1e-9, (way * way).sum(axis=0) / (2.0 * np.maximum(room, 1e-9)), np.inf)
        assert (there <= depth + by_s * way[0] + by_rho * way[1] + bent + 1e-12).all()
        for s, rho in one.T[(depth > CHORD * chords + 2e-6)][:5]:
            assert brute_force.depth_in_outline(outline, s, rho) > 0
            assert abs(s) <= piece.half_width


@pytest.mark.parametrize("tip", [38.69658717152865, 40.0, 23.456789])
def test_an_arc_that_ends_upright_is_as_wide_as_its_end(tip):
    """Rounding must not lean its last side: drawn on, it would get ever wider."""
    profile = tooth_profile(((0.6, 0.0, 0.4), (1.0, 0.4), (1.9, 3.5)), tip=tip, land=False)
    assert [piece.half_width for piece in profile.pieces] == pytest.approx([1.0, 1.9])


def test_neighbouring_pieces_overlap(brute_force):
    """Deep inside a stepped tooth no point lies between two pieces: the depth is all but the distance."""
    points = [[0.5, 0.0], [0.5, 1.0], [1.5, 1.0], [1.5, 2.0], [1.0, 2.0], [1.0, 3.0], [2.0, 4.0]]
    profile = tooth_profile(points, tip=TIP, land=False)
    rho = TIP - np.linspace(0.3, 6.0, 200)
    assert (profile.depth(np.zeros(200), rho)[0] >= 0.3 - 1e-12).all()


def test_full_radius_tip_is_a_circle():
    profile = tooth_profile([[0.0, 0.0, 1.2], [1.2, 1.2], [1.2, 3.0]], tip=TIP, land=False)
    turn = np.linspace(-1.5, math.pi + 1.5, 50)
    above = np.sin(turn) > 0
    for r in (0.5, 1.2, 2.0):
        s, rho = r * np.cos(turn[above]), TIP - 1.2 + r * np.sin(turn[above])
        np.testing.assert_allclose(profile.depth(s, rho)[0], 1.2 - r, atol=1e-12)


def hollow_arc(points, turns):
    """(s, rho) on the hollow arc from the first of some points to the next, by the circle through both."""
    (x0, _, radius), (x1, down, *_) = points[:2]
    a, b = complex(x0, TIP), complex(x1, TIP - down)
    centre = (a + b) / 2 + 1j * (b - a) / abs(b - a) * math.sqrt(radius**2 - abs(b - a) ** 2 / 4)
    arc = centre + (a - centre) * np.exp(1j * np.angle((b - centre) / (a - centre)) * turns)
    return arc.real, arc.imag, (arc - centre) / abs(radius)


HOLLOW = [[0.5, 0.0, -10.0], [2.0, 4.0], [2.0, 5.0]]


def test_depth_above_a_hollow_arc_is_the_distance_from_its_circle():
    s, rho, inwards = hollow_arc(HOLLOW, np.linspace(0.0, 1.0, 501))
    profile = tooth_profile(HOLLOW, tip=TIP, land=False)
    assert len(profile.pieces) == 1
    for depth in (-0.3, 0.0, 1e-7, 0.4):
        found = profile.depth(s + depth * inwards.real, rho + depth * inwards.imag)
        # next to its ends other parts of the outline are nearer
        near = slice(100, 300)
        np.testing.assert_allclose(found[0][near], depth, atol=1e-12)
        np.testing.assert_allclose(found[1][near], inwards.real[near], atol=1e-9)
        np.testing.assert_allclose(found[2][near], inwards.imag[near], atol=1e-9)


def test_hollow_arc_of_a_wheel_is_held_within_the_stated_chord():
    """On the true arc the depth is between 0 and CHORD."""
    s, rho, _ = hollow_arc(HOLLOW, np.linspace(0.0, 1.0, 5001))
    depth = tooth_profile(HOLLOW, tip=TIP, land=False, chords=True).depth(s, rho)[0]
    assert depth.min() >= -1e-9
    assert 0.5 * CHORD < depth.max() <= CHORD * (1 + 1e-6)
    wheel = DiscWheel(outside_diameter_mm=2.0 * TIP, profile=tuple(tuple(point) for point in HOLLOW))
    assert all(piece.hollow == math.inf for piece in wheel.outline().pieces)
    np.testing.assert_array_equal(wheel.outline().depth(s, rho)[0], depth)


def test_a_hollow_arc_splits_no_tooth():
    """It stays with what it meets smoothly or at an outer corner, and is parted from what is hollow to it."""
    smooth = [[0.3, 0.0, 0.5], [0.8, 0.5], [0.8, 1.0, -2.0], [2.8, 3.0]]
    assert [piece.hollow for piece in tooth_profile(smooth, tip=TIP, land=True).pieces] == [2.0]
    parted = [[0.3, 0.0], [0.8, 2.0, -8.0], [1.6, 3.0, -9.0], [2.9, 3.75]]
    assert [piece.hollow for piece in tooth_profile(parted, tip=TIP, land=True).pieces] == [
        math.inf,
        8.0,
        9.0,
    ]


def test_a_side_drawn_on_past_a_waist_ends_there(brute_force):
    """It would come back into the tooth below."""
    waist = [[0.6, 0.0], [0.6, 1.0], [0.9, 1.0, -0.65], [0.9, 2.2], [0.9, 3.0]]
    profile = tooth_profile(waist, tip=TIP, land=False)
    (outline,) = brute_force.chain_outlines(waist, tip=TIP)
    s, rho = np.meshgrid(np.linspace(0.0, 1.0, 41), TIP - np.linspace(-0.1, 3.0, 63))
    drawn = np.array(
        [brute_force.depth_in_outline(outline, *at) for at in zip(s.flat, rho.flat, strict=True)]
    )
    depth = profile.depth(s.ravel(), rho.ravel())[0]
    sure = np.abs(drawn) > 1e-6
    np.testing.assert_array_equal(depth[sure] > 0, drawn[sure] > 0)
    np.testing.assert_allclose(depth[drawn < 0], drawn[drawn < 0], atol=2e-6)


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([[0.5, 0.0]], "needs at least two points"),
        ([[0.5, 0.0], [1.0]], r"point 2 has 1 numbers .*radius of the arc"),
        ([[0.5, 0.1], [1.0, 2.0]], r"begins at depth 0\.1 mm .*valid: 0"),
        (
            [[0.5, 0.0], [0.8, 2.0], [0.9, 1.5]],
            r"runs up again from depth 2 to 1\.5 mm between its points 2 and 3",
        ),
        ([[1.0, 4.0], [0.5, 0.0]], "begins at depth 4"),
        ([[-0.5, 0.0], [0.8, 2.0]], r"point 1 lies beyond the middle of the tooth, at half-width -0\.5"),
        ([[0.5, 0.0], [0.0, 1.0], [0.5, 2.0]], "no width at profile point 2"),
        ([[0.5, 0.0], [0.8, 1.0], [1.5, 1.0], [1.0, 1.0], [1.0, 2.0]], "runs back on itself at depth 1 mm"),
        ([[1.5, 0.0], [1.0, 0.0], [1.0, 2.0]], "runs back on itself at depth 0 mm"),
        ([[0.5, 0.0], [0.5, 0.0], [1.0, 2.0]], "points 1 and 2 are the same"),
        ([[0.5, 0.0, 0.2], [1.0, 2.0]], r"arc of 0\.2 mm cannot reach .*valid: 1\.03078 or more"),
        ([[0.5, 0.0, 1.05], [1.0, 2.0]], "runs up again before the next"),
        ([[0.1, 0.0, -1.2], [0.2, 2.0]], "hollow arc from profile point 1 crosses the middle"),
        ([[0.5, 0.0], [1.0, 2.0, 3.0]], "radius of the last profile point leads to no other"),
        ([[0.5, 0.0], [1.0, 40.0]], r"ends at depth 40 mm .*less than the tip's radius 30"),
        ([[0.5, 0.0], [1.0, math.nan]], "point 2 is not finite"),
    ],
)
def test_a_chain_that_is_no_tooth_is_refused(points, said):
    with pytest.raises(InputError, match=said):
        tooth_profile(points, tip=TIP, land=False)


HOB = {"normal_module_mm": 2.0, "outside_diameter_mm": 70.0}
CHAIN = ((0.4, 0.0), (0.5, 0.2), (2.0, 4.5), (2.5, 5.0))


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({"profile": ((0.4, 0.0), (0.5, 2.0))}, "ends above the reference line"),
        ({"profile": CHAIN, "tip_radius_factor": 0.2}, "tip_radius_factor stands beside profile"),
        ({"profile": CHAIN, "protuberance_mm": 0.1}, "protuberance_mm stands beside profile"),
        (
            {"profile": ((0.4, 0.0), (3.5, 5.0))},
            r"teeth 7 mm wide run into each other at a pitch of 6\.286 mm",
        ),
        ({"dedendum_factor": 3.0}, "run into each other"),
        (
            {"protuberance_mm": 0.1, "protuberance_angle_deg": 25.0},
            r"no less than the flank's own .*less than 20",
        ),
        ({"protuberance_mm": 1.0}, "protuberance of 1 mm reaches below the reference line"),
        (
            {"chamfer_height_mm": 3.0},
            r"chamfer_height_mm 3 reaches above the reference line .*less than 2\.5",
        ),
        (
            {"chamfer_height_mm": 0.5, "chamfer_angle_deg": 15.0},
            r"no more than the flank's own .*more than 20",
        ),
        ({"chamfer_angle_deg": 40.0}, "chamfer_angle_deg is given without chamfer_height_mm"),
        ({"gash_lead_mm": 3000.0}, r'the gashes are straight .*gash = "helical"'),
        ({"gash": "helical", "gash_lead_mm": 50.0}, r"more than 45° off .*204\.2 or more"),
    ],
)
def test_a_hob_that_contradicts_itself_is_refused(data, said):
    with pytest.raises(InputError, match=said):
        Hob(**HOB, **data)


def test_an_insert_with_two_shapes_is_refused():
    with pytest.raises(InputError, match="edge_width_mm stands beside profile"):
        PolygonHead(inserts=2, tip_radius_mm=40.0, edge_width_mm=3.0, profile=((1.0, 0.0), (1.0, 2.0)))
    head = PolygonHead(inserts=2, tip_radius_mm=40.0, profile=((1.0, 0.0, 0.5), (1.5, 0.5), (1.5, 2.0)))
    assert head.breadth_mm == pytest.approx(3.0)
