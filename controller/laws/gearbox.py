"""The electronic gear box law: two integers, two rates, pure functions.

Slave travel = master travel · numerator / denominator + axial travel · rate.
Hobbing (G81): master = tool, slave = work, L / T. Polygon (G51.2): master = work, slave = tool, Q / P.
"""

import math
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MM_PER_INCH = 25.4


class SyncKind(Enum):
    """Which of the two functions holds the gear box."""

    HOBBING = "hobbing"
    POLYGON = "polygon turning"


@dataclass(frozen=True, slots=True, kw_only=True)
class GearBox:
    """One electronic gear box as G81 or G51.2 latches it."""

    kind: SyncKind
    master: int
    """column of the master axis"""
    slave: int
    """column of the slave axis"""
    numerator: int
    """turns of the slave …"""
    denominator: int
    """… per so many of the master, > 0"""
    axial: int | None = None
    """column of the axial axis, whose travel shifts the slave; None = spur"""
    axial_rate: float = 0.0
    """slave shift per axial travel [deg/mm]"""
    follow: bool = False
    """follow type: on the measured master (parameter 201#7 = 1)"""

    @property
    def ratio(self) -> float:
        """Slave speed over master speed; for messages and limits, not for positions."""
        return self.numerator / self.denominator

    @property
    def helical(self) -> bool:
        """Whether axial travel turns the slave."""
        return self.axial is not None


Travel = TypeVar("Travel", float, "NDArray[np.float64]")


def slave_travel(gear: GearBox, master_travel: Travel) -> Travel:
    """Sync motion of the slave [deg] for master travel [deg], a number or any shape.

    No error accumulates: one product and one division, whatever the number of turns.
    """
    return master_travel * gear.numerator / gear.denominator


def helix_rate(*, teeth: int, normal_module: float, helix_angle: float, sense: int) -> float:
    """Work rotation per axial travel [deg/mm] for a helical gear (hobbing, 斜齿轮加工, 公制输入).

    `normal_module` in mm, `helix_angle` in deg (+ right-hand), `sense` the machine constant k = ±1.
    """
    return sense * 360.0 * math.sin(math.radians(helix_angle)) / (math.pi * teeth * normal_module)


def helix_rate_inch(*, teeth: int, diametral_pitch: float, helix_angle: float, sense: int) -> float:
    """Work rotation per axial travel [deg/mm] from a normal diametral pitch in 1/inch (英制输入)."""
    module = MM_PER_INCH / diametral_pitch
    return helix_rate(teeth=teeth, normal_module=module, helix_angle=helix_angle, sense=sense)


def polygon_rate(*, sides: int, cutters: int, lead: float) -> float:
    """Tool rotation per axial travel [deg/mm] for a helical polygon of `lead` mm a turn, + right-hand.

    The slave is shifted by (Q/P) · 360° · ΔZ / A (rulings, section 3).
    """
    return 360.0 * sides / (cutters * lead)
