"""Left and right flanks of a gear: profile and helix traces, pitch (inspection.md, sections 1 and 4)."""

import math
from dataclasses import dataclass

import numpy as np

from twin.inspection.beside import Beside
from twin.inspection.reading import SENSES, Placed, pitch_readings, read_flanks
from twin.inspection.result import Figures, Flank, Trace, Wave
from twin.inspection.solid import Floats, Solid
from twin.inspection.trace import cut_off, evaluate
from twin.inspection.usable import Usable
from twin.inspection.waviness import waviness

POINTS = 480
"""points of a trace"""
TRACES = 4
"""teeth traced, equally spaced"""
NO_SLOPE = 5e-3
"""a mean slope or crowning below this [µm] is the noise of the figures: none"""
TIP_LIMIT = 0.95
"""part of the way from its start to the tip form diameter, in roll length, that a profile is evaluated"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """All flanks read: what the figures of a gear are made of."""

    left: Flank
    right: Flank
    profile_range: tuple[float, float]
    """evaluated roll lengths [mm]"""
    largest_facet_um: float
    """largest departure of the mesh's chords in the evaluated ranges"""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Scan:
    """All teeth read along profile or helix."""

    position: Floats
    """(m,) roll length or z [mm]"""
    limits: tuple[float, float]
    """evaluated range of `position`"""
    deviation: Floats
    """(2, m, z) left and right [µm]"""
    facet: Floats
    """(2, m, z) the part of it that chords put in [µm]"""
    turn: Floats
    """(2, m) rotation angle of the points from their tooth [rad]"""
    rise: tuple[float, float]
    """sign of the slope where material rises with position, left and right"""

    @property
    def inside(self) -> np.ndarray:
        """(m,) within the evaluated range."""
        return (self.position >= self.limits[0]) & (self.position <= self.limits[1])

    @property
    def largest_facet_um(self) -> float:
        """Largest departure of chords within the range."""
        values = np.abs(self.facet[:, self.inside])
        return float(np.max(values, initial=0.0, where=np.isfinite(values)))

    def traces(self, side: int, teeth: tuple[int, ...]) -> list[Trace | None]:
        """Evaluate the traces of teeth counted from 0."""
        return evaluate(
            self.position,
            self.deviation[side],
            self.facet[side],
            self.limits,
            teeth=teeth,
            sense=self.rise[side],
        )

    def waves(self, side: int) -> tuple[Wave, ...]:
        """Return the waviness of all teeth; none where the points of a trace share one rotation angle."""
        turn = self.turn[side][self.inside]
        if len(turn) < 2 or np.ptp(turn) == 0:
            return ()
        teeth = self.deviation.shape[2]
        # the shortest wave that the filter lets pass, in turns of the gear
        turns = np.ptp(turn) / (self.limits[1] - self.limits[0]) * cut_off(self.limits) / (2 * math.pi)
        centres = -2 * math.pi * np.arange(teeth) / teeth
        return waviness(turn, centres, self.deviation[side][self.inside], highest=1 / turns)


def usual_teeth(teeth: int) -> tuple[int, ...]:
    """Return the teeth to trace where none are chosen, equally spaced, counted from 0."""
    count = min(TRACES, teeth)
    return tuple(round(i * teeth / count) for i in range(count))


def measure_flanks(solid: Solid, placed: Placed, usable: Usable, teeth: tuple[int, ...]) -> Measured:
    """Measure left and right flanks; traces are evaluated on `teeth`, counted from 0."""
    beside = Beside(lambda: _evaluated(_helices(solid, placed), teeth))
    profile, profiles = _evaluated(_profiles(solid, placed, usable), teeth)
    helix, helices = beside.result()
    pitch = pitch_readings(solid, placed)
    outward = placed.gear.measuring_diameter / placed.gear.base_diameter
    left, right = (
        _flank(
            profile=profiles[side][0],
            helix=helices[side][0],
            # numbered clockwise: a flank further on is at a smaller angle
            index=-sense * pitch.deviation[side, 0, 0] * outward,
            facet=pitch.facet[side, 0, 0] * outward,
            waves=(profiles[side][1], helices[side][1]),
        )
        for side, sense in enumerate(SENSES)
    )
    return Measured(
        left=left,
        right=right,
        profile_range=profile.limits,
        largest_facet_um=max(profile.largest_facet_um, helix.largest_facet_um),
    )


def _evaluated(
    scan: _Scan, teeth: tuple[int, ...]
) -> tuple[_Scan, list[tuple[list[Trace | None], tuple[Wave, ...]]]]:
    """Return a scan, and traces and waves of its left and its right flanks."""
    return scan, [(scan.traces(side, teeth), scan.waves(side)) for side in range(len(SENSES))]


