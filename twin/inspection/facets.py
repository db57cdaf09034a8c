"""What the mesh's own facets put into the figures of a polygon: how far chords cut its faces short."""

import math

import numpy as np

from twin.inspection.result import PolygonResult
from twin.inspection.solid import Solid

FACING = math.cos(math.radians(35.0))
"""a facet belongs to a face of the polygon if their normals differ by less"""


def chord_depth_um(solid: Solid, polygon: PolygonResult) -> float:
    """Return the largest depth [µm] of an edge's middle against a surface of that bow and twist.

    The surface is taken through both ends of the edge: twisted, and a parabola across.
    """
    low, high = polygon.range_mm
    inside = (solid.face_low >= low - 1e-9) & (solid.face_high <= high + 1e-9)
    corners = solid.vertices[solid.faces[inside]]
    pitch, twist = 2 * math.pi / polygon.number_of_sides, math.radians(polygon.twist_deg_per_mm)
    first, middle = math.radians(polygon.faces[0].direction_deg), (low + high) / 2
    centre = corners.mean(axis=1)
    turn = np.arctan2(centre[:, 1], centre[:, 0]) - first - twist * (centre[:, 2] - middle)
    base = first + pitch * np.round(turn / pitch)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    at_centre = base + twist * (centre[:, 2] - middle)
    along = normal[:, 0] * np.cos(at_centre) + normal[:, 1] * np.sin(at_centre)
    facing = along > FACING * np.linalg.norm(normal, axis=1)
    corners, base = corners[facing], base[facing]
    bend = polygon.bow_um / 1000 / (np.mean([face.width_mm for face in polygon.faces]) / 2) ** 2

    def height(points: np.ndarray) -> np.ndarray:
        """How far points (n, 3) stand outside the surface, but for a constant [mm]."""
        direction = base + twist * (points[:, 2] - middle)
        cos, sin = np.cos(direction), np.sin(direction)
        across = points[:, 1] * cos - points[:, 0] * sin
        return points[:, 0] * cos + points[:, 1] * sin + bend * across**2

    heights = [height(corners[:, i]) for i in range(3)]
    depths = [
        (heights[i] + heights[j]) / 2 - height((corners[:, i] + corners[:, j]) / 2)
        for i, j in ((0, 1), (1, 2), (2, 0))
    ]
    return 1000 * float(np.abs(depths).max(initial=0.0))
