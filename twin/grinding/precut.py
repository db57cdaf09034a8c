"""A gear cut before, with stock left for grinding, as the blank of a job."""

import math
from dataclasses import dataclass, fields, replace
from typing import Annotated

import numpy as np
from msgspec import Meta

from twin.cutting.section import Section
from twin.errors import InputError
from twin.grinding.gap import Gap, gap_of
from twin.inspection.involute import Involute, geometry
from twin.inspection.nominal import GearNominal

FLANK_POINTS = 40
FILLET_POINTS = 12
OVER = 0.1
"""modules that the section goes on beyond the blank's largest diameter"""
STEP = 1e-9
"""[rad] by which each point of a side stands further round than the one below it"""
POINTED = 0.02
"""modules of tooth thickness at which the section's teeth end at the latest"""


@dataclass(frozen=True, slots=True, kw_only=True)
class PrecutGear:
    """`[work.gear]`: the blank has gaps already; what is left out is as in [nominal]."""

    stock_per_flank_mm: Annotated[float, Meta(ge=0)]
    """on flanks and root, normal to them"""
    gap_phase_deg: float = 0.0
    """direction of the middle of gap 1 in the front face, from the part's +X counter-clockwise"""
    number_of_teeth: Annotated[int, Meta(ge=3)] | None = None
    normal_module_mm: Annotated[float, Meta(gt=0)] | None = None
    helix_angle_deg: float | None = None
    """+ right-hand"""
    normal_pressure_angle_deg: float | None = None
    profile_shift: float | None = None
    dedendum_factor: Annotated[float, Meta(gt=0)] | None = None
    tip_radius_factor: Annotated[float, Meta(gt=0, le=1)] = 0.38
    """fillet of the gaps, in modules"""

    def nominal(self) -> GearNominal:
        """The gear without its stock. Raises InputError where number of teeth or module are not known."""
        if self.number_of_teeth is None or self.normal_module_mm is None:
            raise InputError(
                "the gear's number_of_teeth and normal_module_mm are not known",
                remedy='valid: both here, or [nominal] kind = "gear"',
            )
        given = {
            "helix_angle_deg": self.helix_angle_deg,
            "normal_pressure_angle_deg": self.normal_pressure_angle_deg,
            "profile_shift": self.profile_shift,
            "dedendum_factor": self.dedendum_factor,
        }
        gear = GearNominal(number_of_teeth=self.number_of_teeth, normal_module_mm=self.normal_module_mm)
        return replace(gear, **{name: value for name, value in given.items() if value is not None})

    def completed(self, nominal: GearNominal) -> "PrecutGear":
        """With what is left out taken from the nominal."""
        names = [f.name for f in fields(self) if getattr(self, f.name) is None]
        return replace(self, **{name: getattr(nominal, name) for name in names})

    def section(self, blank_radius: float) -> Section:
        """Transverse section of the gear with its stock, out to the blank. Raises InputError for no gear."""
        gear = geometry(self.nominal())
        gap = gap_of(gear, stock=self.stock_per_flank_mm, fillet_factor=self.tip_radius_factor)
        outer = min(blank_radius + OVER * gear.module, _pointed(gap, gear))
        if outer <= gap.root_radius + 0.1 * gear.module:
            raise InputError(
                f"a blank of Ø {2 * blank_radius:g} mm holds no gaps down to Ø {2 * gap.root_radius:.3f} mm",
                remedy=f"diameter_mm near the tip diameter, {gear.tip_diameter:.3f}",
            )
        roll = np.linspace(gap.first_roll**1.5, gap.roll_at(outer) ** 1.5, FLANK_POINTS) ** (2.0 / 3.0)
        half = np.vstack([gap.fillet(FILLET_POINTS)[0], gap.flank(roll)[0]])
        keep = np.concatenate([[True], np.hypot(*np.diff(half, axis=0).T) > 1e-9])
        side = half[keep] @ [1.0, 1j]
        # a flank that is radial inside its base circle goes on by so little
        outwards = np.maximum.accumulate(np.angle(side)) + STEP * np.arange(len(side))
        side = np.hypot(side.real, side.imag) * (np.cos(outwards) + 1j * np.sin(outwards))
        one = np.concatenate([side.conj()[::-1], side])
        middles = math.radians(self.gap_phase_deg) + 2.0 * math.pi * np.arange(gear.teeth) / gear.teeth
        around = (np.exp(1j * middles)[:, None] * one).ravel()
        return Section(outline=np.column_stack([around.real, around.imag]), twist=gear.twist)


def _pointed(gap: Gap, gear: Involute) -> float:
    """Radius at which the tooth between two gaps is no thicker than POINTED [mm]."""

    def thick(radius: float) -> float:
        point = gap.flank(np.array([gap.roll_at(radius)]))[0][0]
        return 2.0 * radius * (math.pi / gear.teeth - math.atan2(point[1], point[0]))

    low, high = max(gap.base_radius, gap.root_radius), 2.0 * gear.tip_diameter
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if thick(middle) > POINTED * gear.module else (low, middle)
    return low
