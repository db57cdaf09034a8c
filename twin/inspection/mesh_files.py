"""Meshes from files, in millimetres, equal vertices joined."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from twin.errors import InputError, Place
from twin.inspection.formats.others import read_other
from twin.inspection.formats.raw import DamagedError, Raw
from twin.inspection.solid import Floats, Ints
from twin.inspection.units import DECLARED, MILLIMETRES

FORMATS = {".stl": "STL", ".obj": "OBJ", ".ply": "PLY", ".3mf": "3MF", ".glb": "GLB", ".gltf": "glTF"}
"""suffix -> name"""
GZIP = b"\x1f\x8b"
"""how a compressed file begins"""
MIX = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)
"""odd multipliers that spread the bits of x, y and z over one word"""


def read_mesh(path: Path, unit: str | None = None) -> tuple[Floats, Ints]:
    """Read vertices (n, 3) [mm] and faces (m, 3).

    `unit` is what one unit of the file is, whatever it declares. Without it 3MF has the unit it declares, GLB
    metres by definition, and the others, which declare none, millimetres.

    Raises:
        InputError: no such file, not a readable mesh, no triangles, an unknown unit.

    """
    place = Place(file=str(path))
    if not path.is_file():
        raise InputError("is a folder" if path.is_dir() else "there is no such file", place=place)
    if path.stat().st_size == 0:
        raise InputError("the file is empty", place=place)
    suffix = path.suffix.lower()
    _check_unpacked(path, place)
    if suffix not in FORMATS:
        raise InputError(
            f"{path.suffix or 'no suffix'} names no format of meshes",
            place=place,
            remedy=f"valid: {', '.join(FORMATS)}",
        )
    try:
        raw = short_way(path) or read_other(path)
    except DamagedError as fault:
        raise InputError(f"not a readable mesh: {fault}", place=place) from fault
    except OSError as fault:
        raise InputError(f"cannot be read: {fault.strerror}", place=place) from fault
    vertices, faces = raw.vertices, raw.faces
    if len(vertices) == 0 or (faces is not None and len(faces) == 0):
        raise InputError("the file holds no triangles", place=place, remedy="valid: a mesh of triangles")
    if faces is not None and not 0 <= faces.min() <= faces.max() < len(vertices):
        raise InputError(
            f"not a readable mesh: faces name vertices {faces.min()} to {faces.max()}, "
            f"there are 0 to {len(vertices) - 1}",
            place=place,
        )
    factor = MILLIMETRES.get(unit or DECLARED.get(raw.unit, raw.unit))
    if factor is None:
        raise InputError(
            f"the file declares the unknown unit {raw.unit!r}",
            place=place,
            remedy=f"valid: {', '.join(DECLARED)}; or name it with --units",
        )
    points, index = joined(vertices)
    return points * factor, index.reshape(-1, 3) if faces is None else index[faces]


def _check_unpacked(path: Path, place: Place) -> None:
    """Raise InputError for a file that was compressed as a whole."""
    try:
        with path.open("rb") as file:
            begin = file.read(2)
    except OSError as fault:
        raise InputError(f"cannot be read: {fault.strerror}", place=place) from fault
    if begin == GZIP:
        raise InputError("the file is compressed by gzip", place=place, remedy="unpack it first: gunzip")


def short_way(path: Path) -> Raw | None:
    """Read a file by the module for its suffix, none of the others loaded.

    None where that leaves it to trimesh, which takes three to five times longer, and half a second to load.
    Raises DamagedError.
    """
    match path.suffix.lower():
        case ".stl":
            from twin.inspection.formats.stl import read_stl as read  # noqa: PLC0415
        case ".obj":
            from twin.inspection.formats.obj import read_obj as read  # noqa: PLC0415
        case ".ply":
            from twin.inspection.formats.ply import read_ply as read  # noqa: PLC0415
        case ".3mf":
            from twin.inspection.formats.package import read_3mf as read  # noqa: PLC0415
        case ".glb":
            from twin.inspection.formats.glb import read_glb as read  # noqa: PLC0415
        case _:
            return None
    return read(path)


@np.errstate(invalid="ignore")  # a NaN may signal; it is told of where the solid is checked
def joined(vertices: np.ndarray) -> tuple[Floats, Ints]:
    """Join vertices (n, 3), float32 or float64, that are equal to the last bit.

    Returns:
        those left (k, 3), and the index of each one among them (n,).

    """
    columns = [np.ascontiguousarray(column) + vertices.dtype.type(0) for column in vertices.T]  # no -0
    word = np.zeros(len(vertices), dtype=np.uint64)
    for column, factor in zip(columns, MIX, strict=True):
        word ^= word >> np.uint64(29)
        word ^= column.view(f"u{column.itemsize}")
        word *= np.uint64(factor)
    for order, fresh in _orders(word):
        index = np.zeros_like(order)
        index[order] = np.cumsum(fresh) - 1
        first = order[fresh]
        if all((column[first][index] == column).all() for column in columns):
            return np.column_stack([column[first] for column in columns]).astype(np.float64), index
    # two points made the same word
    points, index = np.unique(vertices, axis=0, return_inverse=True)
    return points.astype(np.float64), index.reshape(-1).astype(np.int64)


def _orders(word: NDArray[np.uint64]) -> Iterator[tuple[Ints, np.ndarray]]:
    """Ways to put equal words (n,) beside each other, and where a new one begins: a quick one, a sure one.

    The quick one sorts the words' upper bits with their places below them, values instead of places.
    """
    bits = np.uint64(max(len(word) - 1, 1).bit_length())
    low = (np.uint64(1) << bits) - np.uint64(1)
    packed = np.sort((word & ~low) | np.arange(len(word), dtype=np.uint64))
    upper = packed >> bits
    yield (packed & low).astype(np.int64), np.diff(upper, prepend=~upper[:1]) != 0
    order = np.argsort(word)
    yield order, np.diff(word[order], prepend=~word[order[:1]]) != 0
