"""What manifold3d leaves of the blank."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import manifold3d
import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.dual import Surface
from twin.cutting.sheets import Widened, restored, widened
from twin.cutting.snapping import snapped
from twin.errors import PartError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CHORD = 2.5e-4
"""How far the blank's facets may lie inside its circles [mm]."""
CRUMB = 1e-6
"""[mm³] below which a severed piece is rounding"""


def blank_solid(blank: Blank) -> manifold3d.Manifold:
    """The blank with facets within CHORD of its circles, vertices on them."""
    turned = lathe(blank.outline(), math.ceil(math.pi / math.acos(1.0 - CHORD / blank.radius)))
    return turned if blank.section is None else turned ^ solid(*blank.section.mesh(*blank.z_range))


def lathe(outline: Floats, segments: int) -> manifold3d.Manifold:
    """Turn a closed outline (n, 2) of (r, z) about the z axis; points with r = 0 lie on the axis."""
    angle = 2.0 * math.pi * np.arange(segments) / segments
    cos, sin = np.cos(angle), np.sin(angle)
    rings: list[Ints] = []
    points: list[Floats] = []
    count = 0
    for r, z in outline:
        if r > 0:
            points.append(np.stack([r * cos, r * sin, np.full(segments, z)], axis=1))
            rings.append(count + np.arange(segments))
            count += segments
        else:
            points.append(np.array([[0.0, 0.0, z]]))
            rings.append(np.full(segments, count))
            count += 1
    faces = []
    for a, b in zip(rings, [*rings[1:], rings[0]], strict=True):
        a1, b1 = np.roll(a, -1), np.roll(b, -1)
        faces += [np.stack([a, a1, b1], axis=1), np.stack([a, b1, b], axis=1)]
    triangles = np.concatenate(faces)
    flat = (
        (triangles[:, 0] == triangles[:, 1])
        | (triangles[:, 1] == triangles[:, 2])
        | (triangles[:, 0] == triangles[:, 2])
    )
    return solid(np.concatenate(points), triangles[~flat])


def solid(vertices: Floats, faces: Ints, number: int | None = None) -> manifold3d.Manifold:
    """A manifold3d solid in double precision, under a reserved `number` to know its faces by later.

    Raises PartError where the mesh is no closed 2-manifold.
    """
    run = None if number is None else np.array([0, faces.size], dtype=np.uint64)
    name = None if number is None else np.array([number], dtype=np.uint32)
    own = None if number is None else np.arange(len(faces), dtype=np.uint64)
    mesh = manifold3d.Mesh64(
        vertices, faces.astype(np.uint64), run_index=run, run_original_id=name, face_id=own
    )
    made = manifold3d.Manifold(mesh)
    if made.status() != manifold3d.Error.NoError:
        raise PartError(f"the cut surface is no closed solid ({made.status().name})")
    return made


@dataclass(frozen=True, slots=True, kw_only=True)
class Remains:
    """What is left of the blank."""

    vertices: Floats
    """(n, 3) [mm], part frame, exact in single precision"""
    faces: Ints
    """(m, 3) counter-clockwise seen from outside"""
    volume_mm3: float
    """before its vertices were rounded to single precision, as that of the blank"""
    blank_volume_mm3: float
    loose_volumes_mm3: tuple[float, ...]
    """of the pieces that the cut severed, larger than CRUMB, largest first"""
    genus: int
    origin: Ints
    """(m,) face of the removed surfaces, counted through all of them, that each face is a piece of;
    −1 = of the blank's skin"""


def subtract(blank: Blank, *surfaces: Surface) -> Remains:
    """One boolean: the blank without the removed solids. The largest piece is the part."""
    whole = blank_solid(blank)
    wide = [widened(one.vertices, one.faces, one.sheets, blank) for one in surfaces]
    left = _left(whole, surfaces, wide)
    if left is None:
        left = _left(whole, surfaces, [Widened.none(one.faces) for one in surfaces])
    if left is None:
        raise PartError(
            "nothing is left of the blank", remedy="the cut removes all of it; check X and the tool"
        )
    vertices, faces, kept = snapped(left.vertices, left.faces)
    return Remains(
        vertices=vertices,
        faces=faces,
        volume_mm3=_volume(left.vertices, left.faces),
        blank_volume_mm3=whole.volume(),
        loose_volumes_mm3=tuple(size for size in left.loose if size > CRUMB),
        genus=left.genus,
        origin=left.origin[kept],
    )


