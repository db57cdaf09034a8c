"""A gear from its mesh: found without being told, then measured against its nominal.

The base radius is fitted to the tooth thickness over the radius; with the number of teeth and the twist it
gives helix angle and module, the normal pressure angle being taken from the nominal or as 20°.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import fminbound

from twin.errors import InputError, PartError
from twin.inspection.balls import choose_ball, measure_balls, over_balls
from twin.inspection.flanks import TIP_LIMIT, Placed, locate, measure_flanks, pitch_deviations
from twin.inspection.involute import Involute, geometry, involute
from twin.inspection.nominal import GearNominal
from twin.inspection.recognise import Outline, phase_sums
from twin.inspection.result import Flank, GearResult, Trace
from twin.inspection.sections import circle_crossings, plane_segments_in_parts
from twin.inspection.size import measure_span, tip_and_root_radii
from twin.inspection.solid import Floats, Solid

SPUR_BELOW = 0.1
"""a found helix angle [degrees] below this is a spur gear's deviation"""
NO_HELIX = 5e-5
"""a helix angle [degrees] below this is the noise of the figures: none"""
DEPTH = (0.8, 4.0)
"""possible depths of gear teeth, in modules"""
MOST_SHIFT = 1.5
"""largest possible |x| of a tooth thickness"""
# fmt: off
STANDARD_MODULES = (
    0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.125, 1.25, 1.375, 1.5, 1.75, 2, 2.25, 2.5, 2.75, 3, 3.25,
    3.5, 3.75, 4, 4.5, 5, 5.5, 6, 6.5, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20, 22, 25, 28, 32, 36, 40, 45, 50,
)
# fmt: on
"""ISO 54, both series, and the usual ones below 1 [mm]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Found:
    """What a gear is, by best fit, without a nominal."""

    teeth: int
    module: float
    """m_n [mm], for the pressure angle assumed"""
    helix_deg: float
    """beta, + right-hand"""
    shift: float
    """x of the tooth thickness, in modules"""
    pressure_deg: float
    """alpha_n assumed"""
    straying: float
    """largest departure of the mean tooth from the involute, at any height [mm]"""

    @property
    def hand(self) -> str:
        """`spur`, `right` or `left`."""
        return hand(self.helix_deg)

    def __str__(self) -> str:
        helix = "spur" if self.hand == "spur" else f"{abs(self.helix_deg):.2f}° {self.hand}-hand"
        return f"{self.teeth} teeth, normal module {self.module:.3f} mm, {helix}"


def hand(helix_deg: float) -> str:
    """Name the hand of a helix angle [degrees]."""
    if abs(helix_deg) < SPUR_BELOW:
        return "spur"
    return "right" if helix_deg > 0 else "left"


def find_gear(solid: Solid, outline: Outline, *, pressure_deg: float = 20.0) -> Found:
    """Fit an involute gear to an outline of regular teeth.

    Raises:
        PartError: the flanks are no involutes.

    """
    radius, half_tooth = _thickness(solid, outline, 0.45, 0.95)
    if len(radius) < 10:
        raise PartError(f"{outline.count} teeth stand about the axis, but their flanks have holes")
    found = _fit(outline, radius, half_tooth, pressure_deg)
    # the involute may begin higher or reach lower than assumed: fit again from where this fit has it begin
    form = _geometry_of(found, outline).form_diameter / 2
    fraction = max((form - outline.root_radius) / outline.depth, 0.05)
    if fraction < 0.85:
        radius, half_tooth = _thickness(solid, outline, fraction, 0.95)
        found = _fit(outline, radius, half_tooth, pressure_deg)
        _geometry_of(found, outline)
    return found


def measure_gear(
    solid: Solid, outline: Outline, found: Found, nominal: GearNominal | None
) -> tuple[GearResult, dict[str, str]]:
    """Measure a gear against its nominal, or against the best fit where there is none.

    Returns:
        the result, and for every result key that cannot be measured the reason.

    """
    reference = nominal if nominal is not None else _as_nominal(found, outline)
    gear = geometry(reference)
    placed = locate(
        solid, gear, phase=outline.phase, middle=outline.middle, low=outline.low, high=outline.high
    )
    tips, gaps = tip_and_root_radii(solid, placed, root_radius=outline.root_radius)
    tip_diameter = 2 * float(min(tips.min(), gear.tip_diameter / 2))
    left, right = measure_flanks(solid, placed, tip_diameter=tip_diameter)
    unmeasured: dict[str, str] = {}
    offset = _offset(solid, placed)
    if offset is None:
        unmeasured["flank_offset_um"] = "no flank crosses the measuring circle once"
    if nominal is None:
        left, right = (_without_slopes(flank, found, reference, unmeasured) for flank in (left, right))
    k = gear.span_teeth()
    span, reason = measure_span(solid, placed, k, tip_radius=tip_diameter / 2)
    if span is None:
        unmeasured["span_mm"] = reason
    ball = reference.pin_diameter_mm
    if ball is None:
        ball = choose_ball(gear, tip_radius=tip_diameter / 2)
    centres, reason = None, "no usual ball touches the flanks between form and tip diameter"
    if ball is not None:
        centres, reason = measure_balls(solid, placed, ball, tip_radius=tip_diameter / 2)
    if centres is None:
        unmeasured |= {"over_pins_mm": reason, "runout_um": reason}
        if ball is None:
            unmeasured["pin_diameter_mm"] = reason
    twist = gear.twist + _twist_error(left.helix, right.helix, gear)
    helix_deg = math.degrees(math.asin(min(max(twist * gear.teeth * gear.module / 2, -1.0), 1.0)))
    form, tip = (float(gear.roll_length(d)) for d in (gear.form_diameter, tip_diameter))
    result = GearResult(
        number_of_teeth=gear.teeth,
        normal_module_mm=found.module,
        helix_angle_deg=0.0 if abs(helix_deg) < NO_HELIX else helix_deg,
        hand=hand(helix_deg),
        lead_mm=2 * math.pi / abs(twist) if hand(helix_deg) != "spur" else None,
        profile_shift=found.shift,
        tip_diameter_mm=2 * float(tips.mean()),
        root_diameter_mm=2 * float(gaps.mean()),
        span_teeth=k,
        span_mm=span,
        pin_diameter_mm=ball,
        over_pins_mm=over_balls(centres, ball) if centres is not None and ball is not None else None,
        runout_um=1000 * float(np.ptp(centres)) if centres is not None else None,
        flank_offset_um=offset,
        left=left,
        right=right,
        reference=reference,
        profile_range_mm=(
            gear.form_diameter,
            2 * float(gear.radius_at(form + TIP_LIMIT * (tip - form))),
        ),
        teeth_range_mm=(outline.low, outline.high),
        measuring_plane_mm=placed.middle,
        phase_deg=math.degrees(placed.phase),
    )
    return result, unmeasured


def _offset(solid: Solid, placed: Placed) -> float | None:
    """Return the mean place of all flanks on the measuring circle [µm], normal to them."""
    left, right = pitch_deviations(solid, placed)
    if not (np.isfinite(left).any() and np.isfinite(right).any()):
        return None
    return float(np.nanmean(left) + np.nanmean(right)) / 2 * math.cos(placed.gear.base_helix)


def _without_slopes(flank: Flank, found: Found, fit: GearNominal, unmeasured: dict[str, str]) -> Flank:
    """Take out what a best fit cannot show: the slopes it was fitted to."""
    if fit.normal_module_mm == found.module:
        reason = f"no nominal and no standard module near {found.module:.4f} mm: traced against the best fit"
        unmeasured |= {"profile_slope_um": reason, "profile_total_um": reason}
        flank = replace(flank, profile_slope_um=None, profile_total_um=None)
    if fit.helix_angle_deg != 0.0:
        reason = "no nominal helix angle: traced against the best fit"
        unmeasured |= {"helix_slope_um": reason, "helix_total_um": reason}
        flank = replace(flank, helix_slope_um=None, helix_total_um=None)
    return flank


def _twist_error(left: tuple[Trace, ...], right: tuple[Trace, ...], gear: Involute) -> float:
    """Return the mean rotation of the traces against the reference [rad/mm], + right-hand."""
    traces = (*left, *right)
    if not traces:
        return 0.0
    sense = -1.0 if gear.helix < 0 else 1.0
    slope = np.mean([t.slope_um / (t.evaluation[1] - t.evaluation[0]) for t in traces])
    return sense * float(slope) / 1000 / gear.base_radius


def _thickness(solid: Solid, outline: Outline, low: float, high: float) -> tuple[Floats, Floats]:
    """Return radii (n,) [mm] between fractions of the depth and mean half angles of the teeth there [rad].

    The angles are (planes, n), of planes spread over the width.
    """
    radii = outline.root_radius + np.linspace(low, high, 80) * outline.depth
    reach = 0.4 * (outline.high - outline.low)
    heights = outline.middle + reach * np.linspace(-1, 1, 9)
    rows = []
    for part in plane_segments_in_parts(solid, heights):
        crossings = circle_crossings(part, radii)
        shape = (len(part.heights), len(radii))
        place = crossings.plane * len(radii) + crossings.circle
        left, right = phase_sums(crossings, outline.count, place, math.prod(shape))
        half = np.mod(np.angle(left * right.conj()), 2 * math.pi) / (2 * outline.count)
        count = np.bincount(place, minlength=math.prod(shape))
        rows.append((half.reshape(shape), (count == 2 * outline.count).reshape(shape)))
    half, whole = (np.concatenate(column) for column in zip(*rows, strict=True))
    everywhere = whole.all(axis=0)
    return radii[everywhere], half[:, everywhere]


def _fit(outline: Outline, radius: Floats, half_tooth: Floats, pressure_deg: float) -> Found:
    """Name the gear whose involute fits tooth thicknesses (planes, n) over radii (n,) best."""
    mean = half_tooth.mean(axis=0)

    def misfit(base: float) -> float:
        return float(np.var(mean + involute(np.arccos(np.minimum(base / radius, 1.0)))))

    base = np.asarray(fminbound(misfit, 0.5 * radius[0], radius[-1], xtol=1e-9)).item()
    alpha = math.radians(pressure_deg)
    sine = math.sin(math.atan(base * outline.twist)) / math.cos(alpha)
    if abs(sine) >= math.sin(math.radians(80.0)):
        raise PartError(
            f"{outline.count} flutes of a lead of {2 * math.pi / outline.twist:+.2f} mm, too short for a gear"
        )
    beta = math.asin(sine)
    alpha_t = math.atan(math.tan(alpha) / math.cos(beta))
    module = 2 * base * math.cos(beta) / (outline.count * math.cos(alpha_t))
    rest = half_tooth + involute(np.arccos(np.minimum(base / radius, 1.0)))
    at_reference = float(np.mean(rest)) - float(involute(alpha_t))
    shift = (at_reference * outline.count - math.pi / 2) / (2 * math.tan(alpha))
    if not (DEPTH[0] <= outline.depth / module <= DEPTH[1] and abs(shift) <= MOST_SHIFT):
        raise PartError(
            f"{outline.count} regular teeth, {outline.depth:.3f} mm deep, stand about the axis, "
            "but they have no involute flanks"
        )
    return Found(
        teeth=outline.count,
        module=module,
        helix_deg=math.degrees(beta),
        shift=shift,
        pressure_deg=pressure_deg,
        straying=base * float(np.abs(rest - rest.mean()).max()),
    )


def _geometry_of(found: Found, outline: Outline) -> Involute:
    """Work out a found gear. Raises PartError: it is of no possible size or shape."""
    try:
        return geometry(_as_nominal(found, outline))
    except InputError as fault:
        largest = 2 * outline.tip_radius
        raise PartError(
            f"{found.teeth} teeth of normal module {found.module:.5g} mm on a largest diameter of "
            f"{largest:.5g} mm were found: no gear of that size can be measured; the mesh's units may be "
            "wrong, millimetres are expected"
        ) from fault


def _as_nominal(found: Found, outline: Outline) -> GearNominal:
    """Return the nominal to measure a found gear against: standard module, spur where it is close to that."""
    nearest = min(STANDARD_MODULES, key=lambda m: abs(m - found.module))
    module = nearest if abs(found.module - nearest) <= 0.01 * nearest else found.module
    beta = 0.0
    if found.hand != "spur":
        sine = math.sin(math.radians(found.helix_deg)) * module / found.module  # keeps the lead
        beta = math.degrees(math.asin(min(max(sine, -1.0), 1.0)))
    return GearNominal(
        number_of_teeth=found.teeth,
        normal_module_mm=module,
        helix_angle_deg=beta,
        normal_pressure_angle_deg=found.pressure_deg,
        profile_shift=found.shift,
        tip_diameter_mm=2 * outline.tip_radius,
    )
