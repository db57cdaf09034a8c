"""The verdict: what was found against what was named, in sentences a reader understands."""

import math
from dataclasses import replace

from twin.inspection.gear import Found
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal, Nominal, PolygonNominal
from twin.inspection.result import GearResult, PolygonResult, Trace, Verdict
from twin.inspection.tolerances import (
    GearSize,
    across_flats_limits,
    class_reached,
    gear_tolerance,
    outside_standard,
)

HELIX_LIMIT = 0.5
"""a helix angle [degrees] farther off is another gear"""
MODULE_LIMIT = 0.02
"""a module relatively farther off is another gear"""
FLANK_LIMIT = 0.1
"""flanks farther off than this, in modules, are no flanks of the named gear"""
OFFSET_LIMIT = 0.05
"""flanks farther off than this, in modules, and the gear does not mesh as it should"""
TIP_LIMIT = 0.1
"""a tip diameter farther off than this, in modules, is another gear's"""
TWIST_LIMIT = 0.5
"""faces that turn by more than this [degrees] over the length are not plain"""
OFFSET_WORTH = 0.01
"""flanks farther off than this, in modules, are worth a word"""
CORNERS_OVER_FLATS = 1.13
"""e_min / s_min of a hexagon (ISO 4759-1)"""

CONCAVE_ABOVE = 5.0
"""bow [µm] from which concave faces are worth a word"""
HOLES = "the flanks have holes"
GRADED = (
    "single_pitch",
    "cumulative_pitch",
    "profile_slope",
    "profile_form",
    "profile_total",
    "helix_slope",
    "helix_form",
    "helix_total",
)
"""the items of ISO 1328-1 that make up the overall class"""
_WORDS = {
    "single_pitch": "single pitch deviation f_p",
    "cumulative_pitch": "cumulative pitch deviation F_p",
    "profile_slope": "profile slope deviation f_Hα",
    "profile_form": "profile form deviation f_fα",
    "profile_total": "total profile deviation F_α",
    "helix_slope": "helix slope deviation f_Hβ",
    "helix_form": "helix form deviation f_fβ",
    "helix_total": "total helix deviation F_β",
}


def name_of(nominal: Nominal) -> str:
    """Say what a nominal is."""
    if isinstance(nominal, PolygonNominal):
        return f"a polygon of {nominal.number_of_sides} sides, {nominal.across_flats_mm:g} mm across flats"
    found = Found(
        teeth=nominal.number_of_teeth,
        module=nominal.normal_module_mm,
        helix_deg=nominal.helix_angle_deg,
        shift=nominal.profile_shift,
        pressure_deg=nominal.normal_pressure_angle_deg,
        straying=0.0,
    )
    return f"a gear with {found}"


def unlike(found: Found, nominal: GearNominal) -> str:
    """Say in what a found gear is not the one named; empty if it is."""
    off = []
    if found.teeth != nominal.number_of_teeth:
        off.append(f"{found.teeth} teeth instead of {nominal.number_of_teeth}")
    if abs(found.helix_deg - nominal.helix_angle_deg) > HELIX_LIMIT:
        off.append(
            f"helix angle {round(found.helix_deg, 2) + 0.0:g}° instead of {nominal.helix_angle_deg:g}° "
            "(+ right-hand)"
        )
    if abs(found.module / nominal.normal_module_mm - 1) > MODULE_LIMIT:
        off.append(f"normal module {found.module:.3f} mm instead of {nominal.normal_module_mm:g} mm")
    return ", ".join(off)


def worst_values(gear: GearResult) -> dict[str, float]:
    """Return for each item of ISO 1328-1 the largest |value| [µm] of both sides, as far as measured."""
    values: dict[str, float] = {}
    for flank in (gear.left, gear.right):
        items = {
            "profile_slope": None if flank.profile_slope_um is None else _steepest(flank.profile),
            "profile_form": flank.profile_form_um,
            "profile_total": flank.profile_total_um,
            "helix_slope": None if flank.helix_slope_um is None else _steepest(flank.helix),
            "helix_form": flank.helix_form_um,
            "helix_total": flank.helix_total_um,
            "single_pitch": flank.single_pitch_um,
            "cumulative_pitch": flank.cumulative_pitch_um,
        }
        for item, value in items.items():
            if value is not None:
                values[item] = max(values.get(item, 0.0), value)
    return values


