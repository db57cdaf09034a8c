"""The cylindrical hob with straight gashes (geometry.md 2; DIN 3972, ISO 53)."""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from msgspec import Meta

from twin.cutters.cutter import Cutter
from twin.cutters.profile import ToothProfile
from twin.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Hob:
    """A hob by its catalogue data."""

    normal_module_mm: Annotated[float, Meta(gt=0)]
    """m_n"""
    outside_diameter_mm: Annotated[float, Meta(gt=0)]
    """d_a0"""
    starts: Annotated[int, Meta(ge=1, le=20)] = 1
    """z_0"""
    gashes: Annotated[int, Meta(ge=1, le=100)] = 12
    """n_i"""
    gash: Literal["straight"] = "straight"
    """parallel to the axis, rake face radial"""
    hand: Literal["right", "left"] = "right"
    pressure_angle_deg: Annotated[float, Meta(gt=0, lt=45)] = 20.0
    """alpha_n"""
    addendum_factor: Annotated[float, Meta(gt=0)] = 1.25
    """h_aP0 in modules"""
    tip_radius_factor: Annotated[float, Meta(ge=0)] = 0.38
    """rho_aP0 in modules"""
    dedendum_factor: Annotated[float, Meta(gt=0)] = 1.25
    """h_fP0 in modules: down to the land between the teeth"""
    length_mm: Annotated[float, Meta(gt=0)] | None = None
    """None = longer than any cut needs"""
    shift_mm: float = 0.0
    """of the hob along its axis"""
    swivel_deg: Annotated[float, Meta(ge=-90, le=90)] | None = None
    """eta as the operator set it; None = from the nominal helix and the lead angle"""

    def __post_init__(self) -> None:
        if self.pitch_diameter <= 0 or self.starts * self.normal_module_mm >= self.pitch_diameter:
            raise InputError(
                f"a hob of outside diameter {self.outside_diameter_mm:g} mm is too small for module "
                f"{self.normal_module_mm:g} mm, {self.starts} start(s)",
                remedy=f"more than {(2 * self.addendum_factor + self.starts) * self.normal_module_mm:g} mm",
            )
        self.profile()

    @property
    def sign(self) -> int:
        """+1 for a right-hand thread, −1 for a left-hand one."""
        return 1 if self.hand == "right" else -1

    @property
    def pitch_diameter(self) -> float:
        """d_0 = d_a0 − 2 h_aP0 [mm]."""
        return self.outside_diameter_mm - 2.0 * self.addendum_factor * self.normal_module_mm

    @property
    def lead_angle(self) -> float:
        """gamma_0 [rad], + right-hand: sin gamma_0 = z_0 m_n / d_0."""
        return self.sign * math.asin(self.starts * self.normal_module_mm / self.pitch_diameter)

    @property
    def axial_pitch(self) -> float:
        """p_x = pi m_n / cos gamma_0 [mm]."""
        return math.pi * self.normal_module_mm / math.cos(self.lead_angle)

    def profile(self) -> ToothProfile:
        """Outline in the axial plane: tan alpha_x = tan alpha_n / cos gamma_0."""
        alpha = math.atan(math.tan(math.radians(self.pressure_angle_deg)) / math.cos(self.lead_angle))
        tip = self.outside_diameter_mm / 2.0
        addendum = self.addendum_factor * self.normal_module_mm
        corner = self.tip_radius_factor * self.normal_module_mm
        corner_s = (
            self.axial_pitch / 4.0
            - addendum * math.tan(alpha)
            - corner * (1.0 - math.sin(alpha)) / math.cos(alpha)
        )
        if corner_s < 0:
            largest = (self.axial_pitch / 4.0 - addendum * math.tan(alpha)) * math.cos(alpha)
            largest /= (1.0 - math.sin(alpha)) * self.normal_module_mm
            raise InputError(
                f"tip_radius_factor {self.tip_radius_factor:g} leaves the hob tooth no tip",
                remedy=f"valid: 0 to {largest:.3f}",
            )
        return ToothProfile(
            tip=tip,
            corner_s=corner_s,
            corner_radius=corner,
            flank_angle=alpha,
            root=tip - addendum - self.dedendum_factor * self.normal_module_mm,
            pitch=self.axial_pitch,
        )

    def cutter(self, swivel: float) -> Cutter:
        """The hob set at `swivel` = eta [rad] from the machine's Y (geometry.md 2)."""
        gash = np.arange(self.gashes)
        return Cutter(
            gash_angle=2.0 * math.pi * gash / self.gashes,
            gash_shift=self.shift_mm + self.sign * self.starts * self.axial_pitch * gash / self.gashes,
            profile=self.profile(),
            half_length=math.inf if self.length_mm is None else self.length_mm / 2.0,
            shift=self.shift_mm,
            swivel=math.pi / 2.0 - swivel,
        )
