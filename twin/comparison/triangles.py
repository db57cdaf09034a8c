"""Laws of single triangles: the nearest point, and their size."""

import numpy as np
from numpy.typing import NDArray

from twin.inspection.solid import Floats

Bools = NDArray[np.bool_]


def closest(points: Floats, corner: Floats) -> tuple[Floats, Floats]:
    """Points (n, 3) of triangles (n, 3, 3) nearest to points (n, 3), and the corners' weights there (n, 3).

    The regions of a triangle's corners, edges and inside after Ericson, Real-Time Collision Detection, 5.1.5.
    """
    a, b, c = corner[:, 0], corner[:, 1], corner[:, 2]
    ab, ac = b - a, c - a
    ap, bp, cp = points - a, points - b, points - c
    d1, d2, d3, d4, d5, d6 = (
        dot(u, v) for u, v in ((ab, ap), (ac, ap), (ab, bp), (ac, bp), (ab, cp), (ac, cp))
    )
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    with np.errstate(divide="ignore", invalid="ignore"):
        on_ab, on_ac = d1 / (d1 - d3), d2 / (d2 - d6)
        on_bc = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        share = 1.0 / (va + vb + vc)
        v, w = vb * share, vc * share
    zero, one = np.zeros_like(v), np.ones_like(v)
    regions: tuple[tuple[Bools, Floats, Floats], ...] = (
        ((d1 <= 0) & (d2 <= 0), zero, zero),
        ((d3 >= 0) & (d4 <= d3), one, zero),
        ((vc <= 0) & (d1 >= 0) & (d3 <= 0), on_ab, zero),
        ((d6 >= 0) & (d5 <= d6), zero, one),
        ((vb <= 0) & (d2 >= 0) & (d6 <= 0), zero, on_ac),
        ((va <= 0) & (d4 >= d3) & (d5 >= d6), 1.0 - on_bc, on_bc),
    )
    tests = [region for region, _, _ in regions]
    v = np.select(tests, [first for _, first, _ in regions], v)
    w = np.select(tests, [second for _, _, second in regions], w)
    return a + v[:, None] * ab + w[:, None] * ac, np.stack([1.0 - v - w, v, w], axis=1)


def reaches(corner: Floats) -> Floats:
    """(m,) how far triangles (m, 3, 3) reach from their middles."""
    from_middle = corner - corner.mean(axis=1)[:, None]
    return np.sqrt(dot(from_middle, from_middle).max(axis=1))


def dot(u: Floats, v: Floats) -> Floats:
    """Products of vectors (..., 3)."""
    return u[..., 0] * v[..., 0] + u[..., 1] * v[..., 1] + u[..., 2] * v[..., 2]
