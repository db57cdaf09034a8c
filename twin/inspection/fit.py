"""Which gear it is, without being told: teeth, module, helix and profile shift by best fit.

The base radius is fitted to the tooth thickness over the radius; with the number of teeth and the twist it
gives helix angle and module, the normal pressure angle being told or taken as 20°.
"""

import math
from dataclasses import dataclass

import numpy as np

from twin.errors import InputError, PartError
from twin.inspection.beside import Beside
from twin.inspection.involute import Involute, geometry, involute
from twin.inspection.nominal import GearNominal
from twin.inspection.recognise import Outline
from twin.inspection.sections import FOLD, circle_crossings, plane_segments_in_parts, unfolded
from twin.inspection.solid import Floats, Solid
from twin.inspection.turning import phase_sums
from twin.inspection.usable import steep_ends, undercut_corner

SPUR_BELOW = 0.1
"""a found helix angle [degrees] below this is a spur gear's deviation"""
RADII = 200
"""at which the teeth's thickness is taken"""
SURE = (0.45, 0.75)
"""from root to tip, there are flanks here"""
CLEAR = 5
"""radii left out at both ends of the flank for the second fit"""
DEPTH = (0.8, 4.0)
"""possible depths of gear teeth, in modules"""
MOST_SHIFT = 1.5
"""largest possible |x| of a tooth thickness"""
# fmt: off
STANDARD_MODULES = (
    0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.125, 1.25, 1.375, 1.5, 1.75, 2, 2.25, 2.5, 2.75, 3, 3.25,
    3.5, 3.75, 4, 4.5, 5, 5.5, 6, 6.5, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20, 22, 25, 28, 32, 36, 40, 45, 50,
)
# fmt: on
"""ISO 54, both series, and the usual ones below 1 [mm]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Found:
    """What a gear is, by best fit, without a nominal."""

    teeth: int
    module: float
    """m_n [mm], for the pressure angle assumed"""
    helix_deg: float
    """beta, + right-hand"""
    shift: float
    """x of the tooth thickness, in modules"""
    pressure_deg: float
    """alpha_n assumed"""
    straying: float
    """largest departure of the mean tooth from the involute, at any height [mm]"""

    @property
    def hand(self) -> str:
        """`spur`, `right` or `left`."""
        return hand(self.helix_deg)

    def __str__(self) -> str:
        helix = "spur" if self.hand == "spur" else f"{abs(self.helix_deg):.2f}° {self.hand}-hand"
        return f"{self.teeth} teeth, normal module {self.module:.3f} mm, {helix}"


def hand(helix_deg: float) -> str:
    """Name the hand of a helix angle [degrees]."""
    if abs(helix_deg) < SPUR_BELOW:
        return "spur"
    return "right" if helix_deg > 0 else "left"


def find_gear(solid: Solid, outline: Outline, *, pressure_deg: float = 20.0) -> Found:
    """Fit an involute gear to an outline of regular teeth.

    Raises:
        PartError: the flanks are no involutes.

    """
    radius, half_tooth = _thickness(solid, outline)
    fraction = (radius - outline.root_radius) / outline.depth
    sure = (fraction >= SURE[0]) & (fraction <= SURE[1])
    if np.count_nonzero(sure) < 10:
        raise PartError(f"{outline.count} teeth stand about the axis, but their flanks have holes")
    found = _fit(outline, radius[sure], half_tooth[:, sure], pressure_deg)
    # fit again over the whole flank, between what this fit shows to be fillet and chamfer
    flank = _flank(_geometry_of(found, outline), radius, half_tooth.mean(axis=0))
    if np.count_nonzero(flank) >= 10:
        found = _fit(outline, radius[flank], half_tooth[:, flank], pressure_deg)
        _geometry_of(found, outline)
    return found


def as_nominal(found: Found, outline: Outline) -> GearNominal:
    """Return the nominal to measure a found gear against: standard module, spur where it is close to that."""
    nearest = min(STANDARD_MODULES, key=lambda m: abs(m - found.module))
    module = nearest if abs(found.module - nearest) <= 0.01 * nearest else found.module
    beta = 0.0
    if found.hand != "spur":
        sine = math.sin(math.radians(found.helix_deg)) * module / found.module  # keeps the lead
        beta = math.degrees(math.asin(min(max(sine, -1.0), 1.0)))
    return GearNominal(
        number_of_teeth=found.teeth,
        normal_module_mm=module,
        helix_angle_deg=beta,
        normal_pressure_angle_deg=found.pressure_deg,
        profile_shift=found.shift,
        tip_diameter_mm=2 * outline.tip_radius,
    )


def _flank(gear: Involute, radius: Floats, half_tooth: Floats) -> np.ndarray:
    """Mark the radii (n,) between fillet and tip chamfer, by the mean tooth's half angles (n,)."""
    outside = radius > 1.0005 * gear.base_radius
    if np.count_nonzero(outside) < 10:
        return outside
    at = gear.roll_length(2 * radius[outside])
    roll = np.linspace(at[0], at[-1], RADII)
    missed = np.interp(roll, at, gear.base_radius * (half_tooth[outside] - gear.half_tooth(radius[outside])))
    first, last = (int(k[0]) for k in steep_ends(roll, missed[None, :]))
    step = roll[1] - roll[0]
    all_rolls = gear.roll_length(2 * radius)
    low = max(roll[first] + (CLEAR * step if first else 0.0), float(gear.roll_length(gear.form_diameter)))
    corner = undercut_corner(roll, missed, start=low, end=roll[last])
    low = low if corner is None else corner + CLEAR * step
    high = roll[last] - CLEAR * step
    return outside & (all_rolls >= low) & (all_rolls <= high)


