"""The solid to be measured: a closed, oriented mesh, checked once so that the rest may rely on it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from twin.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


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
    turned: bool
    """the mesh came inside out and was turned"""


def check_solid(vertices: ArrayLike, faces: ArrayLike) -> Solid:
    """Take a mesh for measuring.

    Args:
        vertices: (n, 3) [mm].
        faces: (m, 3) vertex indices.

    Raises:
        InputError: wrong shape or type, empty, NaN or infinite coordinates, indices out of range, or not a
            closed, consistently oriented 2-manifold.

    """
    points = _array(vertices, "vertices", np.float64)
    triangles = _array(faces, "faces", np.int64)
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        raise InputError(
            f"mesh: {np.count_nonzero(bad)} of {len(points)} vertices are not finite, "
            f"the first is vertex {int(np.argmax(bad))}"
        )
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise InputError(
            f"mesh: face indices run from {triangles.min()} to {triangles.max()}, "
            f"valid are 0 to {len(points) - 1}"
        )
    _check_closed(triangles, len(points))
    volume = _volume(points, triangles)
    if volume == 0.0:
        raise InputError("mesh: it encloses no volume")
    turned = volume < 0.0
    low, high = corner_limits(points[:, 2], triangles)
    return Solid(
        vertices=points,
        faces=triangles[:, ::-1] if turned else triangles,
        face_low=low,
        face_high=high,
        turned=turned,
    )


def corner_limits(values: Floats, faces: Ints) -> tuple[Floats, Floats]:
    """Return least and largest (m,) of a value (n,) of vertices at the corners of each face."""
    a, b, c = (values[faces[:, i]] for i in range(3))
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def _array(value: ArrayLike, name: str, dtype: type[np.generic]) -> NDArray:
    try:
        array = np.asarray(value)
        if dtype is np.int64 and array.size and not np.issubdtype(array.dtype, np.integer):
            raise InputError(f"mesh: {name} must be integers, got {array.dtype}")
        array = np.ascontiguousarray(array, dtype=dtype)
    except (TypeError, ValueError) as fault:
        raise InputError(f"mesh: {name} are not an array of numbers ({fault})") from fault
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError(f"mesh: {name} must have shape (n, 3), got {array.shape}")
    if len(array) == 0:
        raise InputError(f"mesh: there are no {name}")
    return array


def _check_closed(faces: Ints, vertex_count: int) -> None:
    """Every directed edge occurs once and so does its reverse."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    if (start == end).any():
        raise InputError(
            f"mesh: face {int(np.argmax(start == end)) // 3} names a vertex twice",
            remedy="remove degenerate faces",
        )
    forward = np.sort(start * vertex_count + end)
    backward = np.sort(end * vertex_count + start)
    doubled = np.count_nonzero(forward[1:] == forward[:-1])
    if doubled:
        raise InputError(
            f"mesh: {doubled} edges belong to more than two faces or to faces of opposite orientation",
            remedy="a closed 2-manifold with faces all turned outward, no duplicates",
        )
    if not np.array_equal(forward, backward):
        lone = np.setdiff1d(forward, backward, assume_unique=True)
        raise InputError(
            f"mesh: not closed, {len(lone)} edges have only one face",
            remedy="a closed 2-manifold; vertices of neighbouring faces must be shared, not repeated",
        )


def _volume(points: Floats, faces: Ints) -> float:
    a, b, c = (points[faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0
