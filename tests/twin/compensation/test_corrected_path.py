"""The compensated program, by where it takes the tool beside the gear: as if the gear stood true."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.language.source import load_program, parse_program
from twin.compensation.correction import SAG_MM, corrected, widest_step
from twin.compensation.rewrite import rewritten
from twin.errors import InputError
from twin.job import read_job
from twin.presets import cutters_of, settings_of
from twin.probing.circle import Circle
from twin.session import run_program
from twin.setup import make_ready


def circle(e, phase):
    return Circle(x=e * math.cos(phase), y=e * math.sin(phase), radius=30.0)


@given(st.floats(0, 3), st.floats(-10, 10), st.floats(-400, 400))
def test_with_y_the_tool_follows_the_gears_axis(e, phase, c):
    found = corrected(circle(e, phase), c, radius=45.0, has_y=True)
    axis = e * np.exp(1j * (phase + math.radians(c)))
    assert complex(found.x, found.y) == pytest.approx(axis, abs=1e-12)
    assert (found.c, found.slope) == (0.0, 0.0)


@given(st.floats(0, 3), st.floats(-10, 10), st.floats(-400, 400), st.floats(5, 100))
def test_without_y_the_gaps_point_comes_back_onto_x(e, phase, c, radius):
    """The gap that stood on X at C as programmed, on the line from O1 along X."""
    found = corrected(circle(e, phase), c, radius=radius, has_y=False)
    more = np.exp(1j * math.radians(found.c))
    axis = e * np.exp(1j * (phase + math.radians(c))) * more
    point = axis + radius * more
    assert point == pytest.approx(radius + found.x, abs=1e-9)
    assert np.angle(more) == pytest.approx(found.slope, abs=1e-12)


@given(st.floats(1e-5, 3))
def test_no_block_turns_so_far_that_the_chord_leaves_the_arc(e):
    half = math.radians(widest_step(circle(e, 0.0))) / 2.0
    assert e * (1.0 - math.cos(half)) <= SAG_MM * (1.0 + 1e-6)


def session(job, program, faults):
    from dataclasses import replace

    job = replace(job, faults=replace(job.faults, **faults))
    cutters = cutters_of(job)
    ready = make_ready(job, cutters)
    return run_program(program, settings_of(job, cutters), ready, ideal=True), ready


@pytest.mark.parametrize(("helix", "phase"), [(0.0, 70.0), (15.0, -130.0), (-22.0, 10.0)])
def test_the_tool_passes_the_gear_as_it_would_a_true_one(gear_job, helix, phase):
    """In the part's own frame, stroke by stroke at equal heights: words of 0.001 mm and 0.001°, the chords of
    an arc, nothing else."""
    job = read_job(gear_job(helix=helix, phase=phase))
    original = load_program(job.program)
    cutters = cutters_of(job)
    settings = settings_of(job, cutters)
    work = make_ready(job, cutters).work_column
    text = rewritten(
        original,
        settings,
        circle(0.05, math.radians(phase)),
        work=work,
        radius=16.0,
        title="T",
    )
    true, _ = session(job, original, {"work_eccentricity_mm": 0.0})
    found, _ = session(job, parse_program(text), {})
    assert found.alarms == ()
    a, b = (_strokes(one.recording) for one in (true, found))
    assert len(a) == len(b) == 15
    for one, other in zip(a, b, strict=True):
        z = np.linspace(-30.0, 15.0, 200)
        off = [np.interp(z, one[:, 2], one[:, k]) - np.interp(z, other[:, 2], other[:, k]) for k in (0, 1)]
        assert np.hypot(*off).max() < 1.2e-3


def test_one_program_probes_and_grinds(gear_job):
    """The control itself fits the circle, and the strokes that follow take e and phi from its variables."""
    folder = gear_job(phase=-40.0)
    original = load_program(folder / "program.nc")
    text = (folder / "program.nc").read_text()
    probing = "T0909\nG00 X60. Z-5.\nG65 P9810 A8. D20. Q0.4 R0.4 F60.\nG28 U0\nT0101\nG00 X60. Z20."
    text = text.replace("G00 X60. Z20.", probing)
    law = "#3=#514*COS[#515+#2]\nG00 Y[#514*SIN[#515+#2]]\nG00 X[26.2+2.*#3]"
    text = text.replace("G00 X26.2000", law)
    (folder / "program.nc").write_text(text)
    job = read_job(folder)
    true, _ = session(job, original, {"work_eccentricity_mm": 0.0})
    found, _ = session(job, load_program(job.program), {})
    assert found.alarms == ()
    a, b = (_strokes(one.recording) for one in (true, found))
    assert len(a) == len(b) == 15
    for one, other in zip(a, b, strict=True):
        assert np.abs(one[10, :2] - other[10, :2]).max() < 1.2e-3


def _strokes(recording):
    """Tool centres of every stroke at depth, ascending in z."""
    reach = np.hypot(*recording.tool_centre_mm[:, :2].T)
    deep = reach < reach.min() + 0.2
    z = recording.tool_centre_mm[:, 2]
    falling = np.concatenate([[False], np.diff(z) < -1e-3]) & deep
    edges = np.flatnonzero(np.diff(falling.astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
    runs: list[np.ndarray] = []
    for first, last in edges:
        part = recording.tool_centre_mm[first:last]
        if runs and runs[-1][-1, 2] - part[0, 2] < 1.0 and runs[-1][-1, 2] > part[0, 2]:
            runs[-1] = np.vstack([runs[-1], part])
        else:
            runs.append(part)
    return [run[::-1] for run in runs if len(run) > 50]


@pytest.mark.parametrize(
    ("block", "what"),
    [
        ("G02 X70. Z10. R20. F100.", "Arc"),
        ("G50 X200.", "SetCoordinates"),
        ("G52 X1.", "zero point that moves"),
        ("G31 X55. F60.", "Skip"),
        ("G81 T20 L1", "Couple"),
    ],
)
def test_what_is_not_straight_is_refused_at_its_line(gear_job, block, what):
    job = read_job(gear_job())
    cutters = cutters_of(job)
    text = f"G28 V0\nG28 U0 W0\nG28 H0\nG00 X60. Z20.\n{block}\nM30"
    with pytest.raises(InputError, match=f":5: error: cannot compensate .*{what}|{what}"):
        rewritten(
            parse_program(text, file="odd.nc"),
            settings_of(job, cutters),
            circle(0.05, 1.0),
            work=3,
            radius=16.0,
            title="T",
        )


def test_tools_zero_points_and_dwells_are_taken_over(gear_job):
    job = read_job(gear_job())
    cutters = cutters_of(job)
    text = "G28 V0\nG28 U0 W0\nG28 H0\nT0101\nG55\nG00 X60. Z20.\nG04 X1.5\nM08\nS300 M04\nM09\nM05\nM30"
    found = rewritten(
        parse_program(text), settings_of(job, cutters), circle(0.0, 0.0), work=3, radius=16.0, title="T"
    )
    said = [line.split(" ", 1)[1].rstrip(" ;") for line in found.splitlines() if line.startswith("N")]
    assert said[3:] == [
        "G28 H0",
        "T0101",
        "G55",
        "G00 X60. Z20. Y0.",
        "G04 X1.500",
        "M08",
        "S300 M04",
        "M09",
        "M05",
        "M30",
    ]
