"""The part's volume against the independent evaluator's, on a sound gear and on one of the wrong hand.

To first order the volume between two surfaces is that of the distance from one of them to the other: the mean
depth of random points of the mesh, times its area. That no wall or slot is missed, points of the blank tell.
"""

import numpy as np
import pytest

from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.cut import cut

HOB = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)
BLANK = Blank(diameter_mm=28.0, length_mm=1.0, bore_mm=12.0)
EDGE = 1e-3
POINTS = 8
NEAR = 0.02
"""[mm] off the cut surface from which a point must be on the side that the evaluator says"""


def inside(points, vertices, faces):
    """Whether points (n, 3) lie in a closed mesh: how often it is met on the way up."""
    a, b, c = vertices[faces].transpose(1, 0, 2)
    low, high = (f(f(a, b), c) for f in (np.minimum, np.maximum))
    found = np.zeros(len(points), dtype=bool)
    for row, (x, y, z) in enumerate(points):
        near = (low[:, 0] <= x) & (high[:, 0] >= x) & (low[:, 1] <= y) & (high[:, 1] >= y) & (high[:, 2] >= z)
        p, q, r = a[near], b[near], c[near]
        one, two, three = (
            (v[:, 0] - u[:, 0]) * (y - u[:, 1]) - (v[:, 1] - u[:, 1]) * (x - u[:, 0])
            for u, v in ((p, q), (q, r), (r, p))
        )
        over = ((one > 0) == (two > 0)) & ((two > 0) == (three > 0))
        total = (one + two + three)[over]
        height = (two[over] * p[over, 2] + three[over] * q[over, 2] + one[over] * r[over, 2]) / total
        found[row] = (height > z).sum() % 2 == 1
    return found


@pytest.mark.parametrize(("hand", "way", "tolerance"), [(1.0, "regular", 1.0), (-1.0, "general", 1.0)])
def test_volume_is_that_of_the_independent_evaluator(hand, way, tolerance, synthetic, brute_force):
    cutter, motion = synthetic.hobbing(
        HOB, teeth=12, tip_x=9.5, z=(16.0, -17.0), feed=2.0, step_deg=8.0, ratio_factor=hand
    )
    result = cut(BLANK, ((cutter, motion),), tolerance_um=tolerance)
    assert result.method.startswith(way)
    part = result.remains
    drawn, pitch, _ = brute_force.hob_outlines(
        module=2.0, outside_diameter=40.0, starts=1, pressure_angle=20.0, addendum=1.25, tip_radius=0.38,
        dedendum=1.25,
    )  # fmt: skip

    def depth(point):
        return brute_force.field(point, motion, cutter, drawn, pitch)[0]

    a, b, c = part.vertices[part.faces].transpose(1, 0, 2)
    middle, area = (a + b + c) / 3.0, np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0
    r, z = np.hypot(middle[:, 0], middle[:, 1]), middle[:, 2]
    made = (r > 6.0 + EDGE) & (r < 14.0 - EDGE) & (z < -EDGE) & (z > -1.0 + EDGE)
    rng = np.random.default_rng(8)
    share = np.sqrt(rng.random((POINTS, 1)))
    rows = rng.choice(np.flatnonzero(made), POINTS, p=area[made] / area[made].sum())
    other = rng.random((POINTS, 1))
    points = a[rows] * (1.0 - share) + share * (b[rows] * (1.0 - other) + c[rows] * other)
    off = np.array([depth(point) for point in points])
    assert abs(off.mean()) * area[made].sum() < 1e-4 * part.volume_mm3
    anywhere = rng.uniform([-14.0, -14.0, -1.0], [14.0, 14.0, 0.0], (60, 3))
    anywhere = anywhere[BLANK.contains(anywhere) & (np.hypot(*anywhere[:, :2].T) > 9.0)][:POINTS]
    found = inside(anywhere, part.vertices, part.faces)
    deep = np.array([depth(point) for point in anywhere])
    far = np.abs(deep) > NEAR
    assert (found[far] == (deep[far] < 0)).all()
    assert far.sum() > 0.5 * POINTS
