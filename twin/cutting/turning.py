"""Sides of facets turned to the other diagonal of the two facets on them, where that follows the cut better.

What is left of facets beside the ridges and steps that they were divided along is flat: a corner close to the
longest side, which runs across what the corner stands on, however often it is divided.
"""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.landing import Ground
from twin.cutting.parting import are_joined, both_across, turned
from twin.cutting.sides import Mesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

FLAT = 0.94
"""Cosine of what the widest angle of a flat facet is at most short of 180°: 20°"""
ASKED = 0.2, 0.4, 0.6, 0.8
"""Shares of the way along both diagonals at which they are compared"""


def unflattened(
    ground: Ground, mesh: Mesh, asked: Ints, stuck: Ints, *, aim: float
) -> tuple[Mesh, Ints, Ints]:
    """The mesh with sides turned: those that are `stuck` (k, 2), to be divided just where a corner across
    stands, and the longest ones of flat facets among those `asked` (m,).

    None is turned that would stand further off the cut then, unless by less than the `aim` [mm]. Returns the
    mesh, which facets are to be asked now, and the new sides (l, 2).
    """
    ends = np.concatenate([stuck, _longest_of_flat(mesh, asked)])
    first = np.arange(len(ends)) < len(stuck)
    facets, corners = both_across(mesh.faces, ends)
    good = (facets >= 0).all(axis=1) & (corners[:, 0] != corners[:, 1])
    good &= (mesh.bite[corners] >= 0).all(axis=1) & ~are_joined(mesh.faces, corners)
    rows = np.flatnonzero(good)
    rows = rows[_once(facets[rows])]
    rows = rows[_once(np.sort(corners[rows], axis=1) @ [[len(mesh.vertices)], [1]])]
    a, b, c, d = (mesh.vertices[v[rows]] for v in (*ends.T, *corners.T))
    # facets that stand upright on the cut tell nothing of its direction
    good = first[rows] | _upright(a, b, c, d)
    leaf = mesh.leaf[ends[rows, 0]]
    good &= _off(ground, c, d, leaf) <= np.maximum(_off(ground, a, b, leaf), aim)
    rows = rows[good]
    faces = turned(mesh.faces, ends[rows], facets[rows], corners[rows])
    mesh = Mesh(mesh.vertices, faces, mesh.bite, mesh.leaf, mesh.within)
    return mesh, np.union1d(asked, facets[rows]), np.sort(corners[rows], axis=1)


def _longest_of_flat(mesh: Mesh, asked: Ints) -> Ints:
    """Longest sides (k, 2) of the flat ones among some facets, the flattest first."""
    faces = mesh.faces[asked]
    faces = faces[mesh.cut_in(faces)]
    corners = mesh.vertices[faces]
    way = np.roll(corners, -1, axis=1) - corners
    length = np.linalg.norm(way, axis=2)
    n, k = np.arange(len(faces)), length.argmax(axis=1)
    one, other = (k + 1) % 3, (k + 2) % 3
    cosine = np.einsum("nx,nx->n", way[n, one], way[n, other])
    cosine /= np.maximum(length[n, one] * length[n, other], 1e-300)
    flat = np.flatnonzero(cosine > FLAT)
    flat = flat[np.argsort(-cosine[flat], kind="stable")]
    return np.stack([faces[flat, k[flat]], faces[flat, one[flat]]], axis=1)


def _once(groups: Ints) -> Bools:
    """Which rows (n, k) of numbers have none that has come before."""
    lead = np.zeros(groups.size, dtype=bool)
    lead[np.unique(groups, return_index=True)[1]] = True
    return np.logical_and.reduce(lead.reshape(groups.shape), axis=1)


def _upright(a: Floats, b: Floats, c: Floats, d: Floats) -> Bools:
    """Whether both facets between c, d (n, 3) and an end a, b of sides face as those on these sides do."""
    facing = np.cross(b - a, c - a) + np.cross(a - b, d - b)
    one, other = np.cross(a - c, d - c), np.cross(b - d, c - d)
    return (np.einsum("nx,nx->n", one, facing) > 0) & (np.einsum("nx,nx->n", other, facing) > 0)


def _off(ground: Ground, start: Floats, end: Floats, leaf: Ints) -> Floats:
    """How far (n,) lines between points (n, 3) stand off the cut [mm]."""
    found = [ground.field(start + share * (end - start), leaf).depth for share in ASKED]
    return np.abs(found).max(axis=0, initial=0.0)
