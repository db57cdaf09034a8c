"""Teeth that are no teeth any more: all of them, or some among sound ones, and which."""

import numpy as np

from twin.inspection.result import Flank, GearResult, Trace

FLANK_LIMIT = 0.1
"""flanks farther off than this, in modules, are no flanks of the named gear"""
DAMAGED = 0.02
"""a trace that strays farther than this, in modules, may be of a damaged tooth"""
OUTSTANDING = 5.0
"""and is, if it strays so many times farther than traces usually do"""
SIDES = ("left", "right")


def destroyed(gear: GearResult) -> str:
    """Say why these are no flanks; empty if they are."""
    totals = [trace.total_um / 1000 for _, trace in _traces(gear)]
    if not totals:
        return "no tooth has a flank that can be traced: the teeth are destroyed"
    usual = float(np.median(totals))
    if usual > FLANK_LIMIT * gear.reference.normal_module_mm:
        return (
            f"flanks stray {usual:.3f} mm from the involute, up to {max(totals):.3f} mm: "
            "the teeth are destroyed"
        )
    return ""


def damaged(gear: GearResult) -> list[str]:
    """Say which of the traced teeth stray from the involute where the others do not."""
    worst: dict[tuple[int, str], float] = {}
    for side, trace in _traces(gear):
        place = (trace.tooth, side)
        worst[place] = max(worst.get(place, 0.0), trace.total_um)
    usual = float(np.median(list(worst.values()))) if worst else 0.0
    limit = max(1000 * DAMAGED * gear.reference.normal_module_mm, OUTSTANDING * usual)
    return [
        f"tooth {tooth} is damaged: its {side} flank strays {total:.0f} µm from the involute, usual are "
        f"{usual:.1f} µm"
        for (tooth, side), total in sorted(worst.items())
        if total > limit
    ]


def holes(gear: GearResult, traced: tuple[int, ...]) -> dict[str, str]:
    """Say by result key of what teeth (counted from 0) there is no whole trace, or no pitch."""
    reasons: dict[str, str] = {}
    for side, flank in zip(SIDES, (gear.left, gear.right), strict=True):
        for name, traces in (("profile", flank.profile), ("helix", flank.helix)):
            lost = sorted({tooth + 1 for tooth in traced} - {trace.tooth for trace in traces})
            if lost:
                keys = (f"{name}_{item}_um" for item in ("slope", "form", "total", "crowning"))
                reasons |= dict.fromkeys(keys, _incomplete(side, lost))
        lost = [int(tooth) + 1 for tooth in np.flatnonzero(~np.isfinite(flank.cumulative_um))]
        if flank.single_pitch_um is None and lost:
            keys = ("single_pitch_um", "cumulative_pitch_um")
            reasons |= dict.fromkeys(keys, _incomplete(side, lost))
    return reasons


def _incomplete(side: str, teeth: list[int]) -> str:
    named = ", ".join(map(str, teeth[:5])) + (" and others" if len(teeth) > 5 else "")
    return f"the {side} flank of tooth {named} is not all there"


def _traces(gear: GearResult) -> list[tuple[str, Trace]]:
    flanks: tuple[Flank, Flank] = (gear.left, gear.right)
    return [
        (side, trace)
        for side, flank in zip(SIDES, flanks, strict=True)
        for trace in (*flank.profile, *flank.helix)
    ]
