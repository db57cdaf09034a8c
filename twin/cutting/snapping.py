"""A mesh on a grid so coarse that every file format tells its vertices apart as we do.

STL and GLB hold single precision. Vertices that are apart only in double precision, as where ridges of
neighbouring cells meet, fall together there and leave gaps and fins; here they are joined before anybody sees
them. Where that would let four faces meet at one edge, or two fans of faces at one vertex, the vertices are
kept some grid steps apart instead.
"""

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

FINEST = 2.0**-17
"""[mm] of the grid at least: 7.6 nm"""
MANTISSA = 24
"""bits of a number in single precision"""
MIXED = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)
"""odd numbers that coordinates are mixed with: different places seldom give the same then"""
ROUNDS = 64
"""of parting what may not be joined"""
WIDER = 4
"""rounds after which it may be parted a grid step wider"""


def grid_step(vertices: Floats) -> float:
    """Step [mm] of a grid whose points single precision tells apart, in mm and in metres: a power of two.

    Two units in the last place of the largest coordinate; in metres that unit is up to 1.95 times as large,
    for 1000 is not quite 1024.
    """
    largest = float(np.abs(vertices).max(initial=0.0))
    return max(2.0 ** (math.frexp(largest)[1] - MANTISSA + 1), FINEST)


def snapped(vertices: Floats, faces: Ints) -> tuple[Floats, Ints, Ints]:
    """Move vertices (n, 3) [mm] onto the grid and join those that meet there; faces (m, 3).

    Faces that lose a side go, and so do two that become each other's back: a closed 2-manifold stays one.
    Returns the vertices, the faces that are left, and which (k,) those were.
    """
    step = grid_step(vertices)
    nearest = np.rint(vertices / step).astype(np.int64)
    places = nearest.copy()
    left, kept, number, met = _joined(places, faces)
    rng = np.random.default_rng(0)
    for turn in range(ROUNDS if met.any() else 0):
        near = left[_at(met, left)]
        shared = _of_shared_edges(near)
        apart = np.isin(number, shared if len(shared) else _pinched(near, met)) & met[number]
        if not apart.any():
            break
        places[apart] = nearest[apart] + _towards_neighbours(vertices, faces)[apart]
        if turn:
            # what is drawn the same way stays together: any other way does
            far = 1 + turn // WIDER
            places[apart] += rng.integers(-far, far + 1, (apart.sum(), 3))
        left, kept, number, met = _joined(places, faces)
    first = np.zeros(len(met), dtype=np.int64)
    first[number] = np.arange(len(number))
    used = np.zeros(len(met), dtype=bool)
    used[left] = True
    return places[first[used]] * np.float64(step), (np.cumsum(used) - 1)[left], np.flatnonzero(kept)


def _joined(places: Ints, faces: Ints) -> tuple[Ints, Bools, Ints, Bools]:
    """The faces left when vertices at one place are one, which (m,) those are, the number of each vertex
    among the places, and which numbers (k,) stand for more than one vertex."""
    number = _numbers(places)
    met = np.bincount(number, minlength=len(number)) > 1
    left = np.ones(len(faces), dtype=bool)
    if not met.any():
        return faces, left, number, met
    named, here = faces.copy(), _at(met[number], faces)  # nothing changes elsewhere
    named[here] = number[faces[here]]
    left[here] = _stays(named[here])
    return named if left.all() else named[left], left, number, met


def _at(some: Bools, faces: Ints) -> Ints:
    """Rows of the faces with a corner among `some` vertices."""
    return np.unique(np.flatnonzero(some.take(faces)) // 3)


def _numbers(places: Ints) -> Ints:
    """(n,) the same number below n for the same place (n, 3)."""
    x, y, z = places.T.astype(np.uint64)
    mixed = x * MIXED[0] + y * MIXED[1] + z * MIXED[2]
    ordered = np.sort(mixed)
    shared = ordered[1:][ordered[1:] == ordered[:-1]]
    number = np.arange(len(places))
    if len(shared):
        # what is mixed alike need not be the same place
        rows = np.flatnonzero(np.isin(mixed, shared))
        _, first, same = np.unique(places[rows], axis=0, return_index=True, return_inverse=True)
        number[rows] = rows[first[same.reshape(-1)]]
    return number


def _stays(faces: Ints) -> Bools:
    """Whether a face has three vertices and no back: another on the same ones that looks the opposite way."""
    a, b, c = faces.T
    ordered = np.sort(faces, axis=1)
    _, group = np.unique(ordered, axis=0, return_inverse=True)
    turn = np.where(((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b)), 1, -1)
    balance = np.bincount(group.reshape(-1), turn)[group.reshape(-1)] if len(faces) else np.zeros(0)
    return (np.diff(ordered, axis=1) > 0).all(axis=1) & (balance != 0)


def _of_shared_edges(faces: Ints) -> Ints:
    """Vertices of edges that more than one face passes in the same sense."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    vertices = faces.max(initial=0) + 1
    passed, times = np.unique(start * vertices + end, return_counts=True)
    return np.concatenate(np.divmod(passed[times > 1], vertices))


def _pinched(faces: Ints, met: Bools) -> Ints:
    """Those of the vertices `met` (k,) with more than one fan of faces around them; no edge may be shared."""
    vertex, after, before = (np.roll(faces, -step, axis=1).ravel() for step in range(3))
    mine = met[vertex]
    vertex, after, before = vertex[mine], after[mine], before[mine]
    count = faces.max(initial=0) + 1
    leaves = vertex * count + after
    order = np.argsort(leaves)
    # the next face around the vertex is the one that leaves it along the edge by which this one comes
    following = order[np.searchsorted(leaves[order], vertex * count + before)] if len(order) else order
    fan = np.arange(len(vertex))
    for _ in range(len(vertex).bit_length()):
        fan = np.minimum(fan, fan[following])
        following = following[following]
    fans = np.unique(np.column_stack([vertex, fan]), axis=0)[:, 0]
    return np.flatnonzero(np.bincount(fans, minlength=1) > 1)


def _towards_neighbours(vertices: Floats, faces: Ints) -> Ints:
    """(n, 3) steps of −1, 0 or 1 from each vertex towards the middle of its faces.

    Wedges of metal that touch are drawn apart by that, and so are wedges of air.
    """
    pull = np.zeros_like(vertices)
    for corner in range(3):
        to_middle = vertices[faces].mean(axis=1) - vertices[faces[:, corner]]
        to_middle /= np.maximum(np.linalg.norm(to_middle, axis=1, keepdims=True), 1e-300)
        for axis in range(3):
            pull[:, axis] += np.bincount(faces[:, corner], to_middle[:, axis], len(vertices))
    return np.rint(pull / np.maximum(np.abs(pull).max(axis=1, keepdims=True), 1e-300)).astype(np.int64)
