"""What a part should be: the nominal gear or polygon that an inspection compares with."""

from dataclasses import dataclass

TOLERANCE = "h13"
"""of widths across flats where none is named"""


@dataclass(frozen=True, slots=True, kw_only=True)
class GearNominal:
    """Nominal involute gear, symbols of ISO 21771."""

    number_of_teeth: int
    """z"""
    normal_module_mm: float
    """m_n"""
    helix_angle_deg: float = 0.0
    """beta, + right-hand"""
    normal_pressure_angle_deg: float = 20.0
    """alpha_n"""
    profile_shift: float = 0.0
    """x, in modules"""
    accuracy_class: int | None = None
    """ISO 1328-1:2013 class A to judge by; None = not graded"""
    tip_diameter_mm: float | None = None
    """d_a; None = d + 2 m_n (1 + x)"""
    face_width_mm: float | None = None
    """b; None = what the mesh has"""
    dedendum_factor: float = 1.25
    """h_aP0* of the tool: root at d - 2 m_n (h - x)"""
    tip_radius_factor: float = 0.38
    """rho_aP0* of the tool"""
    pin_diameter_mm: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class PolygonNominal:
    """Nominal polygon."""

    number_of_sides: int
    across_flats_mm: float
    tolerance: str = TOLERANCE
    """ISO 4759-1 grade A on the width across flats"""


Nominal = GearNominal | PolygonNominal
