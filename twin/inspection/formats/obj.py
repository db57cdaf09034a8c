"""Wavefront OBJ of triangles; no unit."""

import re
from pathlib import Path

import numpy as np

from twin.inspection.beside import Beside
from twin.inspection.formats.digits import whole_numbers
from twin.inspection.formats.raw import DamagedError, Raw, listed_floats, numbers
from twin.inspection.solid import Ints

BESIDE = re.compile(rb"/[^\s]*")
"""texture and normal of a corner"""
LETTERS = bytes.maketrans(b"v", b" ")
COMMAS = bytes.maketrans(b" ", b",")


def read_obj(path: Path) -> Raw | None:
    """Read vertices and triangles. Raises DamagedError."""
    text = path.read_bytes()
    text = b"\n%b\n" % (text.replace(b"\r\n", b"\n") if b"\r" in text else text).rstrip()
    if b"\\\n" in text:
        return None  # lines go on
    vertices, faces = _blocks(text)
    if not vertices or not faces:
        return Raw(vertices=np.zeros((0, 3)), faces=None)
    named = Beside(lambda: _corners(faces))
    places = vertices.count(b"\n")
    values = listed_floats(vertices.translate(COMMAS, b"\nv")[1:])
    values = numbers(vertices.translate(LETTERS)) if values is None else values
    width, rest = divmod(len(values), places)
    corners = named.result()
    if rest or width < 3:
        raise DamagedError(f"{places} vertices hold {len(values)} numbers")
    if corners is None:
        return None
    if (corners == 0).any():
        raise DamagedError("a face names vertex 0; the first is 1")
    return Raw(vertices=values.reshape(-1, width)[:, :3], faces=corners.reshape(-1, 3) - 1)


def _corners(lines: bytes) -> Ints | None:
    """Return the corners (m, 3) of lines of faces, from 1; None for polygons and for corners counted back.

    Raises DamagedError.
    """
    text = np.frombuffer((BESIDE.sub(b"", lines) if b"/" in lines else lines) + b"\n", dtype=np.uint8)
    feeds, blanks = np.flatnonzero(text == ord("\n")), np.flatnonzero(text == ord(" "))
    if len(blanks) != 3 * (len(feeds) - 1):
        return None  # polygons, or spaced in another way
    begin, end = blanks.reshape(-1, 3), feeds[1:]
    if (begin[:, 0] != feeds[:-1] + 2).any() or (begin[:, 2] > end).any():
        return None
    corners = whole_numbers(text, (begin + 1).ravel(), np.column_stack([begin[:, 1:], end]).ravel())
    if corners is not None:
        return corners.reshape(-1, 3)
    if b"-" in lines:
        return None
    raise DamagedError("a face has a corner without a number")


def _blocks(text: bytes) -> tuple[bytes, bytes]:
    """Return all lines of vertices and all of faces, each line with a line feed before it."""
    first, second = text.find(b"\nv "), text.find(b"\nf ")
    if 0 <= first < second:
        vertices, faces = text[first:second], text[second:-1]
        if all(
            block.count(b"\n") == block.count(b"\n" + word)
            for block, word in ((vertices, b"v "), (faces, b"f "))
        ):
            return vertices, faces
    lines = text.split(b"\n")
    vertices, faces = ([b"\n" + line for line in lines if line[:2] == word] for word in (b"v ", b"f "))
    return b"".join(vertices), b"".join(faces)
