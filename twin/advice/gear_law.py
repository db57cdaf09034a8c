"""What a perfect machine leaves on a hobbed flank, and what a wrong setting does to it (geometry.md, 2, 5).

Lengths in mm, angles in radians, results in mm. Symbols of ISO 21771.
"""

import math


def reference_diameter(*, teeth: float, module: float, helix: float) -> float:
    """d = z m_n / cos β."""
    return teeth * module / math.cos(helix)


def transverse_pressure_angle(*, pressure: float, helix: float) -> float:
    """α_t [rad]: tan α_t = tan α_n / cos β."""
    return math.atan(math.tan(pressure) / math.cos(helix))


def feed_mark(*, feed: float, hob_radius: float, pressure: float, helix: float) -> float:
    """δ_x, depth of the feed marks normal to the flank: (f_a / cos β)² sin α_n / (8 ρ).

    `feed` f_a in mm per turn of the work; ρ is the radius of the hob that cuts the point: half of d_a0 gives
    the smallest marks, half of the pitch diameter those at the pitch point.
    """
    return (feed / math.cos(helix)) ** 2 * math.sin(pressure) / (8.0 * hob_radius)


def generating_flat(*, base_radius: float, roll: float, starts: int, gashes: int, teeth: float) -> float:
    """δ_y(ξ) = r_b ξ (2π z_0 / (n_i z))² / 8, depth of the flats at the roll angle `roll` ξ [rad]."""
    return base_radius * roll * (2.0 * math.pi * starts / (gashes * teeth)) ** 2 / 8.0


def roll_angle(*, radius: float, base_radius: float) -> float:
    """ξ [rad] of the flank point at `radius`: r = r_b √(1 + ξ²); 0 below the base circle."""
    return math.sqrt(max((radius / base_radius) ** 2 - 1.0, 0.0))


def swivel_widening(*, pitch_diameter: float, error: float, pressure: float) -> float:
    """How much each flank of a gap loses, normal to it, to a swivel off by `error`.

    d_0 tan²δ cos α_n / (4 tan α_n), with the pitch diameter of the hob.
    """
    return pitch_diameter * math.tan(error) ** 2 * math.cos(pressure) / (4.0 * math.tan(pressure))


def work_rate(*, teeth: float, module: float, helix: float) -> float:
    """Turn of the work per axial travel [deg/mm] that a gear needs: −360° sin β / (π z m_n).

    A right-hand gear needs C to turn back while Z rises (rulings, section 0).
    """
    return -360.0 * math.sin(helix) / (math.pi * teeth * module)


def helix_slope(
    *, rate: float, teeth: float, module: float, helix: float, pressure: float, width: float
) -> float:
    """f_Hβ of a gear whose work turns `rate` [deg/mm] instead of what its nominal needs.

    f_Hβ = L_β (tan β' − tan β) cos α_t, with tan β' = −r · rate.
    """
    radius = reference_diameter(teeth=teeth, module=module, helix=helix) / 2.0
    slope = -radius * math.radians(rate) - math.tan(helix)
    return width * slope * math.cos(transverse_pressure_angle(pressure=pressure, helix=helix))


def cutting_speed(*, diameter: float, rpm: float) -> float:
    """v_c [m/min] at the outside of a tool of `diameter` [mm]."""
    return math.pi * diameter * abs(rpm) / 1000.0
