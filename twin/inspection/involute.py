"""Laws of the involute gear (ISO 21771): from a nominal to every length and angle an inspection needs."""

import math
from dataclasses import dataclass

import numpy as np

from twin.errors import InputError
from twin.inspection.nominal import GearNominal
from twin.inspection.solid import Floats

MIDDLE = (0.25, 0.75)
"""parts of the way from form to tip diameter between which helix and pitch are measured"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Involute:
    """The gear geometry that follows from a nominal. Lengths in mm, angles in radians."""

    teeth: int
    """z"""
    module: float
    """m_n"""
    helix: float
    """beta, + right-hand"""
    pressure: float
    """alpha_n"""
    transverse_pressure: float
    """alpha_t"""
    shift: float
    """x"""
    reference_diameter: float
    """d"""
    base_diameter: float
    """d_b"""
    tip_diameter: float
    """d_a"""
    root_diameter: float
    """d_f"""
    form_diameter: float
    """d_Ff, where the usable flank begins; above the undercut where there is one"""
    undercut: bool
    """the tool named cuts the involute's foot away"""
    measuring_diameter: float
    """d_M = d + 2 x m_n, where helix and pitch are measured; within the middle of a flank that is short"""
    twist: float
    """rotation of the teeth along z [rad/mm], 2 pi / lead, + right-hand"""

    @property
    def base_radius(self) -> float:
        """r_b [mm]."""
        return self.base_diameter / 2

    @property
    def base_helix(self) -> float:
        """beta_b [rad]."""
        return math.asin(math.sin(self.helix) * math.cos(self.pressure))

    @property
    def lead(self) -> float | None:
        """p_z [mm], + right-hand; None for a spur gear."""
        return 2 * math.pi / self.twist if self.twist else None

    def half_tooth(self, radius: Floats | float) -> Floats:
        """Return half the angle [rad] a tooth takes at radii [mm] of at least the base radius."""
        at_reference = (math.pi / 2 + 2 * self.shift * math.tan(self.pressure)) / self.teeth
        angle = np.arccos(np.minimum(self.base_radius / np.asarray(radius, dtype=np.float64), 1.0))
        return at_reference + involute(self.transverse_pressure) - involute(angle)

    def roll_length(self, diameter: Floats | float) -> Floats:
        """Return the roll length [mm] of a flank point on that diameter; 0 inside the base circle."""
        square = (np.asarray(diameter, dtype=np.float64) / 2) ** 2 - self.base_radius**2
        return np.sqrt(np.maximum(square, 0.0))

    def radius_at(self, roll_length: Floats | float) -> Floats:
        """Return the radius [mm] of flank points at a roll length [mm]."""
        return np.hypot(self.base_radius, roll_length)

    def span_teeth(self) -> int:
        """Return k, the number of teeth to measure the span over (geometry.md, section 1)."""
        beta, tan_n, z = self.helix, math.tan(self.pressure), self.teeth
        squares = math.cos(beta) ** 2 + tan_n**2
        reach = squares * (1 / math.cos(beta) + 2 * self.shift / z) ** 2 - 1
        touching = (1 + math.sin(beta) ** 2 / squares) * math.sqrt(max(reach, 0.0))
        k = z / math.pi * (touching - involute(self.transverse_pressure) - 2 * self.shift * tan_n / z) + 0.5
        return min(max(math.floor(k + 0.5), 1), z)

    def span(self, k: int) -> float:
        """Return the nominal span W_k [mm] over k teeth."""
        turns = (k - 0.5) * math.pi + self.teeth * float(involute(self.transverse_pressure))
        return self.module * (math.cos(self.pressure) * turns + 2 * self.shift * math.sin(self.pressure))

    def ball_angle(self, ball: float, lift: Floats | float = 0.0) -> Floats:
        """Return alpha_K [rad], the transverse pressure angle at the centre of a ball [mm] in a gap.

        `lift` [rad] is what both flanks of the gap have too much, over the base radius; any shape.

        Raises:
            ValueError: a ball so small that its centre falls inside the base circle.

        """
        gap = math.pi / self.teeth - float(self.half_tooth(self.base_radius))
        return inverse_involute(ball / (self.teeth * self.module * math.cos(self.pressure)) - gap + lift)


def inverse_involute(value: Floats | float) -> Floats:
    """Return the angles [rad] whose involutes are `value`.

    Raises:
        ValueError: a value that is not positive.

    """
    wanted = np.asarray(value, dtype=np.float64)
    if not (wanted > 0).all():
        raise ValueError(f"no angle has the involute {wanted.min()}")
    # both bounds lie above the solution, and the involute is convex: Newton comes down to it
    angle = np.minimum(np.cbrt(3 * wanted), np.arctan(wanted + math.pi / 2))
    for _ in range(30):
        angle = angle - (involute(angle) - wanted) / np.tan(angle) ** 2
    return angle


def involute(angle: Floats | float) -> Floats:
    """Return inv alpha = tan alpha - alpha of angles [rad]."""
    return np.tan(angle) - angle