def _steepest(traces: tuple[Trace, ...]) -> float:
    return max(abs(t.slope_um) for t in traces)


def grade_gear(gear: GearResult) -> tuple[dict[str, int | None], dict[str, float], list[str]]:
    """Grade by ISO 1328-1:2013.

    Returns:
        class reached per item and "overall" (None: worse than 11, or not all items measured), tolerances of
        the reference's class [µm], and sentences: what exceeds its tolerance, or why nothing is graded.

    """
    reference = gear.reference
    low, high = gear.teeth_range_mm
    size = GearSize(
        number_of_teeth=reference.number_of_teeth,
        reference_diameter=reference.number_of_teeth
        * reference.normal_module_mm
        / math.cos(math.radians(reference.helix_angle_deg)),
        normal_module=reference.normal_module_mm,
        face_width=high - low if reference.face_width_mm is None else reference.face_width_mm,
        helix_angle=reference.helix_angle_deg,
    )
    outside = outside_standard(size)
    if outside:
        return {}, {}, [f"not graded: {sentence}" for sentence in outside]
    values = worst_values(gear)
    classes = {item: class_reached(item, size, value) for item, value in values.items()}
    if gear.runout_um is not None:
        classes["runout"] = class_reached("runout", size, gear.runout_um)
    reached = [classes.get(item) for item in GRADED]
    known = [a for a in reached if a is not None]
    classes["overall"] = max(known) if len(known) == len(reached) else None
    allowed = reference.accuracy_class
    if allowed is None:
        return classes, {}, []
    tolerances = {item: gear_tolerance(item, size, allowed) for item in GRADED}
    findings = [
        f"{_WORDS[item]} {value:.1f} µm exceeds the {tolerances[item]:g} µm of class {allowed}"
        for item, value in values.items()
        if value > tolerances[item]
    ]
    return classes, tolerances, findings


def judge_gear(
    gear: GearResult, nominal: GearNominal | None, *, whole: bool, unmeasured: dict[str, str]
) -> tuple[GearResult, Verdict, list[str]]:
    """Return the gear with its classes, the verdict and the findings, most important first."""
    classes, tolerances, exceeded = grade_gear(gear)
    result = replace(gear, accuracy_class=classes, tolerances_um=tolerances)
    wrong = _unfinished(gear, nominal, whole=whole)
    notes = []
    if nominal is None:
        if wrong:
            return result, Verdict.NOT_GRADED, [*wrong, *exceeded]
    else:
        notes = _infeed(gear, unmeasured)
        if abs(gear.flank_offset_um or 0.0) > 1000 * OFFSET_LIMIT * nominal.normal_module_mm:
            wrong, notes = wrong + notes, []
        wrong += _tip(gear, nominal)
    allowed = nominal.accuracy_class if nominal is not None else None
    if classes and allowed is not None:
        measured = worst_values(gear)
        wrong += [
            f"{_WORDS[item]} cannot be measured: {unmeasured.get(item + '_um', HOLES)}"
            for item in GRADED
            if item not in measured
        ]
        wrong += exceeded
        exceeded = []
    if wrong:
        return result, Verdict.OUT, wrong + exceeded + notes
    if not classes:
        return result, Verdict.NOT_GRADED, exceeded + notes
    if allowed is None:
        return result, Verdict.NOT_GRADED, ["no accuracy class was named to judge by", *notes]
    return result, Verdict.IN, [f"all measured items hold class {allowed} of ISO 1328-1:2013", *notes]


def _unfinished(gear: GearResult, nominal: GearNominal | None, *, whole: bool) -> list[str]:
    """Say where teeth are missing."""
    words = []
    low, high = gear.teeth_range_mm
    if not whole:
        words.append(f"the teeth have their full depth only from z = {low:.2f} to {high:.2f} mm")
    wanted = nominal.face_width_mm if nominal is not None else None
    if wanted is not None and high - low < 0.98 * wanted:
        words.append(f"the teeth are {high - low:.2f} mm wide instead of {wanted:g} mm")
    return words


