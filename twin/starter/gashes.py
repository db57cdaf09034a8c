"""How many gashes a hob needs for its generating flats to be fine enough."""

import math

from twin.advice.gear_law import generating_flat, roll_angle, transverse_pressure_angle
from twin.errors import InputError
from twin.inspection.tolerances import CLASSES, GearSize, gear_tolerance

SHARE = 0.5
"""of the profile form tolerance, left to the generating flats"""
MOST = 24
"""gashes of a hob for gears: more leave no room for chips and regrinding"""


def enough_gashes(
    size: GearSize, *, tip_diameter: float, pressure_deg: float, starts: int, accuracy_class: int, usual: int
) -> int:
    """The usual number of gashes, or as many more as the class needs.

    Raises InputError, with the starts and the classes that would do, where that is more than MOST.
    """
    base = _base_radius(size, pressure_deg)
    roll = roll_angle(radius=tip_diameter / 2.0, base_radius=base)

    def needed(starts: int, grade: int) -> int:
        """Flats go with the square of starts over gashes."""
        one = generating_flat(
            base_radius=base, roll=roll, starts=starts, gashes=1, teeth=size.number_of_teeth
        )
        allowed = SHARE * gear_tolerance("profile_form", size, grade) / 1000.0
        return math.ceil(math.sqrt(one / allowed) * (1.0 + 1e-9))

    count = needed(starts, accuracy_class)
    if count <= MOST:
        return max(usual, count)
    fewer = [n for n in range(starts - 1, 0, -1) if needed(n, accuracy_class) <= MOST]
    coarser = [grade for grade in CLASSES if grade > accuracy_class and needed(starts, grade) <= MOST]
    ways = [f"--starts {fewer[0]}"] if fewer else []
    ways += [f"--class {coarser[0]}"] if coarser else []
    raise InputError(
        f"{starts} start(s) on {size.number_of_teeth} teeth need a hob of {count} gashes for class "
        f"{accuracy_class}, usual are up to {MOST}",
        remedy=f"valid: {', '.join([*ways, f'--gashes {count}'])}",
    )


def _base_radius(size: GearSize, pressure_deg: float) -> float:
    angle = transverse_pressure_angle(
        pressure=math.radians(pressure_deg), helix=math.radians(size.helix_angle)
    )
    return size.reference_diameter / 2.0 * math.cos(angle)