def geometry(nominal: GearNominal) -> Involute:
    """Work out a nominal gear.

    Raises:
        InputError: a nominal that is no gear: teeth, module, angles or diameters out of any possible range.

    """
    _check(nominal)
    z, m, x = nominal.number_of_teeth, nominal.normal_module_mm, nominal.profile_shift
    alpha, beta = math.radians(nominal.normal_pressure_angle_deg), math.radians(nominal.helix_angle_deg)
    alpha_t = math.atan(math.tan(alpha) / math.cos(beta))
    d = z * m / math.cos(beta)
    d_a = nominal.tip_diameter_mm if nominal.tip_diameter_mm is not None else d + 2 * m * (1 + x)
    d_f = d - 2 * m * (nominal.dedendum_factor - x)
    d_b = d * math.cos(alpha_t)
    form_diameter, undercut = _form_diameter(nominal, alpha_t, d)
    lowest, highest = (form_diameter + part * (d_a - form_diameter) for part in MIDDLE)
    if d_f <= 0 or d_a <= max(d_f, d_b):
        raise InputError(
            f"nominal gear: tip diameter {d_a:.3f} mm and root diameter {d_f:.3f} mm leave no tooth flank",
            remedy=f"0 < root diameter < tip diameter, tip diameter above the base diameter {d_b:.3f} mm",
        )
    return Involute(
        teeth=z,
        module=m,
        helix=beta,
        pressure=alpha,
        transverse_pressure=alpha_t,
        shift=x,
        reference_diameter=d,
        base_diameter=d_b,
        tip_diameter=d_a,
        root_diameter=d_f,
        form_diameter=form_diameter,
        undercut=undercut,
        measuring_diameter=min(max(d + 2 * x * m, lowest), highest),
        twist=2 * math.sin(beta) / (z * m),
    )


def _check(nominal: GearNominal) -> None:
    z = nominal.number_of_teeth
    limits = (
        ("number_of_teeth", z, 3, 10_000),
        ("normal_module_mm", nominal.normal_module_mm, 0.01, 100.0),
        ("helix_angle_deg", nominal.helix_angle_deg, -80.0, 80.0),
        ("normal_pressure_angle_deg", nominal.normal_pressure_angle_deg, 5.0, 45.0),
        ("profile_shift", nominal.profile_shift, -2.0, 2.0),
        (
            "pin_diameter_mm",
            1.0 if nominal.pin_diameter_mm is None else nominal.pin_diameter_mm,
            0.01,
            1000.0,
        ),
        ("accuracy_class", 1 if nominal.accuracy_class is None else nominal.accuracy_class, 1, 11),
        ("face_width_mm", 1.0 if nominal.face_width_mm is None else nominal.face_width_mm, 0.01, 10_000.0),
        ("dedendum_factor", nominal.dedendum_factor, 0.1, 5.0),
        ("tip_radius_factor", nominal.tip_radius_factor, 0.0, 1.0),
    )
    for name, value, low, high in limits:
        if not low <= value <= high:  # NaN fails too
            raise InputError(f"nominal gear: {name} is {value}", remedy=f"valid is {low} to {high}")


def _form_diameter(nominal: GearNominal, alpha_t: float, d: float) -> tuple[float, bool]:
    """d_Ff of a gear cut by a rack with a rounded tip, and whether it is undercut (geometry.md, 1)."""
    m, x, z = nominal.normal_module_mm, nominal.profile_shift, nominal.number_of_teeth
    alpha, beta = math.radians(nominal.normal_pressure_angle_deg), math.radians(nominal.helix_angle_deg)
    rho = nominal.tip_radius_factor * m
    straight = nominal.dedendum_factor * m - rho * (1 - math.sin(alpha))
    roll = d * math.sin(alpha_t) - 2 * (straight - x * m) / math.sin(alpha_t)
    d_b = d * math.cos(alpha_t)
    if roll >= 0:
        return math.hypot(roll, d_b), False
    # Undercut: the path of the rounded rack corner, turned into the gear frame, cuts the involute off.
    centre = (
        math.pi * m / 4
        - nominal.dedendum_factor * m * math.tan(alpha)
        - rho * (1 - math.sin(alpha)) / math.cos(alpha)
    )
    at_reference = (math.pi / 2 + 2 * x * math.tan(alpha)) / z
    highest, low, high = d_b / 2, alpha, math.pi / 2
    for points in (4000, 200, 200, 200):
        # direction of the contact normal, in the rack's normal plane
        phi = np.linspace(low, high, points)
        across = (centre + rho * np.cos(phi)) / math.cos(beta)
        depth = nominal.dedendum_factor * m - x * m - rho * (1 - np.sin(phi))
        travel = depth * np.cos(phi) * math.cos(beta) / np.sin(phi) - across
        radius = np.hypot(across + travel, d / 2 - depth)
        gap = np.arctan2(across + travel, d / 2 - depth) - travel / (d / 2)
        outside = np.arccos(np.minimum(d_b / 2 / radius, 1.0))
        half_tooth = at_reference + involute(alpha_t) - involute(outside)
        undercut = (radius > d_b / 2) & (gap > math.pi / z - half_tooth)
        if not undercut.any():
            break
        # the corner of undercut and involute lies between this point and one of its neighbours
        top = int(np.argmax(np.where(undercut, radius, 0.0)))
        highest = float(radius[top])
        low, high = phi[max(top - 1, 0)], phi[min(top + 1, points - 1)]
    return 2 * highest, True
