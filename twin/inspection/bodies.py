"""How many bodies a mesh holds: shells that neither enclose a cavity nor stand inside another body."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from twin.inspection.solid import Ints, Solid

CHIP = 1e-3
"""a shell of less than this part of the largest one's volume is a loose chip, no body"""


def separate_bodies(solid: Solid) -> int:
    """Count the bodies that stand beside each other; cavities, what lies within, and chips do not count."""
    shell = _shells(solid)
    count = int(shell.max()) + 1
    if count == 1:
        return 1
    a, b, c = (solid.vertices[solid.faces[:, i]] for i in range(3))
    volume = np.bincount(shell, weights=np.einsum("ij,ij->i", a, np.cross(b, c)), minlength=count) / 6.0
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    for corner in (a, b, c):
        np.minimum.at(low, shell, corner)
        np.maximum.at(high, shell, corner)
    large = np.flatnonzero(np.abs(volume) > CHIP * np.abs(volume).max())
    bodies = 0
    for one in large:
        others = large[large != one]
        inside = (low[others] <= low[one]).all(axis=1) & (high[others] >= high[one]).all(axis=1)
        # of two shells that fill the same box, the first is not inside the other
        same = (low[others] == low[one]).all(axis=1) & (high[others] == high[one]).all(axis=1)
        bodies += not (inside & ~(same & (others > one))).any()
    return bodies


def _shells(solid: Solid) -> Ints:
    """Number (m,) the shell each face belongs to: faces that share an edge are of one."""
    faces, vertex_count = solid.faces, len(solid.vertices)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    face = np.repeat(np.arange(len(faces)), 3)
    # every edge is passed once in each sense, so the two orders pair the faces on both sides of it
    up = start < end
    first = face[up][np.argsort(start[up] * vertex_count + end[up])]
    second = face[~up][np.argsort(end[~up] * vertex_count + start[~up])]
    shape = (len(faces), len(faces))
    graph = coo_array((np.ones(len(first), dtype=np.int8), (first, second)), shape=shape)
    _, shell = connected_components(graph, directed=False)
    return shell.astype(np.int64)
