"""STL, binary and in words: corners three by three, nothing shared, no unit."""

from pathlib import Path

import numpy as np

from twin.inspection.formats.raw import DamagedError, Raw, numbers

FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""of a binary STL, after 80 bytes of header and a count of 4"""
BLANKS = bytes(32 if chr(i).isalpha() and chr(i) not in "eE" else i for i in range(256))
"""table that leaves of letters only those of exponents"""


def read_stl(path: Path) -> Raw | None:
    """Read a STL file. Raises DamagedError."""
    with path.open("rb") as file:
        head = file.read(84)
        size = file.seek(0, 2) - 84
        count = int.from_bytes(head[80:84], "little")
        if size == count * FACET.itemsize:
            file.seek(84)
            facets = np.fromfile(file, dtype=FACET, count=count)
            return Raw(vertices=facets["corners"].reshape(-1, 3), faces=None)
    if head.lstrip()[:5].lower() == b"solid":
        return _in_words(path.read_bytes())
    raise DamagedError(
        f"it announces {count} triangles, {count * FACET.itemsize} bytes, and holds {max(size, 0)}"
    )


def _in_words(text: bytes) -> Raw | None:
    last = text[-1000:].lower()
    end = last.rfind(b"endsolid")
    begin = text.find(b"\n") + 1
    if end < 0:
        raise DamagedError("it ends before its endsolid")
    body = text[begin : len(text) - len(last) + end]
    if b"solid" in body or b"SOLID" in body:
        return None  # several, with names between them
    letters = np.frombuffer(body.translate(BLANKS), dtype=np.uint8).copy()
    alone = (letters[1:] | 32 == ord("e")) & (letters[:-1] <= 32)
    letters[1:][alone] = 32
    values = numbers(letters.tobytes())
    if len(values) != 12 * max(body.count(b"endfacet"), body.count(b"ENDFACET")):
        return None  # normals that are no numbers, or something lost
    return Raw(vertices=values.reshape(-1, 4, 3)[:, 1:].reshape(-1, 3), faces=None)
