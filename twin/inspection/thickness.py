"""Tooth thickness: along the reference circle, and its chord as a tooth caliper reads it.

The caliper's law is that of the virtual spur gear of z / cos³β teeth (geometry.md, section 1: SDP/SI tables).
"""

import math
from dataclasses import dataclass

import numpy as np

from twin.inspection.involute import Involute
from twin.inspection.reading import Placed, read_flanks
from twin.inspection.solid import Solid
from twin.inspection.usable import Usable


@dataclass(frozen=True, slots=True, kw_only=True)
class Thickness:
    """Mean thickness of the teeth [mm]."""

    normal: float
    """s_n, along the reference circle, normal to the teeth"""
    chord: float
    """of that arc"""
    height: float
    """of the tip over the chord"""
    facet: float
    """how much of it the mesh's chords make"""


def chordal(gear: Involute, thickness: float, *, tip_diameter: float) -> tuple[float, float]:
    """Return chordal thickness and chordal height [mm] of a normal thickness [mm] on the reference circle."""
    radius = gear.teeth / math.cos(gear.helix) ** 3 * gear.module / 2
    half = thickness / (2 * radius)
    addendum = (tip_diameter - gear.reference_diameter) / 2
    return 2 * radius * math.sin(half), addendum + radius * (1 - math.cos(half))


def measure_thickness(
    solid: Solid, placed: Placed, usable: Usable, *, tip_diameter: float
) -> tuple[Thickness | None, str]:
    """Measure the teeth in the measuring plane, or say why not. `tip_diameter` [mm] is the mean."""
    gear = placed.gear
    radius = gear.reference_diameter / 2
    roll = float(gear.roll_length(2 * radius))
    if not usable.start <= roll <= usable.end:
        return None, f"the reference circle of {2 * radius:.3f} mm does not meet the usable flank"
    read = read_flanks(solid, placed, np.array([placed.middle]), np.array([radius]))
    if not np.isfinite(read.deviation).all():
        return None, "the flanks have holes on the reference circle"
    # a flank that lies outside by a length along the base tangent adds that angle of the base circle
    wider, facet = (
        2 * radius * math.cos(gear.helix) * float(table.mean()) / 1000 / gear.base_radius
        for table in (read.deviation, read.facet)
    )
    normal = 2 * radius * math.cos(gear.helix) * float(gear.half_tooth(radius)) + wider
    chord, height = chordal(gear, normal, tip_diameter=tip_diameter)
    return Thickness(normal=normal, chord=chord, height=height, facet=abs(facet)), ""
