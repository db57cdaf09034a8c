import dataclasses
import math

import manifold3d as m3
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from twin.inspection.sections import (
    Crossings,
    circle_crossings,
    outer_outlines,
    outline,
    plane_segments,
    plane_segments_in_parts,
    radial_limits,
    unfolded,
)
from twin.inspection.solid import check_solid


def body(angles, spread):
    """A holed, askew body: two crossed bars and a hole along z."""
    bar = m3.Manifold.cylinder(24.0, 5.0, 3.0, 17, True).rotate(angles)
    other = m3.Manifold.cube((spread, 7.0, 9.0), True).rotate(angles[::-1])
    return (bar + other) - m3.Manifold.cylinder(40.0, 1.0, 1.0, 24, True)


def solid_of(manifold):
    mesh = manifold.to_mesh64()
    return check_solid(np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64))


angle = st.floats(-180, 180)


@given(angles=st.tuples(angle, angle, angle), spread=st.floats(8, 20), z=st.floats(-2.5, 2.5))
@settings(max_examples=40, deadline=None)
def test_sections_are_closed_and_have_the_kernels_area(angles, spread, z):
    shape = body(angles, spread)
    segments = plane_segments(solid_of(shape), np.array([z]))
    assert np.array_equal(np.sort(segments.start_node), np.sort(segments.end_node))
    cross = segments.start[:, 0] * segments.end[:, 1] - segments.start[:, 1] * segments.end[:, 0]
    assert cross.sum() / 2 == pytest.approx(shape.slice(z).area(), rel=1e-6, abs=1e-6)


@given(angles=st.tuples(angle, angle, angle), spread=st.floats(8, 20), radius=st.floats(1.5, 9))
@example(angles=(0.0, 23.0, 0.0), spread=10.0, radius=6.0)  # the circle cuts one chord twice
@settings(max_examples=40, deadline=None)
def test_circle_crossings_bound_the_arcs_inside(angles, spread, radius):
    """Right flanks open and left flanks close the arcs of a circle that lie in the section."""
    shape = body(angles, spread)
    solid = solid_of(shape)
    segments = plane_segments(solid, np.array([0.5]))
    found = circle_crossings(segments, np.array([radius]))
    near = circle_crossings(plane_segments(solid, np.array([0.5]), radius=radius), np.array([radius]))
    np.testing.assert_array_equal(near.angle, found.angle)
    assert np.count_nonzero(found.left) * 2 == len(found.angle)
    assert (found.left != np.roll(found.left, 1)).all()
    # the arcs' length against a fine polygon of the circle, cut by the kernel
    inside = np.where(found.left, found.angle, -found.angle).sum()
    if len(found.left) and found.left[0]:
        inside += 2 * math.pi
    rim = m3.CrossSection.circle(radius, 20000) - m3.CrossSection.circle(radius * (1 - 1e-4), 20000)
    if len(found.angle):
        expected = (rim ^ shape.slice(0.5)).area() / (radius**2 * 1e-4 * (1 - 0.5e-4))
        assert inside == pytest.approx(expected, abs=2e-3)


def test_crossings_lie_on_circle_and_chord(parts):
    vertices, faces = parts.gear_mesh(teeth=9, module=2.0, helix_deg=15.0, width=4.0, roll_step=0.5)
    segments = plane_segments(check_solid(vertices, faces), np.array([-2.3, -1.1]))
    radii = np.array([8.9, 9.4])
    crossings = circle_crossings(segments, radii)
    assert len(crossings.angle) == 2 * 2 * 2 * 9
    r = radii[crossings.circle]
    points = np.column_stack([r * np.cos(crossings.angle), r * np.sin(crossings.angle)])
    for point, plane in zip(points, crossings.plane, strict=True):
        own = segments.select(segments.plane == plane)
        along = own.end - own.start
        t = np.einsum("ij,ij->i", point - own.start, along) / np.einsum("ij,ij->i", along, along)
        foot = own.start + np.clip(t, 0, 1)[:, None] * along
        assert np.hypot(*(foot - point).T).min() < 1e-12


