"""A gear hobbed off centre, with and without the table against the work angle: its flanks felt by rays."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from controller.language.source import load_program, parse_program
from twin.budget.felt import feel
from twin.compensation.hobbing import corrections, first_gear_box, points_of, table_blocks, with_table
from twin.cutting.fields import tool_field
from twin.errors import InputError
from twin.inspection.involute import geometry
from twin.job import read_job
from twin.presets import cutters_of, settings_of
from twin.probing.circle import Circle
from twin.session import run_program
from twin.setup import make_ready

SCENE = Path(__file__).parents[3] / "scenes" / "spur_m2_z20"
E, PHASE = 0.05, math.radians(110.0)
CIRCLE = Circle(x=E * math.cos(PHASE), y=E * math.sin(PHASE), radius=15.0)
PLUNGE = """G28 U0 W0
G28 H0 V0
G54 G00 X50. Z0.5
G81 T20 L1
S300
G99 G01 X35. F3.
G01 Z-4.5 F0.5
G01 X50. F3.
S0
G80
M30
"""


def felt(text, e):
    """Index deviations (2, 20) of both flanks [µm] at the middle of a blank 4 mm long."""
    job = read_job(SCENE)
    job = replace(
        job,
        work=replace(job.work, length_mm=4.0),
        faults=replace(job.faults, work_eccentricity_mm=e, work_eccentricity_phase_deg=math.degrees(PHASE)),
    )
    cutters = cutters_of(job)
    ready = make_ready(job, cutters, lowest_z_mm=-10.0)
    session = run_program(parse_program(text), settings_of(job, cutters), ready, ideal=True)
    assert session.alarms == ()
    blank = job.work.blank()
    fields = tuple(tool_field(c, m, blank.radius, blank.z_range) for c, m in session.motions)
    return feel(fields, geometry(replace(job.nominal, face_width_mm=4.0)), blank).pitch


def test_the_table_brings_the_gear_back_to_what_a_true_one_would_be():
    """Felt along their normals the flanks go to and fro by ± e without, which is F_p = 2e/cos α; with the
    table they stand as the hob leaves them on a true gear, but for words of 0.001 mm and 0.001°."""
    settings = settings_of(read_job(SCENE), cutters_of(read_job(SCENE)))
    program = parse_program(PLUNGE)
    engaged = first_gear_box(program, settings)
    text = with_table(program, engaged, CIRCLE, radius=20.0, title="T")
    off, mended, true = felt(PLUNGE, E), felt(text, E), felt(PLUNGE, 0.0)
    for a, b, c in zip(off, mended, true, strict=True):
        assert 0.1 * abs(np.fft.rfft(a)[1]) == pytest.approx(1e3 * E, rel=0.02)
        assert np.ptp(b) < 0.05 * np.ptp(a)
        assert b - b.mean() == pytest.approx(c - c.mean(), abs=1.5)


def test_the_law_by_rolling():
    """Seen from O1, the hob stands as far across as the gear's extra turn has rolled."""
    for c in np.linspace(0.0, 2.0 * math.pi, 17):
        along, turn = corrections(CIRCLE, c, 20.0)
        axis = E * np.exp(1j * (PHASE + c))
        hob = complex(30.0 + along, 0.0) - axis
        assert hob.real == pytest.approx(30.0, abs=1e-12)
        assert hob.imag == pytest.approx(20.0 * turn, abs=1e-12)


def test_the_points_lie_so_close_that_lines_between_them_keep_to_the_wave():
    n = points_of(CIRCLE)
    assert E * (1.0 - math.cos(math.pi / n)) <= 0.05e-3
    assert E * (1.0 - math.cos(math.pi / (n - 1))) > 0.05e-3
    blocks = table_blocks(CIRCLE, 20.0)
    assert blocks[0] == f"G10 L60 Q{n} ;"
    assert len(blocks) == n + 2
    assert points_of(Circle(x=0.0, y=0.0, radius=1.0)) == 12


def test_a_gear_box_in_a_subprogram_is_refused(tmp_path):
    (tmp_path / "main.nc").write_text("O0001\nG28 U0 W0\nG28 H0 V0\nM98 P0002\nG80\nM30\n")
    (tmp_path / "sub.nc").write_text("O0002\nG81 T20 L1\nM99\n")
    settings = settings_of(read_job(SCENE), cutters_of(read_job(SCENE)))
    program = load_program(tmp_path / "main.nc")
    engaged = first_gear_box(program, settings)
    with pytest.raises(InputError, match=r"sub\.nc:2: error: cannot compensate a gear box"):
        with_table(program, engaged, CIRCLE, radius=20.0, title="T")