def _profiles(solid: Solid, placed: Placed, usable: Usable) -> _Scan:
    """Read all profiles in the measuring plane."""
    gear = placed.gear
    start, end = usable.start, max(usable.end, usable.start + 1e-3 * gear.module)
    limits = (start, start + TIP_LIMIT * (end - start))
    roll = _snapped(np.linspace(start, start + 0.99 * (end - start), POINTS), limits)
    read = read_flanks(solid, placed, np.array([placed.middle]), gear.radius_at(roll))
    return _Scan(
        position=roll,
        limits=limits,
        deviation=read.deviation[:, 0],
        facet=read.facet[:, 0],
        # a point touches its mate where its tangent to the base circle stands
        turn=np.array([-sense * roll / gear.base_radius for sense in SENSES]),
        rise=(1.0, 1.0),
    )


def _helices(solid: Solid, placed: Placed) -> _Scan:
    """Read all helices on the measuring circle."""
    gear = placed.gear
    margin = 0.5 * (placed.high - placed.low) / POINTS
    heights = _snapped(np.linspace(placed.low + margin, placed.high - margin, POINTS), placed.helix_range)
    read = read_flanks(solid, placed, heights, np.array([gear.measuring_diameter / 2]))
    # along z a right-hand helix leans to +angle: material on left flanks, lack of it on right ones
    hand = -1.0 if gear.helix < 0 else 1.0
    return _Scan(
        position=heights,
        limits=placed.helix_range,
        deviation=read.deviation[:, :, 0],
        facet=read.facet[:, :, 0],
        turn=np.array([gear.twist * (heights - placed.middle)] * 2),
        rise=(hand * SENSES[0], hand * SENSES[1]),
    )


def _snapped(position: Floats, limits: tuple[float, float]) -> Floats:
    """Return positions (m,) with the ones nearest to both ends of the evaluated range moved there.

    A relief is steepest there: a point beside the end would miss a part of it.
    """
    moved = position.copy()
    for limit in limits:
        moved[int(np.argmin(np.abs(position - limit)))] = limit
    return moved


def _flank(
    *,
    profile: list[Trace | None],
    helix: list[Trace | None],
    index: Floats,
    facet: Floats,
    waves: tuple[tuple[Wave, ...], tuple[Wave, ...]],
) -> Flank:
    """Gather one side.

    `index` (z,) is each flank's displacement [µm] in the sense of numbering, `facet` what chords do to it,
    `waves` the waviness of profile and helix.
    """
    cumulative = index - index[0]
    pitch = np.roll(index, -1) - index
    whole = bool(np.isfinite(index).all())
    profiles, helices = _whole(profile), _whole(helix)
    uncertainty = _facet_limits("profile", profiles) | _facet_limits("helix", helices)
    if whole:
        uncertainty["single_pitch_um"] = float(np.abs(np.roll(facet, -1) - facet).max())
        uncertainty["cumulative_pitch_um"] = float(np.ptp(facet))
    return Flank(
        profile=tuple(t for t in profile if t is not None),
        helix=tuple(t for t in helix if t is not None),
        pitch_um=pitch,
        cumulative_um=cumulative,
        profile_slope_um=_mean([t.slope_um for t in profiles]),
        profile_form_um=_largest([t.form_um for t in profiles]),
        profile_total_um=_largest([t.total_um for t in profiles]),
        helix_slope_um=_mean([t.slope_um for t in helices]),
        helix_form_um=_largest([t.form_um for t in helices]),
        helix_total_um=_largest([t.total_um for t in helices]),
        single_pitch_um=float(np.abs(pitch).max()) if whole else None,
        cumulative_pitch_um=float(np.ptp(cumulative)) if whole else None,
        profile_crowning_um=_mean([t.crowning_um for t in profiles]),
        helix_crowning_um=_mean([t.crowning_um for t in helices]),
        filtered=_filtered("profile", profiles) | _filtered("helix", helices),
        uncertainty=uncertainty,
        profile_waviness=waves[0],
        helix_waviness=waves[1],
    )


def _whole(traces: list[Trace | None]) -> list[Trace]:
    """All traces, or none: figures over some of the teeth would not be what they are called."""
    whole = [t for t in traces if t is not None]
    return whole if len(whole) == len(traces) else []


def _filtered(name: str, traces: list[Trace]) -> dict[str, float | None]:
    found: list[Figures] = [t.filtered for t in traces if t.filtered is not None]
    return {
        f"{name}_slope_um": _mean([f.slope_um for f in found]),
        f"{name}_form_um": _largest([f.form_um for f in found]),
        f"{name}_total_um": _largest([f.total_um for f in found]),
        f"{name}_crowning_um": _mean([f.crowning_um for f in found]),
    }


def _facet_limits(name: str, traces: list[Trace]) -> dict[str, float]:
    """Return how much of each figure the mesh's chords alone can make: no more than they show themselves."""
    limits: dict[str, float] = {}
    for trace in traces:
        for item in ("slope_um", "form_um", "total_um", "crowning_um"):
            key = f"{name}_{item}"
            limits[key] = max(limits.get(key, 0.0), abs(getattr(trace.facets, item)))
    return limits


def _mean(values: list[float]) -> float | None:
    if not values:
        return None
    mean = float(np.mean(values))
    return 0.0 if abs(mean) < NO_SLOPE else mean


def _largest(values: list[float]) -> float | None:
    return max(values, default=None)
