"""A gear from its mesh, measured against its nominal or against the best fit."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from twin.errors import InputError
from twin.inspection.balls import choose_ball, measure_balls, over_balls
from twin.inspection.damage import holes
from twin.inspection.fit import Found, as_nominal, hand
from twin.inspection.flanks import Measured, measure_flanks, usual_teeth
from twin.inspection.involute import Involute, geometry
from twin.inspection.nominal import GearNominal
from twin.inspection.reading import Placed, locate, pitch_readings
from twin.inspection.recognise import Outline
from twin.inspection.result import Flank, GearResult, Trace
from twin.inspection.size import measure_span, tip_and_root_radii
from twin.inspection.solid import Floats, Solid
from twin.inspection.thickness import measure_thickness
from twin.inspection.usable import Usable, usable_flank

NO_HELIX = 5e-5
"""a helix angle [degrees] below this is the noise of the figures: none"""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Sizes:
    """Span, balls and thickness: fields of the result, their uncertainties, and why some are missing."""

    values: dict[str, float | None]
    ball_depth_um: Floats
    uncertainty: dict[str, float]
    unmeasured: dict[str, str]


def measure_gear(
    solid: Solid,
    outline: Outline,
    found: Found,
    nominal: GearNominal | None,
    teeth: Sequence[int] | Literal["all"] | None = None,
) -> tuple[GearResult, dict[str, str]]:
    """Measure a gear against its nominal, or against the best fit where there is none.

    Args:
        solid: the part.
        outline: where its teeth stand.
        found: what gear they make.
        nominal: what gear it should be.
        teeth: numbers of the teeth to trace, from 1, or all; None: four, equally spaced.

    Returns:
        the result, and for every result key that cannot be measured the reason.

    Raises:
        InputError: a tooth to trace that the gear does not have.

    """
    reference = nominal if nominal is not None else as_nominal(found, outline)
    gear = geometry(reference)
    traced = _chosen(teeth, gear.teeth)
    placed = locate(
        solid,
        Placed(gear=gear, phase=outline.phase, middle=outline.middle, low=outline.low, high=outline.high),
    )
    tips, gaps = tip_and_root_radii(solid, placed, root_radius=outline.root_radius)
    shortest = 2 * float(min(tips.min(), gear.tip_diameter / 2))
    usable = usable_flank(solid, placed, root_radius=outline.root_radius, tip_diameter=shortest)
    measured = measure_flanks(solid, placed, usable, traced)
    left, right = measured.left, measured.right
    sizes = _sizes(solid, placed, usable, measured, reference=reference, tips=tips)
    unmeasured = dict(sizes.unmeasured)
    offset = _offset(solid, placed)
    if offset is None:
        unmeasured["flank_offset_um"] = "no flank crosses the measuring circle once"
    if nominal is None:
        left, right = (_without_slopes(flank, found, reference, unmeasured) for flank in (left, right))
    twist = gear.twist + _twist_error(left.helix, right.helix, gear)
    helix_deg = math.degrees(math.asin(min(max(twist * gear.teeth * gear.module / 2, -1.0), 1.0)))
    low, high = (2 * float(gear.radius_at(roll)) for roll in measured.profile_range)
    result = GearResult(
        number_of_teeth=gear.teeth,
        normal_module_mm=found.module,
        helix_angle_deg=0.0 if abs(helix_deg) < NO_HELIX else helix_deg,
        hand=hand(helix_deg),
        lead_mm=2 * math.pi / abs(twist) if hand(helix_deg) != "spur" else None,
        profile_shift=found.shift,
        tip_diameter_mm=2 * float(tips.mean()),
        root_diameter_mm=2 * float(gaps.mean()),
        span_teeth=gear.span_teeth(),
        span_mm=sizes.values["span_mm"],
        pin_diameter_mm=sizes.values["pin_diameter_mm"],
        over_pins_mm=sizes.values["over_pins_mm"],
        runout_um=sizes.values["runout_um"],
        flank_offset_um=offset,
        left=left,
        right=right,
        reference=reference,
        profile_range_mm=(low, high),
        teeth_range_mm=(outline.low, outline.high),
        measuring_plane_mm=placed.middle,
        phase_deg=math.degrees(placed.phase),
        tooth_thickness_mm=sizes.values["tooth_thickness_mm"],
        chordal_thickness_mm=sizes.values["chordal_thickness_mm"],
        chordal_height_mm=sizes.values["chordal_height_mm"],
        form_diameter_mm=2 * float(gear.radius_at(usable.start)),
        tip_form_diameter_mm=2 * float(gear.radius_at(usable.end)),
        undercut=usable.undercut,
        chamfered=usable.chamfered,
        helix_range_mm=placed.helix_range,
        ball_depth_um=sizes.ball_depth_um,
        uncertainty=sizes.uncertainty,
    )
    return result, holes(result, traced) | unmeasured


def _chosen(teeth: Sequence[int] | Literal["all"] | None, count: int) -> tuple[int, ...]:
    """Return the teeth to trace, counted from 0."""
    if teeth is None:
        return usual_teeth(count)
    if teeth == "all":
        return tuple(range(count))
    wrong = [tooth for tooth in teeth if not 1 <= tooth <= count]
    if wrong or not teeth:
        what = f"there is no tooth {wrong[0]}" if wrong else "no tooth is named"
        raise InputError(f"teeth to measure: {what}", remedy=f"valid: 1 to {count}")
    return tuple(sorted({tooth - 1 for tooth in teeth}))


def _sizes(
    solid: Solid, placed: Placed, usable: Usable, measured: Measured, *, reference: GearNominal, tips: Floats
) -> _Sizes:
    """Measure span, balls and tooth thickness."""
    gear = placed.gear
    tip_radius = float(gear.radius_at(usable.end))
    unmeasured: dict[str, str] = {}
    uncertainty: dict[str, float] = {}
    span, reason = measure_span(
        solid,
        placed,
        gear.span_teeth(),
        form_radius=float(gear.radius_at(usable.start)),
        tip_radius=tip_radius,
    )
    if span is None:
        unmeasured["span_mm"] = reason
    else:
        # jaws feel the mesh's corners; between them the flank may stand out as far as chords cut it short
        uncertainty["span_mm"] = 2 * measured.largest_facet_um / 1000 * math.cos(gear.base_helix)
    ball = reference.pin_diameter_mm
    if ball is None:
        ball = choose_ball(gear, tip_radius=tip_radius)
    lie, reason = None, "no usual ball touches the flanks between form and tip diameter"
    if ball is not None:
        lie, reason = measure_balls(solid, placed, ball, tip_radius=tip_radius)
    over = runout = None
    depth = np.zeros(0)
    if lie is None or ball is None:
        unmeasured |= {"over_pins_mm": reason, "runout_um": reason}
        if ball is None:
            unmeasured["pin_diameter_mm"] = reason
    else:
        centres, facet = lie
        over, runout = over_balls(centres, ball), 1000 * float(np.ptp(centres))
        depth = 1000 * (centres - centres.mean())
        uncertainty["over_pins_mm"] = abs(over - over_balls(centres - facet, ball))
        uncertainty["runout_um"] = 1000 * float(np.ptp(facet))
    thickness, reason = measure_thickness(solid, placed, usable, tip_diameter=2 * float(tips.mean()))
    if thickness is None:
        keys = ("tooth_thickness_mm", "chordal_thickness_mm", "chordal_height_mm")
        unmeasured |= dict.fromkeys(keys, reason)
    else:
        uncertainty |= dict.fromkeys(("tooth_thickness_mm", "chordal_thickness_mm"), thickness.facet)
    return _Sizes(
        values={
            "span_mm": span,
            "pin_diameter_mm": ball,
            "over_pins_mm": over,
            "runout_um": runout,
            "tooth_thickness_mm": thickness.normal if thickness else None,
            "chordal_thickness_mm": thickness.chord if thickness else None,
            "chordal_height_mm": thickness.height if thickness else None,
        },
        ball_depth_um=depth,
        uncertainty=uncertainty,
        unmeasured=unmeasured,
    )


def _offset(solid: Solid, placed: Placed) -> float | None:
    """Return the mean place of all flanks on the measuring circle [µm], normal to them."""
    left, right = pitch_readings(solid, placed).deviation[:, 0, 0]
    if not (np.isfinite(left).any() and np.isfinite(right).any()):
        return None
    return float(np.nanmean(left) + np.nanmean(right)) / 2 * math.cos(placed.gear.base_helix)


def _without_slopes(flank: Flank, found: Found, fit: GearNominal, unmeasured: dict[str, str]) -> Flank:
    """Take out what a best fit cannot show: the slopes it was fitted to."""
    filtered = dict(flank.filtered)
    if fit.normal_module_mm == found.module:
        reason = f"no nominal and no standard module near {found.module:.4f} mm: traced against the best fit"
        fitted = {"profile_slope_um": reason, "profile_total_um": reason}
        unmeasured |= fitted
        filtered |= dict.fromkeys(fitted)
        flank = replace(flank, profile_slope_um=None, profile_total_um=None)
    if fit.helix_angle_deg != 0.0:
        reason = "no nominal helix angle: traced against the best fit"
        fitted = {"helix_slope_um": reason, "helix_total_um": reason}
        unmeasured |= fitted
        filtered |= dict.fromkeys(fitted)
        flank = replace(flank, helix_slope_um=None, helix_total_um=None)
    return replace(flank, filtered=filtered)


def _twist_error(left: tuple[Trace, ...], right: tuple[Trace, ...], gear: Involute) -> float:
    """Return the mean rotation of the traces against the reference [rad/mm], + right-hand."""
    traces = (*left, *right)
    if not traces:
        return 0.0
    sense = -1.0 if gear.helix < 0 else 1.0
    slope = np.mean([t.slope_um / (t.evaluation[1] - t.evaluation[0]) for t in traces])
    return sense * float(slope) / 1000 / gear.base_radius