@dataclass(frozen=True, slots=True)
class _Left:
    """The largest piece after a boolean, in double precision."""

    vertices: Floats
    faces: Ints
    origin: Ints
    genus: int
    loose: tuple[float, ...]


def _left(whole: manifold3d.Manifold, surfaces: Sequence[Surface], wide: Sequence[Widened]) -> _Left | None:
    """What the removed solids, seen in wide faces, leave of the blank; None for nothing, or where wide faces
    do not do."""
    first_id = manifold3d.Manifold.reserve_ids(max(len(surfaces), 1))
    removed = [
        solid(*_used(one.vertices, seen.faces), first_id + k)
        for k, (one, seen) in enumerate(zip(surfaces, wide, strict=True))
    ]
    left = manifold3d.Manifold.batch_boolean([whole, *removed], manifold3d.OpType.Subtract)
    pieces = sorted(left.decompose(), key=lambda piece: -piece.volume())
    if left.is_empty():
        return None
    mesh = pieces[0].to_mesh64()
    found = (
        np.array(mesh.vert_properties[:, :3]),
        np.array(mesh.tri_verts, dtype=np.int64),
        _origin(mesh, first_id, np.cumsum([0, *(len(seen.faces) for seen in wide)])),
    )
    loose = tuple(piece.volume() for piece in pieces[1:])
    if any(len(seen.replaced) for seen in wide):
        back = None if loose else restored(*found, *_joined(surfaces, wide))
        return None if back is None else _Left(*back, pieces[0].genus(), loose)
    return _Left(*found, pieces[0].genus(), loose)


def _used(vertices: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """A mesh without the vertices that no face has."""
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    return vertices[used], (np.cumsum(used) - 1)[faces]


def _joined(surfaces: Sequence[Surface], wide: Sequence[Widened]) -> tuple[tuple[Floats, Ints], Widened]:
    """All removed solids as one mesh, and as one mesh in wide faces."""
    if len(surfaces) == 1:
        return (surfaces[0].vertices, surfaces[0].faces), wide[0]
    vertex, face = (
        np.cumsum([0, *map(len, arrays)])
        for arrays in ([one.vertices for one in surfaces], [one.faces for one in surfaces])
    )
    seen = [one.after(int(v), int(f)) for one, v, f in zip(wide, vertex, face, strict=False)]
    fine = (
        np.concatenate([one.vertices for one in surfaces]),
        np.concatenate([one.faces + v for one, v in zip(surfaces, vertex, strict=False)]),
    )
    return fine, Widened(
        *(np.concatenate([getattr(one, name) for one in seen]) for name in Widened.__slots__)
    )


def _volume(vertices: Floats, faces: Ints) -> float:
    """Of a closed mesh [mm³]."""
    x, y, z = np.ascontiguousarray(vertices.T)
    a, b, c = np.ascontiguousarray(faces.T)
    x0, y0 = x.take(a), y.take(a)
    # twice the area seen along z, times three times the mean height
    area = (x.take(b) - x0) * (y.take(c) - y0) - (x.take(c) - x0) * (y.take(b) - y0)
    return float((area * (z.take(a) + z.take(b) + z.take(c))).sum()) / 6.0


def _origin(mesh: manifold3d.Mesh64, first_id: int, first_face: Ints) -> Ints:
    """(m,) for each face of a result, the face it is a piece of among those of the solids with the ids from
    `first_id` on, whose faces begin at `first_face` (k + 1,); −1 for any other solid."""
    runs = np.diff(np.array(mesh.run_index, dtype=np.int64)) // 3
    number = np.repeat(np.array(mesh.run_original_id, dtype=np.int64) - first_id, runs)
    own = (number >= 0) & (number < len(first_face) - 1)
    return np.where(own, first_face[np.where(own, number, 0)] + np.array(mesh.face_id, dtype=np.int64), -1)
