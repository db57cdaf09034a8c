"""Facets parted where vertices stand on their sides, alike on both sides of each: a closed mesh stays one."""

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]


def parted(faces: Ints, ends: Ints, first: int) -> tuple[Ints, Ints]:
    """Facets with vertices on some of their sides, numbered from `first` on; which of them are new.

    A facet with one divided side becomes two, with two sides three, with three sides four.
    """
    near, _ = _near(faces, ends)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    keys = ends[order, 0] * first + ends[order, 1]
    pairs = pairs_of(faces[near])
    wanted = pairs[..., 0] * first + pairs[..., 1]
    at = np.minimum(np.searchsorted(keys, wanted), max(len(keys) - 1, 0))
    middle = np.where(keys[at] == wanted, first + order[at], -1) if len(keys) else np.full(wanted.shape, -1)
    count = (middle >= 0).sum(axis=1)
    near, middle, count = near[count > 0], middle[count > 0], count[count > 0]
    made = [np.zeros((0, 3), dtype=np.int64)]
    for number in (1, 2, 3):
        rows = np.flatnonzero(count == number)
        corner, mid = faces[near[rows]], middle[rows]
        # turned so that the divided sides come first
        lead = (mid >= 0).argmax(axis=1) if number == 1 else np.roll(mid < 0, 1, axis=1).argmax(axis=1)
        turn = (np.arange(3) + lead[:, None]) % 3 if number < 3 else np.broadcast_to(np.arange(3), mid.shape)
        (a, b, c), (ab, bc, ca) = np.take_along_axis(corner, turn, 1).T, np.take_along_axis(mid, turn, 1).T
        if number == 1:
            triangles = (a, ab, c), (ab, b, c)
        elif number == 2:
            triangles = (ab, b, bc), (a, ab, c), (ab, bc, c)
        else:
            triangles = (a, ab, ca), (ab, b, bc), (bc, c, ca), (ab, bc, ca)
        made += [np.stack(triangle, axis=1) for triangle in triangles]
    left = np.ones(len(faces), dtype=bool)
    left[near] = False
    new = np.concatenate(made)
    kept = faces[left]
    return np.concatenate([kept, new]), len(kept) + np.arange(len(new))


def pairs_of(faces: Ints) -> Ints:
    """The ends (m, 3, 2) of the sides of facets (m, 3), the lower number first."""
    return np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2)


def both_across(faces: Ints, ends: Ints) -> tuple[Ints, Ints]:
    """Both facets (n, 2) on sides (n, 2), and their third corners (n, 2): `across` along and against."""
    one, other = across(faces, ends), across(faces, ends[:, ::-1])
    return np.stack([one[0], other[0]], axis=1), np.stack([one[1], other[1]], axis=1)


def across(faces: Ints, ends: Ints) -> tuple[Ints, Ints]:
    """The facet (n,) in which each side (n, 2) runs from its first end to its second, and that facet's third
    corner (n,); −1 where there is none."""
    near, count = _near(faces, ends)
    keys = (faces[near] * count + np.roll(faces[near], -1, axis=1)).ravel()
    if not len(keys):
        return np.full(len(ends), -1), np.full(len(ends), -1)
    order = np.argsort(keys)
    wanted = ends[:, 0] * count + ends[:, 1]
    at = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)]
    found = keys[at] == wanted
    row, corner = np.divmod(at, 3)
    return np.where(found, near[row], -1), np.where(found, faces[near[row], (corner + 2) % 3], -1)


def are_joined(faces: Ints, pairs: Ints) -> NDArray[np.bool_]:
    """Which pairs (n, 2) of vertices have a side between them."""
    near, count = _near(faces, pairs)
    return among(np.sort(pairs, axis=1), pairs_of(faces[near]).reshape(-1, 2), count)


def among(pairs: Ints, some: Ints, count: int) -> NDArray[np.bool_]:
    """Which pairs (n, 2) of numbers below `count` are `some` (m, 2)."""
    return np.isin(pairs[:, 0] * count + pairs[:, 1], some[:, 0] * count + some[:, 1])


def turned(faces: Ints, ends: Ints, facets: Ints, corners: Ints) -> Ints:
    """Facets whose common sides (n, 2) run between the third `corners` (n, 2) of both instead.

    `facets` and `corners` (n, 2) are those of `both_across`.
    """
    faces = faces.copy()
    (a, b), (c, d) = ends.T, corners.T
    faces[facets[:, 0]] = np.stack([c, a, d], axis=1)
    faces[facets[:, 1]] = np.stack([d, b, c], axis=1)
    return faces


def _near(faces: Ints, pairs: Ints) -> tuple[Ints, int]:
    """Facets with two corners or more among those of `pairs`, and a number above those of all corners."""
    count = int(max(faces.max(initial=0), pairs.max(initial=0))) + 1
    marked = np.zeros(count, dtype=bool)
    marked[pairs] = True
    return np.flatnonzero(marked[faces].sum(axis=1) > 1), count
