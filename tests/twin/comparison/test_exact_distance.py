"""Distances against other implementations, all triangles, and solid angles."""

import math

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from twin.comparison.boxes import Boxes
from twin.comparison.distance import Surface
from twin.comparison.triangles import closest

seeds = settings(max_examples=20)


@seeds
@given(st.integers(0, 10**6))
def test_the_nearest_point_of_a_triangle_is_that_of_trimesh(seed):
    rng = np.random.default_rng(seed)
    corner = rng.normal(size=(500, 3, 3))
    corner[:50, 2] = corner[:50, 0] + 1e-4 * rng.normal(size=(50, 3))  # slivers
    points = 2 * rng.normal(size=(500, 3))
    found, weight = closest(points, corner)
    theirs = trimesh.triangles.closest_point(corner, points)
    assert (
        np.abs(np.linalg.norm(points - found, axis=1) - np.linalg.norm(points - theirs, axis=1)).max() < 1e-9
    )
    assert weight.min() >= -1e-12
    assert np.einsum("nk,nki->ni", weight, corner) == pytest.approx(found, abs=1e-9)


@seeds
@given(st.integers(0, 10**6))
def test_no_box_within_the_limit_is_passed_over(seed):
    rng = np.random.default_rng(seed)
    corner = rng.normal(size=(300, 1, 3)) + rng.exponential(0.2, size=(300, 1, 1)) * rng.normal(
        size=(300, 3, 3)
    )
    points, limit = 2 * rng.normal(size=(40, 3)), rng.exponential(1.0, 40)
    point, triangle, bound = Boxes(corner).within(points, limit)
    low, high = corner.min(axis=1), corner.max(axis=1)
    off = np.maximum(np.maximum(low[None] - points[:, None], points[:, None] - high[None]), 0)
    apart = np.linalg.norm(off, axis=2)
    expected = {(p, t) for p, t in np.argwhere(apart < limit[:, None])}
    assert set(zip(point.tolist(), triangle.tolist(), strict=True)) == expected
    assert bound == pytest.approx(apart[point, triangle], abs=1e-12)


def winding(vertices, faces, points):
    """Turns of the mesh about points, by solid angles (van Oosterom & Strackee 1983)."""
    total = np.zeros(len(points))
    for a, b, c in vertices[faces]:
        u, v, w = a - points, b - points, c - points
        p, q, r = (np.linalg.norm(x, axis=1) for x in (u, v, w))
        triple = np.einsum("ni,ni->n", u, np.cross(v, w))
        dots = [np.einsum("ni,ni->n", *pair) for pair in ((u, v), (v, w), (w, u))]
        total += 2 * np.arctan2(triple, p * q * r + dots[0] * r + dots[1] * p + dots[2] * q)
    return total / (4 * math.pi)


def test_distance_and_side_of_a_gear_are_those_of_all_its_triangles(parts):
    """Concave, with large end faces beside small flank facets; points near and far."""
    vertices, faces = parts.gear_mesh(teeth=8, module=2.0, width=4.0, roll_step=1.0, z_step=2.0, bore=6.0)
    rng = np.random.default_rng(4)
    near = vertices[rng.integers(len(vertices), size=150)] + 0.05 * rng.normal(size=(150, 3))
    points = np.vstack([near, rng.uniform(-12, 12, size=(100, 3))])
    found = Surface(vertices, faces).signed(points)
    inside = winding(vertices, faces, points) > 0.5
    assert ((found < 0) == inside).all()
    assert 20 < inside.sum() < 230
    for point, distance in zip(points, found, strict=True):
        at = closest(np.broadcast_to(point, (len(faces), 3)), vertices[faces])[0]
        assert abs(distance) == pytest.approx(np.linalg.norm(point - at, axis=1).min(), abs=1e-12)


def test_points_of_the_surface_itself_are_at_zero(parts):
    vertices, faces = parts.gear_mesh(teeth=12, module=2.0, width=4.0)
    assert Surface(vertices, faces).signed(vertices) == pytest.approx(np.zeros(len(vertices)), abs=1e-12)


def test_the_side_at_a_sharp_corner():
    """Beyond an edge the planes of both faces may be behind a point that is outside."""
    spike = trimesh.creation.cone(radius=1.0, height=20.0, sections=6)
    surface = Surface(np.array(spike.vertices), np.array(spike.faces))
    tip = np.array([[0.0, 0.0, 20.5], [0.3, 0.1, 20.2], [0.0, 0.0, 19.5], [0.0, 0.0, -0.5]])
    found = surface.signed(tip)
    assert (found[[0, 1, 3]] > 0).all()
    assert found[2] < 0
    assert found[0] == pytest.approx(0.5)
    assert found[3] == pytest.approx(0.5)


def test_slivers_that_are_folded_by_nanometres_turn_no_side_around():
    """A ball with edges split twice, the second time 20 nm beside the first, in any direction."""
    ball = trimesh.creation.icosphere(subdivisions=2, radius=5.0)
    vertices, faces = np.array(ball.vertices), np.array(ball.faces)
    rng = np.random.default_rng(7)
    for _ in range(60):
        at = rng.integers(len(faces))
        a, b, c = faces[at]
        other = np.flatnonzero(((faces == b) & (np.roll(faces, -1, axis=1) == a)).any(axis=1))[0]
        d = next(v for v in faces[other] if v not in (a, b))
        m, n = len(vertices), len(vertices) + 1
        middle = (vertices[a] + vertices[b]) / 2
        vertices = np.vstack([vertices, middle, middle + 2e-5 * rng.normal(size=3)])
        new = [[a, m, c], [m, n, c], [n, b, c], [b, n, d], [n, m, d], [m, a, d]]
        faces = np.vstack([np.delete(faces, [at, other], axis=0), new])
    surface = Surface(vertices, faces)
    for factor in (1.02, 0.98):
        found = surface.signed(factor * vertices)
        assert (np.sign(found) == np.sign(factor - 1)).all()
