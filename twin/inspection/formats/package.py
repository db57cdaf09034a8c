"""3MF: one object of one mesh, placed once; in the unit that the model declares."""

import re
import zipfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from twin.inspection.formats.raw import DamagedError, Raw, numbers
from twin.inspection.solid import Ints

UNIT = re.compile(rb'<model\b[^>]*?\bunit="([^"]*)"')
OBJECT = re.compile(rb"<object\b[^>]*>")
ITEM = re.compile(rb"<item\b[^>]*>")
TRANSFORM = re.compile(rb'\btransform="([^"]*)"')
BLANKS, NUMERALS = b" \t\r\n", b"0123456789.+-"
VERTEX, TRIANGLE = b'<vrtxx=""y=""z=""/>', b'<trianglev=""v=""v=""/>'
"""elements without blanks and numerals; e and E are numerals of coordinates"""
QUOTES = bytes.maketrans(b'"', b" ")


def read_3mf(path: Path) -> Raw | None:
    """Read a 3MF file. Raises DamagedError."""
    try:
        with zipfile.ZipFile(path) as package:
            models = [name for name in package.namelist() if name.lower().endswith(".model")]
            if len(models) != 1:
                return None
            text = package.read(models[0])
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, OSError, EOFError, ValueError) as fault:
        raise DamagedError(f"its package cannot be opened ({fault})") from fault
    begin, end = text.find(b"<vertices>"), text.rfind(b"</triangles>")
    middle = (text.find(b"</vertices>", begin), text.find(b"<triangles>", begin))
    head, tail = text[: max(begin, 0)], text[end:]
    around = head + text[slice(*middle)] + tail
    items = ITEM.findall(tail)
    if not 0 <= begin < middle[0] < middle[1] < end or len(OBJECT.findall(around)) != 1 or len(items) != 1:
        return None
    if b"<component" in around or around.count(b"triangles>") != 1 or around.count(b"vertices>") != 1:
        return None
    places, faces = text[begin + 10 : middle[0]], text[middle[1] + 11 : end]
    if _only(places, BLANKS + NUMERALS + b"eE", VERTEX) and _only(faces, BLANKS + NUMERALS, TRIANGLE):
        found = _numbers_of(places, faces)
        if found is None:
            return None
        points, corners = found
    elif all(places.count(word) == places.count(b"<") for word in (b' x="', b' y="', b' z="', b"/>")):
        raise DamagedError("a coordinate or a corner is no number")
    else:
        return None  # other attributes, another order, comments
    unit = UNIT.search(head)
    return Raw(
        vertices=_placed(points, items[0]),
        faces=corners,
        unit=unit[1].decode("latin-1") if unit else "millimeter",
    )


def _only(text: bytes, numerals: bytes, element: bytes) -> bool:
    """Whether a text holds nothing but elements that differ in their numerals."""
    bare = text.translate(None, numerals)
    many, rest = divmod(len(bare), len(element))
    return not rest and bare == many * element


def _numbers_of(places: bytes, faces: bytes) -> tuple[NDArray[np.float64], Ints] | None:
    """Return the coordinates (n, 3) of elements of vertices and the corners (m, 3) of triangles.

    None where a triangle's corners are not in their order.
    """
    plain = places.count(b"e") == 2 * places.count(b"<") and b"E" not in places
    bare = places if plain else places.replace(b"vertex", b"")  # else an e may be an exponent's
    points = numbers(bare.translate(QUOTES, b"<vrtxyz=/>" + BLANKS + b"e" * plain))
    # with the 1, 2, 3 of v1, v2, v3 before each
    corners = numbers(faces.translate(QUOTES, b"<triangle v=/>" + BLANKS), np.int64)
    if len(points) != 3 * places.count(b"<") or len(corners) != 6 * faces.count(b"<"):
        raise DamagedError("a coordinate or a corner is no number")
    named = corners.reshape(-1, 6)
    if (named[:, ::2] != (1, 2, 3)).any():
        return None
    return points.reshape(-1, 3), np.ascontiguousarray(named[:, 1::2])


def _placed(points: np.ndarray, item: bytes) -> np.ndarray:
    """Move points (n, 3) as the item of the build says: rows of a matrix (4, 3), points from the left."""
    found = TRANSFORM.search(item)
    if not found:
        return points
    values = numbers(found[1])
    if len(values) != 12:
        raise DamagedError(f"a transform has {len(values)} numbers, not 12")
    matrix = values.reshape(4, 3)
    if (matrix == np.eye(4, 3)).all():
        return points
    return points @ matrix[:3] + matrix[3]
