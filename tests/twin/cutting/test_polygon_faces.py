"""Faces of a turned polygon, from the field along rays: the table of geometry.md 3."""

import math

import numpy as np
import pytest
from rays import crossing, deepest

from twin.cutters.polygon_head import PolygonHead
from twin.cutting.field import DepthField

TABLE = [
    # across flats, R, inserts, Q, i, bow µm (+ convex), across corners, face slope at the corner °
    (17.0, 40.0, 3, 6, 2, 13.04, 19.600, 0.305),
    (17.0, 40.0, 2, 6, 3, -82.97, 19.822, 1.919),
    (17.0, 40.0, 1, 6, 6, -194.5, 20.079, 4.44),
    (17.0, 40.0, 2, -6, -3, -677.0, 21.194, 14.5),
    (10.0, 40.0, 2, 4, 2, 8.63, 14.118, 0.198),
]


@pytest.fixture(params=TABLE, ids=lambda row: f"S{row[0]:g} Q{row[3]} i{row[4]}")
def row(request):
    return request.param


def outline(synthetic, row, angle):
    """Radius (n,) of the part at mid-face height at these angles, and the field."""
    across, tip, inserts, _, ratio = row[:5]
    head = PolygonHead(inserts=inserts, tip_radius_mm=tip)
    # three turns of the work at rest along Z: the middle one is cut by whole passes only
    cutter, motion = synthetic.polygon_turning(
        head, ratio=ratio, across_flats=across, work_turns=3, z=(0.0, 0.0), step_deg=1.0
    )
    field = DepthField(cutter, motion, 0.7 * across, (-0.5, 0.5))
    ray = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    low, high = np.full(len(angle), 0.4 * across), np.full(len(angle), 0.68 * across)
    for _ in range(14):
        middle = 0.5 * (low + high)
        removed = deepest(field, middle[:, None] * ray)[0] > 0
        low, high = np.where(removed, low, middle), np.where(removed, middle, high)
    return low - crossing(field, low[:, None] * ray, -ray), field


def test_sides_across_flats_bow_and_corners(synthetic, row):
    across, _, _, q, _, bow, corners, _ = row
    sides = abs(q)
    flat, corner = math.pi * np.arange(0, 2 * sides, 2) / sides, math.pi * np.arange(1, 2 * sides, 2) / sides
    r, _ = outline(synthetic, row, np.concatenate([flat, corner]))
    on_flat, on_corner = r[:sides], r[sides:]
    np.testing.assert_allclose(2 * on_flat, across, atol=1e-6)
    np.testing.assert_allclose(2 * on_corner, corners, atol=0.6e-3)
    # the table prints four figures of the bow
    np.testing.assert_allclose(on_flat - on_corner * math.cos(math.pi / sides), bow * 1e-3, rtol=1e-3)


def test_curvature_at_mid_face(synthetic, row):
    """((i−1)² R − A)/(A + (i−1) R)², positive concave."""
    across, tip, _, _, ratio, *_ = row
    angle = np.radians([-1.0, 0.0, 1.0])
    r, _ = outline(synthetic, row, angle)
    x, y = r * np.cos(angle), r * np.sin(angle)
    curvature = (x[0] - 2 * x[1] + x[2]) / (0.5 * (y[2] - y[0])) ** 2
    distance = across / 2 + tip
    law = ((ratio - 1) ** 2 * tip - distance) / (distance + (ratio - 1) * tip) ** 2
    assert curvature == pytest.approx(law, rel=0.005)


def test_face_slope_at_the_corner(synthetic, row):
    _, _, _, q, _, _, _, slope = row
    angle = np.array([math.pi / abs(q) - 1e-5])
    r, field = outline(synthetic, row, angle)
    _, gradient = deepest(field, np.stack([r * np.cos(angle), r * np.sin(angle), 0 * r], axis=1))
    assert abs(math.degrees(math.atan2(gradient[0, 1], gradient[0, 0]))) == pytest.approx(slope, rel=0.01)


def test_whole_outline_is_the_envelope_of_the_edge_paths(synthetic, row):
    """No point of any edge's path w_k(θ) lies inside the part, and each face is touched by one."""
    across, tip, inserts, q, ratio = row[:5]
    distance = across / 2 + tip
    theta = np.linspace(0.0, 2 * math.pi, 200_001)
    paths = np.array(
        [
            distance * np.exp(-1j * theta)
            + tip * np.exp(1j * ((ratio - 1) * theta + math.pi + 2 * math.pi * k / inserts))
            for k in range(inserts)
        ]
    )
    angle = np.radians(np.arange(1.5, 360.0, 3.0))
    r, _ = outline(synthetic, row, angle)
    # the innermost of the path's chords across each ray
    a, b = paths[:, :-1].ravel(), paths[:, 1:].ravel()
    near = np.minimum(np.abs(a), np.abs(b)) < 0.7 * across
    a, b = a[near], b[near]
    for ray, radius in zip(np.exp(-1j * angle), r, strict=True):
        p, q = a * ray, b * ray
        across_ray = (p.imag > 0) != (q.imag > 0)
        p, q = p[across_ray], q[across_ray]
        hits = (p.real * q.imag - q.real * p.imag) / (q.imag - p.imag)
        assert radius == pytest.approx(hits[hits > 0].min(), abs=1e-6)
