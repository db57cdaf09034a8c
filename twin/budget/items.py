"""The items of a budget, from flanks felt on one part: as the inspection sheet has them (ISO 1328-1:2013)."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twin.budget.felt import Felt
from twin.inspection.trace import figures

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Item:
    """One line of the budget."""

    key: str
    """as among the tolerances of ISO 1328-1, or a word of its own"""
    symbol: str
    words: str


ITEMS = (
    Item(key="profile_slope", symbol="f_Hα", words="profile slope"),
    Item(key="profile_form", symbol="f_fα", words="profile form"),
    Item(key="profile_total", symbol="F_α", words="profile, total"),
    Item(key="helix_slope", symbol="f_Hβ", words="helix slope"),
    Item(key="helix_form", symbol="f_fβ", words="helix form"),
    Item(key="helix_total", symbol="F_β", words="helix, total"),
    Item(key="single_pitch", symbol="f_p", words="single pitch"),
    Item(key="cumulative_pitch", symbol="F_p", words="cumulative pitch"),
    Item(key="runout", symbol="F_r", words="runout"),
    Item(key="size", symbol="ΔW_k", words="span"),
)


def difference(felt: Felt, ideal: Felt) -> Felt:
    """What a source alone puts on the flanks: what is felt less what the process leaves anyway."""
    return replace(
        felt,
        profile=felt.profile - ideal.profile,
        helix=felt.helix - ideal.helix,
        pitch=felt.pitch - ideal.pitch,
        offset=felt.offset - ideal.offset,
    )


def values(felt: Felt) -> dict[str, float | None]:
    """Item -> the largest over both sides and all teeth traced [µm], span with its sign; None = not whole."""
    found: dict[str, float | None] = {}
    for name, position, traces in (("profile", felt.roll, felt.profile), ("helix", felt.height, felt.helix)):
        limits = float(position[0]), float(position[-1])
        rows = traces.reshape(-1, len(position))
        whole = bool(np.isfinite(rows).all())
        each = [figures(position, row, limits) for row in rows] if whole else []
        found[f"{name}_slope"] = max((abs(f.slope_um) for f in each), default=None)
        found[f"{name}_form"] = max((f.form_um for f in each), default=None)
        found[f"{name}_total"] = max((f.total_um for f in each), default=None)
    gear = felt.gear
    # along the measuring circle, where pitch is read
    place = felt.pitch * gear.measuring_diameter / gear.base_diameter
    steps = np.roll(place, -1, axis=1) - place
    found["single_pitch"] = float(np.abs(steps).max())
    found["cumulative_pitch"] = float(np.ptp(place, axis=1).max())
    found["runout"] = float(np.ptp(_gap_depths(felt)))
    # both flanks of the span stand out by as much, normal to them
    found["size"] = 2.0 * felt.offset * math.cos(gear.base_helix)
    return found


def _gap_depths(felt: Felt) -> Floats:
    """(z,) how far out a ball stands in every gap [µm]: on both flanks of a wedge."""
    gear = felt.gear
    at = gear.measuring_diameter / 2
    pressure = math.acos(min(gear.base_radius / at, 1.0))
    half_gap = math.pi / gear.teeth - float(gear.half_tooth(at))
    facing = np.roll(felt.pitch[0], -1)
    return 0.5 * (felt.pitch[1] + facing) / math.sin(pressure + half_gap)
