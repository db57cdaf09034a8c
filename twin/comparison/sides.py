"""Which way is out at any place of a closed mesh: the pseudonormals of Bærentzen & Aanæs (2005).

A face's own normal inside of it, the sum of both faces' on an edge, on a corner the sum of all by their
angles. Meshes that were rounded to single precision have slivers that are folded over by nanometres, with
normals that point anywhere: vertices closer than WELD are one here, and faces that are narrower have no say.
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from twin.comparison.triangles import dot
from twin.inspection.solid import Floats, Ints

WELD = 1e-4
"""[mm] a tenth of a micrometre"""
EDGE = 1e-12
"""weight of a corner below which a point lies on the edge opposite"""


class Sides:
    """The pseudonormals of a mesh."""

    def __init__(self, vertices: Floats, faces: Ints) -> None:
        """Vertices (n, 3), faces (m, 3) of a closed 2-manifold, counter-clockwise seen from outside."""
        label, places = _welded(vertices)
        self._names = label[faces]
        corner = places[self._names]
        side = np.roll(corner, -1, axis=1) - corner
        length = np.sqrt(dot(side, side))
        square = np.cross(side[:, 0], side[:, 1])
        twice_area = np.sqrt(dot(square, square))
        longest = length.max(axis=1)
        broad = twice_area > WELD * longest
        self._face = np.where(broad[:, None], square / np.maximum(twice_area, 1e-300)[:, None], 0.0)
        self._longest = length.argmax(axis=1)
        self._broad = broad
        along = side / np.maximum(length, 1e-300)[..., None]
        angle = np.arccos(np.clip(-dot(along, np.roll(along, 1, axis=1)), -1.0, 1.0))
        start, end = self._names, np.roll(self._names, -1, axis=1)
        count = len(places)
        _, number = np.unique(
            (np.minimum(start, end) * count + np.maximum(start, end)).ravel(), return_inverse=True
        )
        edges, self._corner = np.zeros((int(number.max()) + 1, 3)), np.zeros((count, 3))
        beside = np.repeat(self._face, 3, axis=0)
        for axis in range(3):
            edges[:, axis] = np.bincount(number, beside[:, axis])
            self._corner[:, axis] = np.bincount(start.ravel(), angle.ravel() * beside[:, axis], count)
        self._edge = edges[number].reshape(-1, 3, 3)
        self._short = start == end

    def normals(self, face: Ints, weight: Floats) -> Floats:
        """Directions (k, 3), of any length, at points of faces (k,) with the corners' weights (k, 3)."""
        on = weight > EDGE
        touched = on.sum(axis=1)
        normal = self._face[face]
        narrow = np.flatnonzero((touched == 3) & ~self._broad[face])
        self._at_edge(normal, narrow, face[narrow], self._longest[face[narrow]])
        on_edge = np.flatnonzero(touched == 2)
        self._at_edge(normal, on_edge, face[on_edge], (np.argmin(on[on_edge], axis=1) + 1) % 3)
        at_corner = np.flatnonzero(touched == 1)
        normal[at_corner] = self._corner[self._names[face[at_corner], np.argmax(on[at_corner], axis=1)]]
        return normal

    def _at_edge(self, normal: Floats, rows: Ints, face: Ints, edge: Ints) -> None:
        """Set rows of `normal` to those of edges; of an edge that was welded away, to that of its corner."""
        short = self._short[face, edge][:, None]
        normal[rows] = np.where(short, self._corner[self._names[face, edge]], self._edge[face, edge])


def _welded(vertices: Floats) -> tuple[Ints, Floats]:
    """(n,) which vertices (n, 3) are one, and the middle of each (k, 3)."""
    pairs = KDTree(vertices).query_pairs(WELD, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(vertices),) * 2)
    count, label = connected_components(links, directed=False)
    number = np.bincount(label, minlength=count)
    middle = np.stack([np.bincount(label, column, count) for column in vertices.T], axis=1) / number[:, None]
    return label.astype(np.int64), np.asarray(middle, dtype=np.float64)
