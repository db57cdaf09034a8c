"""What manifold3d leaves of the blank."""

import math
from dataclasses import dataclass

import manifold3d
import numpy as np
from numpy.typing import NDArray

from twin.cutting.blank import Blank
from twin.cutting.dual import Surface
from twin.cutting.snapping import snapped
from twin.errors import PartError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CHORD = 2.5e-4
"""How far the blank's facets may lie inside its circles [mm]."""


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
    """of the pieces that the cut severed, largest first"""
    genus: int
    origin: Ints
    """(m,) face of the removed surfaces, counted through all of them, that each face is a piece of;
    −1 = of the blank's skin"""


def subtract(blank: Blank, *surfaces: Surface) -> Remains:
    """One boolean: the blank without the removed solids. The largest piece is the part."""
    whole = blank_solid(blank)
    first_id = manifold3d.Manifold.reserve_ids(max(len(surfaces), 1))
    removed = [solid(surface.vertices, surface.faces, first_id + k) for k, surface in enumerate(surfaces)]
    left = manifold3d.Manifold.batch_boolean([whole, *removed], manifold3d.OpType.Subtract)
    if left.is_empty():
        raise PartError(
            "nothing is left of the blank", remedy="the cut removes all of it; check X and the tool"
        )
    pieces = sorted(left.decompose(), key=lambda piece: -piece.volume())
    part = pieces[0]
    mesh = part.to_mesh64()
    vertices, faces, kept = snapped(
        np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, dtype=np.int64)
    )
    first_face = np.cumsum([0, *(len(surface.faces) for surface in surfaces)])
    return Remains(
        vertices=vertices,
        faces=faces,
        volume_mm3=part.volume(),
        blank_volume_mm3=whole.volume(),
        loose_volumes_mm3=tuple(piece.volume() for piece in pieces[1:]),
        genus=part.genus(),
        origin=_origin(mesh, first_id, first_face)[kept],
    )


def _origin(mesh: manifold3d.Mesh64, first_id: int, first_face: Ints) -> Ints:
    """(m,) for each face of a result, the face it is a piece of among those of the solids with the ids from
    `first_id` on, whose faces begin at `first_face` (k + 1,); −1 for any other solid."""
    runs = np.diff(np.array(mesh.run_index, dtype=np.int64)) // 3
    number = np.repeat(np.array(mesh.run_original_id, dtype=np.int64) - first_id, runs)
    own = (number >= 0) & (number < len(first_face) - 1)
    return np.where(own, first_face[np.where(own, number, 0)] + np.array(mesh.face_id, dtype=np.int64), -1)
