"""Meshes from files, in millimetres, equal vertices joined.

Binary STL, the largest and the commonest, is read here; trimesh reads the rest and is loaded only for it.
"""

import warnings
from pathlib import Path

import numpy as np

from twin.errors import InputError, Place
from twin.inspection.solid import Floats, Ints
from twin.inspection.units import DECLARED, MILLIMETRES

FORMATS = {".stl": "STL", ".obj": "OBJ", ".ply": "PLY", ".3mf": "3MF", ".glb": "GLB", ".gltf": "glTF"}
"""suffix -> name"""
FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""of a binary STL, after 80 bytes of header and a count of 4"""
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
        raise InputError("there is no such file", place=place)
    if path.stat().st_size == 0:
        raise InputError("the file is empty", place=place)
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise InputError(
            f"{path.suffix or 'no suffix'} names no format of meshes",
            place=place,
            remedy=f"valid: {', '.join(FORMATS)}",
        )
    faces, declared = None, "mm"
    vertices = _binary_stl(path) if suffix == ".stl" else None
    if vertices is None:
        vertices, faces, declared = _by_trimesh(path, place)
    if len(vertices) == 0 or (faces is not None and len(faces) == 0):
        raise InputError("the file holds no triangles", place=place, remedy="valid: a mesh of triangles")
    factor = MILLIMETRES.get(unit or DECLARED.get(declared, declared))
    if factor is None:
        raise InputError(
            f"the file declares the unknown unit {declared!r}",
            place=place,
            remedy=f"valid: {', '.join(DECLARED)}; or name it with --units",
        )
    points, index = joined(vertices)
    return points * factor, index.reshape(-1, 3) if faces is None else index[faces]


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
    order = np.argsort(word)
    fresh = np.diff(word[order], prepend=~word[order[:1]]) != 0
    index = np.zeros_like(order)
    index[order] = np.cumsum(fresh) - 1
    first = order[fresh]
    if any((column[first][index] != column).any() for column in columns):  # two points made the same word
        points, index = np.unique(vertices, axis=0, return_inverse=True)
        return points.astype(np.float64), index.reshape(-1).astype(np.int64)
    return np.column_stack([column[first] for column in columns]).astype(np.float64), index


def _binary_stl(path: Path) -> np.ndarray | None:
    """Read the corners (3 m, 3) of a binary STL; None if it is not one."""
    with path.open("rb") as file:
        head = file.read(84)
        if len(head) < 84:
            return None
        count = int.from_bytes(head[80:84], "little")
        size = file.seek(0, 2) - 84
        if size != count * FACET.itemsize:
            return None
        file.seek(84)
        facets = np.fromfile(file, dtype=FACET, count=count)
    return facets["corners"].reshape(-1, 3)


def _by_trimesh(path: Path, place: Place) -> tuple[Floats, Ints, str]:
    """Read vertices, faces and the unit that the file declares."""
    import trimesh  # noqa: PLC0415 - half a second to load

    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            mesh = trimesh.load_mesh(path, process=False)
    except Exception as cause:  # readers raise whatever they please on damaged files
        raise InputError(
            "not a readable mesh", place=place, remedy=f"valid: {', '.join(FORMATS.values())}"
        ) from cause
    if not isinstance(mesh, trimesh.Trimesh):
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64), "mm"
    declared = "m" if path.suffix.lower() in (".glb", ".gltf") else "mm"
    if path.suffix.lower() == ".3mf":
        declared = str(mesh.units or "millimeter").removesuffix("s").lower()
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64), declared
