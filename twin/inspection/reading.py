"""Where a mesh's flanks lie against where they should: the one reading behind profile, helix and pitch.

The mesh crosses a circle about the axis where a tooth flank should cross it at a known angle; the difference,
times the base radius, is the deviation along the tangent to the base cylinder in the transverse plane, which
is normal to the flank there (inspection.md, section 1).
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from twin.inspection.involute import Involute
from twin.inspection.sections import FOLD, Crossings, Segments, circle_crossings, plane_segments, unfolded
from twin.inspection.solid import Floats, Ints, Solid

SENSES = (1.0, -1.0)
"""of rotation towards the material's outside: left flank, right flank"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """A gear geometry in its place about the axis."""

    gear: Involute
    phase: float
    """angle [rad] of tooth 1's centre at `middle`"""
    middle: float
    """z [mm] where profile and pitch are measured"""
    low: float
    """z [mm] where the teeth begin"""
    high: float
    """z [mm] where they end"""

    @property
    def helix_range(self) -> tuple[float, float]:
        """z [mm] over which helices are evaluated: b less the smaller of 5 % b and one module at each end."""
        margin = min(0.05 * (self.high - self.low), self.gear.module)
        return self.low + margin, self.high - margin

    def turned_back(self, angle: Floats, z: Floats) -> Floats:
        """Return angles [rad] as seen from tooth 1, the twist of the helix taken out."""
        return angle - self.phase - self.gear.twist * (z - self.middle)

    def tooth(self, angle: Floats) -> tuple[Ints, Floats]:
        """Return the nearest tooth (0 = tooth 1, clockwise) and the angle [rad] from its centre."""
        pitch = 2 * math.pi / self.gear.teeth
        steps = np.round(-angle / pitch).astype(np.int64)
        return steps % self.gear.teeth, angle + steps * pitch


@dataclass(frozen=True, slots=True, kw_only=True)
class Readings:
    """Deviations of left and right flanks at heights and radii, tooth by tooth clockwise from tooth 1."""

    deviation: Floats
    """(2, planes, circles, z) left and right [µm], + = material outside; NaN: no flank crosses there once"""
    facet: Floats
    """(2, planes, circles, z) the part of it that chords of the mesh put in [µm]: what the deviation falls
    short of the one interpolated between the vertices of the facet"""


def read_flanks(solid: Solid, placed: Placed, heights: Floats, radii: Floats) -> Readings:
    """Read all flanks on circles; heights (planes,) and radii (circles,) [mm] ascending."""
    segments = plane_segments(solid, heights, radius=float(radii[0]) if len(radii) == 1 else None)
    crossings = unfolded(circle_crossings(segments, radii), FOLD * 2 * math.pi / placed.gear.teeth)
    height, radius = heights[crossings.plane], radii[crossings.circle]
    side = np.where(crossings.left, *SENSES)
    angle = placed.turned_back(crossings.angle, height)
    tooth, offset = placed.tooth(angle - side * placed.gear.half_tooth(radius))
    shape = (2, len(heights), len(radii), placed.gear.teeth)
    place = np.ravel_multi_index(
        ((~crossings.left).astype(np.int64), crossings.plane, crossings.circle, tooth), shape
    )
    scale = 1000 * placed.gear.base_radius
    return Readings(
        deviation=_table(place, scale * side * offset, shape),
        facet=_table(
            place,
            scale * _chord_errors(solid, segments, crossings, placed, height=height, radius=radius),
            shape,
        ),
    )


def _table(place: Ints, value: Floats, shape: tuple[int, ...]) -> Floats:
    size = math.prod(shape)
    hits = np.bincount(place, minlength=size)
    total = np.bincount(place, weights=value, minlength=size)
    return np.where(hits == 1, total, np.nan).reshape(shape)


def _chord_errors(
    solid: Solid, segments: Segments, crossings: Crossings, placed: Placed, *, height: Floats, radius: Floats
) -> Floats:
    """Return what each crossing (n,) lacks against its facet's vertices [rad], + = material outside."""
    gear, side = placed.gear, np.where(crossings.left, *SENSES)
    cos, sin = np.cos(crossings.angle), np.sin(crossings.angle)
    half = gear.half_tooth(radius)
    between = np.zeros(len(radius))
    ends = ((segments.start_node, 1 - crossings.along), (segments.end_node, crossings.along))
    for node, near in ends:
        low, high = np.divmod(node[crossings.segment], len(solid.vertices))
        z_low, z_high = solid.vertices[low, 2], solid.vertices[high, 2]
        up = (height - z_low) / (z_high - z_low)
        for vertex, share in ((low, 1 - up), (high, up)):
            x, y, z = solid.vertices[vertex].T
            turn = np.arctan2(y * cos - x * sin, x * cos + y * sin) - gear.twist * (z - height)
            between += near * share * (side * turn - gear.half_tooth(np.hypot(x, y)) + half)
    return -between


def locate(solid: Solid, rough: Placed) -> Placed:
    """Turn a geometry onto a solid: mean of all flanks on the measuring circle, tooth 1 nearest C0."""
    left, right = pitch_readings(solid, rough).deviation[:, 0, 0]
    shift = 0.0
    if np.isfinite(left).any() and np.isfinite(right).any():
        shift = (np.nanmean(left) - np.nanmean(right)) / 2000 / rough.gear.base_radius
    _, nearest = rough.tooth(np.array([-(rough.phase + shift)]))
    return replace(rough, phase=float(-nearest[0]))


def pitch_readings(solid: Solid, placed: Placed) -> Readings:
    """Read all flanks on the measuring circle in the measuring plane."""
    return read_flanks(
        solid, placed, np.array([placed.middle]), np.array([placed.gear.measuring_diameter / 2])
    )
