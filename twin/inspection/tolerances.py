"""Tolerances: ISO 1328-1:2013 for gear flanks, ISO 4759-1 and ISO 2768-2 for polygons."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from twin.errors import InputError

CLASSES = range(1, 12)


@dataclass(frozen=True, slots=True, kw_only=True)
class GearSize:
    """What the tolerances of a gear depend on."""

    number_of_teeth: int
    reference_diameter: float
    """d [mm]"""
    normal_module: float
    """m_n [mm]"""
    face_width: float
    """b [mm]"""
    helix_angle: float
    """beta [degrees]"""


def _root_sum(*laws: Callable[[GearSize], float]) -> Callable[[GearSize], float]:
    return lambda g: math.hypot(*(law(g) for law in laws))


def _single_pitch(g: GearSize) -> float:
    return 0.001 * g.reference_diameter + 0.4 * g.normal_module + 5


def _cumulative_pitch(g: GearSize) -> float:
    d = g.reference_diameter
    return 0.002 * d + 0.55 * math.sqrt(d) + 0.7 * g.normal_module + 12


def _profile_slope(g: GearSize) -> float:
    return 0.4 * g.normal_module + 0.001 * g.reference_diameter + 4


def _profile_form(g: GearSize) -> float:
    return 0.55 * g.normal_module + 5


def _helix_slope(g: GearSize) -> float:
    return 0.05 * math.sqrt(g.reference_diameter) + 0.35 * math.sqrt(g.face_width) + 4


def _helix_form(g: GearSize) -> float:
    return 0.07 * math.sqrt(g.reference_diameter) + 0.45 * math.sqrt(g.face_width) + 4


_CLASS_5: Mapping[str, Callable[[GearSize], float]] = {
    "single_pitch": _single_pitch,
    "cumulative_pitch": _cumulative_pitch,
    "profile_slope": _profile_slope,
    "profile_form": _profile_form,
    "profile_total": _root_sum(_profile_slope, _profile_form),
    "helix_slope": _helix_slope,
    "helix_form": _helix_form,
    "helix_total": _root_sum(_helix_slope, _helix_form),
    "runout": lambda g: 0.9 * _cumulative_pitch(g),
}
"""item -> tolerance [µm] of class 5, unrounded (ISO 1328-1:2013, clause 5; runout: its annex)"""

ITEMS = tuple(_CLASS_5)


def gear_tolerance(item: str, size: GearSize, accuracy_class: int) -> float:
    """Return the rounded tolerance [µm] of one of `ITEMS` in an accuracy class 1 to 11."""
    return _round(_CLASS_5[item](size) * math.sqrt(2.0) ** (accuracy_class - 5))


def class_reached(item: str, size: GearSize, value_um: float) -> int | None:
    """Return the finest class whose tolerance holds |value|, None if worse than the coarsest."""
    reached = (a for a in CLASSES if abs(value_um) <= gear_tolerance(item, size, a))
    return next(reached, None)


def outside_standard(size: GearSize) -> list[str]:
    """Say, one sentence each, what lies outside the range of ISO 1328-1:2013; empty if nothing does."""
    ranges = (
        ("number of teeth", size.number_of_teeth, 5, 1000, ""),
        ("reference diameter", size.reference_diameter, 5, 15000, " mm"),
        ("normal module", size.normal_module, 0.5, 70, " mm"),
        ("face width", size.face_width, 4, 1200, " mm"),
        ("helix angle", abs(size.helix_angle), 0, 45, "°"),
    )
    return [
        f"{name} {value:.5g}{unit} is outside ISO 1328-1 ({low} to {high}{unit})"
        for name, value, low, high, unit in ranges
        if not low <= value <= high
    ]


def across_flats_limits(nominal_mm: float, tolerance: str) -> tuple[float, float]:
    """Return smallest and largest width across flats [mm] (ISO 4759-1 grade A, deviations of ISO 286-1).

    Raises:
        InputError: an unknown tolerance or a width outside its table.

    """
    grades = _WIDTH_TOLERANCES.get(tolerance)
    if grades is None:
        known = ", ".join(_WIDTH_TOLERANCES)
        raise InputError(f"nominal polygon: tolerance {tolerance!r} is unknown", remedy=f"known are {known}")
    width = next((t for limit, t in grades if 0 < nominal_mm <= limit), None)
    if width is None:
        raise InputError(
            f"nominal polygon: across flats {nominal_mm} mm is outside the table of {tolerance}",
            remedy=f"valid is above 0 up to {grades[-1][0]} mm",
        )
    return nominal_mm - width, nominal_mm


_WIDTH_TOLERANCES: Mapping[str, tuple[tuple[float, float], ...]] = {
    "h13": ((3, 0.14), (6, 0.18), (10, 0.22), (18, 0.27), (30, 0.33), (50, 0.39), (80, 0.46), (120, 0.54)),
    "h14": ((3, 0.25), (6, 0.30), (10, 0.36), (18, 0.43), (30, 0.52), (50, 0.62), (80, 0.74), (120, 0.87)),
}
"""tolerance -> (up to and including [mm], width of the tolerance below nominal [mm])"""


def flatness_limits_um(length_mm: float) -> dict[str, float]:
    """Return the general tolerances H, K and L on flatness [µm] of a face of that longest side (ISO 2768-2).

    Empty beyond the standard's table.
    """
    row = next((row for longest, row in _FLATNESS if length_mm <= longest), ())
    return dict(zip("HKL", row, strict=False))


_FLATNESS: tuple[tuple[float, tuple[float, float, float]], ...] = (
    (10, (20, 50, 100)),
    (30, (50, 100, 200)),
    (100, (100, 200, 400)),
    (300, (200, 400, 800)),
    (1000, (300, 600, 1200)),
    (3000, (400, 800, 1600)),
)
"""longest side up to and including [mm] -> H, K, L [µm] (ISO 2768-2, table 1)"""


def _round(value: float) -> float:
    """Round a tolerance as the standard prints it: half up, coarser where it is larger."""
    step = 1.0 if value > 10 else 0.5 if value >= 5 else 0.1
    # a hair for values that are half a step but for their binary representation
    return round(math.floor(value / step + 0.5 + 1e-9) * step, 1)