def test_a_vertex_in_the_plane_does_not_open_the_outline():
    """The plane through every vertex of a ring of the mesh, and through its end."""
    solid = solid_of(m3.Manifold.cylinder(2.0, 5.0, 5.0, 32) + m3.Manifold.cylinder(4.0, 3.0, 3.0, 32))
    segments = plane_segments(solid, np.array([0.0, 2.0, 4.0]))
    for plane in range(3):
        own = segments.plane == plane
        np.testing.assert_array_equal(np.sort(segments.start_node[own]), np.sort(segments.end_node[own]))
    assert len(outline(outer_outlines(segments), 1)) > 0


def test_outer_outline_leaves_bores_and_parts_agree():
    solid = solid_of(m3.Manifold.cylinder(4.0, 5.0, 5.0, 64) - m3.Manifold.cylinder(9.0, 2.0, 2.0, 64, True))
    heights = np.linspace(0.5, 3.5, 7)
    segments = plane_segments(solid, heights)
    low, high = radial_limits(segments)
    np.testing.assert_allclose(low, 2.0 * math.cos(math.pi / 64), rtol=1e-12)
    outer_low, outer_high = radial_limits(outer_outlines(segments))
    np.testing.assert_allclose(outer_low, 5.0 * math.cos(math.pi / 64), rtol=1e-12)
    np.testing.assert_allclose([high, outer_high], 5.0, rtol=1e-12)
    parts = list(plane_segments_in_parts(solid, heights))
    np.testing.assert_array_equal(np.concatenate([p.heights for p in parts]), heights)
    np.testing.assert_array_equal(np.concatenate([p.start for p in parts]), segments.start)


def crossed(*at):
    """Crossings of one circle: (angle, left?)."""
    n = len(at)
    return Crossings(
        plane=np.zeros(n, dtype=np.int64),
        circle=np.zeros(n, dtype=np.int64),
        angle=np.array([a for a, _ in at], dtype=np.float64),
        left=np.array([left for _, left in at], dtype=bool),
        segment=np.arange(n),
        along=np.zeros(n),
    )


LEFT, RIGHT = True, False


@pytest.mark.parametrize(
    ("at", "wanted"),
    [
        # a fold: material to 0.10, none to 0.11, material to 0.13
        ([(-1, RIGHT), (0.10, LEFT), (0.11, RIGHT), (0.13, LEFT), (2, RIGHT)], [(0, -1), (1, 0.12), (4, 2)]),
        # the same on a right flank, and crossings that coincide in any order
        ([(0.10, RIGHT), (0.11, LEFT), (0.13, RIGHT), (1, LEFT)], [(0, 0.12), (3, 1)]),
        ([(0.1, LEFT), (0.1, LEFT), (0.1, RIGHT), (1, RIGHT)], [(0, 0.1), (3, 1)]),
        ([(0.1, RIGHT), (0.1, LEFT), (0.1, LEFT), (1, RIGHT)], [(1, 0.1), (3, 1)]),
        # a nick goes, what makes no sense stays
        ([(0.1, RIGHT), (0.11, LEFT), (1, LEFT)], [(2, 1)]),
        ([(0.1, LEFT), (0.11, LEFT), (1, LEFT)], [(0, 0.1), (1, 0.11), (2, 1)]),
        ([(0.1, LEFT), (0.5, RIGHT), (0.9, LEFT)], [(0, 0.1), (1, 0.5), (2, 0.9)]),
    ],
)
def test_folds_are_crossed_once(at, wanted):
    found = unfolded(crossed(*at), 0.05)
    assert found.segment.tolist() == [row for row, _ in wanted]
    assert found.angle == pytest.approx([a for _, a in wanted], abs=1e-12)
    assert found.left.tolist() == [at[row][1] for row, _ in wanted]


def test_folds_of_different_circles_are_not_mixed():
    one = crossed((0.1, LEFT), (0.11, RIGHT))
    for apart in ("plane", "circle"):
        two = dataclasses.replace(one, **{apart: np.array([0, 1])})
        assert unfolded(two, 0.05).angle.tolist() == [0.1, 0.11]
