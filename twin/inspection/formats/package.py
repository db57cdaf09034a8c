"""3MF: one object of one mesh, placed once; in the unit that the model declares."""

import re
import zipfile
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from twin.inspection.beside import Beside
from twin.inspection.formats.digits import whole_numbers
from twin.inspection.formats.raw import DamagedError, Raw, listed_floats, numbers
from twin.inspection.solid import Ints

UNIT = re.compile(rb'<model\b[^>]*?\bunit="([^"]*)"')
OBJECT = re.compile(rb"<object\b[^>]*>")
ITEM = re.compile(rb"<item\b[^>]*>")
TRANSFORM = re.compile(rb'\btransform="([^"]*)"')
BLANKS, NUMERALS = b" \t\r\n", b"0123456789.+-"
VERTEX, TRIANGLE = b'<vrtxx=""y=""z=""/>', b'<trianglev=""v=""v=""/>'
"""elements without blanks and numerals; e and E are numerals of coordinates"""
COMMAS = bytes.maketrans(b"=", b",")


def read_3mf(path: Path) -> Raw | None:
    """Read a 3MF file. Raises DamagedError."""
    try:
        with zipfile.ZipFile(path) as package:
            models = [name for name in package.namelist() if name.lower().endswith(".model")]
            if len(models) != 1:
                return None
            text = package.read(models[0])
    except (zipfile.BadZipFile, zlib.error, RuntimeError, OSError, EOFError, ValueError) as fault:
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
    named = Beside(lambda: _corners(faces))
    points = _points(places)
    corners = named.result()
    if points is None or corners is None:
        if all(places.count(word) == places.count(b"<") for word in (b' x="', b' y="', b' z="', b"/>")):
            raise DamagedError("a coordinate is no number, or a corner names no vertex")
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


def _points(places: bytes) -> NDArray[np.float64] | None:
    """Return the coordinates (n, 3) of elements of vertices; None where something else stands there."""
    if not _only(places, BLANKS + NUMERALS + b"eE", VERTEX):
        return None
    plain = places.count(b"e") == 2 * places.count(b"<") and b"E" not in places
    bare = places if plain else places.replace(b"vertex", b"")  # else an e may be an exponent's
    listed = bare.translate(COMMAS, b'<vrtxyz"/>' + BLANKS + b"e" * plain)
    points = listed_floats(listed[1:])
    if points is None:
        points = numbers(listed.replace(b",", b" "))
    return points.reshape(-1, 3) if len(points) == 3 * places.count(b"<") else None


def _corners(faces: bytes) -> Ints | None:
    """Return the corners (m, 3) of elements of triangles; None where something else stands there."""
    if not _only(faces, BLANKS + NUMERALS, TRIANGLE):
        return None
    text = np.frombuffer(faces, dtype=np.uint8)
    quotes = np.flatnonzero(text == ord('"')).reshape(-1, 6)
    opening, closing = quotes[:, ::2], quotes[:, 1::2]
    if (text[opening - 2] != np.frombuffer(b"123", dtype=np.uint8)).any():
        return None  # another order
    corners = whole_numbers(text, (opening + 1).ravel(), closing.ravel())
    return None if corners is None else corners.reshape(-1, 3)


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
