"""The hob as it is mounted: does it fit the nominal gear, and its own swivel?"""

import math
from collections.abc import Iterator

from controller.laws.gearbox import SyncKind
from twin.advice.advice import Advice
from twin.advice.gear_law import (
    generating_flat,
    roll_angle,
    swivel_widening,
    transverse_pressure_angle,
)
from twin.advice.kinds import Kind
from twin.advice.limits import limit_of, pitch_diameter
from twin.advice.moment import Engagement
from twin.advice.scene import Scene
from twin.cutters.hob import Hob
from twin.inspection.nominal import GearNominal, PolygonNominal

SAME = 1e-6
"""relative: two catalogue figures that agree"""
_WIDENING_UM = 10.0
"""[µm] per flank, where there is no nominal gear to judge by"""


def judge_hob(scene: Scene, engagement: Engagement) -> Iterator[Advice]:
    """Advice on the hob itself, at the block that engages the gear box."""
    hob, nominal = engagement.mounted.tool, scene.job.nominal
    if engagement.gear.kind is not SyncKind.HOBBING or not isinstance(hob, Hob):
        return
    if isinstance(nominal, GearNominal):
        yield from _catalogue(hob, nominal)
        yield from _flats(hob, nominal, engagement)
    if not isinstance(nominal, PolygonNominal):
        yield from _swivel(hob, nominal, engagement)


def _catalogue(hob: Hob, nominal: GearNominal) -> Iterator[Advice]:
    pairs = (
        ("module", hob.normal_module_mm, nominal.normal_module_mm, "mm"),
        ("pressure angle", hob.pressure_angle_deg, nominal.normal_pressure_angle_deg, "°"),
    )
    for name, has, wants, unit in pairs:
        if not math.isclose(has, wants, rel_tol=SAME):
            found = f"{name} {has:g} {unit} of the hob, {wants:g} {unit} of the gear"
            yield Advice(kind=Kind.HOB, found=found, span=None, value=has - wants)


def _swivel(hob: Hob, nominal: GearNominal | None, engagement: Engagement) -> Iterator[Advice]:
    """η = β − γ_0; a wrong one widens the gaps."""
    helix = nominal.helix_angle_deg if nominal else engagement.couple.helix_angle
    wanted = math.radians(helix or 0.0) - hob.lead_angle
    error = engagement.mounted.swivel - wanted
    widening = 1000.0 * swivel_widening(
        pitch_diameter=hob.pitch_diameter, error=error, pressure=math.radians(hob.pressure_angle_deg)
    )
    if nominal:
        limit = limit_of(nominal, "profile_form")
        allowed, reason = limit.um, limit.reason
    else:
        allowed, reason = _WIDENING_UM, f"{_WIDENING_UM:g} µm"
    if widening > allowed:
        found = (
            f"swivel {math.degrees(engagement.mounted.swivel):.3f}°, which widens every gap by "
            f"{widening:.1f} µm a flank, more than {reason}"
        )
        valid = f"swivel_deg = {math.degrees(wanted):.3f}"
        yield Advice(kind=Kind.SWIVEL, found=found, span=engagement.span, valid=valid, value=widening)


def _flats(hob: Hob, nominal: GearNominal, engagement: Engagement) -> Iterator[Advice]:
    """δ_y is largest at the tip of the tooth."""
    pressure = math.radians(nominal.normal_pressure_angle_deg)
    helix = math.radians(nominal.helix_angle_deg)
    diameter = pitch_diameter(nominal)
    base = diameter / 2.0 * math.cos(transverse_pressure_angle(pressure=pressure, helix=helix))
    tip = nominal.tip_diameter_mm or diameter + 2.0 * nominal.normal_module_mm * (1.0 + nominal.profile_shift)
    flat = 1000.0 * generating_flat(
        base_radius=base,
        roll=roll_angle(radius=tip / 2.0, base_radius=base),
        starts=hob.starts,
        gashes=hob.gashes,
        teeth=nominal.number_of_teeth,
    )
    limit = limit_of(nominal, "profile_form")
    if flat > limit.um:
        found = f"flats of {flat:.1f} µm at the tip, more than {limit.reason}"
        yield Advice(kind=Kind.GENERATING_FLATS, found=found, span=engagement.span, value=flat)
