"""Exact signed distance of points from a closed triangle mesh.

Each point begins with the triangles about the vertex nearest to it as a bound and goes down a tree of boxes
about the triangles, many points abreast; a box that is not nearer than the bound is passed over with all it
holds. What is left is measured exactly: the nearest triangle is proved, not guessed.
"""

import numpy as np
from scipy.spatial import KDTree

from twin.comparison.boxes import Boxes, along_curve
from twin.comparison.sides import Sides
from twin.comparison.triangles import closest, dot, reaches
from twin.inspection.solid import Floats, Ints

RATIO = 4.0
"""of the reaches of triangles whose boxes are put together: a few large ones would spoil the others"""
AROUND = 6
"""triangles about a vertex that are looked at first"""
BATCH = 20_000
"""points at once"""


class Surface:
    """A mesh to measure distances from."""

    def __init__(self, vertices: Floats, faces: Ints) -> None:
        """Vertices (n, 3), faces (m, 3) of a closed 2-manifold, counter-clockwise seen from outside."""
        self._corner = vertices[faces]
        self._sides = Sides(vertices, faces)
        self._vertices = KDTree(vertices)
        self._around = _around(faces, len(vertices))
        size = np.floor(np.log(np.maximum(reaches(self._corner), 1e-12)) / np.log(RATIO)).astype(np.int64)
        size = np.maximum(size, np.median(size))  # small ones spoil no boxes
        self._boxes = [
            (rows, Boxes(self._corner[rows])) for rows in (np.flatnonzero(size == k) for k in np.unique(size))
        ]

    def signed(self, points: Floats) -> Floats:
        """(k,) distance of points (k, 3), + outside."""
        distance, face = self.nearest(points)
        foot, weight = closest(points, self._corner[face])
        inside = dot(points - foot, self._sides.normals(face, weight)) < 0
        return np.where(inside, -distance, distance)

    def nearest(self, points: Floats) -> tuple[Floats, Ints]:
        """Distance (k,) of points (k, 3) and the face that it is to (k,)."""
        best, face = np.zeros(len(points)), np.zeros(len(points), dtype=np.int64)
        order = along_curve(points)
        for first in range(0, len(points), BATCH):
            some = order[first : first + BATCH]
            best[some], face[some] = self._nearest(points[some])
        return best, face

    def _nearest(self, points: Floats) -> tuple[Floats, Ints]:
        around = self._around[self._vertices.query(points)[1]]
        best, face = np.full(len(points), np.inf), around[:, 0].copy()
        for candidate in around.T:
            away = points - closest(points, self._corner[candidate])[0]
            square = dot(away, away)
            nearer = square < best
            best[nearer], face[nearer] = square[nearer], candidate[nearer]
        np.sqrt(best, out=best)
        for rows, boxes in self._boxes:
            self._look(points, rows, boxes, best, face)
        return best, face

    def _look(self, points: Floats, rows: Ints, boxes: Boxes, best: Floats, face: Ints) -> None:
        """Note in `best` and `face` what among the triangles `rows` is nearer to the points (k, 3)."""
        point, leaf, bound = boxes.within(points, best)
        if not len(point):
            return
        # the box nearest to each point first: it closes most of the others
        order = np.lexsort((bound, point))
        first = np.diff(point[order], prepend=-1) != 0
        for turn in (order[first], order[~first]):
            open_ = turn[bound[turn] < best[point[turn]]]
            at, triangle = point[open_], rows[leaf[open_]]
            away = points[at] - closest(points[at], self._corner[triangle])[0]
            distance = np.sqrt(dot(away, away))
            nearest = np.lexsort((distance, at))
            nearest = nearest[np.diff(at[nearest], prepend=-1) != 0]
            nearer = nearest[distance[nearest] < best[at[nearest]]]
            best[at[nearer]] = distance[nearer]
            face[at[nearer]] = triangle[nearer]


def _around(faces: Ints, count: int) -> Ints:
    """Return some of the faces (count, AROUND) about each vertex, the same again where it has fewer."""
    vertex = faces.ravel()
    order = np.argsort(vertex, kind="stable")
    many = np.bincount(vertex, minlength=count)
    first = np.cumsum(many) - many
    which = first[:, None] + np.arange(AROUND) % np.maximum(many, 1)[:, None]
    # a vertex of no face has any
    return order[np.minimum(which, len(order) - 1)] // 3
