"""`inspection.json`: the result keys of inspection.md, section 5, as plain values."""

import math
from collections.abc import Mapping
from typing import Any

from twin.inspection.nominal import GearNominal, Nominal
from twin.inspection.result import (
    Axis,
    Figures,
    Flank,
    GearResult,
    Inspection,
    PolygonResult,
    Trace,
    Wave,
)
from twin.inspection.trace import cut_off

FLANK_KEYS = (
    "profile_slope_um",
    "profile_form_um",
    "profile_total_um",
    "profile_crowning_um",
    "helix_slope_um",
    "helix_form_um",
    "helix_total_um",
    "helix_crowning_um",
    "single_pitch_um",
    "cumulative_pitch_um",
)


def to_json(inspection: Inspection) -> dict[str, Any]:
    """Return an inspection as JSON values: mm, µm and degrees; null with its reason in `unmeasured`."""
    values: dict[str, Any] = {"kind": inspection.kind}
    if inspection.kind is None:
        values["reason"] = inspection.reason
    if inspection.gear is not None:
        values |= _gear(inspection.gear)
    if inspection.polygon is not None:
        values |= _polygon(inspection.polygon)
    if inspection.axis is not None:
        values["axis"] = _axis(inspection.axis)
    values["nominal"] = _nominal(inspection.nominal)
    values["verdict"] = inspection.verdict.value
    values["findings"] = list(inspection.findings)
    values["unmeasured"] = dict(inspection.unmeasured)
    return _plain(values)


def _gear(gear: GearResult) -> dict[str, Any]:
    return {
        "number_of_teeth": gear.number_of_teeth,
        "normal_module": gear.normal_module_mm,
        "helix_angle_deg": gear.helix_angle_deg,
        "hand": gear.hand,
        "lead_mm": gear.lead_mm,
        "profile_shift": gear.profile_shift,
        "tip_diameter_mm": gear.tip_diameter_mm,
        "root_diameter_mm": gear.root_diameter_mm,
        "span_teeth": gear.span_teeth,
        "span_mm": gear.span_mm,
        "pin_diameter_mm": gear.pin_diameter_mm,
        "over_pins_mm": gear.over_pins_mm,
        "runout_um": gear.runout_um,
        "flank_offset_um": gear.flank_offset_um,
        "flanks": {"left": _flank(gear.left), "right": _flank(gear.right)},
        "tooth_thickness_mm": gear.tooth_thickness_mm,
        "chordal_thickness_mm": gear.chordal_thickness_mm,
        "chordal_height_mm": gear.chordal_height_mm,
        "uncertainty": gear.uncertainty,
        "accuracy_class": gear.accuracy_class,
        "accuracy_class_filtered": gear.accuracy_class_filtered,
        "tolerances_um": gear.tolerances_um,
        "reference": _nominal(gear.reference),
        "form_diameter_mm": gear.form_diameter_mm,
        "tip_form_diameter_mm": gear.tip_form_diameter_mm,
        "undercut": gear.undercut,
        "chamfered": gear.chamfered,
        "profile_range_mm": gear.profile_range_mm,
        "helix_range_mm": gear.helix_range_mm,
        "teeth_range_mm": gear.teeth_range_mm,
        "measuring_plane_mm": gear.measuring_plane_mm,
    }


def _flank(flank: Flank) -> dict[str, Any]:
    return {key: getattr(flank, key) for key in FLANK_KEYS} | {
        "filtered": dict(flank.filtered),
        "uncertainty": dict(flank.uncertainty),
        "profile_waviness": [_wave(wave) for wave in flank.profile_waviness],
        "helix_waviness": [_wave(wave) for wave in flank.helix_waviness],
        "pitch_um": flank.pitch_um.tolist(),
        "cumulative_um": flank.cumulative_um.tolist(),
        "profile": [_trace(trace) for trace in flank.profile],
        "helix": [_trace(trace) for trace in flank.helix],
    }


def _wave(wave: Wave) -> dict[str, Any]:
    return {"order": wave.order, "amplitude_um": wave.amplitude_um}


def _trace(trace: Trace) -> dict[str, Any]:
    """The figures of one tooth; the points themselves are for `--csv`."""
    return {
        "tooth": trace.tooth,
        "points": len(trace.position),
        "evaluation": trace.evaluation,
        "cut_off_mm": cut_off(trace.evaluation),
        **_figures(trace),
        "filtered": _figures(trace.filtered) if trace.filtered else None,
        "uncertainty": _figures(trace.facets) if trace.facets else None,
    }


def _figures(figures: Trace | Figures) -> dict[str, Any]:
    return {key: getattr(figures, key) for key in ("slope_um", "form_um", "total_um", "crowning_um")}


def _polygon(polygon: PolygonResult) -> dict[str, Any]:
    return {
        "number_of_sides": polygon.number_of_sides,
        "across_flats_mm": polygon.across_flats_mm,
        "across_flats_planes_mm": polygon.across_flats_planes_mm,
        "across_flats_caliper_mm": polygon.across_flats_caliper_mm,
        "across_flats_caliper_least_mm": polygon.across_flats_caliper_least_mm,
        "across_corners_mm": polygon.across_corners_mm,
        "across_corners_least_mm": polygon.across_corners_least_mm,
        "bow_um": polygon.bow_um,
        "flatness_um": polygon.flatness_um,
        "twist_deg_per_mm": polygon.twist_deg_per_mm,
        "hand": polygon.hand,
        "concentricity_um": polygon.concentricity_um,
        "angles_deg": polygon.angles_deg.tolist(),
        "faces": [
            {
                "direction_deg": face.direction_deg,
                "distance_mm": face.distance_mm,
                "width_mm": face.width_mm,
                "mid_distance_mm": face.mid_distance_mm,
                "bow_um": face.bow_um,
                "flatness_um": face.flatness_um,
                "twist_deg_per_mm": face.twist_deg_per_mm,
            }
            for face in polygon.faces
        ],
        "range_mm": polygon.range_mm,
        "flatness_class": polygon.flatness_class,
        "flatness_limits_um": polygon.flatness_limits_um,
        "uncertainty": polygon.uncertainty,
    }


def _axis(axis: Axis) -> dict[str, Any]:
    names = ("offset_mm", "tilt_deg", *axis.__dataclass_fields__)
    return {name: getattr(axis, name) for name in names}


def _nominal(nominal: Nominal | None) -> dict[str, Any] | None:
    if nominal is None:
        return None
    kind = "gear" if isinstance(nominal, GearNominal) else "polygon"
    return {"kind": kind} | {name: getattr(nominal, name) for name in nominal.__dataclass_fields__}


def _plain(value: Any) -> Any:
    """Return numbers as Python's own, without the noise beyond a picometre; NaN as null."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, bool | str) or value is None:
        return value
    if isinstance(value, int):
        return int(value)
    number = round(float(value), 9) + 0.0
    return number if math.isfinite(number) else None
