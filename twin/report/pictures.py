"""Still pictures of the part, drawn in numpy: the same on every machine, with or without graphics hardware.

An orthographic scan-line renderer with a depth buffer, vectorised over all triangles at once.
"""

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.inspection.result import Floats
from twin.report.colours import STEEL
from twin.report.png import png_rgba
from twin.report.raster import area, on_plane, visible

Ints = NDArray[np.integer]
Single = NDArray[np.floating]
SAMPLES = 2
"""picture elements are averaged over SAMPLES × SAMPLES"""
CREASE_COSINE = np.cos(np.radians(15.0))
"""a blended normal further than this from the facet's own lies on a sharp edge"""
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Tint:
    """Colours of a mesh by its vertices."""

    index: NDArray[np.uint8]
    """(n,) into `palette`; 0 = left in steel"""
    palette: NDArray[np.uint8]
    """(256, 3) red, green, blue"""


def render_part(
    vertices: Floats,
    faces: NDArray[np.integer],
    size: tuple[int, int],
    views: Iterable[tuple[View, Tint | None]],
) -> tuple[bytes, ...]:
    """Draw a mesh, filling the frame, once for every view; return PNGs with a transparent background.

    `vertices` (n, 3) [mm]; `faces` (m, 3) counter-clockwise seen from outside; `size` (width, height) in
    pixels. Without a tint the part is of steel. An empty mesh gives an empty picture.
    """
    mesh = _Mesh(vertices, faces)
    width, height = size[0] * SAMPLES, size[1] * SAMPLES
    with ThreadPoolExecutor() as pool:  # numpy leaves the interpreter free
        return tuple(pool.map(lambda shot: png_rgba(_draw(mesh, width, height, *shot), level=3), views))


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

    def normals(self, chosen: Ints) -> Single:
        """(3, 3 corners, k) unit normals at the corners of the `chosen` faces (k,).

        Blended from the facets around a vertex; the facet's own where that lies off it by a sharp edge.
        """
        near = np.zeros(self.points.shape[1], bool)
        near[self.faces[:, chosen]] = True
        around = np.flatnonzero(near[self.faces[0]] | near[self.faces[1]] | near[self.faces[2]])
        faces = self.faces[:, around]
        corner = self.points.take(faces, axis=1)
        edge = [_unit(corner[:, (k + 1) % 3] - corner[:, k]) for k in range(3)]
        facet = _unit(_cross(edge[0], edge[1]))
        total = np.zeros_like(self.points)
        for k in range(3):
            # Weighted by the angle at the vertex: the mean does not depend on the triangulation.
            angle = np.arccos(np.clip(-_dot(edge[k], edge[k - 1]), -1, 1))
            for axis in range(3):
                total[axis] += np.bincount(faces[k], facet[axis] * angle, total.shape[1])
        own = facet[:, None, np.searchsorted(around, chosen)]
        blended = _unit(total.take(self.faces[:, chosen], axis=1))
        return np.where(_dot(own, blended) < CREASE_COSINE, own, blended)


def _draw(mesh: _Mesh, width: int, height: int, view: View, tint: Tint | None) -> NDArray[np.uint8]:
    """(height / SAMPLES, width / SAMPLES, 4) red, green, blue, coverage."""
    turn = view.axes().astype(np.float32)
    screen = turn @ mesh.points
    scale, shift = _fit(screen, width, height)
    screen = _to_screen(screen, scale, shift)
    facing = _facing(screen, mesh.faces)
    pixel, seen, depth = visible(screen.take(mesh.faces[:, facing], axis=1), width, height)
    # of all triangles, those that are seen have a brightness
    drawn, seen = _numbered(seen, len(facing))
    chosen = facing[drawn]
    faces = mesh.faces[:, chosen]
    corner = screen.take(faces, axis=1)
    brightness = steel(np.tensordot(turn, mesh.normals(chosen), 1))
    shade = on_plane(corner, brightness, seen, pixel % width, pixel // width)
    shade *= _falloff(pixel, width, height) * _crevices(depth * scale, pixel, (height, width))
    # brightness of steel and coverage, and with a tint red, green and blue of what is coloured
    image = np.zeros((2 if tint is None else 5, height * width), np.float32)
    image[0, pixel], image[1, pixel] = shade, 1
    if tint is not None:
        _colour(image, tint, faces, corner, pixel=pixel, seen=seen, shade=shade, width=width)
    image = image.reshape(-1, height, width)
    mean = image[:, ::SAMPLES, ::SAMPLES].copy()
    for i, j in list(np.ndindex(SAMPLES, SAMPLES))[1:]:
        mean += image[:, i::SAMPLES, j::SAMPLES]
    mean /= SAMPLES**2
    rgba = np.zeros((*mean.shape[1:], 4), np.float32)
    own_colour = mean[0, ..., None] * np.array(STEEL, np.float32)
    if tint is not None:
        own_colour += np.moveaxis(mean[2:], 0, -1)
    rgba[..., :3] = own_colour / np.maximum(mean[1, ..., None], 1e-6)
    rgba[..., 3] = mean[1]
    return (np.clip(rgba, 0, 1) * 255 + 0.5).astype(np.uint8)


def _facing(screen: Single, faces: Ints) -> Ints:
    """Triangles (k,) that face the eye and reach over the middles of a row and a column of pixels."""
    x, y = (axis.take(faces) for axis in screen[:2])
    over = [np.rint(axis).max(axis=0) > np.rint(axis).min(axis=0) for axis in (x, y)]
    return np.flatnonzero(over[0] & over[1] & (area(*np.stack([x, y], axis=1)) < -1e-6))


def _numbered(seen: Ints, count: int) -> tuple[Ints, Ints]:
    """Which of `count` triangles are `seen` (p,), and their places among those."""
    some = np.zeros(count, bool)
    some[seen] = True
    return np.flatnonzero(some), (np.cumsum(some, dtype=np.int32) - 1)[seen]


def _colour(
    image: Single,
    tint: Tint,
    faces: Ints,
    corner: Single,
    *,
    pixel: Ints,
    seen: Ints,
    shade: Single,
    width: int,
) -> None:
    """Take the pixels (p,) of wholly coloured triangles out of the steel and paint them, softly shaded."""
    index = tint.index[faces].astype(np.float32)
    own = np.flatnonzero(index.min(axis=0)[seen] > 0)
    pixel, seen = pixel[own], seen[own]
    value = np.rint(on_plane(corner, index, seen, pixel % width, pixel // width))
    base = tint.palette[np.clip(value, 1, 255).astype(np.int32)].T.astype(np.float32) / 255
    image[0, pixel] = 0
    image[2:, pixel] = np.minimum(base * (0.35 + 0.65 * shade[own]), 1)


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
    coarse = _blurred(mask[::step, ::step], radius / step)
    around = _blurred(filled[::step, ::step], radius / step) / np.maximum(coarse, 1e-3)
    around = around.repeat(step, axis=0).repeat(step, axis=1)[: shape[0], : shape[1]]
    buried = np.clip((around.flat[pixel] - depth) / (1.6 * radius) - 0.5, 0, 1)
    return 1 - 0.55 * buried


def _blurred(image: Single, radius: float) -> Single:
    """An image (h, w) seen through a Gaussian of that radius [pixels], zero beyond its edges."""
    rows, columns = (np.arange(count, dtype=np.float32) for count in image.shape)
    weights = [
        np.exp(-0.5 * np.square((at[:, None] - at) / np.float32(radius)))
        / np.float32(radius * np.sqrt(2.0 * np.pi))
        for at in (rows, columns)
    ]
    return weights[0] @ image @ weights[1]
