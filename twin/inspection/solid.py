"""The solid to be measured: a closed, oriented mesh, checked once so that the rest may rely on it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from twin.errors import InputError
from twin.inspection.beside import Beside

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


LARGEST = 1e6
"""a coordinate beyond this [mm] is no workpiece's"""


class MeshError(InputError):
    """A mesh that is no solid to measure."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """A closed 2-manifold with outward faces, in the part frame (work axis = Z, front face at z = 0)."""

    vertices: Floats
    """(n, 3) [mm]"""
    faces: Ints
    """(m, 3) vertex indices, counter-clockwise seen from outside"""
    face_low: Floats
    """(m,) least z of each face"""
    face_high: Floats
    """(m,) largest z of each face"""
    face_near: Floats
    """(m,) no point of the face is nearer to the z axis, squared [mm²]"""
    face_far: Floats
    """(m,) no point of the face is farther from it, squared [mm²]"""
    neighbours: tuple[Ints, Ints]
    """(3 m / 2,) each: the faces on both sides of every edge"""
    mended: tuple[str, ...] = ()
    """what had to be mended, in sentences"""


def check_solid(vertices: ArrayLike, faces: ArrayLike) -> Solid:
    """Take a mesh for measuring. Doubled and degenerate faces and a mesh inside out are mended.

    Args:
        vertices: (n, 3) [mm].
        faces: (m, 3) vertex indices.

    Raises:
        MeshError: wrong shape or type, empty, NaN, infinite or huge coordinates, indices out of range, or
            not a closed, consistently oriented 2-manifold.

    """
    points = _array(vertices, "vertices", np.float64)
    triangles = _array(faces, "faces", np.int64)
    check_finite(points)
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise MeshError(
            f"mesh: face indices run from {triangles.min()} to {triangles.max()}, "
            f"valid are 0 to {len(points) - 1}"
        )
    triangles, mended = _without_degenerate(triangles)
    measured = Beside(lambda: _limits(points, triangles))
    try:
        neighbours = _neighbours(triangles, len(points))
    except MeshError:
        single = _without_doubled(triangles)
        doubled = len(triangles) - len(single)
        if not doubled:
            raise
        mended.append(f"{doubled} doubled faces were left out")
        return solid_of(points, single, _neighbours(single, len(points)), tuple(mended))
    return _solid(points, triangles, neighbours, tuple(mended), measured.result())


def solid_of(
    points: Floats, triangles: Ints, neighbours: tuple[Ints, Ints], mended: tuple[str, ...] = ()
) -> Solid:
    """Return the solid of checked vertices (n, 3) and faces (m, 3), turned outward, with their limits.

    Raises MeshError if it encloses no volume.
    """
    return _solid(points, triangles, neighbours, mended, _limits(points, triangles))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Limits:
    """What can be said of faces without their neighbours: see `Solid`."""

    low: Floats
    high: Floats
    near: Floats
    far: Floats
    volume: float


def _limits(points: Floats, triangles: Ints) -> _Limits:
    corners = np.ascontiguousarray(triangles.T)
    x, y, z = (np.ascontiguousarray(values).take(corners) for values in points.T)
    squares = x * x + y * y
    sides = [(x[i] - x[j], y[i] - y[j]) for i, j in ((1, 0), (2, 0), (2, 1))]
    longest = np.maximum.reduce([a * a + b * b for a, b in sides])
    # columns under the faces; from the middle, so that little is lost where a part stands far up
    shadow = sides[0][0] * sides[1][1] - sides[1][0] * sides[0][1]
    return _Limits(
        low=np.minimum.reduce(z),
        high=np.maximum.reduce(z),
        # a chord of length l between points outside R comes no nearer than sqrt(R^2 - l^2/4)
        near=np.minimum.reduce(squares) - longest / 4,
        far=np.maximum.reduce(squares),
        volume=float(shadow @ (z[0] + z[1] + z[2] - 3 * z[0].mean())) / 6,
    )


def _solid(
    points: Floats, triangles: Ints, neighbours: tuple[Ints, Ints], mended: tuple[str, ...], limits: _Limits
) -> Solid:
    if limits.volume == 0.0:
        raise MeshError("mesh: it encloses no volume")
    if limits.volume < 0.0:
        triangles = np.ascontiguousarray(triangles[:, ::-1])
        mended = (*mended, "the mesh came inside out and was turned")
    return Solid(
        vertices=points,
        faces=triangles,
        face_low=limits.low,
        face_high=limits.high,
        face_near=limits.near,
        face_far=limits.far,
        neighbours=neighbours,
        mended=mended,
    )


def check_finite(points: Floats) -> None:
    """Raise MeshError if a coordinate of the points (n, 3) is not finite or too large."""
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        raise MeshError(
            f"mesh: {np.count_nonzero(bad)} of {len(points)} vertices are not finite, "
            f"the first is vertex {int(np.argmax(bad))}"
        )
    reach = float(np.abs(points).max(initial=0.0))
    if reach > LARGEST:
        raise MeshError(f"mesh: coordinates reach {reach:.3g} mm", remedy=f"valid: up to {LARGEST:g} mm")


def _array(value: ArrayLike, name: str, dtype: type[np.generic]) -> NDArray:
    try:
        array = np.asarray(value)
        if dtype is np.int64 and array.size and not np.issubdtype(array.dtype, np.integer):
            raise MeshError(f"mesh: {name} must be integers, got {array.dtype}")
        array = np.ascontiguousarray(array, dtype=dtype)
    except (TypeError, ValueError) as fault:
        raise MeshError(f"mesh: {name} are not an array of numbers ({fault})") from fault
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(f"mesh: {name} must have shape (n, 3), got {array.shape}")
    if len(array) == 0:
        raise MeshError(f"mesh: there are no {name}")
    return array


def _without_degenerate(faces: Ints) -> tuple[Ints, list[str]]:
    """Leave out faces that name a vertex twice: their edges cancel, a closed mesh stays closed."""
    a, b, c = faces.T
    flat = (a == b) | (b == c) | (c == a)
    if not flat.any():
        return faces, []
    if flat.all():
        raise MeshError("mesh: every face names a vertex twice")
    return faces[~flat], [f"{np.count_nonzero(flat)} degenerate faces were left out"]


def _without_doubled(faces: Ints) -> Ints:
    """Leave out what repeats a face, in whatever order it names the same vertices in the same sense."""
    first = faces.argmin(axis=1)
    turned = np.take_along_axis(faces, (first[:, None] + np.arange(3)) % 3, axis=1)
    return faces[np.sort(np.unique(turned, axis=0, return_index=True)[1])]


def _by_number(number: Ints, face: Ints) -> tuple[Ints, Ints]:
    """Sort the numbers (n,) of edges, and the faces (n,) they belong to with them."""
    bits = int(face.max(initial=1)).bit_length()
    if int(number.max(initial=1)).bit_length() + bits > 63:
        order = np.argsort(number)
        return number[order], face[order]
    # both in one word: values sort several times faster than places
    packed = np.sort((number << bits) | face)
    return packed >> bits, packed & ((1 << bits) - 1)


def _paired(faces: Ints, vertex_count: int) -> tuple[Ints, Ints] | None:
    """The same in one sort; None for a mesh that is refused, or has too many vertices for it."""
    bits = (len(faces) - 1).bit_length() + 1
    if 2 * vertex_count.bit_length() + bits > 63:
        return None
    # an edge, its sense and its face in one word
    words = np.empty((3, len(faces)), dtype=np.int64)
    face, corners = np.arange(len(faces)), np.ascontiguousarray(faces.T)
    for side, (start, end) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True)):
        edge = np.minimum(start, end) * vertex_count + np.maximum(start, end)
        words[side] = ((edge << 1 | (start > end)) << (bits - 1)) | face
    words = np.sort(words, axis=None)
    if len(words) % 2:
        return None
    rising, falling = words[::2], words[1::2]
    edge = rising >> (bits - 1)
    whole = np.array_equal(falling >> (bits - 1), edge + 1) and not (edge & 1).any()
    if not (whole and (np.diff(edge) > 0).all()):
        return None
    mask = (1 << (bits - 1)) - 1
    return rising & mask, falling & mask


def _neighbours(faces: Ints, vertex_count: int) -> tuple[Ints, Ints]:
    """Pair the faces on both sides of every edge: it is passed once in each sense, or the mesh is refused."""
    paired = _paired(faces, vertex_count)
    if paired is not None:
        return paired
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    face = np.repeat(np.arange(len(faces)), 3)
    up = start < end
    (rising, first), (falling, second) = (
        _by_number(low[passed] * vertex_count + high[passed], face[passed])
        for low, high, passed in ((start, end, up), (end, start, ~up))
    )
    if len(rising) == len(falling) and np.array_equal(rising, falling) and (np.diff(rising) > 0).all():
        return first, second
    doubled = sum(int(np.count_nonzero(np.diff(number) == 0)) for number in (rising, falling))
    if doubled:
        raise MeshError(
            f"mesh: {doubled} edges belong to more than two faces or to faces of opposite orientation",
            remedy="a closed 2-manifold with faces all turned outward",
        )
    lone = len(np.setxor1d(rising, falling, assume_unique=True))
    raise MeshError(
        f"mesh: not closed, {lone} edges have only one face",
        remedy="a closed 2-manifold; vertices of neighbouring faces must be shared, not repeated",
    )
