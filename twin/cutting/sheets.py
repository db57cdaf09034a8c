"""Most of a finely meshed cut lies deep in the blank, where the boolean has nothing to do.

There it is given wide faces on some of the same vertices, and the fine ones come back afterwards. The rim of
a widened rectangle keeps all of its vertices, so both fit. Where a wide face does not come out of the boolean
as it went in, nothing is taken from it.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

WIDE = 4, 12
"""Cells across and along that a wide face spans: chords so long still keep within the metal."""
DEEP = 0.25
"""Cells between wide faces and the blank's skin."""
WORTH = 10_000
"""Faces of sheets below which nothing is gained."""


@dataclass(frozen=True, slots=True)
class Sheets:
    """Rectangles of a surface whose vertices stand in rows and columns, all of one size."""

    vertices: Ints
    """(sheets, ni, nk) their numbers in the surface; (0, 0, 0) for a surface that has none"""
    faces: Ints
    """(sheets, ni − 1, nk − 1, 2) the two faces of each cell, which run i before k"""


NO_SHEETS = Sheets(np.zeros((0, 0, 0), dtype=np.int64), np.zeros((0, 0, 0, 2), dtype=np.int64))


@dataclass(frozen=True, slots=True)
class Widened:
    """A surface with wide faces."""

    faces: Ints
    """(m, 3) vertices of the surface"""
    origin: Ints
    """(m,) which of the surface's faces each one is; −1 = a wide one"""
    replaced: Ints
    """(k,) faces of the surface that the wide ones stand for"""

    @classmethod
    def none(cls, faces: Ints) -> "Widened":
        """A surface with its own faces (m, 3) alone."""
        return cls(faces, np.arange(len(faces)), np.zeros(0, dtype=np.int64))

    def after(self, vertices: int, faces: int) -> "Widened":
        """The same behind so many vertices and faces of others."""
        origin = np.where(self.origin < 0, -1, self.origin + faces)
        return Widened(self.faces + vertices, origin, self.replaced + faces)


def widened(vertices: Floats, faces: Ints, sheets: Sheets, blank: Blank) -> Widened:
    """The faces (m, 3) of a surface with wide ones wherever its sheets are deep in the blank."""
    whole = Widened.none(faces)
    if sheets.faces.size < WORTH or blank.section is not None:
        return whole
    found = _rectangle(_deep(vertices[sheets.vertices], blank))
    if found is None:
        return whole
    (i0, i1), (k0, k1) = found
    inner = sheets.vertices[:, i0 : i1 + 1, k0 : k1 + 1].reshape(len(sheets.vertices), -1)
    wide = inner[:, _pattern(i1 - i0, k1 - k0)].reshape(-1, 3)
    replaced = sheets.faces[:, i0:i1, k0:k1].ravel()
    kept = np.ones(len(faces), dtype=bool)
    kept[replaced] = False
    origin = np.concatenate([np.flatnonzero(kept), np.full(len(wide), -1)])
    return Widened(np.concatenate([faces[kept], wide]), origin, replaced)


def _deep(points: Floats, blank: Blank) -> Bools:
    """Which nodes (ni, nk) are some cells away from the blank's skin, of all sheets (n, ni, nk, 3)."""
    across, along = (
        DEEP * math.sqrt(float((np.diff(points, axis=axis) ** 2).sum(axis=-1).max())) for axis in (1, 2)
    )
    reach = max(across, along)
    away = np.hypot(points[..., 0], points[..., 1])
    height = points[..., 2]
    low, high = height.min(axis=0) - reach, height.max(axis=0) + reach
    inside = away.max(axis=0) + across < blank.least_radius(low, high)
    inside &= 2.0 * (away.min(axis=0) - across) > blank.bore_mm
    bottom, top = blank.z_range
    return inside & (low > bottom) & (high < top)


