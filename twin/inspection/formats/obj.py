"""Wavefront OBJ of triangles; no unit."""

import re
from pathlib import Path

import numpy as np

from twin.inspection.formats.raw import DamagedError, Raw, numbers

BESIDE = re.compile(rb"/[^\s]*")
"""texture and normal of a corner"""
LETTERS = bytes.maketrans(b"vf", b"  ")


def read_obj(path: Path) -> Raw | None:
    """Read vertices and triangles. Raises DamagedError."""
    text = path.read_bytes()
    text = b"\n%b\n" % (text.replace(b"\r\n", b"\n") if b"\r" in text else text).rstrip()
    if b"\\\n" in text:
        return None  # lines go on
    vertices, faces = _blocks(text)
    if not vertices or not faces:
        return Raw(vertices=np.zeros((0, 3)), faces=None)
    many = faces.count(b"f ")
    if faces.count(b" ") != 3 * many:
        return None  # polygons, or spaced in another way
    faces = BESIDE.sub(b"", faces) if b"/" in faces else faces
    corners = numbers(faces.translate(LETTERS), np.int64)
    if len(corners) != 3 * many:
        raise DamagedError("a face has a corner without a number")
    places = vertices.count(b"v ")
    width, rest = divmod(len(values := numbers(vertices.translate(LETTERS))), places)
    if rest or width < 3:
        raise DamagedError(f"{places} vertices hold {len(values)} numbers")
    if (corners < 0).any():
        return None  # counted back from where they stand
    if (corners == 0).any():
        raise DamagedError("a face names vertex 0; the first is 1")
    return Raw(vertices=values.reshape(-1, width)[:, :3], faces=corners.reshape(-1, 3) - 1)


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
