"""The cylindrical hob (geometry.md 2; DIN 3972, ISO 53)."""

import math
from dataclasses import dataclass, fields
from typing import Annotated, Literal

import numpy as np
from msgspec import Meta

from twin.cutters.cutter import Cutter
from twin.cutters.profile import ToothProfile, tooth_profile
from twin.cutters.rack import Chain, RackTooth
from twin.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class HobErrors:
    """What is wrong with a hob itself (DIN 3968)."""

    gash_rad: tuple[float, ...] = ()
    """how far each rake face stands ahead of its place, the thread where it was"""
    lead_mm: float = 0.0
    """how much longer the lead of its thread is, counted from the hob's middle"""


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
    gash: Literal["straight", "helical"] = "straight"
    """parallel to the axis with radial rake faces, or on a helix, by default at right angles to the thread"""
    gash_lead_mm: float | None = None
    """of helical gashes, + right-hand; None = −pi d_0 / tan gamma_0"""
    hand: Literal["right", "left"] = "right"
    pressure_angle_deg: Annotated[float, Meta(gt=0, lt=45)] = 20.0
    """alpha_n"""
    addendum_factor: Annotated[float, Meta(gt=0)] = 1.25
    """h_aP0 in modules"""
    tip_radius_factor: Annotated[float, Meta(ge=0)] = 0.38
    """rho_aP0 in modules"""
    dedendum_factor: Annotated[float, Meta(gt=0)] = 1.25
    """h_fP0 in modules: down to the land between the teeth"""
    protuberance_mm: Annotated[float, Meta(ge=0)] = 0.0
    """pr_P0: how far the tip stands out of the flank, at right angles to it"""
    protuberance_angle_deg: Annotated[float, Meta(ge=0, lt=45)] = 10.0
    """alpha_prP0 of the protuberance's own flank"""
    chamfer_height_mm: Annotated[float, Meta(ge=0)] = 0.0
    """of the flank that chamfers the gear's tip (semi-topping), above the land"""
    chamfer_angle_deg: Annotated[float, Meta(gt=0, lt=80)] = 45.0
    """alpha_KP0 of that flank"""
    profile: Chain | None = None
    """the tooth instead of all that: (half-width, depth below the tip[, radius of the arc to the next]) [mm]
    in the plane of the cutting edge, from the tip down to the land; radius + bulging, − hollow"""
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
        self._check_gashes()
        self._check_profile()
        self.tooth()

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

    @property
    def twist(self) -> float:
        """Turn of the edges about the axis per way along it [rad/mm], + right-hand; 0 = straight gashes.

        At right angles to the thread on the pitch cylinder, whose tangent is (cos gamma_0, sin gamma_0).
        """
        if self.gash == "straight":
            return 0.0
        if self.gash_lead_mm is not None:
            return 2.0 * math.pi / self.gash_lead_mm
        return -2.0 * math.tan(self.lead_angle) / self.pitch_diameter

    @property
    def edge_scale(self) -> float:
        """Axial lengths on the edge over those in the axial plane: a twisted edge meets the thread sooner.

        The thread stands at s = lead phi / 2 pi, the edge at phi = twist s: with gashes at right angles to
        the thread this is cos² gamma_0.
        """
        thread = math.pi * self.pitch_diameter * math.tan(self.lead_angle)
        return 1.0 / (1.0 - thread * self.twist / (2.0 * math.pi))

    @property
    def edge_pitch(self) -> float:
        """Axial distance of the teeth on one edge [mm]."""
        return self.axial_pitch * self.edge_scale

    def tooth(self, lead_error_mm: float = 0.0) -> ToothProfile:
        """Outline of the edge, over its axial position: tan alpha_x = tan alpha_n / cos gamma_0, scaled.

        A thread whose lead is longer sets its teeth further apart, and leaves them as they are.
        """
        tip = self.outside_diameter_mm / 2.0
        chain = self.profile
        if chain is None:
            module = self.normal_module_mm
            chain = RackTooth(
                width=self.edge_pitch / 2.0,
                flank_angle=self._on_edge(self.pressure_angle_deg),
                addendum=self.addendum_factor * module,
                dedendum=self.dedendum_factor * module,
                tip_radius=self.tip_radius_factor * module,
                protuberance=self.protuberance_mm,
                protuberance_angle=self._on_edge(self.protuberance_angle_deg),
                chamfer_height=self.chamfer_height_mm,
                chamfer_angle=self._on_edge(self.chamfer_angle_deg),
            ).chain()
        pitch = self.edge_pitch + lead_error_mm * self.edge_scale / self.starts
        return tooth_profile(chain, tip=tip, land=True, pitch=pitch)

    def cutter(self, swivel: float, errors: HobErrors | None = None) -> Cutter:
        """The hob set at `swivel` = eta [rad] from the machine's Y (geometry.md 2).

        Raises InputError for errors that are not this hob's.
        """
        error = errors or HobErrors()
        if len(error.gash_rad) not in {0, self.gashes}:
            raise InputError(
                f"{len(error.gash_rad)} gash errors for a hob with {self.gashes} gashes",
                remedy=f"valid: {self.gashes} of them, or none",
            )
        gash = np.arange(self.gashes)
        tooth = self.tooth(error.lead_mm)
        lead = self.sign * self.starts * tooth.pitch
        return Cutter(
            gash_angle=2.0 * math.pi * gash / self.gashes + np.array(error.gash_rad or 0.0),
            gash_shift=self.shift_mm + lead * gash / self.gashes,
            profile=tooth,
            half_length=math.inf if self.length_mm is None else self.length_mm / 2.0,
            shift=self.shift_mm,
            swivel=math.pi / 2.0 - swivel,
            twist=self.twist,
        )

    def _on_edge(self, normal_angle_deg: float) -> float:
        """Flank angle over the edge's axial position [rad], from that in the normal section."""
        tangent = math.tan(math.radians(normal_angle_deg)) / math.cos(self.lead_angle)
        return math.atan(tangent * self.edge_scale)

    def _check_gashes(self) -> None:
        if self.gash_lead_mm is None:
            return
        if self.gash == "straight":
            raise InputError("gash_lead_mm is given, but the gashes are straight", remedy='gash = "helical"')
        least = math.pi * self.pitch_diameter
        if abs(self.gash_lead_mm) < least:
            raise InputError(
                f"gash_lead_mm {self.gash_lead_mm:g} turns the gashes more than 45° off the hob's axis",
                remedy=f"valid: {least:.4g} or more, − for left-hand gashes",
            )

    def _check_profile(self) -> None:
        """What contradicts itself in the data of the tooth. Raises InputError."""
        preset = {f.name: f.default for f in fields(self)}
        if self.profile is not None:
            beside = [name for name in CATALOGUE if getattr(self, name) != preset[name]]
            if beside:
                raise InputError(
                    f"{beside[0]} stands beside profile, which says it all", remedy=f"without {beside[0]}"
                )
            if self.profile and self.profile[-1][1] <= self.addendum_factor * self.normal_module_mm:
                raise InputError("the profile ends above the reference line, at addendum_factor × module")
        if self.protuberance_mm and self.protuberance_angle_deg >= self.pressure_angle_deg:
            raise InputError(
                f"protuberance_angle_deg {self.protuberance_angle_deg:g} is no less than the flank's own",
                remedy=f"valid: 0 to less than {self.pressure_angle_deg:g}",
            )
        if self.chamfer_height_mm and self.chamfer_angle_deg <= self.pressure_angle_deg:
            raise InputError(
                f"chamfer_angle_deg {self.chamfer_angle_deg:g} is no more than the flank's own",
                remedy=f"valid: more than {self.pressure_angle_deg:g}",
            )
        for name, angle in (
            ("protuberance_mm", "protuberance_angle_deg"),
            ("chamfer_height_mm", "chamfer_angle_deg"),
        ):
            if not getattr(self, name) and getattr(self, angle) != preset[angle]:
                raise InputError(f"{angle} is given without {name}", remedy=f"{name} too")


CATALOGUE = (
    "tip_radius_factor",
    "dedendum_factor",
    "protuberance_mm",
    "protuberance_angle_deg",
    "chamfer_height_mm",
    "chamfer_angle_deg",
)
"""What a profile of its own replaces."""
