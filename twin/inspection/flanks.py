"""Deviations of gear flanks: profile and helix traces, pitch (inspection.md, sections 1 and 4).

All of them are one thing: the mesh crosses a circle about the axis where a tooth flank should cross it at a
known angle; the difference, times the base radius, is the deviation along the tangent to the base cylinder in
the transverse plane, which is normal to the flank there.
"""

import math
from dataclasses import dataclass

import numpy as np

from twin.inspection.involute import Involute
from twin.inspection.result import Flank, Trace
from twin.inspection.sections import (
    Crossings,
    circle_crossings,
    faces_at_height,
    faces_at_radius,
    plane_segments,
)
from twin.inspection.solid import Floats, Ints, Solid

POINTS = 480
"""points of a trace"""
TRACES = 4
"""teeth traced, equally spaced"""
NO_SLOPE = 5e-3
"""a mean slope below this [µm] is the noise of the figures: none"""
TIP_LIMIT = 0.95
"""profile evaluation ends here on the way from form to tip diameter, in roll length (ISO 1328-1:2013)"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """A gear geometry in its place about the axis."""

    gear: Involute
    phase: float
    """angle [rad] of tooth 1's centre at `middle`"""
    middle: float
    """z [mm] where profile and pitch are measured"""
    low: float
    """z [mm] where the teeth begin"""
    high: float
    """z [mm] where they end"""

    @property
    def helix_range(self) -> tuple[float, float]:
        """z [mm] over which helices are evaluated: b less the smaller of 5 % b and one module at each end."""
        margin = min(0.05 * (self.high - self.low), self.gear.module)
        return self.low + margin, self.high - margin

    def turned_back(self, angle: Floats, z: Floats) -> Floats:
        """Return angles [rad] as seen from tooth 1, the twist of the helix taken out."""
        return angle - self.phase - self.gear.twist * (z - self.middle)

    def tooth(self, angle: Floats) -> tuple[Ints, Floats]:
        """Return the nearest tooth (0 = tooth 1, clockwise) and the angle [rad] from its centre."""
        pitch = 2 * math.pi / self.gear.teeth
        steps = np.round(-angle / pitch).astype(np.int64)
        return steps % self.gear.teeth, angle + steps * pitch


def deviations(crossings: Crossings, heights: Floats, radii: Floats, placed: Placed) -> tuple[Floats, Floats]:
    """Return the left and right flanks' deviations [µm], (planes, circles, z) each, + = material outside.

    NaN where a flank does not cross a circle exactly once.
    """
    height, radius = heights[crossings.plane], radii[crossings.circle]
    angle = placed.turned_back(crossings.angle, height)
    side = np.where(crossings.left, 1.0, -1.0)
    tooth, offset = placed.tooth(angle - side * placed.gear.half_tooth(radius))
    value = 1000 * placed.gear.base_radius * side * offset
    shape = (len(heights), len(radii), placed.gear.teeth)
    place = np.ravel_multi_index((crossings.plane, crossings.circle, tooth), shape)
    left, right = (
        _table(place[chosen], value[chosen], shape) for chosen in (crossings.left, ~crossings.left)
    )
    return left, right


def _table(place: Ints, value: Floats, shape: tuple[int, int, int]) -> Floats:
    size = math.prod(shape)
    hits = np.bincount(place, minlength=size)
    total = np.bincount(place, weights=value, minlength=size)
    return np.where(hits == 1, total, np.nan).reshape(shape)


def locate(solid: Solid, gear: Involute, *, phase: float, middle: float, low: float, high: float) -> Placed:
    """Turn a geometry onto a solid: mean of all flanks on the measuring circle, tooth 1 nearest C0."""
    rough = Placed(gear=gear, phase=phase, middle=middle, low=low, high=high)
    left, right = pitch_deviations(solid, rough)
    if np.isfinite(left).any() and np.isfinite(right).any():
        shift = (np.nanmean(left) - np.nanmean(right)) / 2000 / gear.base_radius
    else:
        shift = 0.0
    _, nearest = rough.tooth(np.array([-(phase + shift)]))
    return Placed(gear=gear, phase=float(-nearest[0]), middle=middle, low=low, high=high)


def pitch_deviations(solid: Solid, placed: Placed) -> tuple[Floats, Floats]:
    """Return left and right flanks' places on the measuring circle (z,) [µm along the base tangent]."""
    left, right = on_circles(
        solid, placed, np.array([placed.middle]), np.array([placed.gear.measuring_diameter / 2])
    )
    return left[0, 0], right[0, 0]


