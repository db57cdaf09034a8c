"""Tooth and face numbers, where they stand on the part's front face."""

from dataclasses import dataclass

import numpy as np

from twin.inspection.result import GearResult, Inspection, PolygonResult

MOST_LABELS = 40
"""more are thinned out evenly, from 1"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Label:
    """A number and its place."""

    text: str
    position_mm: tuple[float, float, float]
    """in the part frame, on the front face"""


def labels(inspection: Inspection) -> tuple[Label, ...]:
    """Numbers of the teeth or faces that tables and charts speak of."""
    if inspection.gear:
        return _tooth_labels(inspection.gear)
    if inspection.polygon:
        return _face_labels(inspection.polygon)
    return ()


def _tooth_labels(gear: GearResult) -> tuple[Label, ...]:
    """Below the root of each tooth: clockwise from tooth 1, whose phase holds in the measuring plane."""
    front = gear.teeth_range_mm[1]
    turn = 0.0
    if gear.lead_mm:
        turn = (
            360.0
            * (front - gear.measuring_plane_mm)
            / abs(gear.lead_mm)
            * (1 if gear.hand == "right" else -1)
        )
    radius = gear.root_diameter_mm / 2 - 0.03 * gear.tip_diameter_mm
    return tuple(
        _label(tooth, gear.phase_deg + turn - 360.0 * (tooth - 1) / gear.number_of_teeth, radius, front)
        for tooth in _spread(gear.number_of_teeth)
    )


def _face_labels(polygon: PolygonResult) -> tuple[Label, ...]:
    return tuple(
        _label(
            k,
            polygon.faces[k - 1].direction_deg,
            0.86 * polygon.faces[k - 1].distance_mm,
            polygon.range_mm[1],
        )
        for k in _spread(len(polygon.faces))
    )


def _spread(count: int) -> range:
    """Numbers from 1 to `count`, or at most `MOST_LABELS` of them."""
    return range(1, count + 1, max(1, -(-count // MOST_LABELS)))


def _label(number: int, angle_deg: float, radius: float, z: float) -> Label:
    angle = np.radians(angle_deg)
    return Label(
        text=str(number), position_mm=(float(radius * np.cos(angle)), float(radius * np.sin(angle)), float(z))
    )
