"""Linear programs in three unknowns against those of scipy."""

import numpy as np
import pytest
from scipy.optimize import linprog

from twin.cutting.climb import highest


@pytest.mark.parametrize("planes", [0, 3, 15])
def test_many_at_once_are_each_the_best(planes):
    """Random planes about the origin within a cube; a third of them go through it."""
    rng = np.random.default_rng(planes)
    n = 60
    cube = np.broadcast_to(np.concatenate([np.eye(3), -np.eye(3)]), (n, 6, 3))
    slope = np.concatenate([rng.normal(size=(n, planes, 3)), cube], axis=1)
    room = np.concatenate([np.maximum(rng.normal(0.4, 1.0, (n, planes)), 0.0), np.ones((n, 6))], axis=1)
    rise = rng.normal(size=(n, 3))
    way = highest(rise, slope, room)
    assert ((slope @ way[:, :, None])[:, :, 0] <= room + 1e-12).all()
    best = [
        -linprog(-r, A_ub=a, b_ub=b, bounds=(None, None)).fun
        for r, a, b in zip(rise, slope, room, strict=True)
    ]
    np.testing.assert_allclose((rise * way).sum(axis=1), best, rtol=1e-9, atol=1e-12)


def test_a_plane_that_is_not_there_holds_nothing_back():
    cube = np.concatenate([np.eye(3), -np.eye(3), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]])[None]
    room = np.array([[2.0, 3.0, 4.0, 2.0, 3.0, 4.0, np.inf, np.inf]])
    np.testing.assert_allclose(highest(np.array([[1.0, -1.0, 0.5]]), cube, room), [[2.0, -3.0, 4.0]])


def test_no_program_has_no_way():
    assert highest(np.zeros((0, 3)), np.zeros((0, 4, 3)), np.zeros((0, 4))).shape == (0, 3)