def on_circles(solid: Solid, placed: Placed, heights: Floats, radii: Floats) -> tuple[Floats, Floats]:
    """Measure all flanks on circles, see `deviations`; heights and radii [mm] ascending."""
    faces = faces_at_height(solid, float(heights[0])) if len(heights) == 1 else solid.faces
    if len(radii) == 1:
        faces = faces_at_radius(solid, float(radii[0]), faces=faces)
    segments = plane_segments(solid, heights, faces=faces)
    return deviations(circle_crossings(segments, radii), heights, radii, placed)


def measure_flanks(solid: Solid, placed: Placed, *, tip_diameter: float) -> tuple[Flank, Flank]:
    """Measure left and right flanks; `tip_diameter` [mm] is where the shortest tooth ends."""
    gear = placed.gear
    form, tip = (float(gear.roll_length(d)) for d in (gear.form_diameter, tip_diameter))
    profile_range = (form, form + TIP_LIMIT * (tip - form))
    roll = np.linspace(form, form + 0.99 * (tip - form), POINTS)
    profiles = on_circles(solid, placed, np.array([placed.middle]), gear.radius_at(roll))
    margin = 0.5 * (placed.high - placed.low) / POINTS
    heights = np.linspace(placed.low + margin, placed.high - margin, POINTS)
    helices = on_circles(solid, placed, heights, np.array([gear.measuring_diameter / 2]))
    pitches = pitch_deviations(solid, placed)
    # along z a right-hand helix leans to +angle: material on left flanks, lack of it on right ones
    hand = -1.0 if gear.helix < 0 else 1.0
    left, right = (
        _flank(
            profile=[
                _trace(k, roll, profiles[i][0, :, k], profile_range, 1.0) for k in traced_teeth(gear.teeth)
            ],
            helix=[
                _trace(k, heights, helices[i][:, 0, k], placed.helix_range, hand * sense)
                for k in traced_teeth(gear.teeth)
            ],
            # numbered clockwise: a flank further on is at a smaller angle
            index=-sense * pitches[i] * gear.measuring_diameter / gear.base_diameter,
        )
        for i, sense in enumerate((1.0, -1.0))
    )
    return left, right


def traced_teeth(teeth: int) -> tuple[int, ...]:
    """Return the teeth to trace, equally spaced, counted from 0."""
    count = min(TRACES, teeth)
    return tuple(round(i * teeth / count) for i in range(count))


def _trace(
    tooth: int, position: Floats, deviation: Floats, limits: tuple[float, float], sense: float
) -> Trace | None:
    """Evaluate one trace; None if it has holes. `sense` turns a rise of material into the slope's sign."""
    finite = np.isfinite(deviation)
    inside = finite & (position >= limits[0]) & (position <= limits[1])
    wanted = np.count_nonzero((position >= limits[0]) & (position <= limits[1]))
    if np.count_nonzero(inside) < max(0.98 * wanted, 2):
        return None
    x, y = position[inside], deviation[inside]
    length = limits[1] - limits[0]
    rise, level = np.polyfit((x - x.mean()) / length, y, 1)
    rest = y - level - rise * (x - x.mean()) / length
    return Trace(
        tooth=tooth + 1,
        position=position[finite],
        deviation_um=deviation[finite] - y.mean(),
        evaluation=limits,
        slope_um=sense * float(rise),
        form_um=float(np.ptp(rest)),
        total_um=float(np.ptp(y)),
    )


def _flank(*, profile: list[Trace | None], helix: list[Trace | None], index: Floats) -> Flank:
    """Gather one side; index (z,) is each flank's displacement [µm] in the sense of numbering."""
    cumulative = index - index[0]
    pitch = np.roll(index, -1) - index
    whole = bool(np.isfinite(index).all())
    profiles, helices = ([t for t in traces if t is not None] for traces in (profile, helix))
    return Flank(
        profile=tuple(profiles),
        helix=tuple(helices),
        pitch_um=pitch,
        cumulative_um=cumulative,
        profile_slope_um=_mean_slope(profile),
        profile_form_um=_largest([t.form_um for t in profiles], len(profile)),
        profile_total_um=_largest([t.total_um for t in profiles], len(profile)),
        helix_slope_um=_mean_slope(helix),
        helix_form_um=_largest([t.form_um for t in helices], len(helix)),
        helix_total_um=_largest([t.total_um for t in helices], len(helix)),
        single_pitch_um=float(np.abs(pitch).max()) if whole else None,
        cumulative_pitch_um=float(np.ptp(cumulative)) if whole else None,
    )


def _mean_slope(traces: list[Trace | None]) -> float | None:
    slopes = [t.slope_um for t in traces if t is not None]
    if len(slopes) < len(traces):
        return None
    mean = float(np.mean(slopes))
    return 0.0 if abs(mean) < NO_SLOPE else mean


def _largest(values: list[float], wanted: int) -> float | None:
    return max(values) if len(values) == wanted else None
