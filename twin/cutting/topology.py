"""How the surface passes a cell: for each pattern of corner signs, which crossed edges belong together.

Each connected sheet in a cell gets a vertex of its own (dual marching cubes), so the mesh is closed and
oriented. On a face with four crossings the removed corners are kept apart, which both cells at the face see
alike. Where all four belong to one sheet in both cells, four faces meet at one edge; manifold3d parts them.
"""

import itertools

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]

CORNERS: Ints = np.array(list(itertools.product([0, 1], repeat=3)), dtype=np.int64)
"""Cell corners (8, 3) as steps along r, theta, z; bit n of a case is corner n."""


def _edges() -> list[tuple[int, int, int]]:
    """(axis, lower corner, upper corner) of the cell's twelve edges, four for each axis."""
    found = []
    for axis in range(3):
        bit = 4 >> axis
        found += [(axis, c, c | bit) for c in range(8) if not c & bit]
    return found


EDGES = _edges()


def edge_at(axis: int, corner: tuple[int, int, int]) -> int:
    """Number of the edge along `axis` that starts at a lower corner."""
    number = corner[0] * 4 + corner[1] * 2 + corner[2]
    return next(n for n, (a, low, _) in enumerate(EDGES) if a == axis and low == number)


def _sheets(case: int) -> list[int]:
    """For one case the sheet of each edge, −1 where it is not crossed."""
    inside = [bool(case >> c & 1) for c in range(8)]
    crossed = [inside[a] != inside[b] for _, a, b in EDGES]
    parent = list(range(12))

    def root(e: int) -> int:
        while parent[e] != e:
            e = parent[e]
        return e

    for axis, side in itertools.product(range(3), (0, 1)):
        bit = 4 >> axis
        on_face = [n for n, (a, low, _) in enumerate(EDGES) if a != axis and bool(low & bit) == bool(side)]
        cuts = [n for n in on_face if crossed[n]]
        if len(cuts) == 2:
            parent[root(cuts[0])] = root(cuts[1])
        elif len(cuts) == 4:
            corners = {c for n in on_face for c in EDGES[n][1:]}
            for corner in corners:
                if inside[corner]:
                    first, second = (n for n in cuts if corner in EDGES[n][1:])
                    parent[root(first)] = root(second)
    names: dict[int, int] = {}
    return [names.setdefault(root(e), len(names)) if crossed[e] else -1 for e in range(12)]


SHEET: Ints = np.array([_sheets(case) for case in range(256)], dtype=np.int64)
"""(256, 12) sheet of each edge"""
SHEETS: Ints = SHEET.max(axis=1) + 1
"""(256,) number of sheets"""
