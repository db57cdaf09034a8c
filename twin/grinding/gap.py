"""The transverse section of a gap: a flat root, a round fillet, an involute flank, radial inside its base."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.errors import InputError
from twin.inspection.involute import Involute

Floats = NDArray[np.float64]

FILLETS = 60
"""radii tried where the one wanted does not fit"""
HALVINGS = 60


@dataclass(frozen=True, slots=True, kw_only=True)
class Gap:
    """Half a gap, symmetrical about +X, the work axis at the origin. Lengths in mm."""

    base_radius: float
    """r_b"""
    base_half_angle: float
    """half the gap's angle on the base circle [rad]; below 0 where the teeth meet above it"""
    root_radius: float
    """distance of the flat root from the axis"""
    fillet_radius: float
    fillet_centre: tuple[float, float]
    fillet_end: float
    """direction in which the fillet's last point stands from its centre [rad]"""
    first_roll: float
    """roll length at which the involute begins; 0 where a radial line leads up to it"""

    def flank(self, roll: Floats) -> tuple[Floats, Floats]:
        """Points (n, 2) of the flank at roll lengths, y > 0, and their unit tangents (n, 2) outwards."""
        angle = self.base_half_angle + roll / self.base_radius
        out, across = _unit(angle), _unit(angle + math.pi / 2.0)
        return self.base_radius * out - roll[:, None] * across, out

    def fillet(self, count: int) -> tuple[Floats, Floats]:
        """Points (count, 2) of the fillet from the flat root on, and unit tangents."""
        angle = np.linspace(-math.pi, self.fillet_end, count)
        points = np.array(self.fillet_centre) + self.fillet_radius * _unit(angle)
        return points, _unit(angle - math.pi / 2.0)

    def roll_at(self, radius: float) -> float:
        """Roll length of the flank on a radius, 0 inside the base circle."""
        return math.sqrt(max(radius**2 - self.base_radius**2, 0.0))


def gap_of(gear: Involute, *, stock: float = 0.0, fillet_factor: float = 0.38) -> Gap:
    """The gap of a gear whose flanks and root stand `stock` [mm, normal] outside the nominal.

    The fillet is `fillet_factor` modules, or the radius next to it that touches both root and involute below
    the form diameter. Raises InputError where there is none, or the stock fills the gap.
    """
    r_b = gear.base_radius
    root = gear.root_diameter / 2.0 + stock
    lift = stock / (r_b * math.cos(gear.base_helix))
    half = math.pi / gear.teeth - float(gear.half_tooth(r_b)) - lift
    for radius in _radii(fillet_factor * gear.module):
        gap = _rounded(r_b, half, root, radius, gear)
        if gap is not None:
            return gap
    raise InputError(
        f"no round fillet joins the root circle {2 * root:.3f} mm and the involute of {gear.teeth} teeth",
        remedy="more teeth, profile shift, or less stock: an undercut gap cannot be form ground here",
    )


def _radii(wanted: float) -> list[float]:
    """Fillet radii to be tried, the nearest to the wanted first."""
    tries = wanted * np.linspace(0.1, 2.0, FILLETS)
    return [wanted, *sorted(tries.tolist(), key=lambda r: abs(r - wanted))]


def _rounded(r_b: float, half: float, root: float, radius: float, gear: Involute) -> Gap | None:
    """The gap with that fillet; None where it does not touch both sides.

    Where the fillet touches the involute, its centre lies on the involute moved by the radius, which is the
    same involute turned; else it touches the radial line at the involute's foot.
    """

    def centre(roll: float) -> complex:
        turned = half + (roll - radius) / r_b
        return (r_b - 1j * roll) * complex(math.cos(turned), math.sin(turned))

    level = root + radius
    form = math.sqrt(max(gear.form_diameter**2 / 4.0 - r_b**2, 0.0))
    low, high = radius, radius + form
    if centre(low).real >= level:
        across = (level * math.sin(half) - radius) / math.cos(half)
        reach = level * math.cos(half) + across * math.sin(half)
        found, first, angle = complex(level, across), 0.0, half
        if reach > r_b:
            return None
    elif centre(high).real >= level:
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if centre(middle).real < level else (low, middle)
        found, first = centre(high), high - radius
        angle = half + first / r_b
    else:
        return None
    if found.imag < 0.0:
        return None
    return Gap(
        base_radius=r_b,
        base_half_angle=half,
        root_radius=root,
        fillet_radius=radius,
        fillet_centre=(found.real, found.imag),
        fillet_end=angle + math.pi / 2.0 - 2.0 * math.pi,
        first_roll=first,
    )


def _unit(angle: Floats) -> Floats:
    """(n, 2) directions."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)
