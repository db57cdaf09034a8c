"""The verdict on a gear, in sentences a reader understands (ISO 1328-1:2013)."""

import math
from dataclasses import replace

from twin.inspection.damage import damaged
from twin.inspection.involute import geometry
from twin.inspection.nominal import GearNominal
from twin.inspection.result import Figures, Flank, GearResult, Trace, Verdict
from twin.inspection.tolerances import GearSize, class_reached, gear_tolerance, outside_standard

OFFSET_LIMIT = 0.05
"""flanks farther off than this, in modules, and the gear does not mesh as it should"""
TIP_LIMIT = 0.1
"""a tip diameter farther off than this, in modules, is another gear's"""
OFFSET_WORTH = 0.01
"""flanks farther off than this, in modules, are worth a word"""
COARSE = 0.2
"""part of a tolerance that the mesh's facets may make without a word"""
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


def worst_values(gear: GearResult, *, filtered: bool = False) -> dict[str, float]:
    """Return for each item of ISO 1328-1 the largest |value| [µm] of both sides, where both were measured.

    `filtered` takes profile and helix behind the Gaussian filter; pitch has none.
    """
    sides = [_values(flank, filtered=filtered) for flank in (gear.left, gear.right)]
    return {
        item: max(one, other)
        for (item, one), other in zip(sides[0].items(), sides[1].values(), strict=True)
        if one is not None and other is not None
    }


def _values(flank: Flank, *, filtered: bool) -> dict[str, float | None]:
    """Return the items of one side; None: not measured."""
    items = {
        "profile_slope": _steepest(flank.profile, filtered=filtered),
        "profile_form": flank.profile_form_um,
        "profile_total": flank.profile_total_um,
        "helix_slope": _steepest(flank.helix, filtered=filtered),
        "helix_form": flank.helix_form_um,
        "helix_total": flank.helix_total_um,
    }
    if filtered:
        items |= {item: flank.filtered.get(f"{item}_um") for item in items if not item.endswith("slope")}
    items = {item: None if getattr(flank, f"{item}_um") is None else v for item, v in items.items()}
    return items | {"single_pitch": flank.single_pitch_um, "cumulative_pitch": flank.cumulative_pitch_um}


def _steepest(traces: tuple[Trace, ...], *, filtered: bool) -> float:
    figures: list[Trace | Figures] = [t.filtered if filtered and t.filtered else t for t in traces]
    return max((abs(f.slope_um) for f in figures), default=0.0)


def _classes(gear: GearResult, size: GearSize, values: dict[str, float]) -> dict[str, int | None]:
    """Return the class reached per item, of the runout, and overall."""
    classes = {item: class_reached(item, size, value) for item, value in values.items()}
    reached = [classes.get(item) for item in GRADED]
    known = [a for a in reached if a is not None]
    if gear.runout_um is not None:
        classes["runout"] = class_reached("runout", size, gear.runout_um)
    return classes | {"overall": max(known) if len(known) == len(reached) else None}


def grade_gear(gear: GearResult) -> tuple[GearResult, list[str]]:
    """Grade by ISO 1328-1:2013: by the values as read, and beside it by the filtered ones.

    Returns:
        the gear with the class reached per item and "overall" (None: worse than 11, or not all items
        measured) and the tolerances of the reference's class [µm], and sentences: what exceeds its tolerance,
        or why nothing is graded.

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
        return gear, [f"not graded: {sentence}" for sentence in outside]
    values = worst_values(gear)
    graded = replace(
        gear,
        accuracy_class=_classes(gear, size, values),
        accuracy_class_filtered=_classes(gear, size, worst_values(gear, filtered=True)),
    )
    allowed = reference.accuracy_class
    if allowed is None:
        return graded, []
    tolerances = {item: gear_tolerance(item, size, allowed) for item in GRADED}
    findings = [
        f"{_WORDS[item]} {value:.1f} µm exceeds the {tolerances[item]:g} µm of class {allowed}"
        for item, value in values.items()
        if value > tolerances[item]
    ]
    return replace(graded, tolerances_um=tolerances), findings


def judge_gear(
    gear: GearResult, nominal: GearNominal | None, *, whole: bool, unmeasured: dict[str, str]
) -> tuple[GearResult, Verdict, list[str]]:
    """Return the gear with its classes, the verdict and the findings, most important first."""
    result, exceeded = grade_gear(gear)
    classes = result.accuracy_class
    wrong = _unfinished(gear, nominal, whole=whole) + damaged(gear)
    notes: list[str] = []
    if nominal is None:
        if wrong:
            return result, Verdict.NOT_GRADED, [*wrong, *exceeded]
    else:
        notes = _infeed(gear, unmeasured)
        if abs(gear.flank_offset_um or 0.0) > 1000 * OFFSET_LIMIT * nominal.normal_module_mm:
            wrong, notes = wrong + notes, []
        wrong += _tip(gear, nominal)
        notes += _usable(gear, nominal) + _coarse(result)
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


def _usable(gear: GearResult, nominal: GearNominal) -> list[str]:
    """Say where the usable flank begins higher or ends lower than the nominal's."""
    words = []
    start, end = gear.form_diameter_mm, gear.tip_form_diameter_mm
    if gear.undercut and start is not None:
        words.append(f"the teeth are undercut: the usable flank begins at Ø {start:.3f} mm")
    elif start is not None and start > geometry(nominal).form_diameter + 1e-6:
        words.append(
            f"the fillet reaches up to Ø {start:.3f} mm, the nominal's to "
            f"Ø {geometry(nominal).form_diameter:.3f} mm: profiles are evaluated above it"
        )
    if gear.chamfered:
        words.append(f"the tips are chamfered or rounded from Ø {end:.3f} mm on")
    return words


def _coarse(gear: GearResult) -> list[str]:
    """Say where the mesh's own facets make a good part of a tolerance."""
    worst: dict[str, float] = {}
    for flank in (gear.left, gear.right):
        for item in gear.tolerances_um:
            worst[item] = max(worst.get(item, 0.0), flank.uncertainty.get(f"{item}_um", 0.0))
    return [
        f"the mesh's facets alone can make {worst[item]:.1f} µm of the {_WORDS[item]}, "
        f"of which {tolerance:g} µm are allowed"
        for item, tolerance in gear.tolerances_um.items()
        if worst[item] > COARSE * tolerance
    ]


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
