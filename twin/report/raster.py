"""Triangles to pixels in numpy, all at once: which triangle is seen in a pixel, and what it carries there."""

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.integer]
Single = NDArray[np.floating]
LEVEL = 1e-4
"""an edge that falls by less crosses no row [pixels]"""


def visible(corner: Single, width: int, height: int) -> tuple[Ints, Ints, Single]:
    """Pixels (p,) that show something, the triangle seen there, its depth: triangles to rows, rows to pixels.

    `corner` (3 coordinates, 3 corners, m) of triangles that face the eye.
    """
    x, y = np.take_along_axis(corner[:2], np.argsort(corner[1], axis=0)[None], axis=1)
    triangle, row = _expand(*_span(y[0], y[2], height))
    at = row.astype(np.float32) + 0.5
    # From top to bottom a triangle has one long edge, and two short ones by its middle corner.
    long = _edge(x[[0]], y[[0]], x[[2]], y[[2]])
    short = _edge(x[:2], y[:2], x[1:], y[1:])
    lower = triangle + np.where(at > y[1, triangle], np.int32(corner.shape[2]), np.int32(0))
    one = long[0, triangle] + at * long[1, triangle]
    other = short[0, lower] + at * short[1, lower]
    span, column = _expand(*_span(np.minimum(one, other), np.maximum(one, other), width))
    pixel, triangle = row[span] * np.int32(width) + column, triangle[span]
    depth = on_plane(corner, corner[2], triangle, column, row[span])
    nearest = np.full(width * height, -np.inf, np.float32)
    np.maximum.at(nearest, pixel, depth)
    front = depth == nearest[pixel]
    seen = np.full(width * height, -1, np.int32)
    seen[pixel[front]] = triangle[front]
    shown = np.flatnonzero(seen >= 0)
    return shown, seen[shown], nearest[shown]


def on_plane(corner: Single, value: Single, triangle: Ints, column: Ints, row: Ints) -> Single:
    """Value (p,) in the middle of pixels, of a triangle that has `value` (3, m) at its corners."""
    (bx, cx), (by, cy) = corner[:2, 1:].astype(np.float64) - corner[:2, :1]
    to_b, to_c = value[1] - value[0], value[2] - value[0]
    twice = bx * cy - by * cx
    by_column = ((to_b * cy - to_c * by) / twice).astype(np.float32)
    by_row = ((to_c * bx - to_b * cx) / twice).astype(np.float32)
    across = column.astype(np.float32) + np.float32(0.5) - corner[0, 0, triangle]
    down = row.astype(np.float32) + np.float32(0.5) - corner[1, 0, triangle]
    return value[0, triangle] + by_column[triangle] * across + by_row[triangle] * down


def area(a: Single, b: Single, c: Single) -> Single:
    """Twice the signed area of triangles (m,) by their corners (2, m) on the screen."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _expand(first: Ints, count: Ints) -> tuple[Ints, Ints]:
    """For runs first, first + 1, … of `count` members: the run of every member, and the member."""
    run = np.repeat(np.arange(len(count), dtype=np.int32), count)
    return run, np.arange(len(run), dtype=np.int32) + np.repeat(
        first - np.cumsum(count, dtype=np.int32) + count, count
    )


def _span(low: Single, high: Single, size: int) -> tuple[Ints, Ints]:
    """First of the pixels 0 … size - 1 whose middles lie between `low` and `high`, and their number."""
    first = np.ceil(np.clip(low - 0.5, 0, size)).astype(np.int32)
    last = np.floor(np.clip(high - 0.5, -1, size - 1)).astype(np.int32)
    return first, np.maximum(last - first + 1, 0)


def _edge(x: Single, y: Single, to_x: Single, to_y: Single) -> Single:
    """(2, k m) of k edges of m triangles, one after the other: x at y = 0, and how x runs with y."""
    fall = to_y - y
    slope = (to_x - x) / np.where(np.abs(fall) < LEVEL, np.inf, fall)
    return np.stack([x - y * slope, slope]).reshape(2, -1)
