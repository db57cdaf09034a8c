"""How much is worth advice: half of the tolerance in the class that the nominal names, or a fixed figure."""

import math
from dataclasses import dataclass

from twin.advice.gear_law import reference_diameter
from twin.inspection.nominal import GearNominal
from twin.inspection.tolerances import CLASSES, GearSize, gear_tolerance

SHARE = 0.5
"""of the tolerance that one cause may take for itself"""
_SYMBOLS = {"profile_form": "f_fα", "helix_form": "f_fβ", "helix_slope": "f_Hβ", "runout": "F_r"}
_UNGRADED_UM = {"profile_form": 10.0, "helix_form": 10.0, "helix_slope": 10.0, "runout": 50.0}
"""[µm] where the nominal names no class"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """What may not be exceeded, and why."""

    um: float
    """[µm]"""
    reason: str
    """for a message, with the tolerance it comes from"""


def limit_of(nominal: GearNominal, item: str, *, share: float = SHARE) -> Limit:
    """The limit of one cause for an item of ISO 1328-1: profile_form, helix_form, helix_slope or runout."""
    grade = nominal.accuracy_class
    if grade is None or grade not in CLASSES:
        um = _UNGRADED_UM[item]
        return Limit(um=um, reason=f"{um:g} µm, as the nominal names no accuracy class")
    size = GearSize(
        number_of_teeth=nominal.number_of_teeth,
        reference_diameter=pitch_diameter(nominal),
        normal_module=nominal.normal_module_mm,
        face_width=nominal.face_width_mm or 0.0,
        helix_angle=nominal.helix_angle_deg,
    )
    whole = gear_tolerance(item, size, grade)
    part = "half of " if share == SHARE else ""
    return Limit(um=share * whole, reason=f"{part}{_SYMBOLS[item]} {whole:g} µm of class {grade}")


def pitch_diameter(nominal: GearNominal) -> float:
    """d [mm]."""
    return reference_diameter(
        teeth=nominal.number_of_teeth,
        module=nominal.normal_module_mm,
        helix=math.radians(nominal.helix_angle_deg),
    )
