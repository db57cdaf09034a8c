"""One drive of the machine: motor, transmission, encoder, loops, as its parameter file gives it."""

import math
from dataclasses import dataclass
from enum import Enum

SI_PER_MM = 1e-3
SI_PER_DEG = math.pi / 180.0
UM_PER_MM = 1e3
ARCSEC_PER_DEG = 3600.0
RPM = math.tau / 60.0
"""[rad/s]"""


class DriveKind(Enum):
    """How a motor is controlled."""

    SERVO = "servo"
    """position and velocity loops on the encoder"""
    VARIABLE_FREQUENCY = "variable_frequency"
    """an induction motor on an inverter, speed by frequency alone; its encoder is only read"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """One drive. The motor in its own turns [kg m², N m, 1/min], the axis in the units of its display."""

    kind: DriveKind
    travel_per_turn: float
    """of the axis per turn of the motor [mm | deg]; 360 = direct drive"""
    motor_inertia: float
    """[kg m²] of rotor, coupling and screw, besides the bodies they move"""
    torque_limit: float
    """of the motor [N m]; breakdown torque of an induction motor"""
    speed_limit: float
    """of the motor [1/min]"""
    overload_time_s: float
    """how long the motor may stand at its torque limit before the drive gives an alarm"""
    coulomb_friction: float
    """of the axis [N | N m]"""
    viscous_friction: float
    """of the axis [N s/m | N m s]"""
    backlash: float
    """whole play between motor side, where the encoder sits, and load side [µm | arcsec]"""
    encoder_counts: float
    """per turn of the motor; 0 = reads exactly"""
    encoder_cyclic_error: float
    """amplitude, at the axis [µm | arcsec]"""
    encoder_cyclic_order: float
    """periods per turn of the motor"""
    position_gain: float
    """Kv [1/s]"""
    velocity_feedforward: float
    """k_ff; the lag at constant speed v is (1 - k_ff) v / Kv"""
    acceleration_feedforward: float
    """share of the force of acceleration that is given ahead of the loops"""
    velocity_gain: float
    """proportional gain of the velocity loop over the moved inertia [1/s]"""
    integral_time_s: float
    """reset time of the velocity loop"""
    breakdown_slip: float
    """speed that an induction motor loses at its breakdown torque [1/min]; 0 = not known"""
    in_position: float
    """following error below which the axis counts as in position [mm | deg]"""
    error_limit: float
    """following error above which the drive gives an alarm [mm | deg]"""

    def at_axis(self, *, rotary: bool) -> "AxisDrive":
        """The same drive referred to the axis that it moves, in SI."""
        unit = SI_PER_DEG if rotary else SI_PER_MM
        fine = unit / (ARCSEC_PER_DEG if rotary else UM_PER_MM)
        reduction = self.travel_per_turn * unit / math.tau
        return AxisDrive(
            drive=self,
            unit=unit,
            reduction=reduction,
            inertia=self.motor_inertia / reduction**2,
            force_limit=self.torque_limit / reduction,
            speed_limit=self.speed_limit * RPM * reduction,
            breakdown_slip=self.breakdown_slip * RPM * reduction,
            backlash=self.backlash * fine,
            count=math.tau * reduction / self.encoder_counts if self.encoder_counts else 0.0,
            cyclic_error=self.encoder_cyclic_error * fine,
            in_position=self.in_position * unit,
            error_limit=self.error_limit * unit,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisDrive:
    """A drive as its axis feels it: [m, kg, N] or [rad, kg m², N m], seconds."""

    drive: Drive
    unit: float
    """[m/mm | rad/deg]"""
    reduction: float
    """travel per radian of the motor [m/rad | rad/rad]"""
    inertia: float
    """of the motor's rotor [kg | kg m²]"""
    force_limit: float
    speed_limit: float
    breakdown_slip: float
    backlash: float
    count: float
    """travel per count of the encoder; 0 = reads exactly"""
    cyclic_error: float
    in_position: float
    error_limit: float
