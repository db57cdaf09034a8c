"""A part with every fault at once says the same felt by rays and, meshed, measured by the inspection."""

import shutil
from pathlib import Path

import pytest

from twin.budget.felt import feel
from twin.budget.items import values
from twin.cutting.fields import tool_field
from twin.inspection.involute import geometry
from twin.inspection.judge_gear import worst_values
from twin.job import read_job
from twin.outcome import Options
from twin.run import run_job

SCENES = Path(__file__).parents[3] / "scenes"
FAULTS = """
[faults]
work_eccentricity_mm = 0.02
work_eccentricity_phase_deg = 30.0
work_tilt_deg = 0.1
work_tilt_phase_deg = 80.0
hob_runout_mm = 0.01
hob_wobble_mm = 0.02
hob_lead_error_um_per_turn = 6.0
hob_gash_error_deg = [0.0, 0.1, 0.0, 0.0, -0.1, 0.0, 0.0, 0.05, 0.0, 0.0, 0.0, 0.0]
swivel_error_deg = 0.3
encoder_cyclic_arcsec = { C = 20.0 }
encoder_cyclic_order = { C = 3 }
x_drift_um_per_min = 20.0
slide_tilt_deg = { xz = 0.05, yz = 0.08 }
"""


def test_the_inspection_reads_every_fault_off_the_mesh(tmp_path):
    folder = tmp_path / "job"
    shutil.copytree(SCENES / "spur_m2_z20", folder)
    text = (folder / "job.toml").read_text(encoding="utf-8").replace("length_mm = 20.0", "length_mm = 5.0")
    (folder / "job.toml").write_text(text + FAULTS, encoding="utf-8")
    program = (folder / "program.nc").read_text(encoding="utf-8")
    program = program.replace("Z20.", "Z5.").replace("Z-38. F2.", "Z-8. F1.")
    (folder / "program.nc").write_text(program, encoding="utf-8")
    job = read_job(folder)
    outcome = run_job(job, tmp_path / "out", Options(ideal=True, cell_mm=0.15))
    gear = outcome.inspection.gear
    assert gear is not None
    blank = job.work.blank()
    fields = tuple(tool_field(c, m, blank.radius, blank.z_range) for c, m in outcome.session.motions)
    felt = values(feel(fields, geometry(job.nominal), blank))
    measured = worst_values(gear) | {"runout": gear.runout_um}
    for item, least in (
        ("profile_slope", 9.0),
        ("profile_total", 12.0),
        ("helix_slope", 8.0),
        ("single_pitch", 5.0),
        ("cumulative_pitch", 40.0),
        ("runout", 35.0),
    ):
        assert felt[item] > least
        assert measured[item] == pytest.approx(felt[item], rel=0.03), item
