"""PLY of triangles, binary of either order or in words; no unit."""

from pathlib import Path

import numpy as np

from twin.inspection.formats.raw import DamagedError, Raw, indices, numbers

ORDERS = {b"binary_little_endian": "<", b"binary_big_endian": ">"}
"""format of the header -> order of bytes"""
# fmt: off
TYPES = {
    b"char": "i1", b"int8": "i1", b"uchar": "u1", b"uint8": "u1", b"short": "i2", b"int16": "i2",
    b"ushort": "u2", b"uint16": "u2", b"int": "i4", b"int32": "i4", b"uint": "u4", b"uint32": "u4",
    b"float": "f4", b"float32": "f4", b"double": "f8", b"float64": "f8",
}
# fmt: on
HEADER = 1 << 16
"""a header is shorter than this"""
LISTS = (b"vertex_indices", b"vertex_index")
"""names of the corners of a face"""


def read_ply(path: Path) -> Raw | None:
    """Read vertices and triangles that stand in this order. Raises DamagedError."""
    data = path.read_bytes()
    end = data.find(b"end_header", 0, HEADER)
    begin = data.find(b"\n", end) + 1
    if not data.startswith(b"ply") or end < 0 or begin == 0:
        raise DamagedError("its header has no end")
    lines = [line.split() for line in data[:end].splitlines() if line.strip()]
    form, elements = b"", []
    try:
        for line in lines:
            if line[0] == b"format":
                form = line[1]
            elif line[0] == b"element":
                elements.append((line[1], int(line[2]), []))
            elif line[0] == b"property":
                elements[-1][2].append(line[1:])
    except (IndexError, ValueError) as fault:
        raise DamagedError("its header makes no sense") from fault
    if [name for name, _, _ in elements] != [b"vertex", b"face"]:
        return None
    (_, count, scalars), (_, triangles, corners) = elements
    names = [words[-1] for words in scalars]
    plain = all(len(words) == 2 and words[0] in TYPES for words in scalars)
    if not (plain and {b"x", b"y", b"z"} <= set(names) and len(set(names)) == len(names)):
        return None
    if len(corners) == 0 or len(corners[0]) != 4 or corners[0][0] != b"list" or corners[0][3] not in LISTS:
        return None
    (_, counter, index, _), *more = corners
    if not {counter, index} <= set(TYPES) or any(len(words) != 2 or words[0] not in TYPES for words in more):
        return None
    if form == b"ascii":
        return _in_words(data[begin:], count, triangles, names, 4 + len(more))
    if form not in ORDERS:
        raise DamagedError(f"its format is {form.decode('latin-1')!r}")
    order = ORDERS[form]
    vertex = np.dtype([(name.decode("latin-1"), order + TYPES[kind]) for kind, name in scalars])
    face = np.dtype(
        [("count", order + TYPES[counter]), ("corners", order + TYPES[index], 3)]
        + [(f"more {k}", order + TYPES[kind]) for k, (kind, _) in enumerate(more)]
    )
    return _binary(memoryview(data)[begin:], count, triangles, vertex, face)


def _binary(body: memoryview, count: int, triangles: int, vertex: np.dtype, face: np.dtype) -> Raw | None:
    size = count * vertex.itemsize
    if len(body) < size:
        raise DamagedError(f"it announces {count} vertices and ends within them")
    points = np.frombuffer(body, dtype=vertex, count=count)
    whole = len(body) - size >= triangles * face.itemsize
    faces = np.frombuffer(body, dtype=face, count=triangles if whole else 0, offset=size)
    if triangles and not (whole and (faces["count"] == 3).all()):
        if _ends_early(body[size:], triangles, face):
            raise DamagedError(f"it announces {triangles} faces and ends within them")
        return None  # polygons
    columns = [points[axis].astype(points[axis].dtype.newbyteorder("=")) for axis in "xyz"]
    return Raw(vertices=np.column_stack(columns), faces=faces["corners"].astype(np.int64))


def _ends_early(body: memoryview, faces: int, face: np.dtype) -> bool:
    """Walk through faces of any number of corners: does the file end before them?"""
    counter, corner = face["count"], face["corners"].base
    more = face.itemsize - counter.itemsize - face["corners"].itemsize
    at = 0
    for _ in range(faces):
        if at + counter.itemsize > len(body):
            return True
        at += counter.itemsize + int(np.frombuffer(body, counter, 1, at)[0]) * corner.itemsize + more
    return at > len(body)


def _in_words(body: bytes, count: int, triangles: int, names: list[bytes], width: int) -> Raw | None:
    """`width` is how many numbers a triangle has: 3, its corners, and what else is said of it."""
    values = numbers(body)
    size = count * len(names)
    if len(values) < size + width * triangles:
        raise DamagedError(f"it announces {count} vertices and {triangles} faces and ends within them")
    faces = values[size : size + width * triangles].reshape(-1, width)
    if len(values) != size + width * triangles or (faces[:, 0] != 3).any():
        return None
    points = values[:size].reshape(count, len(names))[:, [names.index(axis) for axis in (b"x", b"y", b"z")]]
    return Raw(vertices=points, faces=indices(faces[:, 1:4]))
