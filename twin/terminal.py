"""A run in lines, for the terminal."""

import numpy as np

from twin.inspection.result import GearResult, Inspection, PolygonResult
from twin.load.figures import load_words
from twin.outcome import Outcome
from twin.regression.judge import table
from twin.report.data import Message, Part, ReportData
from twin.report.words import headline
from twin.summary import chip_words, messages, signed


def lines(outcome: Outcome) -> list[str]:
    """What the terminal says when a run has ended."""
    said = [str(a) for a in (*outcome.session.alarms, *outcome.session.warnings, *outcome.advice)]
    said += [f"note: {note}" for note in outcome.cut.notes]
    if outcome.chips is not None:
        said.append(f"  {chip_words(outcome.chips)}")
    if outcome.loaded is not None:
        said.append(f"  cutting forces: {load_words(outcome.loaded)}")
        if outcome.loaded.stiffness.free is not None:
            said.append(f"note: {outcome.loaded.stiffness.words()}")
    return said + part_lines(outcome.inspection, messages(outcome)) + expected_lines(outcome)


def expected_lines(outcome: Outcome) -> list[str]:
    """Whether the part is what the job expects."""
    count, missed = len(outcome.job.expect), len(outcome.missed)
    if not count:
        return []
    if not missed:
        return [f"As expected: {count} of {count} in [expect] of {outcome.job.path}"]
    return [f"Not as expected: {missed} of {count} in [expect] of {outcome.job.path}", *table(outcome.missed)]


def part_lines(inspection: Inspection, said_before: tuple[Message, ...] = ()) -> list[str]:
    """Key figures and verdict of a part."""
    said: list[str] = []
    if inspection.gear:
        said += _gear_lines(inspection.gear)
    elif inspection.polygon:
        said += _polygon_lines(inspection.polygon)
    nothing = np.zeros((0, 3))
    part = Part(vertices=nothing, faces=nothing.astype(int), deviation_um=nothing[:, 0])
    head = headline(ReportData(title="", messages=said_before, inspection=inspection, part=part))
    said.append(f"{head.label}: {head.sentence}")
    said += [f"  - {finding}" for finding in head.findings]
    return said


def _gear_lines(gear: GearResult) -> list[str]:
    def row(name: str, left: float | None, right: float | None) -> str:
        shown = ["  —   " if v is None else f"{v:6.2f}" for v in (left, right)]
        return f"  {name:<24} left {shown[0]} µm   right {shown[1]} µm"

    a, b = gear.left, gear.right
    size = f"  tip {gear.tip_diameter_mm:.3f} mm, root {gear.root_diameter_mm:.3f} mm"
    if gear.span_mm is not None:
        size += f", span over {gear.span_teeth} teeth {gear.span_mm:.4f} mm"
    return [
        f"  {gear.number_of_teeth} teeth, module {gear.normal_module_mm:.4f} mm, "
        f"helix {signed(gear.helix_angle_deg, 4)}° ({gear.hand})",
        size,
        row("profile slope f_Hα", a.profile_slope_um, b.profile_slope_um),
        row("profile form f_fα", a.profile_form_um, b.profile_form_um),
        row("helix slope f_Hβ", a.helix_slope_um, b.helix_slope_um),
        row("helix form f_fβ", a.helix_form_um, b.helix_form_um),
        row("single pitch f_p", a.single_pitch_um, b.single_pitch_um),
        row("cumulative pitch F_p", a.cumulative_pitch_um, b.cumulative_pitch_um),
    ]


def _polygon_lines(polygon: PolygonResult) -> list[str]:
    def mm(value: float | None) -> str:
        return "—" if value is None else f"{value:.4f} mm"

    return [
        f"  {polygon.number_of_sides} sides, across flats {mm(polygon.across_flats_mm)}, "
        f"by caliper {mm(polygon.across_flats_caliper_mm)}, across corners {mm(polygon.across_corners_mm)}",
        f"  bow {signed(polygon.bow_um, 2)} µm ({'concave' if polygon.bow_um < -0.005 else 'convex'}), "
        f"flatness {polygon.flatness_um:.2f} µm, twist {signed(polygon.twist_deg_per_mm, 4)} °/mm",
    ]
