"""Faults that cannot be are refused with the line they stand on and what would be valid."""

import shutil
from pathlib import Path

import pytest

from twin.cli import main

SCENES = Path(__file__).parents[3] / "scenes"


def refused(tmp_path, capsys, scene, lines):
    """What the command line says to a scene with these faults, and the lines of its job."""
    job = tmp_path / "job"
    shutil.copytree(SCENES / scene, job)
    with (job / "job.toml").open("a", encoding="utf-8") as file:
        file.write("\n[faults]\n" + lines + "\n")
    out = tmp_path / "out"
    code = main(["run", str(job), "--out", str(out), "--quiet", "--ideal"])
    said = capsys.readouterr().err.strip()
    assert code == 2
    assert said.count("\n") == 0
    assert not out.exists()
    return said, (job / "job.toml").read_text(encoding="utf-8").splitlines()


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("work_eccentricity_mm = -0.1", ["faults.work_eccentricity_mm", ">= 0"]),
        ("work_eccentricity_mm = 1e3", ["faults.work_eccentricity_mm", "pass the blank by", "below"]),
        ("work_eccentricity_mm = nan", ["work_eccentricity_mm", "finite"]),
        ("work_tilt_deg = 45.0", ["faults.work_tilt_deg", "< 10"]),
        ('work_tilt_deg = "much"', ["faults.work_tilt_deg", "float"]),
        ("work_excentricity_mm = 0.1", ["unknown key 'work_excentricity_mm'", "work_eccentricity_mm"]),
        ("hob_runout_mm = -0.01", ["faults.hob_runout_mm", ">= 0"]),
        ("hob_gash_error_deg = [0.1, 0.2]", ["2 gash errors for a hob with 12 gashes", "valid: 12 of them"]),
        ("hob_gash_error_deg = [nan]", ["hob_gash_error_deg", "finite"]),
        ("hob_gash_error_deg = 0.1", ["faults.hob_gash_error_deg", "array"]),
        ("hob_lead_error_um_per_turn = -5000.0", ["hob_lead_error_um_per_turn", "run into each other"]),
        ("hob_lead_error_um_per_turn = inf", ["hob_lead_error_um_per_turn", "finite"]),
        ("encoder_cyclic_arcsec = { X = 5.0 }", ["'X' is no rotary axis", "valid: ", "C"]),
        ("encoder_cyclic_arcsec = { W = 5.0 }", ["'W' is no rotary axis", "valid: ", "C"]),
        ("encoder_cyclic_arcsec = 5.0", ["faults.encoder_cyclic_arcsec", "object"]),
        ("encoder_cyclic_order = { C = 3 }", ["C has no amplitude", "encoder_cyclic_arcsec.C"]),
        ("slide_tilt_deg = 0.1", ["faults.slide_tilt_deg", "object"]),
        ("slide_tilt_deg = { xy = 0.1 }", ["slide_tilt_deg", "xy"]),
        ("x_drift_um_per_min = true", ["faults.x_drift_um_per_min", "float"]),
    ],
)
def test_refused_with_its_line(tmp_path, capsys, line, words):
    said, lines = refused(tmp_path, capsys, "spur_m2_z20", line)
    assert f"job.toml:{len(lines)}" in said
    for word in words:
        assert word in said


def test_an_encoder_wave_steeper_than_a_control_can_follow(tmp_path, capsys):
    lines = "encoder_cyclic_order = { C = 1000 }\nencoder_cyclic_arcsec = { C = 200.0 }"
    said, text = refused(tmp_path, capsys, "spur_m2_z20", lines)
    assert f"job.toml:{len(text)}" in said
    assert "so steep" in said
    # 0.5 rad of error per rad: A = 0.5/1000 rad
    assert "up to 103.132" in said


def test_faults_of_a_hob_need_a_hob(tmp_path, capsys):
    said, text = refused(tmp_path, capsys, "hexagon_af17", "hob_runout_mm = 0.01")
    assert f"job.toml:{len(text)}" in said
    assert "hob_runout_mm: the job has no hob" in said