def _rectangle(deep: Bools) -> tuple[tuple[int, int], tuple[int, int]] | None:
    """First and last rows and columns about the middle in which all nodes (ni, nk) are `deep`."""
    i = _run(deep[:, deep.shape[1] // 2])
    if i is None:
        return None
    k = _run(np.logical_and.reduce(deep[i[0] : i[1] + 1]))
    if k is None or i[1] - i[0] < 2 * WIDE[0] or k[1] - k[0] < 2 * WIDE[1]:
        return None
    return i, k


def _run(held: Bools) -> tuple[int, int] | None:
    """First and last of those about the middle one that are `held`."""
    middle = len(held) // 2
    if not held[middle]:
        return None
    low = np.flatnonzero(~held[:middle]).max(initial=-1) + 1
    high = middle + np.flatnonzero(~np.append(held[middle:], False)).min() - 1
    return int(low), int(high)


@lru_cache(maxsize=4)
def _pattern(ni: int, nk: int) -> Ints:
    """Triangles (n, 3) of wide faces on a rectangle of `ni` by `nk` cells, nodes numbered row by row.

    A wide face on the rim is a fan over all of its vertices there, from the corner opposite.
    """
    rows, columns = (_stops(count, wide) for count, wide in zip((ni, nk), WIDE, strict=True))
    fans: list[tuple[int, int, int]] = []
    for i0, i1 in pairwise(rows):
        for k0, k1 in pairwise(columns):
            sides = [
                ([(i, k0) for i in range(i0, i1)], k0 == 0),
                ([(i1, k) for k in range(k0, k1)], i1 == ni),
                ([(i, k1) for i in range(i1, i0, -1)], k1 == nk),
                ([(i0, k) for k in range(k1, k0, -1)], i0 == 0),
            ]
            path = [node for side, rim in sides for node in (side if rim else side[:1])]
            apex = path.index((i1 if i0 == 0 else i0, k1 if k0 == 0 else k0))
            turn = [i * (nk + 1) + k for i, k in path[apex:] + path[:apex]]
            fans += [(turn[0], b, c) for b, c in pairwise(turn[1:])]
    return np.array(fans, dtype=np.int64)


def _stops(count: int, wide: int) -> list[int]:
    """Where wide faces begin and end, at least two of them."""
    return [round(at) for at in np.linspace(0, count, max(count // wide, 2) + 1)]


def restored(
    vertices: Floats, faces: Ints, origin: Ints, surface: tuple[Floats, Ints], made: Widened
) -> tuple[Floats, Ints, Ints] | None:
    """What is left by removing a widened surface, with the fine faces again.

    Args:
        vertices: (n, 3) of the result
        faces: (m, 3) of the result
        origin: (m,) of which face of the widened surface each face is a piece; −1 = of none
        surface: vertices and faces that were widened
        made: what they were widened to

    Returns:
        Vertices, faces and the faces of the surface that they are pieces of (−1 = of none); None where a wide
        face did not come out whole.

    """
    fine, fine_faces = surface
    own = np.where(origin >= 0, made.origin[origin], 0)
    wide = np.flatnonzero(own < 0)
    if len(wide) != np.count_nonzero(made.origin < 0) or len(np.unique(origin[wide])) != len(wide):
        return None
    # what was removed is seen from the other side, and a face may begin at another of its corners
    ends = made.faces[origin[wide]][:, ::-1]
    places = vertices[faces[wide]]
    turns = [np.roll(ends, turn, axis=1) for turn in range(3)]
    same = np.stack([(fine[turn] == places).all(axis=(1, 2)) for turn in turns])
    if not same.any(axis=0).all():
        return None
    corner = np.stack(turns)[same.argmax(axis=0), np.arange(len(wide))]
    number = np.full(len(fine), -1)
    number[corner] = faces[wide]
    # a corner at a time, for whole faces would be the largest arrays of a run
    back = [fine_faces[:, n].take(made.replaced) for n in (2, 1, 0)]
    lost = np.zeros(len(fine), dtype=bool)
    for mine in back:
        lost[mine] = True
    new = np.flatnonzero(lost & (number < 0))
    number[new] = len(vertices) + np.arange(len(new))
    kept = np.flatnonzero(own >= 0)
    whole = np.empty((len(kept) + len(made.replaced), 3), dtype=np.int64)
    whole[: len(kept)] = faces[kept]
    for n, mine in enumerate(back):
        whole[len(kept) :, n] = number.take(mine)
    return (
        np.concatenate([vertices, fine[new]]),
        whole,
        np.concatenate([np.where(origin >= 0, own, -1)[kept], made.replaced]),
    )
