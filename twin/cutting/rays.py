"""Where rays cross the cut surface: from the passes themselves, without grid or mesh.

What a feeler of a measuring machine would find at some points of a part that nobody has meshed. Passes that
cannot reach a ray are left out by the bounds of the depth field; the rest are all evaluated.
"""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.fields import Field
from twin.cutting.pairs import in_parallel

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

GROUP = 24
"""Neighbouring rays that share a list of passes."""
SETTLED = 1e-7
"""[mm] below which a step ends the search"""
ROUNDS = 12
CLOSE = 0.03
"""[mm] that is searched first"""


def crossings(fields: tuple[Field, ...], points: Floats, along: Floats, *, reach: float) -> Floats:
    """How far (n,) from points (n, 3) the cut surface is met on the way along unit vectors (n, 3) [mm].

    The vectors lead out of the material; − is behind the point. NaN where nothing is met within `reach`.
    Points that follow one another should be neighbours on the part.
    """
    slices = (slice(first, first + GROUP) for first in range(0, len(points), GROUP))
    parts = in_parallel(lambda part: _group(fields, points[part], along[part], reach), slices)
    return np.concatenate([np.zeros(0), *parts])


def depths(fields: tuple[Field, ...], points: Floats) -> Floats:
    """How deep (n,) points (n, 3) lie inside everything that is cut away [mm]; −inf where no tool comes."""

    def work(part: slice) -> Floats:
        pairs = _near(fields, points[part], 0.0)
        depth, _ = pairs.meet(points[part], np.zeros(len(points[part])))
        deepest = np.full(len(points[part]), -np.inf)
        np.maximum.at(deepest, pairs.row, depth)
        return deepest

    slices = (slice(first, first + GROUP) for first in range(0, len(points), GROUP))
    return np.concatenate([np.zeros(0), *in_parallel(work, slices)])


class _Pairs:
    """Rays of a group, each with passes that can make the surface on it."""

    def __init__(self, fields: tuple[Field, ...], row: Ints, tool: Ints, number: Ints) -> None:
        self.fields, self.row, self.tool, self.number = fields, row, tool, number

    def meet(self, points: Floats, radius: Floats) -> tuple[Floats, Floats]:
        """Depths (m,) at the rays' places (n, 3), and how much they can change within `radius` (n,)."""
        depth, change = np.zeros(len(self.row)), np.zeros(len(self.row))
        for k, field in enumerate(self.fields):
            here = np.flatnonzero(self.tool == k)
            row, number = self.row[here], self.number[here]
            meeting = field.evaluate(points[row], number)
            depth[here] = meeting.depth
            change[here] = field.bound(meeting, number * field.bites, radius[row])[0]
        return depth, change

    def where(self, keep: NDArray[np.bool_]) -> "_Pairs":
        """Some of the pairs."""
        return _Pairs(self.fields, self.row[keep], self.tool[keep], self.number[keep])

    def step(self, places: Floats, along: Floats, depth: Floats) -> Floats:
        """Newton's step (n,) of each ray towards where its deepest pass is left; NaN where there is none."""
        order = np.lexsort((depth, self.row))
        best = order[np.flatnonzero(np.diff(self.row[order], append=-1))]
        step = np.full(len(places), np.nan)
        for k, field in enumerate(self.fields):
            here = best[self.tool[best] == k]
            row = self.row[here]
            meeting = field.evaluate(places[row], self.number[here], gradient=True)
            with np.errstate(divide="ignore", invalid="ignore"):
                step[row] = -meeting.depth / np.einsum("ni,ni->n", meeting.gradient, along[row])
        return step


def _group(fields: tuple[Field, ...], points: Floats, along: Floats, reach: float) -> Floats:
    n = len(points)
    way = np.full(n, np.nan)
    rows = np.arange(n)
    for limit in (min(CLOSE, reach), reach):
        pairs = _near(fields, points[rows], limit)
        depth, change = pairs.meet(points[rows], np.full(len(rows), limit))
        start = pairs.step(points[rows], along[rows], depth)
        pairs = pairs.where(depth + change > 0)
        found = _search(pairs, points[rows], along[rows], np.clip(start, -limit, limit))
        way[rows] = np.where(np.abs(found) <= limit, found, np.nan)
        rows = rows[np.isnan(way[rows])]
        if not len(rows):
            break
    return way


def _search(pairs: _Pairs, points: Floats, along: Floats, start: Floats) -> Floats:
    """Newton's method on the largest of the depths, which rises outwards and bends that way only."""
    way, step = start.copy(), np.full(len(points), np.inf)
    for _ in range(ROUNDS):
        places = points + way[:, None] * along
        depth, _ = pairs.meet(places, np.zeros(len(places)))
        step = np.clip(pairs.step(places, along, depth), -0.05, 0.05)
        way += step
        if not (np.abs(step) >= SETTLED).any():
            return way
    way[~(np.abs(step) < SETTLED)] = np.nan
    return way


def _near(fields: tuple[Field, ...], points: Floats, reach: float) -> _Pairs:
    """All rays with the passes that can make the surface within `reach` of any of them."""
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    radius = float(np.linalg.norm(points - middle, axis=1).max()) + reach
    tool, number = [], []
    for k, field in enumerate(fields):
        index = field.near(middle, radius)
        meeting = field.evaluate(np.broadcast_to(middle, (len(index), 3)), index)
        change, _ = field.bound(meeting, index * field.bites, np.full(len(index), radius))
        index = index[meeting.depth + change > 0]
        tool.append(np.full(len(index), k))
        number.append(index)
    n = len(points)
    tools, numbers = np.concatenate(tool), np.concatenate(number)
    row = np.repeat(np.arange(n), len(numbers))
    return _Pairs(fields, row, np.tile(tools, n), np.tile(numbers, n))