def _tip(gear: GearResult, nominal: GearNominal) -> list[str]:
    """Say whether the tips stand where they were named."""
    wanted = nominal.tip_diameter_mm
    if wanted is None or abs(gear.tip_diameter_mm - wanted) <= TIP_LIMIT * nominal.normal_module_mm:
        return []
    return [f"tip {gear.tip_diameter_mm:.3f} mm instead of {wanted:g} mm"]


def _infeed(gear: GearResult, unmeasured: dict[str, str]) -> list[str]:
    """Say whether the teeth are too thick or too thin, where that is worth a word."""
    offset = gear.flank_offset_um
    if offset is None or abs(offset) <= 1000 * OFFSET_WORTH * gear.reference.normal_module_mm:
        return []
    nominal = geometry(gear.reference)
    thickness = 2 * abs(offset) / 1000 / math.cos(nominal.pressure)
    where, how, why = (
        ("outside", "thick", "not cut to depth") if offset > 0 else ("inside", "thin", "cut too deep")
    )
    k = nominal.span_teeth()
    if gear.span_mm is None:
        span = f"not measurable ({unmeasured.get('span_mm', HOLES)})"
    else:
        span = f"{gear.span_mm:.3f} mm"
    return [
        f"the flanks lie {abs(offset):.0f} µm {where} the nominal: teeth too {how} by {thickness:.3f} mm, "
        f"{why}; span over {k} teeth {span}, wanted {nominal.span(k):.3f} mm"
    ]


def judge_polygon(
    polygon: PolygonResult, nominal: PolygonNominal | None, *, whole: bool
) -> tuple[Verdict, list[str]]:
    """Return the verdict on a polygon and the findings, most important first (ISO 4759-1 grade A)."""
    shape = _shape_of_faces(polygon)
    if nominal is None:
        return Verdict.NOT_GRADED, [*shape, "no width across flats was named to judge by"]
    wrong = _twisted(polygon)
    low, high = across_flats_limits(nominal.across_flats_mm, nominal.tolerance)
    limits = f"{nominal.tolerance} of {nominal.across_flats_mm:g} mm allows {low:.3f} to {high:.3f} mm"
    least, largest = polygon.across_flats_caliper_least_mm, polygon.across_flats_caliper_mm
    how = "by caliper"
    if least is None or largest is None:  # no face stands opposite another: twice the distance from the axis
        least = largest = polygon.across_flats_mm
        how = "as twice the distance of the faces from the axis"
    if round(largest, 3) > high:
        wrong.append(f"too large: {largest:.3f} mm across flats {how}, {limits}")
    if round(least, 3) < low:
        wrong.append(f"too small: {least:.3f} mm across flats {how}, {limits}")
    least_corners = CORNERS_OVER_FLATS * low
    if polygon.number_of_sides == 6 and round(polygon.across_corners_least_mm, 3) < round(least_corners, 3):
        wrong.append(
            f"corners too small: {polygon.across_corners_least_mm:.3f} mm across corners, "
            f"at least {least_corners:.3f} mm are wanted (1.13 times the smallest width across flats)"
        )
    if not whole:
        z = polygon.range_mm
        shape.append(f"the faces have their full depth from z = {z[0]:.2f} to {z[1]:.2f} mm")
    if wrong:
        return Verdict.OUT, wrong[:1] + shape + wrong[1:]
    return Verdict.IN, [f"across flats {largest:.3f} mm {how}: {limits}", *shape]


def _twisted(polygon: PolygonResult) -> list[str]:
    """Say whether the faces turn, where plain ones are wanted: a nominal polygon has no twist."""
    low, high = polygon.range_mm
    turn = abs(polygon.twist_deg_per_mm) * (high - low)
    if turn <= TWIST_LIMIT:
        return []
    return [
        f"the faces are twisted by {abs(polygon.twist_deg_per_mm):.3f} °/mm {polygon.hand}-hand, {turn:.1f}° "
        f"over {high - low:.2f} mm: plain faces are wanted"
    ]


def _shape_of_faces(polygon: PolygonResult) -> list[str]:
    words = []
    if polygon.bow_um < -CONCAVE_ABOVE:
        words.append(
            f"the faces are concave by {-polygon.bow_um:.1f} µm: "
            f"{polygon.across_flats_mm:.3f} mm across flats at the middle of the faces, "
            "but a caliper touches near the corners; a ratio Q/P of 2 makes them convex"
        )
    return words
