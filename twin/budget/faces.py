"""The faces of a polygon as a feeler finds them on what the passes leave, and the items of their budget."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.budget.items import Item
from twin.cutting.blank import Blank
from twin.cutting.fields import Field
from twin.cutting.motion import RigidTransform
from twin.cutting.rays import crossings, depths
from twin.errors import PartError
from twin.inspection.nominal import PolygonNominal

Floats = NDArray[np.float64]

ACROSS, ALONG = 41, 15
"""points over the width and the length of a face"""
EDGE = 0.1
"""part of the half width left out at each edge"""
END = 0.05
"""part of the length left out at each end"""
SCANNED = 24
"""points about the axis to each side, where the corners are looked for"""
REACH = 0.04
"""of the width across flats, that a face may stand off"""
UM = 1e3

FACE_ITEMS = (
    Item(key="across_flats", symbol="Δs", words="width across flats"),
    Item(key="flatness", symbol="t_fl", words="flatness"),
    Item(key="angle", symbol="Δ_α", words="angle of a face, over its width"),
    Item(key="lean", symbol="Δ_z", words="lean of a face, over its length"),
    Item(key="concentricity", symbol="t_c", words="concentricity of the faces"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class FeltFaces:
    """How far the faces of a polygon stand out of their nominal planes [µm], + = material outside.

    The polygon is turned to the mean of all faces.
    """

    phase: float
    """direction of face 1 [rad]"""
    across: Floats
    """(m,) places over the width of a face [mm]"""
    along: Floats
    """(k,) z [mm]"""
    out: Floats
    """(n, k, m)"""


def feel_faces(
    fields: tuple[Field, ...],
    nominal: PolygonNominal,
    blank: Blank,
    *,
    datum: RigidTransform | None = None,
    phase: float = 0.0,
) -> FeltFaces:
    """Feel the faces of a polygon that fills the blank's length; face 1 is the one nearest to `phase` [rad].

    `datum` takes the part frame to that of the measurement. Raises PartError where no faces are to be found.
    """
    datum = datum or RigidTransform()
    sides, inner = nominal.number_of_sides, nominal.across_flats_mm / 2.0
    corner = min(inner / math.cos(math.pi / sides), blank.radius)
    if corner <= inner:
        raise PartError(f"a blank of Ø {blank.diameter_mm:g} mm is no wider than the faces stand apart")
    low, high = blank.z_range
    along = np.linspace(low + END * (high - low), high - END * (high - low), ALONG)
    across = (1.0 - EDGE) * math.sqrt(corner**2 - inner**2) * np.linspace(-1.0, 1.0, ACROSS)
    found = _phase(fields, datum, sides, (0.5 * (inner + corner), 0.5 * (low + high)))
    pitch = 2.0 * math.pi / sides
    found -= pitch * round((found - phase) / pitch)

    def out(first: float) -> Floats:
        directions: Floats = first + pitch * np.arange(sides, dtype=np.float64)
        felt = _out(fields, datum, (directions, inner), (along, across))
        if missing := int((~np.isfinite(felt)).any(axis=(1, 2)).sum()):
            reach = REACH * 2.0 * inner
            raise PartError(f"{missing} of {sides} faces are not whole within {reach:.3g} mm of their places")
        return felt

    # faces that all lean one way over their width are a polygon that stands turned
    found -= float(_slopes(out(found), across, 2).mean())
    return FeltFaces(phase=found, across=across, along=along, out=np.asarray(UM * out(found)))


def face_difference(felt: FeltFaces, ideal: FeltFaces) -> FeltFaces:
    """What a source alone puts on the faces: what is felt less what the process leaves anyway."""
    return replace(felt, out=felt.out - ideal.out)


def face_values(felt: FeltFaces) -> dict[str, float | None]:
    """Item -> the largest of all faces [µm], the width across flats with its sign."""
    out, across, along = felt.out, felt.across, felt.along
    turn, lean = _slopes(out, across, 2), _slopes(out, along, 1)
    plane = out.mean(axis=(1, 2))[:, None, None] + turn[:, None, None] * across
    plane = plane + lean[:, None, None] * (along - along.mean())[:, None]
    middle = out[:, :, len(across) // 2].mean(axis=1)
    direction = np.exp(2j * np.pi * np.arange(len(out)) / len(out))
    return {
        "across_flats": 2.0 * float(middle.mean()),
        "flatness": float(np.ptp(out - plane, axis=(1, 2)).max()),
        "angle": float(np.abs(turn - turn.mean()).max() * np.ptp(across)),
        "lean": float(np.abs(lean).max() * np.ptp(along)),
        "concentricity": 4.0 * float(np.abs((middle * direction).mean())),
    }


def _slopes(out: Floats, place: Floats, axis: int) -> Floats:
    """(n,) slope of every face along one of its directions, by least squares."""
    off = place - place.mean()
    mean = out.mean(axis=3 - axis)
    return mean @ off / (off @ off)


def _out(
    fields: tuple[Field, ...],
    datum: RigidTransform,
    faces: tuple[Floats, float],
    places: tuple[Floats, Floats],
) -> Floats:
    """(n, k, m) how far faces stand out at the places of their planes [mm]."""
    (direction, inner), (along, across) = faces, places
    angle, z, u = (grid.ravel() for grid in np.meshgrid(direction, along, across, indexing="ij"))
    cos, sin = np.cos(angle), np.sin(angle)
    points = np.column_stack([inner * cos - u * sin, inner * sin + u * cos, z])
    outward = np.column_stack([cos, sin, np.zeros(len(z))])
    into = datum.rotation
    part = (points - datum.translation) @ into
    reach = REACH * 2.0 * inner
    return crossings(fields, part, outward @ into, reach=reach).reshape(
        len(direction), len(along), len(across)
    )


def _phase(fields: tuple[Field, ...], datum: RigidTransform, sides: int, place: tuple[float, float]) -> float:
    """Direction of a face [rad], from where material stands between face and corner."""
    radius, z = place
    angle = 2.0 * math.pi * np.arange(sides * SCANNED) / (sides * SCANNED)
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(len(angle), z)])
    solid = depths(fields, (points - datum.translation) @ datum.rotation) < 0
    if solid.all() or not solid.any():
        raise PartError(
            f"no corners stand on Ø {2.0 * radius:.3f} mm: {'nothing' if solid.all() else 'all'} is cut away"
        )
    corner = float(np.angle(np.exp(1j * sides * angle[solid]).sum())) / sides
    return corner + math.pi / sides
