"""Facets parted where vertices stand on their sides, alike on both sides of each: a closed mesh stays one."""

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]


def parted(faces: Ints, ends: Ints, first: int) -> tuple[Ints, Ints]:
    """Facets with vertices on some of their sides, numbered from `first` on; which of them are new.

    A facet with one divided side becomes two, with two sides three, with three sides four.
    """
    marked = np.zeros(first, dtype=bool)
    marked[ends] = True
    near = np.flatnonzero(marked[faces].sum(axis=1) > 1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    keys = ends[order, 0] * first + ends[order, 1]
    pairs = np.sort(np.stack([faces[near], np.roll(faces[near], -1, axis=1)], axis=2), axis=2)
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
