import numpy as np
import pytest
from scipy.spatial import ConvexHull

from twin.inspection.hull import hull


def assert_as_qhull(points):
    found = hull(points)
    wanted = ConvexHull(points).vertices
    start = int(np.flatnonzero((points[wanted] == points[found[0]]).all(axis=1))[0])
    assert np.array_equal(points[found], points[np.roll(wanted, -start)])


@pytest.mark.parametrize("count", [3, 4, 500, 20_000])
def test_all_of_a_circle_are_corners(count):
    turn = 2.0 * np.pi * np.random.default_rng(count).permutation(count) / count
    assert_as_qhull(17.0 * np.column_stack([np.cos(turn), np.sin(turn)]))


def test_a_gear_has_its_tips_for_corners():
    turn = np.radians(np.arange(0.0, 360.0, 0.5))
    radius = 20.0 + 2.0 * np.sign(np.sin(20.0 * turn + 0.01))
    points = radius[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    assert_as_qhull(points)
    assert (np.hypot(*points[hull(points)].T) > 21.0).all()


@pytest.mark.parametrize("seed", range(20))
def test_the_corners_are_those_of_qhull(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(int(rng.integers(3, 400)), 2)) * rng.uniform(0.1, 50.0, 2)
    points = np.concatenate([points, points[::3]])
    assert_as_qhull(points)


def test_points_on_the_sides_of_a_square_are_no_corners():
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0))
    points = np.column_stack([x.ravel(), y.ravel()])
    assert points[hull(points)].tolist() == [
        [0, 0],
        [4, 0],
        [4, 4],
        [0, 4],
    ]


@pytest.mark.parametrize("count", [1, 2, 7])
def test_points_on_a_line_bound_nothing(count):
    points = np.column_stack([np.arange(count), 2.0 * np.arange(count)]).astype(float)
    assert len(hull(points)) < 3


def test_rounding_makes_no_corners():
    turn = np.radians(17.0 + 60.0 * np.arange(6))
    corner = np.column_stack([np.cos(turn), np.sin(turn)])
    sides = zip(corner, np.roll(corner, -1, axis=0), strict=True)
    ring = np.concatenate([np.linspace(a, b, 50, endpoint=False) for a, b in sides])
    ring = np.concatenate([ring, ring + np.random.default_rng(0).uniform(-1e-14, 1e-14, ring.shape)])
    assert sorted(hull(ring) % 300) == [0, 50, 100, 150, 200, 250]
