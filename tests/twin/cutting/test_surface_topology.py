"""The mesh closes whatever the signs at the grid's nodes are."""

import itertools
from collections import Counter

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from twin.cutting.crossings import Crossings, edge_key, leaf_cells
from twin.cutting.dual import Cells, _quads
from twin.cutting.grid import Grid
from twin.cutting.local import without_bites
from twin.cutting.refine import LEAF, Leaves
from twin.cutting.stock import solid
from twin.cutting.topology import CORNERS, EDGES, SHEET, SHEETS


def face_segments(case):
    """Pairs of crossed edges that the surface joins on a face: those at each corner that is cut off.

    Two crossings are one segment; of four, the two next to each removed corner belong together.
    """
    removed = [bool(case >> corner & 1) for corner in range(8)]
    ends = [set(edge[1:]) for edge in EDGES]
    for axis, side in itertools.product(range(3), (0, 1)):
        face = {c for c in range(8) if CORNERS[c, axis] == side}
        cuts = [
            n
            for n, (a, b) in enumerate(edge[1:] for edge in EDGES)
            if {a, b} <= face and removed[a] != removed[b]
        ]
        if len(cuts) == 2:
            yield tuple(cuts)
        elif len(cuts) == 4:
            for corner in face:
                if removed[corner]:
                    yield tuple(n for n in cuts if corner in ends[n])


@pytest.mark.parametrize("case", range(256))
def test_every_sheet_of_a_cell_is_one_closed_loop(case):
    segments = list(face_segments(case))
    crossed = [n for n, (_, a, b) in enumerate(EDGES) if (case >> a & 1) != (case >> b & 1)]
    # every crossed edge lies on two faces: the segments form closed loops
    assert Counter(n for pair in segments for n in pair) == dict.fromkeys(crossed, 2)
    assert [n for n in range(12) if SHEET[case, n] >= 0] == crossed
    a, b = np.array(segments, dtype=int).reshape(-1, 2).T
    count, loop = connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(12, 12)), directed=False)
    loops = {frozenset(np.flatnonzero(loop == n)) for n in range(count)} - {
        frozenset([n]) for n in range(12) if n not in crossed
    }
    assert {frozenset(np.flatnonzero(SHEET[case] == n)) for n in range(SHEETS[case])} == loops


def mesh_of(removed):
    """Quadrilaterals of the surface around the removed nodes, and a point for each of their vertices."""
    nr, sectors, nz = removed.shape
    grid = Grid(r=10.0 + np.arange(nr), sectors=sectors, z=1.0 * np.arange(nz))
    low = np.stack(np.meshgrid(*(np.arange(0, n, LEAF) for n in grid.cells), indexing="ij"), axis=-1).reshape(
        -1, 3
    )
    leaves = Leaves(low, without_bites(np.zeros((len(low), 3))), [], 0)
    cell, case, leaf = leaf_cells(grid, leaves, np.where(removed, 1.0, -1.0))
    keys, rising = [], []
    for axis in range(3):
        there = np.roll(removed, -1, axis)
        crossed = np.argwhere(removed != there)
        keys.append(edge_key(grid, axis, crossed))
        rising.append(removed[tuple(crossed.T)])
    key = np.concatenate(keys)
    order = np.argsort(key)
    nothing = np.zeros((len(key), 3))
    crossings = Crossings(
        key[order], nothing, nothing, np.zeros(len(key), dtype=int), np.concatenate(rising)[order]
    )
    first = np.concatenate([[0], np.cumsum(SHEETS[case])])
    quads = _quads(grid, Cells(cell, case, leaf), crossings, first)
    middle = np.repeat(cell, SHEETS[case], axis=0) + 0.5
    angle = grid.angle(middle[:, 1])
    r = 10.0 + middle[:, 0]
    return quads, np.stack([r * np.cos(angle), r * np.sin(angle), middle[:, 2]], axis=1)


def pinches(removed):
    """Number of faces with four crossings that belong to a single sheet in both cells at the face."""
    case = sum(
        np.roll(removed, tuple(-step), (0, 1, 2)).astype(int) << bit for bit, step in enumerate(CORNERS)
    )
    count = 0
    for axis in range(3):
        upper, lower = (
            [n for n, (_, a, b) in enumerate(EDGES) if CORNERS[a, axis] == CORNERS[b, axis] == side]
            for side in (1, 0)
        )
        here, there = SHEET[case][..., upper], SHEET[np.roll(case, -1, axis)][..., lower]
        single = [(s >= 0).all(axis=-1) & (np.ptp(s, axis=-1) == 0) for s in (here, there)]
        count += int((single[0] & single[1]).sum())
    return count


def random_signs(seed, share):
    removed = np.random.default_rng(seed).random((7, 16, 7)) < share
    removed[[0, -1]] = False
    removed[:, :, [0, -1]] = False
    return removed


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.7, 0.9])
def test_surface_of_any_signs_is_closed_and_oriented(seed, share):
    removed = random_signs(seed, share)
    quads, points = mesh_of(removed)
    directed = Counter(zip(quads.ravel().tolist(), np.roll(quads, -1, axis=1).ravel().tolist(), strict=True))
    assert directed == {(b, a): n for (a, b), n in directed.items()}
    # two faces at every edge, but for four where two sheets touch on a face
    assert Counter(directed.values())[2] == 2 * pinches(removed)
    assert max(directed.values()) <= 2
    assert set(np.unique(quads)) == set(range(len(points)))
    triangles = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    assert solid(points, triangles).status().name == "NoError"
