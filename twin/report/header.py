"""The table at the head of every page of the sheet: what was measured, where, against what."""

import math
from pathlib import PurePath

from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal
from twin.inspection.result import GearResult, Inspection, PolygonResult
from twin.report import tables
from twin.report.data import ReportData
from twin.report.scale import MISSING, number, plain

Pairs = tuple[tuple[str, str], ...]
"""names, with `_{…}` for what stands lower, and values"""


def gear_header(report: ReportData, gear: GearResult) -> Pairs:
    """Job, gear data, ranges of evaluation, class."""
    reference = gear.reference
    ideal = geometry(reference)
    low, high = (float(ideal.roll_length(d)) for d in gear.profile_range_mm)
    teeth_low, teeth_high = gear.teeth_range_mm
    helix = gear.helix_range_mm
    traced = [trace.tooth for trace in gear.left.profile] or [trace.tooth for trace in gear.right.profile]
    lead = number(abs(ideal.lead), 3, "mm") if ideal.lead else "∞"
    return (
        ("Part", report.title),
        ("Program", _programs(report)),
        ("Measured on", _mesh(report)),
        ("Datum", _datum(report.inspection)),
        ("Number of teeth z", str(reference.number_of_teeth)),
        ("Normal module m_{n}", plain(reference.normal_module_mm, "mm")),
        ("Pressure angle α_{n}", plain(reference.normal_pressure_angle_deg, "°")),
        ("Helix angle β", _helix(reference)),
        ("Profile shift x", number(reference.profile_shift, 4)),
        ("Lead p_{z}", lead),
        ("Base Ø d_{b}", number(ideal.base_diameter, 4, "mm")),
        ("Base helix β_{b}", number(math.degrees(abs(ideal.base_helix)), 4, "°")),
        ("Tip Ø d_{a}", number(gear.tip_diameter_mm, 3, "mm")),
        ("Root Ø d_{f}", number(gear.root_diameter_mm, 3, "mm")),
        ("Face width b", number(teeth_high - teeth_low, 3, "mm")),
        ("Measuring Ø d_{M}", number(ideal.measuring_diameter, 3, "mm")),
        ("Profile range", f"Ø {gear.profile_range_mm[0]:.2f} … {gear.profile_range_mm[1]:.2f}"),
        ("L_{α}", number(high - low, 2, "mm")),
        ("Helix range", f"z {number(helix[0], 2)} … {number(helix[1], 2)}" if helix else MISSING),
        ("L_{β}", number(helix[1] - helix[0], 2, "mm") if helix else MISSING),
        ("Measuring plane", f"z {number(gear.measuring_plane_mm, 2)} mm"),
        ("Teeth traced", _listed(traced)),
        ("Class allowed", tables.class_allowed(report.inspection)),
        ("Class reached", tables.class_reached(gear, "overall")),
    )


def polygon_header(report: ReportData, polygon: PolygonResult) -> Pairs:
    """Job, polygon, where it was measured."""
    reference = polygon.reference
    width = f"{plain(reference.across_flats_mm)} mm {reference.tolerance}" if reference else MISSING
    return (
        ("Part", report.title),
        ("Program", _programs(report)),
        ("Measured on", _mesh(report)),
        ("Datum", _datum(report.inspection)),
        ("Sides", str(reference.number_of_sides if reference else polygon.number_of_sides)),
        ("Across flats", width),
        ("Faces from", f"z {number(polygon.range_mm[0], 2)} … {number(polygon.range_mm[1], 2)}"),
        ("Section at", f"z {number(sum(polygon.range_mm) / 2, 2)} mm"),
    )


def _programs(report: ReportData) -> str:
    return ", ".join(PurePath(program.name).name for program in report.programs) or MISSING


def _mesh(report: ReportData) -> str:
    return f"{len(report.part.faces):,} facets".replace(",", " ") if report.part else "mesh"


def _datum(inspection: Inspection) -> str:
    axis = inspection.axis
    return "work axis" if axis is None else f"{axis.datum} Ø {number(axis.diameter_mm, 3)} mm"


def _helix(reference: GearNominal) -> str:
    if reference.helix_angle_deg == 0:
        return "0° spur"
    hand = "right" if reference.helix_angle_deg > 0 else "left"
    return f"{number(abs(reference.helix_angle_deg), 4)}° {hand}"


def _listed(teeth: list[int]) -> str:
    """Numbers of teeth: all of a few, the ends of many."""
    if not teeth:
        return MISSING
    if len(teeth) > 6:
        return f"{len(teeth)}, {teeth[0]} … {teeth[-1]}"
    return ", ".join(str(tooth) for tooth in teeth)
