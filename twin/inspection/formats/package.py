"""3MF: one object of one mesh, placed once; in the unit that the model declares."""

import re
import zipfile
from pathlib import Path

import numpy as np

from twin.inspection.formats.raw import DamagedError, Raw, numbers

UNIT = re.compile(rb'<model\b[^>]*?\bunit="([^"]*)"')
OBJECT = re.compile(rb"<object\b[^>]*>")
ITEM = re.compile(rb"<item\b[^>]*>")
TRANSFORM = re.compile(rb'\btransform="([^"]*)"')
VERTICES = re.compile(rb'(?:\s*+<vertex x="[^"]*+" y="[^"]*+" z="[^"]*+"\s*+/>)*+\s*+')
TRIANGLES = re.compile(rb'(?:\s*+<triangle v1="[^"]*+" v2="[^"]*+" v3="[^"]*+"\s*+/>)*+\s*+')
NAMES = bytes.maketrans(b'<>="/xyz', b" " * 8)


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
    begin = text.find(b"<vertices>")
    head, tail = text[: max(begin, 0)], text[text.rfind(b"</triangles>") :]
    one = [text.count(word) for word in (b"<vertices>", b"</vertices>", b"<triangles>", b"</triangles>")]
    items = ITEM.findall(tail)
    if one != [1, 1, 1, 1] or len(OBJECT.findall(head)) != 1 or b"<component" in text or len(items) != 1:
        return None
    places = text[begin + 10 : text.find(b"</vertices>")]
    faces = text[text.find(b"<triangles>") + 11 : text.find(b"</triangles>")]
    if not (VERTICES.fullmatch(places) and TRIANGLES.fullmatch(faces)):
        return None  # other attributes, another order, comments
    points = numbers(places.replace(b"vertex", b"").translate(NAMES))
    for word in (b"triangle", b"v1=", b"v2=", b"v3="):
        faces = faces.replace(word, b"")
    corners = numbers(faces.translate(NAMES), np.int64)
    if len(points) != 3 * places.count(b"<") or len(corners) != 3 * faces.count(b"<"):
        raise DamagedError("a coordinate or a corner is no number")
    unit = UNIT.search(head)
    return Raw(
        vertices=_placed(points.reshape(-1, 3), items[0]),
        faces=corners.reshape(-1, 3),
        unit=unit[1].decode("latin-1") if unit else "millimeter",
    )


def _placed(points: np.ndarray, item: bytes) -> np.ndarray:
    """Move points (n, 3) as the item of the build says: rows of a matrix (4, 3), points from the left."""
    found = TRANSFORM.search(item)
    if not found:
        return points
    values = numbers(found[1])
    if len(values) != 12:
        raise DamagedError(f"a transform has {len(values)} numbers, not 12")
    matrix = values.reshape(4, 3)
    return points @ matrix[:3] + matrix[3]
