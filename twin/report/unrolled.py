"""Every flank or face of the part laid flat: where its vertices stand on it, and its deviation as pixels."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.inspection.involute import geometry
from twin.inspection.reading import Placed
from twin.inspection.result import Floats, GearResult, Inspection, PolygonResult
from twin.report.data import Part
from twin.report.raster import area, visible

Ints = NDArray[np.integer]
NOWHERE = -1
PIXELS = 500_000
"""of all maps together, about"""
WIDEST = 160
"""pixels of one map across"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Unrolled:
    """Places of the part's vertices on its flanks or faces."""

    across: Floats
    """(n,) roll length, or place along the face [mm]"""
    z: Floats
    """(n,) [mm]"""
    patch: Ints
    """(n,) which flank or face; NOWHERE = none"""
    rows: tuple[tuple[str, tuple[str, ...]], ...]
    """name of every row of patches, and the names in it; patches are counted along the rows"""
    across_name: str
    ends: tuple[str, str]
    """what lies at the low and the high end of `across`"""
    direction_deg: tuple[float, ...]
    """of every patch as seen from the axis, from the part's +X counter-clockwise"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Maps:
    """Deviation [µm] of every patch on one common grid."""

    deviation_um: NDArray[np.floating]
    """(patches, height, width), NaN = no material or not measured; top row = largest z"""
    across: tuple[float, float]
    """[mm] at the left and right edge"""
    z: tuple[float, float]
    """[mm] at the bottom and top edge"""


def unroll(part: Part, inspection: Inspection) -> Unrolled | None:
    """Lay the measured flanks or faces flat; None where there are none."""
    if inspection.gear:
        return _unroll_gear(part, inspection.gear)
    if inspection.polygon and inspection.polygon.faces:
        return _unroll_polygon(part, inspection.polygon)
    return None


def map_deviation(part: Part, unrolled: Unrolled) -> Maps | None:
    """Scan-convert the deviation of the mesh onto every patch; None where no triangle lies on any.

    Between the vertices of a triangle the deviation is linear, as the mesh is flat there.
    """
    where = np.where(np.isfinite(part.deviation_um), unrolled.patch, NOWHERE)
    corners = np.ascontiguousarray(part.faces.T)
    a, b, c = (where.take(corner) for corner in corners)
    kept = np.flatnonzero((a >= 0) & (a == b) & (a == c))
    faces, patch = corners.take(kept, axis=1), a.take(kept)
    if not len(patch):
        return None
    across, z = unrolled.across.take(faces), unrolled.z.take(faces)
    spans = ((float(across.min()), float(across.max())), (float(z.min()), float(z.max())))
    count = sum(len(names) for _, names in unrolled.rows)
    width, height = _size(count, *spans)
    (left, right), (bottom, top) = spans
    corner = np.stack(
        [
            (across - left) * (width / ((right - left) or 1.0)),
            (top - z) * (height / ((top - bottom) or 1.0)) + patch * height,
            part.deviation_um.take(faces),
        ]
    ).astype(np.float32)
    corner = corner[:, :, np.abs(area(*corner[:2].swapaxes(0, 1))) > 1e-6]
    pixel, _, value = visible(corner, width, height * count)
    maps = np.full(width * height * count, np.nan, np.float32)
    maps[pixel] = value
    return Maps(deviation_um=maps.reshape(count, height, width), across=spans[0], z=spans[1])


def _size(count: int, across: tuple[float, float], z: tuple[float, float]) -> tuple[int, int]:
    """Width and height of one map [pixels]: as long as it is, but no ribbon."""
    ratio = (z[1] - z[0]) / ((across[1] - across[0]) or 1.0)
    ratio = min(max(ratio, 0.5), 5.0)
    width = min(WIDEST, max(8, round(math.sqrt(PIXELS / max(count, 1) / ratio))))
    return width, max(8, round(width * ratio))


def _unroll_gear(part: Part, gear: GearResult) -> Unrolled:
    ideal = geometry(gear.reference)
    placed = Placed(
        gear=ideal,
        phase=math.radians(gear.phase_deg),
        middle=gear.measuring_plane_mm,
        low=gear.teeth_range_mm[0],
        high=gear.teeth_range_mm[1],
    )
    x, y, z = part.vertices.T
    tooth, around = placed.tooth(placed.turned_back(np.arctan2(y, x), z))
    radius = np.hypot(x, y)
    pitch = 360.0 / ideal.teeth
    half = math.degrees(float(ideal.half_tooth(ideal.measuring_diameter / 2)))
    names = tuple(str(k) for k in range(1, ideal.teeth + 1))
    left = tuple(gear.phase_deg - pitch * k + half for k in range(ideal.teeth))
    return Unrolled(
        across=ideal.roll_length(2 * radius),
        z=z,
        patch=np.where(radius >= ideal.base_radius, tooth + np.where(around > 0, 0, ideal.teeth), NOWHERE),
        rows=(("Left flanks", names), ("Right flanks", names)),
        across_name="roll length ξ",
        ends=("root", "tip"),
        direction_deg=(*left, *(angle - 2 * half for angle in left)),
    )


def _unroll_polygon(part: Part, polygon: PolygonResult) -> Unrolled:
    x, y, z = part.vertices.T
    middle = sum(polygon.range_mm) / 2
    twist = 0.0 if polygon.reference else math.radians(polygon.twist_deg_per_mm)
    point = (x + 1j * y) * np.exp(-1j * twist * (z - middle))
    directions = np.array([face.direction_deg for face in polygon.faces])
    turned = point[:, None] * np.exp(-1j * np.radians(directions))
    face = np.abs(np.angle(turned)).argmin(axis=1)
    return Unrolled(
        across=turned[np.arange(len(point)), face].imag,
        z=z,
        patch=face,
        rows=(("Faces", tuple(str(k) for k in range(1, len(directions) + 1))),),
        across_name="along the face",
        ends=("−", "+"),
        direction_deg=tuple(directions.tolist()),
    )
