"""Triangles to pixels in numpy, all at once: which triangle is seen in a pixel, and what it carries there."""

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.integer]
Single = NDArray[np.floating]
LEVEL = 1e-4
"""an edge that falls by less crosses no row [pixels]"""


def visible(corner: Single, width: int, height: int) -> tuple[Ints, Ints, Single]:
    """Pixels (p,) that show something, the triangle seen there, its depth.

    `corner` (3 coordinates, 3 corners, m) of triangles that face the eye. What is taller than wide is taken
    apart into columns of pixels, the rest into rows: slivers make few of either.
    """
    x, y = corner[:2]
    tall = extent(y) > extent(x)
    lying, standing = np.flatnonzero(~tall), np.flatnonzero(tall)
    one, column, row = _pixels(x.take(lying, axis=1), y.take(lying, axis=1), width, height)
    other, down, across = _pixels(y.take(standing, axis=1), x.take(standing, axis=1), height, width)
    triangle = np.concatenate([lying.take(one), standing.take(other)])
    column, row = np.concatenate([column, across]), np.concatenate([row, down])
    pixel = row * width + column
    depth = on_plane(corner, corner[2], triangle, column, row)
    nearest = np.full(width * height, -np.inf, np.float32)
    np.maximum.at(nearest, pixel, depth)
    front = np.flatnonzero(depth == nearest.take(pixel))
    seen = np.full(width * height, -1, np.int64)
    seen[pixel.take(front)] = triangle.take(front)
    shown = np.flatnonzero(seen >= 0)
    return shown, seen.take(shown), nearest.take(shown)


def extent(values: Single) -> Single:
    """(m,) from the least to the largest of three values (3, m)."""
    a, b, c = values
    return np.maximum(np.maximum(a, b), c) - np.minimum(np.minimum(a, b), c)


def on_plane(corner: Single, value: Single, triangle: Ints, column: Ints, row: Ints) -> Single:
    """Value (p,) in the middle of pixels, of a triangle that has `value` (3, m) at its corners."""
    (bx, cx), (by, cy) = corner[:2, 1:].astype(np.float64) - corner[:2, :1]
    to_b, to_c = value[1] - value[0], value[2] - value[0]
    twice = bx * cy - by * cx
    by_column = ((to_b * cy - to_c * by) / twice).astype(np.float32)
    by_row = ((to_c * bx - to_b * cx) / twice).astype(np.float32)
    across = _middles(column) - corner[0, 0].take(triangle)
    down = _middles(row) - corner[1, 0].take(triangle)
    across *= by_column.take(triangle)
    down *= by_row.take(triangle)
    return value[0].take(triangle) + across + down


def area(a: Single, b: Single, c: Single) -> Single:
    """Twice the signed area of triangles (m,) by their corners (2, m) on the screen."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _pixels(x: Single, y: Single, width: int, height: int) -> tuple[Ints, Ints, Ints]:
    """Triangle, column and row of every pixel whose middle lies in one: triangles to rows, rows to pixels."""
    order = y.argsort(axis=0) * y.shape[1] + np.arange(y.shape[1])
    x, y = x.take(order), y.take(order)
    triangle, row = _expand(*_span(y[0], y[2], height))
    at = _middles(row)
    # From top to bottom a triangle has one long edge, and two short ones by its middle corner.
    long = _edge(x[[0]], y[[0]], x[[2]], y[[2]])
    short = _edge(x[:2], y[:2], x[1:], y[1:])
    lower = triangle + (at > y[1].take(triangle)) * y.shape[1]
    one = long[0].take(triangle) + at * long[1].take(triangle)
    other = short[0].take(lower) + at * short[1].take(lower)
    span, column = _expand(*_span(np.minimum(one, other), np.maximum(one, other), width))
    return triangle.take(span), column, row.take(span)


def _middles(pixel: Ints) -> Single:
    return pixel.astype(np.float32) + np.float32(0.5)


def _expand(first: Ints, count: Ints) -> tuple[Ints, Ints]:
    """For runs first, first + 1, … of `count` members: the run of every member, and the member."""
    run = np.repeat(np.arange(len(count)), count)
    member = (first - np.cumsum(count) + count).take(run)
    member += np.arange(len(run))
    return run, member


def _span(low: Single, high: Single, size: int) -> tuple[Ints, Ints]:
    """First of the pixels 0 … size - 1 whose middles lie between `low` and `high`, and their number."""
    first = np.ceil(np.clip(low - 0.5, 0, size)).astype(np.int64)
    last = np.floor(np.clip(high - 0.5, -1, size - 1)).astype(np.int64)
    return first, np.maximum(last - first + 1, 0)


def _edge(x: Single, y: Single, to_x: Single, to_y: Single) -> Single:
    """(2, k m) of k edges of m triangles, one after the other: x at y = 0, and how x runs with y."""
    fall = to_y - y
    slope = (to_x - x) / np.where(np.abs(fall) < LEVEL, np.inf, fall)
    return np.stack([x - y * slope, slope]).reshape(2, -1)
