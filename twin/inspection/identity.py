"""Is it the part that was named? And if not: another one, or only measured in another unit."""

from twin.inspection.fit import Found
from twin.inspection.nominal import GearNominal, Nominal, PolygonNominal
from twin.inspection.units import wrong_unit

HELIX_LIMIT = 0.5
"""a helix angle [degrees] farther off is another gear"""
MODULE_LIMIT = 0.02
"""a module relatively farther off is another gear"""


def name_of(nominal: Nominal) -> str:
    """Say what a nominal is."""
    if isinstance(nominal, PolygonNominal):
        return f"a polygon of {nominal.number_of_sides} sides, {nominal.across_flats_mm:g} mm across flats"
    found = Found(
        teeth=nominal.number_of_teeth,
        module=nominal.normal_module_mm,
        helix_deg=nominal.helix_angle_deg,
        shift=nominal.profile_shift,
        pressure_deg=nominal.normal_pressure_angle_deg,
        straying=0.0,
    )
    return f"a gear with {found}"


def other_unit(found_mm: float, wanted_mm: float, what: str) -> str:
    """Say whether a size is off by just the ratio of two units; empty if not."""
    unit = wrong_unit(found_mm, wanted_mm)
    if not unit:
        return ""
    return (
        f"{what} is {found_mm:.5g} mm where {wanted_mm:.5g} mm are wanted, a factor of "
        f"{found_mm / wanted_mm:.4g}: {unit.explanation}"
    )


def unlike(found: Found, nominal: GearNominal) -> str:
    """Say in what a found gear is not the one named; empty if it is."""
    off = []
    if found.teeth != nominal.number_of_teeth:
        off.append(f"{found.teeth} teeth instead of {nominal.number_of_teeth}")
    if abs(found.helix_deg - nominal.helix_angle_deg) > HELIX_LIMIT:
        off.append(
            f"helix angle {round(found.helix_deg, 2) + 0.0:g}° instead of {nominal.helix_angle_deg:g}° "
            "(+ right-hand)"
        )
    if abs(found.module / nominal.normal_module_mm - 1) > MODULE_LIMIT:
        off.append(f"normal module {found.module:.3f} mm instead of {nominal.normal_module_mm:g} mm")
    return ", ".join(off)
