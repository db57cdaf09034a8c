"""The part as text inside the page: what `viewer.js` takes apart again.

Deflated (zlib), then base64. Before that, one after the other, for n vertices and m triangles:

1. positions, x of all vertices, then y, then z: steps of `step_mm` from `origin_mm`, each as its difference
   from the vertex before, zigzag (0, -1, 1, -2 … as 0, 1, 2, 3 …);
2. triangles, 3 m values: vertices are numbered in the order in which triangles first use them; written is how
   far the index lies below the next new one (0 = the new one);
3. colour index, n bytes;
4. number of the block that cut each triangle, m values, 0 = none: all low bytes, then all high bytes.

Values of 1 and of 2 are unsigned 32-bit, their bytes apart: all lowest bytes, then all second bytes and so
on.
"""

import base64
import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.inspection.result import Floats
from twin.report.data import Part

STEPS = 2**20
"""over the part's largest extent: 0.04 µm on a gear of 44 mm, so that feed marks keep their shading"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Payload:
    """An encoded part."""

    vertices: int
    triangles: int
    origin_mm: tuple[float, float, float]
    step_mm: float
    data: str
    """base64"""

    def header(self) -> dict[str, object]:
        """What stands beside the data, for JSON."""
        return {
            "vertices": self.vertices,
            "triangles": self.triangles,
            "originMm": self.origin_mm,
            "stepMm": self.step_mm,
        }


def encode(
    vertices: Floats,
    faces: NDArray[np.integer],
    colour: NDArray[np.uint8],
    block: NDArray[np.integer] | None = None,
) -> Payload:
    """Pack vertices (n, 3) [mm], faces (m, 3), m > 0, colour indices (n,); unused vertices are left out.

    `block` (m,) 0 … 65535; left out, no triangle has one.
    """
    labels = np.zeros(len(faces), np.int64) if block is None else block
    used, renumbered = _by_first_use(faces, len(vertices))
    points = vertices[used]
    origin = points.min(axis=0)
    step = float(np.ptp(points, axis=0).max()) / STEPS or 1.0
    steps = np.rint((points - origin).T / step).astype(np.int32)
    difference = np.diff(steps, axis=1, prepend=np.int32(0)).ravel()
    zigzag = (difference << 1) ^ (difference >> 31)
    # An index is at most one above all before it: written against that bound, most are small.
    bound = np.maximum.accumulate(np.concatenate([[-1], renumbered[:-1]])) + 1
    raw = b"".join(
        (_bytes(zigzag, 4), _bytes(bound - renumbered, 4), colour[used].tobytes(), _bytes(labels, 2))
    )
    return Payload(
        vertices=len(used),
        triangles=len(faces),
        origin_mm=(float(origin[0]), float(origin[1]), float(origin[2])),
        step_mm=step,
        data=base64.b64encode(zlib.compress(raw, 1)).decode("ascii"),
    )


def thinned(part: Part, most: int) -> Part:
    """Return the part with at most `most` triangles: vertices that share a cell of a grid become one."""
    if len(part.faces) <= most:
        return part
    extent = float(np.ptp(part.vertices, axis=0).max()) or 1.0
    cell = extent / np.sqrt(most)
    while True:
        key = np.rint((part.vertices - part.vertices.min(axis=0)) / cell).astype(np.int64) @ [
            1 << 42,
            1 << 21,
            1,
        ]
        _, kept, member = np.unique(key, return_index=True, return_inverse=True)
        faces = member[part.faces]
        solid = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
        if np.count_nonzero(solid) <= most:
            return Part(
                vertices=part.vertices[kept],
                faces=faces[solid],
                deviation_um=part.deviation_um[kept],
                face_time_s=part.face_time_s[solid] if len(part.face_time_s) else part.face_time_s,
            )
        cell *= 1.25


def _by_first_use(faces: NDArray[np.integer], n: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Vertices in the order of their first use, and the corners (3 m,) numbered by it."""
    corners = faces.ravel().astype(np.int64)
    first = np.full(n, len(corners))
    np.minimum.at(first, corners, np.arange(len(corners)))
    used = np.argsort(first, kind="stable")[: np.count_nonzero(first < len(corners))]
    number = np.empty_like(first)
    number[used] = np.arange(len(used))
    return used, number[corners]


def _bytes(values: NDArray[np.integer], width: int) -> bytes:
    """Values of `width` bytes: all lowest bytes, then all second ones and so on."""
    return values.astype(f"<u{width}").view(np.uint8).reshape(-1, width).T.tobytes()
