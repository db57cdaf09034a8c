"""G81 against the hob and the nominal gear: T, L, Q and P."""

import math
from collections.abc import Iterator

from controller.laws.gearbox import SyncKind
from twin.advice.advice import Advice
from twin.advice.gear_law import helix_slope, work_rate
from twin.advice.hob_data import SAME
from twin.advice.kinds import Kind
from twin.advice.limits import limit_of
from twin.advice.moment import Engagement
from twin.advice.scene import Scene
from twin.cutters.hob import Hob
from twin.inspection.nominal import GearNominal


def judge_gear_box(scene: Scene, engagement: Engagement) -> Iterator[Advice]:
    """Advice on T, L, Q and P, at the block of G81."""
    hob, nominal = engagement.mounted.tool, scene.job.nominal
    if engagement.gear.kind is not SyncKind.HOBBING or not isinstance(hob, Hob):
        return
    yield from _hand_of_hob(hob, engagement)
    if isinstance(nominal, GearNominal):
        yield from _teeth(hob, nominal, engagement)
        yield from _helix(scene, nominal, engagement)


def _hand_of_hob(hob: Hob, engagement: Engagement) -> Iterator[Advice]:
    starts = engagement.gear.numerator
    if starts * hob.sign < 0:
        found = (
            f"L{starts} with a {hob.hand}-hand hob: the work turns against the thread, the teeth are cut away"
        )
        yield Advice(
            kind=Kind.HAND_OF_HOB, found=found, span=engagement.span, valid=f"L{-starts}", value=float(starts)
        )


def _teeth(hob: Hob, nominal: GearNominal, engagement: Engagement) -> Iterator[Advice]:
    """One turn of the hob moves the work on by as many teeth as the hob has starts: z = z_0 T / |L|."""
    wanted, gear = nominal.number_of_teeth, engagement.gear
    teeth, starts = gear.denominator, abs(gear.numerator)
    if hob.starts * teeth == wanted * starts:
        return
    cut = hob.starts * teeth / starts
    result = f"{cut:g} teeth cut, {wanted} wanted"
    if teeth != wanted:
        found = f"T{teeth} and L{gear.numerator}: {result}"
        yield Advice(
            kind=Kind.TEETH, found=found, span=engagement.span, valid=f"T{wanted}", value=float(teeth)
        )
    if starts != hob.starts:
        found = f"L{gear.numerator} with {hob.starts} start(s) of the hob: {result}"
        valid = f"L{int(math.copysign(hob.starts, gear.numerator))}"
        yield Advice(
            kind=Kind.STARTS, found=found, span=engagement.span, valid=valid, value=float(gear.numerator)
        )


def _helix(scene: Scene, nominal: GearNominal, engagement: Engagement) -> Iterator[Advice]:
    """The turn of the work per axial travel, against what the nominal needs."""
    gear = engagement.gear
    rate = gear.axial_rate if gear.axial == scene.z_column else 0.0
    helix = math.radians(nominal.helix_angle_deg)
    needed = work_rate(teeth=nominal.number_of_teeth, module=nominal.normal_module_mm, helix=helix)
    slope = 1000.0 * helix_slope(
        rate=rate,
        teeth=nominal.number_of_teeth,
        module=nominal.normal_module_mm,
        helix=helix,
        pressure=math.radians(nominal.normal_pressure_angle_deg),
        width=nominal.face_width_mm or scene.job.work.length_mm,
    )
    limit = limit_of(nominal, "helix_slope")
    if abs(slope) <= limit.um:
        return
    result = f"f_Hβ {slope:+.0f} µm to be expected, more than {limit.reason}"
    nominal_words = f"Q{nominal.normal_module_mm:g} P{nominal.helix_angle_deg:g}"
    if rate == 0.0:
        found = f"G81 without Q and P for a helix angle of {nominal.helix_angle_deg:g}°: {result}"
        yield Advice(
            kind=Kind.HELIX_MISSING, found=found, span=engagement.span, valid=nominal_words, value=slope
        )
    elif needed == 0.0:
        found = f"{_words(engagement)} for a spur gear: {result}"
        yield Advice(kind=Kind.HELIX_UNWANTED, found=found, span=engagement.span, value=slope)
    elif rate * needed < 0.0:
        hand = "right" if nominal.helix_angle_deg > 0.0 else "left"
        found = f"{_words(engagement)} for a {hand}-hand gear: {result}"
        angle = engagement.couple.helix_angle
        valid = f"P{nominal.helix_angle_deg if angle is None else -angle:g}"
        yield Advice(kind=Kind.HAND_OF_GEAR, found=found, span=engagement.span, valid=valid, value=slope)
    else:
        yield from _lead(nominal, engagement, slope, result)


def _lead(nominal: GearNominal, engagement: Engagement, slope: float, result: str) -> Iterator[Advice]:
    """Q and P make the lead together: whichever is not the gear's own is named."""
    module, angle = engagement.couple.normal_module, engagement.couple.helix_angle
    if module is not None and not math.isclose(module, nominal.normal_module_mm, rel_tol=SAME):
        found = f"Q for a normal module of {module:g} mm, {nominal.normal_module_mm:g} mm wanted: {result}"
        valid = f"Q for {nominal.normal_module_mm:g} mm"
        yield Advice(kind=Kind.MODULE, found=found, span=engagement.span, valid=valid, value=module)
    if angle is None or not math.isclose(angle, nominal.helix_angle_deg, abs_tol=SAME):
        found = f"{_words(engagement)} for a helix angle of {nominal.helix_angle_deg:g}°: {result}"
        valid = f"P{nominal.helix_angle_deg:g}"
        yield Advice(kind=Kind.HELIX_ANGLE, found=found, span=engagement.span, valid=valid, value=slope)


def _words(engagement: Engagement) -> str:
    angle = engagement.couple.helix_angle
    return "the helical compensation" if angle is None else f"P{angle:g}"
