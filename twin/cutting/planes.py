"""Where planes meet, and where the bites that they touch do."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

FEATURE = 3e-5
"""Share of an eigenvalue of the normals' scatter above which planes are taken to meet in that direction: more
than about 0.6° apart, as feed marks and generating flats are."""
STEPS = 2
"""of Newton's method onto an edge"""
PULLED = 0.5, 0.15, 0.04
"""Shares of the way to places aside at which the planes beside an edge are asked, one step after the other"""


def totals(owner: Ints, values: Floats, n: int) -> Floats:
    """(n,) sums of `values` over what each owner has."""
    return np.asarray(np.bincount(owner, values, minlength=n), dtype=np.float64)


def meet(owner: Ints, normal: Floats, height: Floats, n: int) -> tuple[Floats, Floats]:
    """Least shifts (n, 3) to where planes meet best, and eigenvalues (n, 3) of their normals' scatter.

    Owner i's planes are `normal · shift = height`. Directions whose eigenvalue is below FEATURE of the
    largest are left alone.
    """
    scatter = np.empty((n, 3, 3))
    for x in range(3):
        for y in range(x, 3):
            scatter[:, x, y] = scatter[:, y, x] = totals(owner, normal[:, x] * normal[:, y], n)
    pull = np.stack([totals(owner, normal[:, x] * height, n) for x in range(3)], axis=1)
    values, vectors = np.linalg.eigh(scatter)
    inverse = np.where(values > FEATURE * values[:, 2:], 1.0 / np.maximum(values, 1e-12), 0.0)
    return np.einsum("nxe,ne,nye,ny->nx", vectors, inverse, vectors, pull), values


def onto_edges(sweep: Sweep, points: Floats, owner: Ints, bite: Ints, longest: Floats | float) -> Floats:
    """Points (n, 3), each brought to where its bites meet: `bite` (m,) of point `owner` (m,).

    No step is longer than `longest` (n,) [mm].
    """
    points = points.copy()
    for _ in range(STEPS):
        meeting = sweep.evaluate(points[owner], bite, gradient=True)
        step, _ = meet(owner, meeting.gradient, -meeting.depth, len(points))
        step[np.linalg.norm(step, axis=1) > longest] = 0.0
        points += step
    return points


def onto_corners(
    sweep: Sweep, points: Floats, bite: Ints, around: tuple[Ints, Floats], longest: Floats
) -> tuple[Floats, Bools]:
    """Points (n, 3), each beside a sharp edge of its bite's own brought onto that, and which (n,) those are.

    Such an edge, as that of a wheel's rim, shows from aside only: `around` are places beside the points,
    owners (m,) and positions (m, 3). No step is longer than `longest` (n,) [mm].
    """
    points = points.copy()
    owner, place = around
    sharp = np.ones(len(points), dtype=bool)
    for share in PULLED:
        mine = sharp[owner]
        owner, place = owner[mine], place[mine]
        off = share * (place - points[owner])
        found = sweep.evaluate(points[owner] + off, bite[owner], gradient=True)
        height = np.einsum("nx,nx->n", found.gradient, off) - found.depth
        step, values = meet(owner, found.gradient, height, len(points))
        sharp &= (values[:, 1] > FEATURE * values[:, 2]) & (np.linalg.norm(step, axis=1) < longest)
        points[sharp] += step[sharp]
    return points, sharp
