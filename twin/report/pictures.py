"""Still pictures of the part, drawn in numpy: the same on every machine, with or without graphics hardware.

An orthographic scan-line renderer with a depth buffer, vectorised over all triangles at once.
"""

import io
from collections.abc import Iterable
from dataclasses import dataclass

import matplotlib.image
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from twin.inspection.result import Floats
from twin.report.colours import STEEL

Ints = NDArray[np.integer]
Single = NDArray[np.floating]
SAMPLES = 2
"""picture elements are averaged over SAMPLES × SAMPLES"""
CREASE_COSINE = np.cos(np.radians(15.0))
"""a blended normal further than this from the facet's own lies on a sharp edge"""
LEVEL = 1e-4
"""an edge that falls by less crosses no row [pixels]"""
FALLOFF = np.float32(0.16)
"""share by which the light weakens from the middle to the lower right corner"""


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """A camera at infinity."""

    towards_eye: tuple[float, float, float]
    """from the part to the eye, part frame"""
    up: tuple[float, float, float]

    def axes(self) -> Floats:
        """(3, 3) rows: right, up, towards the eye."""
        eye = np.array(self.towards_eye) / np.linalg.norm(self.towards_eye)
        right = np.cross(self.up, eye)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(eye, right), eye])


ISOMETRIC = View(towards_eye=(1.0, -1.25, 1.0), up=(0.0, 0.0, 1.0))
"""front face on top"""
END = View(towards_eye=(0.0, 0.0, 1.0), up=(0.0, 1.0, 0.0))
"""onto the front face as the tailstock sees it, +X to the right"""


def render_part(
    vertices: Floats,
    faces: NDArray[np.integer],
    size: tuple[int, int],
    views: Iterable[View],
    colour: tuple[float, float, float] = STEEL,
) -> tuple[bytes, ...]:
    """Draw a mesh, filling the frame, once for every view; return PNGs with a transparent background.

    `vertices` (n, 3) [mm]; `faces` (m, 3) counter-clockwise seen from outside; `size` (width, height) in
    pixels; `colour` red, green, blue in 0 … 1. An empty mesh gives an empty picture.
    """
    mesh = _Mesh(vertices, faces)
    return tuple(_png(_draw(mesh, size[0] * SAMPLES, size[1] * SAMPLES, view), colour) for view in views)


def place(vertices: Floats, size: tuple[int, int], view: View, points: Floats) -> Floats:
    """(k, 2) where `points` (k, 3) [mm] stand in the mesh's picture: pixels from its upper left corner."""
    axes = view.axes()
    scale, shift = _fit(axes @ vertices.T, *size)
    return _to_screen(axes @ points.T, scale, shift)[:2].T.astype(np.float64)


class _Mesh:
    """What all views share, one column a point or triangle so that every component lies in one piece."""

    def __init__(self, vertices: Floats, faces: NDArray[np.integer]) -> None:
        self.points = np.ascontiguousarray(vertices.T, np.float32)
        """(3, n)"""
        self.faces = np.ascontiguousarray(faces.T, np.int32)
        """(3, m)"""
        corner = self.points[:, self.faces]
        edge = [_unit(corner[:, (k + 1) % 3] - corner[:, k]) for k in range(3)]
        self.facet_normals = _unit(_cross(edge[0], edge[1]))
        """(3, m)"""
        total = np.zeros_like(self.points)
        for k in range(3):
            # Weighted by the angle at the vertex: the mean does not depend on the triangulation.
            angle = np.arccos(np.clip(-_dot(edge[k], edge[k - 1]), -1, 1))
            for axis in range(3):
                total[axis] += np.bincount(self.faces[k], self.facet_normals[axis] * angle, total.shape[1])
        self.vertex_normals = _unit(total)
        """(3, n)"""