def _thickness(solid: Solid, outline: Outline) -> tuple[Floats, Floats]:
    """Return radii (n,) [mm] from root to tip and mean half angles of the teeth there [rad].

    The angles are (planes, n), of planes spread over the width.
    """
    radii = outline.root_radius + np.linspace(0.02, 0.99, RADII) * outline.depth
    reach = 0.4 * (outline.high - outline.low)
    heights = outline.middle + reach * np.linspace(-1, 1, 9)
    above = Beside(lambda: _half_teeth(solid, outline, heights[5:], radii))
    rows = _half_teeth(solid, outline, heights[:5], radii) + above.result()
    half, whole = (np.concatenate(column) for column in zip(*rows, strict=True))
    everywhere = whole.all(axis=0)
    return radii[everywhere], half[:, everywhere]


def _half_teeth(
    solid: Solid, outline: Outline, heights: Floats, radii: Floats
) -> list[tuple[Floats, np.ndarray]]:
    """Return mean half angles (planes, n) of the teeth at radii (n,), and where every flank is there once."""
    rows = []
    for part in plane_segments_in_parts(solid, heights):
        crossings = unfolded(circle_crossings(part, radii), FOLD * 2 * math.pi / outline.count)
        shape = (len(part.heights), len(radii))
        place = crossings.plane * len(radii) + crossings.circle
        left, right = phase_sums(crossings, outline.count, place, math.prod(shape))
        half = np.mod(np.angle(left * right.conj()), 2 * math.pi) / (2 * outline.count)
        count = np.bincount(place, minlength=math.prod(shape))
        rows.append((half.reshape(shape), (count == 2 * outline.count).reshape(shape)))
    return rows


def _fit(outline: Outline, radius: Floats, half_tooth: Floats, pressure_deg: float) -> Found:
    """Name the gear whose involute fits tooth thicknesses (planes, n) over radii (n,) best."""
    base = _best_base(radius, half_tooth.mean(axis=0))
    alpha = math.radians(pressure_deg)
    sine = math.sin(math.atan(base * outline.twist)) / math.cos(alpha)
    if abs(sine) >= math.sin(math.radians(80.0)):
        raise PartError(
            f"{outline.count} flutes of a lead of {2 * math.pi / outline.twist:+.2f} mm, too short for a gear"
        )
    beta = math.asin(sine)
    alpha_t = math.atan(math.tan(alpha) / math.cos(beta))
    module = 2 * base * math.cos(beta) / (outline.count * math.cos(alpha_t))
    rest = half_tooth + involute(np.arccos(np.minimum(base / radius, 1.0)))
    at_reference = float(np.mean(rest)) - float(involute(alpha_t))
    shift = (at_reference * outline.count - math.pi / 2) / (2 * math.tan(alpha))
    if not (DEPTH[0] <= outline.depth / module <= DEPTH[1] and abs(shift) <= MOST_SHIFT):
        raise PartError(
            f"{outline.count} regular teeth, {outline.depth:.3f} mm deep, stand about the axis, "
            "but they have no involute flanks"
        )
    return Found(
        teeth=outline.count,
        module=module,
        helix_deg=math.degrees(beta),
        shift=shift,
        pressure_deg=pressure_deg,
        straying=base * float(np.abs(rest - rest.mean()).max()),
    )


def _best_base(radius: Floats, half_tooth: Floats) -> float:
    """Return the base radius [mm] whose involute fits half angles (n,) over radii (n,) in least squares."""

    def misfit(base: Floats) -> Floats:
        rest = half_tooth + involute(np.arccos(np.minimum(base[:, None] / radius, 1.0)))
        return rest.var(axis=1)

    low, high = 0.5 * radius[0], radius[-1]
    # the misfit has one valley: look at ever closer grids about its lowest point
    for _ in range(14):
        grid = np.linspace(low, high, 21)
        best = int(np.argmin(misfit(grid)))
        low, high = grid[max(best - 1, 0)], grid[min(best + 1, 20)]
    return float((low + high) / 2)


def _geometry_of(found: Found, outline: Outline) -> Involute:
    """Work out a found gear. Raises PartError: it is of no possible size or shape."""
    try:
        return geometry(as_nominal(found, outline))
    except InputError as fault:
        largest = 2 * outline.tip_radius
        raise PartError(
            f"{found.teeth} teeth of normal module {found.module:.5g} mm on a largest diameter of "
            f"{largest:.5g} mm were found: no gear of that size can be measured; the mesh's units may be "
            "wrong, millimetres are expected"
        ) from fault
