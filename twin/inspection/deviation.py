"""The deviation of every vertex from the nominal surface, to colour the part with."""

import math

import numpy as np
from numpy.typing import ArrayLike

from twin.inspection.axis import straightened
from twin.inspection.involute import geometry
from twin.inspection.reading import Placed
from twin.inspection.result import GearResult, Inspection, PolygonResult
from twin.inspection.solid import Floats, Ints, Solid, check_solid

FACING = math.cos(math.radians(35.0))
"""a mesh face belongs to a nominal surface if their normals differ by less"""


def deviation_map(vertices: ArrayLike, faces: ArrayLike, inspection: Inspection) -> Floats:
    """Return how far each vertex lies outside the nominal surface, normal to it.

    A gear's nominal flanks are involute helicoids of the nominal tooth thickness, turned to the mean of all
    flanks; a polygon's nominal faces are flat, turned to the mean of all faces.

    Returns:
        (n,) [µm], + = material outside; NaN for vertices that are on no flank or face, and everywhere if
        the inspection measured nothing.

    Raises:
        InputError: the mesh is no closed 2-manifold of finite numbers.

    """
    return deviations(check_solid(vertices, faces), inspection)


def deviations(solid: Solid, inspection: Inspection) -> Floats:
    """As `deviation_map`, of a mesh that was checked: (n,) of its vertices."""
    if inspection.axis is not None:
        solid = straightened(solid, inspection.axis)
    value = np.full(len(solid.vertices), np.nan)
    if inspection.gear is not None:
        _gear_map(solid, inspection.gear, value)
    elif inspection.polygon is not None:
        _polygon_map(solid, inspection.polygon, value)
    return value


def _gear_map(solid: Solid, result: GearResult, value: Floats) -> None:
    gear = geometry(result.reference)
    placed = Placed(
        gear=gear,
        phase=math.radians(result.phase_deg),
        middle=result.measuring_plane_mm,
        low=result.teeth_range_mm[0],
        high=result.teeth_range_mm[1],
    )
    x, y, z = solid.vertices.T
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    around = placed.tooth(placed.turned_back(angle, z))[1]
    side = np.where(around > 0, 1.0, -1.0)
    half = gear.half_tooth(np.maximum(radius, gear.base_radius))
    distance = side * around - half
    outside = 1000 * gear.base_radius * math.cos(gear.base_helix) * distance
    # outward normal of the flank through a vertex: square to the base tangent plane's contact line
    roll = np.arccos(np.minimum(gear.base_radius / np.maximum(radius, gear.base_radius), 1.0))
    direction = angle + side * (math.pi / 2 - roll)
    across = math.cos(gear.base_helix)
    normal = np.column_stack(
        [across * np.cos(direction), across * np.sin(direction), -side * math.sin(gear.base_helix)]
    )
    low, high = gear.form_diameter / 2, max(result.tip_diameter_mm, gear.tip_diameter) / 2 + 0.1 * gear.module
    ranged = (radius >= low) & (radius <= high) & (z >= placed.low - 1e-9) & (z <= placed.high + 1e-9)
    on_flank = _facing(solid, normal, ranged)
    value[on_flank] = outside[on_flank]


def _polygon_map(solid: Solid, result: PolygonResult, value: Floats) -> None:
    if result.reference is not None:
        distance, twist = result.reference.across_flats_mm / 2, 0.0
    else:
        distance, twist = result.across_flats_mm / 2, math.radians(result.twist_deg_per_mm)
    pitch = 2 * math.pi / result.number_of_sides
    found = np.radians([face.direction_deg for face in result.faces])
    first = float(np.mean(found - pitch * np.round((found - found[0]) / pitch)))
    x, y, z = solid.vertices.T
    low, high = result.range_mm
    angle = np.arctan2(y, x) - twist * (z - (low + high) / 2) - first
    steps = np.round(angle / pitch)
    direction = first + steps * pitch + twist * (z - (low + high) / 2)
    cos, sin = np.cos(direction), np.sin(direction)
    outside = 1000 * (x * cos + y * sin - distance)
    on_face = _facing(
        solid, np.column_stack([cos, sin, np.zeros_like(cos)]), (z >= low - 1e-9) & (z <= high + 1e-9)
    )
    value[on_face] = outside[on_face]


def _facing(solid: Solid, normal: Floats, ranged: np.ndarray) -> np.ndarray:
    """Mark the vertices (n,) of mesh faces that lie in range and face as `normal` (n, 3) does."""
    faces: Ints = solid.faces[ranged[solid.faces].all(axis=1)]
    a, b, c = (solid.vertices[faces[:, i]] for i in range(3))
    square = np.cross(b - a, c - a)
    length = np.linalg.norm(square, axis=1)
    marked = np.zeros(len(solid.vertices), dtype=bool)
    for i in range(3):
        corner = faces[:, i]
        along = np.einsum("ij,ij->i", square, normal[corner])
        marked[corner[along > FACING * length]] = True
    return marked