def _draw(mesh: _Mesh, width: int, height: int, view: View) -> Single:
    """(height / SAMPLES, width / SAMPLES, 2) brightness times coverage, and coverage."""
    turn = view.axes().astype(np.float32)
    screen = turn @ mesh.points
    scale, shift = _fit(screen, width, height)
    screen = _to_screen(screen, scale, shift)
    facing = np.flatnonzero(_area(*screen[:2, mesh.faces].swapaxes(0, 1)) < -1e-6)
    faces = mesh.faces[:, facing]
    corner = screen[:, faces]
    pixel, seen, depth = _visible(corner, width, height)
    own, blended = mesh.facet_normals[:, None, facing], mesh.vertex_normals[:, faces]
    normal = np.where(_dot(own, blended) < CREASE_COSINE, own, blended)
    brightness = steel(np.tensordot(turn, normal, 1))
    shade = _on_plane(corner, brightness, seen, pixel % width, pixel // width)
    light = _falloff(pixel, width, height) * _crevices(depth * scale, pixel, (height, width))
    image = np.zeros((2, height * width), np.float32)
    image[0, pixel] = shade * light
    image[1, pixel] = 1
    image = image.reshape(2, height, width)
    parts = [image[:, i::SAMPLES, j::SAMPLES] for i in range(SAMPLES) for j in range(SAMPLES)]
    return np.moveaxis(np.sum(parts, axis=0), 0, -1) / SAMPLES**2


def _falloff(pixel: Ints, width: int, height: int) -> Single:
    """Brightness of the light (p,), strongest at the upper left, so that flat faces are not one grey."""
    across, down = (pixel % width).astype(np.float32) / width, (pixel // width).astype(np.float32) / height
    return 1 + FALLOFF * (1 - across - down)


def steel(normal: Single) -> Single:
    """Brightness (...) of turned steel under two soft boxes, by its unit normal (3, ...) in the eye's frame.

    The view that turns is shaded by the same function (`viewer.js`).
    """
    x, y, z = normal
    key = np.clip(-0.45 * x + 0.65 * y + 0.61 * z, 0, 1)
    fill = np.clip(0.87 * x + 0.05 * y + 0.49 * z, 0, 1)
    strip = np.exp(-np.square((y - 0.40 + 0.3 * x) * 5))
    glint = np.square(np.square(key) * key)
    return 0.42 + 0.46 * key + 0.34 * np.square(fill) + 0.26 * strip + 0.45 * np.square(glint)


def _fit(points: Single, width: int, height: int) -> tuple[float, Single]:
    """Pixels per mm, and the shift (2, 1), that let points (3, n) fill the frame but for a margin."""
    if not points.size:
        return 1.0, np.zeros((2, 1), np.float32)
    low, high = points[:2].min(axis=1), points[:2].max(axis=1)
    scale = 0.96 * float(np.min([width, height] / np.maximum(high - low, 1e-6)))
    middle = scale * (low + high) / 2
    return scale, np.array([[width / 2 - middle[0]], [height / 2 + middle[1]]], np.float32)


def _to_screen(points: Single, scale: float, shift: Single) -> Single:
    """Pixel coordinates (3, n), y down, depth in mm as it was."""
    return np.stack([points[0] * scale + shift[0], shift[1] - points[1] * scale, points[2]])


def _area(a: Single, b: Single, c: Single) -> Single:
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


def _visible(corner: Single, width: int, height: int) -> tuple[Ints, Ints, Single]:
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
    depth = _on_plane(corner, corner[2], triangle, column, row[span])
    nearest = np.full(width * height, -np.inf, np.float32)
    np.maximum.at(nearest, pixel, depth)
    front = depth == nearest[pixel]
    seen = np.full(width * height, -1, np.int32)
    seen[pixel[front]] = triangle[front]
    shown = np.flatnonzero(seen >= 0)
    return shown, seen[shown], nearest[shown]


def _edge(x: Single, y: Single, to_x: Single, to_y: Single) -> Single:
    """(2, k m) of k edges of m triangles, one after the other: x at y = 0, and how x runs with y."""
    fall = to_y - y
    slope = (to_x - x) / np.where(np.abs(fall) < LEVEL, np.inf, fall)
    return np.stack([x - y * slope, slope]).reshape(2, -1)


def _on_plane(corner: Single, value: Single, triangle: Ints, column: Ints, row: Ints) -> Single:
    """Value (p,) in the middle of pixels, of a triangle that has `value` (3, m) at its corners."""
    (bx, cx), (by, cy) = corner[:2, 1:].astype(np.float64) - corner[:2, :1]
    to_b, to_c = value[1] - value[0], value[2] - value[0]
    area = bx * cy - by * cx
    by_column = ((to_b * cy - to_c * by) / area).astype(np.float32)
    by_row = ((to_c * bx - to_b * cx) / area).astype(np.float32)
    across = column.astype(np.float32) + np.float32(0.5) - corner[0, 0, triangle]
    down = row.astype(np.float32) + np.float32(0.5) - corner[1, 0, triangle]
    return value[0, triangle] + by_column[triangle] * across + by_row[triangle] * down


def _dot(a: Single, b: Single) -> Single:
    """Products of (3, ...) and (3, ...), summed over the first axis."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Single, b: Single) -> Single:
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _unit(vectors: Single) -> Single:
    """(3, ...) of length one; zero stays zero."""
    return vectors / np.maximum(np.sqrt(_dot(vectors, vectors)), 1e-30)


def _crevices(depth: Single, pixel: Ints, shape: tuple[int, int]) -> Single:
    """Darken what lies deeper than its surroundings (unsharp mask of the depth buffer, Luft et al. 2006)."""
    filled, mask = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    filled.flat[pixel] = depth
    mask.flat[pixel] = 1.0
    radius, step = max(shape) / 60, 4
    coarse = gaussian_filter(mask[::step, ::step], radius / step)
    around = gaussian_filter(filled[::step, ::step], radius / step) / np.maximum(coarse, 1e-3)
    around = around.repeat(step, axis=0).repeat(step, axis=1)[: shape[0], : shape[1]]
    buried = np.clip((around.flat[pixel] - depth) / (1.6 * radius) - 0.5, 0, 1)
    return 1 - 0.55 * buried


def _png(image: Single, colour: tuple[float, float, float]) -> bytes:
    """Encode (height, width, 2), brightness times coverage and coverage."""
    covered = image[..., 1:]
    rgba = np.concatenate(
        [image[..., :1] / np.maximum(covered, 1e-6) * np.array(colour, np.float32), covered], axis=-1
    )
    buffer = io.BytesIO()
    matplotlib.image.imsave(buffer, (np.clip(rgba, 0, 1) * 255 + 0.5).astype(np.uint8), format="png")
    return buffer.getvalue()
